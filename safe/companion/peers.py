"""Peers: search algorithms of others, with this package's robots, novelty and operators.

`nsga2` searches by closeness and novelty at once, without weighing one against the other (Deb et al., 2002). A solution
dominates another if it is at least as good in both, and better in one. Solutions that no other dominates are the first
front; those that only the first front's dominate are the second, and so on. Within a front, the less crowded are
preferred. A solution's crowding distance is the gap between its two neighbours along the front, divided by the front's
range, and summed over the two objectives; at the ends of the front it is infinite.

Each generation breeds as many offspring as there are solutions, by tournaments of two. Parents and offspring together
are scored, and the better half survives. Novelty changes as the archive grows, so parents are scored anew. The paper's
rule of admission to the archive (see `safe.novelty`) offers it all that are scored, parents included; by the other
rules only offspring enter. All draws come from one generator, as in `safe.evolution`: the genes of the first solutions;
then, generation by generation, the draws of admission and those of breeding.

Many robots end in the same cell, and equally good solutions do not dominate each other. So copies of the closest
solution are all in the first front, and can fill the population. The choice `copies` says what becomes of them::

    equal           they count like all others, as published
    latest first    fronts are formed of the latest solution of each cell; the second latest of each cell follow after
                    all of these, in the same order, then the third latest, and so on

Fronts are found by moocore, a package of the extra "book".

    python -m safe.companion.peers      makes the recorded runs again: what was tried of NSGA-II
"""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from itertools import product
from pathlib import Path
from typing import NamedTuple

import moocore
import numpy as np
import pandas as pd

from safe import checks
from safe.algorithms import Parameters
from safe.companion import contest, held_out
from safe.companion.designs import EXPLORING, VARIATION
from safe.evolution import Run, Seed, compile_kernels, seed_sequence
from safe.judges import Judges
from safe.maze import Maze
from safe.maze_files import load_maze, load_mazes
from safe.novelty import ADMISSIONS, LOWEST_REPLACED, admit, empty_archive, empty_occupancy, score_cells
from safe.operators import Breeding, breed, draw_genomes, empty_offspring
from safe.repertoire import empty_repertoire
from safe.robot import WEIGHTS, endpoints

COPIES = ("equal", "latest first")
RECORD = Path(__file__).with_name("record") / "nsga2.csv"
# tournaments go by preference, among the survivors alone:
_NOBODY, _NOTHING = Judges(np.empty((0, 2)), np.empty((2, 0))), empty_repertoire((0, 0), WEIGHTS)


def nsga2(maze: Maze | str, seed: Seed, parameters: Parameters = Parameters(), copies: str = "equal") -> Run:
    """Search by closeness and novelty with NSGA-II, until a success or to the last generation.

    Parameters
    ----------
    maze : Maze or str
        The maze, or its name.
    seed : int, sequence of int, or numpy.random.SeedSequence
        The seed of the run's random numbers.
    parameters : Parameters
        Sizes and rates; the paper's by default. Those of tournaments, elites and objective functions have no effect.
    copies : {"equal", "latest first"}
        What becomes of solutions whose robots end in the same cell.

    Returns
    -------
    Run
        As of `safe.evolve`. There are no objective functions, and so no coefficients.

    Raises
    ------
    ValueError
        As `safe.evolve`.

    Examples
    --------
    >>> run = nsga2("maze1", seed=1, parameters=Parameters(generations=3, admission="random"))
    >>> run.success, run.generation, run.evaluations
    (False, 2, 600)
    """
    maze = load_maze(maze)
    if not isinstance(parameters, Parameters):
        raise ValueError(f"parameters must be a Parameters; got {checks.shown(parameters)}")
    checks.choice("copies", copies, COPIES)
    compile_kernels()
    rng = np.random.Generator(np.random.SFC64(seed_sequence(seed)))
    rule, size = ADMISSIONS.index(parameters.admission), parameters.population
    breeding = Breeding(2, 0, parameters.crossover, parameters.mutation, low=-1.0, high=1.0)
    archive, occupancy = empty_archive(parameters.archive, 2), empty_occupancy(maze.shape)
    threshold = np.array([parameters.threshold, 0.0])

    genomes, ends, preference = np.empty((0, WEIGHTS)), np.empty((0, 2), dtype=np.int64), np.empty(0)
    bred = empty_offspring(size, WEIGHTS)
    offspring = bred.genomes
    draw_genomes(rng, -1.0, 1.0, offspring)
    distance, controller = np.iinfo(np.int64).max, None
    for generation in range(parameters.generations):
        if generation > 0:
            breed(genomes, preference, _NOBODY, _NOTHING, breeding, rng, bred)
        offspring_ends = endpoints(maze, offspring, parameters.steps)
        distances = maze.distance(offspring_ends)
        nearest = int(distances.argmin())
        if distances[nearest] < distance:
            distance, controller = int(distances[nearest]), tuple(offspring[nearest].tolist())
        if distance <= parameters.success_distance:
            break
        genomes, ends = np.concatenate([genomes, offspring]), np.concatenate([ends, offspring_ends])
        novelty = np.empty(len(ends))
        score_cells(ends, archive, occupancy, parameters.k, rule, novelty)
        if rule != LOWEST_REPLACED:
            of_offspring, admitted = novelty[-size:], parameters.admitted
            admit(offspring_ends, of_offspring, archive, occupancy, rule, admitted, threshold, rng)
        closeness = 1 / np.maximum(maze.distance(ends), 0.5)
        preference = preferences(closeness, novelty) if copies == "equal" else latest_first(ends, closeness, novelty)
        survivors = np.sort(np.argsort(-preference, kind="stable")[:size])  # the latest stay the last
        genomes, ends, preference = genomes[survivors], ends[survivors], preference[survivors]
    return Run(distance <= parameters.success_distance, generation, distance, controller, (), (generation + 1) * size)


def preferences(*objectives: np.ndarray) -> np.ndarray:
    """A number for each solution, by which NSGA-II prefers one to another: by its front, then by its crowding.

    Parameters
    ----------
    *objectives : arrays of float, shape (n,)
        To be maximised.

    Returns
    -------
    array of float, shape (n,)
        The larger, the better; the same for solutions between which it has no preference.
    """
    fronts = moocore.pareto_rank(np.column_stack(objectives), maximise=True)
    most = len(objectives)  # the crowding distance of a solution that is not at the end of its front
    # rounded, so that the order of additions does not tell the equally crowded apart
    return np.minimum(crowding(objectives, fronts), most + 1).round(9) - (most + 2) * fronts


def latest_first(ends: np.ndarray, *objectives: np.ndarray) -> np.ndarray:
    """As `preferences`, but of the latest solution of each cell; all others follow, cell by cell in the same order.

    Parameters
    ----------
    ends : array of int, shape (n, 2)
        The end points, the latest last.
    *objectives : arrays of float, shape (n,)
        To be maximised.
    """
    places = np.arange(len(ends))
    by_cell = np.lexsort((-places, *ends.T[::-1]))  # the latest of each cell in front
    is_latest = np.diff(ends[by_cell], axis=0, prepend=-1).any(axis=1)
    copy = places - np.maximum.accumulate(np.where(is_latest, places, 0))  # 0 is the latest, 1 the second latest
    of_cell = preferences(*(values[by_cell[is_latest]] for values in objectives))
    preference = np.empty(len(ends))
    preference[by_cell] = of_cell[np.cumsum(is_latest) - 1] - copy * (np.ptp(of_cell) + 1)
    return preference


def crowding(objectives: tuple[np.ndarray, ...], fronts: np.ndarray) -> np.ndarray:
    """The crowding distance of each solution in its front, all fronts at once; fronts are numbered from 0."""
    total = np.zeros(len(fronts))
    for values in objectives:
        order = np.lexsort((values, fronts))
        ascending, front = values[order], fronts[order]
        first = np.flatnonzero(np.diff(front, prepend=-1))
        last = np.append(first[1:], len(front)) - 1
        span = (ascending[last] - ascending[first])[front]
        share = np.zeros(len(front))
        share[1:-1] = (ascending[2:] - ascending[:-2]) / np.where(span > 0, span, 1)[1:-1]
        share[first] = share[last] = np.inf
        total[order] += share
    return total


# What was tried


class Tried(NamedTuple):
    """A recorded run: the columns of the record that say how it is made."""

    maze: str
    copies: str
    operators: str
    run: int

    def made(self) -> dict[str, int]:
        """How it ends: success, generation and distance."""
        rules = Parameters(**contest.RANDOM_ARCHIVE | VARIATION[self.operators])
        place, maze = _mazes_tried()[self.maze]
        found = nsga2(maze, (EXPLORING, place, self.run), rules, self.copies)
        return {"success": int(found.success), "generation": found.generation, "distance": found.distance}


def all_tried() -> Iterator[Tried]:
    """The runs of the record, in its order: as many as of a contestant (`contest.everything_tried`)."""
    for (label, (place, _)), copies, operators in product(_mazes_tried().items(), COPIES, VARIATION):
        runs = contest.TRIED if place < held_out.SIZE else contest.TRIED_ON_KNOWN
        yield from (Tried(label, copies, operators, run) for run in range(runs))


def counts() -> pd.DataFrame:
    """Successes and runs of NSGA-II on each maze, as `safe.companion.standings.counts` gives those of contestants."""
    table = pd.read_csv(RECORD)
    table["contestant"] = "NSGA-II, copies " + table.copies
    table["evaluations"] = (table.generation + 1) * Parameters().population
    groups = table.groupby(["contestant", "operators", "maze"], sort=False)
    return groups.agg(successes=("success", "sum"), runs=("run", "size"), evaluations=("evaluations", "sum"))


def verify(sample: int = 2, seed: int | None = None) -> int:
    """Make some of the recorded runs again, and compare them.

    Parameters
    ----------
    sample : int
        How many, drawn at random; all if there are no more.
    seed : int, optional
        The seed of the draw; by default every draw differs.

    Returns
    -------
    int
        How many runs were made again.

    Raises
    ------
    ValueError
        If the record does not hold the runs of `all_tried`, or a run differs from what it makes.
    """
    header, *lines = RECORD.read_text(encoding="utf-8").splitlines()
    wanted = list(all_tried())
    if [line.rsplit(",", 3)[0] for line in lines] != [",".join(map(str, one)) for one in wanted]:
        raise ValueError(f"record must hold the runs that were designed; got others in {str(RECORD)!r}")
    drawn = np.random.default_rng(seed).permutation(len(lines))[:sample]
    for place in drawn:
        if lines[place] != (made := _line(wanted[place])):
            raise ValueError(
                f"record must hold what its runs make; got {lines[place]!r} instead of {made!r} ({header})"
            )
    return len(drawn)


@cache
def _mazes_tried() -> dict[str, tuple[int, Maze]]:
    """The mazes of the design set and the known ones, each by its name with its place."""
    mazes = [*held_out.design_set(), *load_mazes(list(contest.KNOWN))]
    return {maze.name: (place, maze) for place, maze in enumerate(mazes)}


def _line(tried: Tried) -> str:
    return ",".join(map(str, (*tried, *tried.made().values())))


def main() -> None:
    with ProcessPoolExecutor() as pool:
        lines = list(pool.map(_line, all_tried(), chunksize=8))
    header = ",".join((*Tried._fields, "success", "generation", "distance"))
    RECORD.write_text("\n".join([header, *lines, ""]), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    from safe.companion import peers  # other processes know what they are sent by this name, not as __main__

    peers.main()
