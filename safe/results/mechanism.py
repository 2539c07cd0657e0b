"""What selects solutions inside a run: measures of each generation, and their means over windows of the run.

They are computed from the generations that `Experiment.replay` gives, and change nothing in the run. To measure what
tournaments favour, TOURNAMENTS of them are held in each generation, of the run's size and by its rule (see
`safe.operators`). Their random numbers come from Generator(SFC64([number of the generation])), the same in every run.

Floating-point numbers are added up in one order, in compiled functions, so that every machine gives the same bits.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable

import numpy as np
import pandas as pd

from safe.algorithms import CLOSENESS, COEFFICIENTS
from safe.evolution import Generation
from safe.experiments.experiment import Experiment
from safe.judges import Judges
from safe.kernel import kernel
from safe.maze import MazeArrays, ways_to_goal
from safe.operators import draw_index, judged_tournament, tournament
from safe.robot import WalkSpace, walk, walk_space

TOURNAMENTS = 500  # held in each generation
WINDOWS = (0, 1, 3, 10, 30, 100, 200, 300, 400)  # first generations; each lasts until the next, the last to the end

MEASURES = {
    "closeness": "mean of 1 / distance to the goal, in 1 / cells",
    "closeness_max": "largest 1 / distance to the goal, in 1 / cells",
    "novelty": "mean novelty, in cells",
    "novelty_sd": "standard deviation of novelty (ddof = 0), in cells",
    "novelty_max": "largest novelty, in cells",
    "judges": "objective functions that give some solution its fitness",
    "sole": "1 if one objective function gives all solutions their fitness, otherwise 0",
    "share": "share of fitnesses given by the objective function that gives most, the first on a tie",
    "a": "coefficient of closeness in this objective function",
    "b": "coefficient of novelty in this objective function",
    "by_novelty": "share of tournaments in which nobody drawn has a higher novelty than the winner",
    "by_closeness": "share of tournaments in which nobody drawn is nearer to the goal than the winner",
    "differential_closeness": "selection differential of minus the distance to the goal, in standard deviations",
    "differential_novelty": "selection differential of novelty, in standard deviations",
    "mean_a": "mean of a over all objective functions",
    "sd_a": "standard deviation of a over all objective functions (ddof = 0)",
    "mean_b": "mean of b over all objective functions",
    "sd_b": "standard deviation of b over all objective functions (ddof = 0)",
    "archive_size": "points in the archive of end points",
    "archive_cells": "distinct cells in the archive",
    "archive_lowest": "lowest score in the archive, in cells",
    "entered": "points in the archive that were not in it a generation before",
    "archived_neighbours": "share of solutions' k nearest neighbours that are in the archive, mean over solutions",
    "end_cells": "distinct cells in which robots have ended since the start of the run",
    "path_cells": "distinct cells that robots have visited since the start of the run",
    "progress": "1 - fewest steps to the goal from a cell visited since the start of the run / steps from the start",
}
SINCE_START = ("end_cells", "path_cells", "progress")


def observe(experiment: Experiment, story: Iterable[Generation]) -> pd.DataFrame:
    """Measure every generation of one run.

    Parameters
    ----------
    experiment : Experiment
        The experiment to which the run belongs.
    story : iterable of Generation
        The run from its first generation, as `Experiment.replay` gives it.

    Returns
    -------
    pandas.DataFrame of float64, one row for each generation, indexed by its number
        The columns of MEASURES. A measure that does not apply is not a number: those of novelty and of the archive if
        no objective function can weigh novelty, those of selection and of objective functions in random search, and
        the lowest score in an empty archive.

    Notes
    -----
    A selection differential is the mean over the winners of the tournaments, less the mean of the population, divided
    by the population's standard deviation (ddof = 0); it is 0 if the population does not vary.

    The k nearest neighbours of a solution are found among the others of the population and the points in the archive
    after the generation. If more are equally far than still count, each counts for its part.

    `entered` counts, cell by cell, the points that the archive holds beyond those of a generation before. A point that
    replaces one in the same cell does not count.

    Examples
    --------
    >>> from safe import Parameters
    >>> experiment = Experiment("novelty", "maze1", parameters=Parameters(generations=3))
    >>> table = observe(experiment, experiment.replay(0))
    >>> table[["by_novelty", "archive_size", "entered"]].loc[2].to_dict()
    {'by_novelty': 1.0, 'archive_size': 600.0, 'entered': 200.0}
    """
    maze, steps = experiment.maze, experiment.parameters.steps
    ways, space = ways_to_goal(maze), walk_space(maze.shape, steps)
    held = np.zeros(maze.shape, dtype=np.int64)  # archived points in each cell
    has_end, is_visited = np.zeros(maze.shape, dtype=bool), np.zeros(maze.shape, dtype=bool)
    numbers, rows = [], []
    for generation in story:
        held_before, held = held, _count(generation.archive[0], maze.shape)
        has_end[tuple(generation.endpoints.T)] = True
        mark_visited(maze.arrays, generation.genomes, steps, space, is_visited)
        numbers.append(generation.generation)
        rows.append(
            _components(generation)
            | _judges(generation)
            | _selection(generation, experiment)
            | _archive(generation, held, held_before, experiment.parameters.k)
            | {
                "end_cells": np.count_nonzero(has_end),
                "path_cells": np.count_nonzero(is_visited),
                "progress": 1 - ways[is_visited].min() / ways[maze.start],
            }
        )
    return pd.DataFrame(rows, pd.Index(numbers, name="generation", dtype=int), list(MEASURES), dtype=np.float64)


def by_window(table: pd.DataFrame, since_start: Collection[str] = SINCE_START) -> pd.DataFrame:
    """A table of `observe` by windows of the run.

    Parameters
    ----------
    table : DataFrame
    since_start : collection of str
        The measures since the start of the run.

    Returns
    -------
    pandas.DataFrame, one row for each of WINDOWS that the run reached, indexed by its first generation
        The mean of each measure over the window's generations, without those in which it is not a number; the last
        value of measures since the start of the run.
    """
    window = np.searchsorted(WINDOWS, table.index, side="right") - 1
    reached = np.unique(window)
    columns = {
        name: [
            values[window == w][-1] if name in since_start else _mean_of_numbers(values[window == w]) for w in reached
        ]
        for name, values in zip(table, table.to_numpy().T, strict=True)
    }
    return pd.DataFrame(columns, pd.Index(WINDOWS, name="generation")[reached], dtype=np.float64)


def _mean_of_numbers(values: np.ndarray) -> float:
    numbers = values[~np.isnan(values)]
    return moments(numbers)[0] if len(numbers) else np.nan


def _count(points: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """The number of points, given as rows and columns, in each cell of a maze: array of int of this shape."""
    cells = np.ravel_multi_index(tuple(points.T.astype(np.int64)), shape)
    return np.bincount(cells, minlength=shape[0] * shape[1]).reshape(shape)


def _components(generation: Generation) -> dict[str, float]:
    closeness, novelty = generation.components[CLOSENESS], generation.novelty
    measures = {"closeness": moments(closeness)[0], "closeness_max": closeness.max()}
    if novelty is not None:
        mean, sd = moments(novelty)
        measures |= {"novelty": mean, "novelty_sd": sd, "novelty_max": novelty.max()}
    return measures


def _judges(generation: Generation) -> dict[str, float]:
    if generation.winners is None:
        return {}
    counts = np.bincount(generation.winners)
    first = counts.argmax()
    judges = np.count_nonzero(counts)
    measures = {"judges": judges, "sole": judges == 1, "share": counts[first] / len(generation.winners)}
    measures |= zip(COEFFICIENTS, generation.objectives[first], strict=True)
    for name, coefficients in zip(COEFFICIENTS, generation.objectives.T.copy(), strict=True):
        measures[f"mean_{name}"], measures[f"sd_{name}"] = moments(coefficients)
    return measures


def _selection(generation: Generation, experiment: Experiment) -> dict[str, float]:
    if generation.fitness is None:
        return {}
    rng, twin = (np.random.Generator(np.random.SFC64([generation.generation])) for _ in range(2))
    judges = Judges(generation.objectives, generation.components if generation.scaled is None else generation.scaled)
    is_judge_drawn = experiment.algorithm.judging == "drawn judge"
    drawn = np.empty((TOURNAMENTS, experiment.parameters.tournament), dtype=np.int64)
    winners = np.empty(TOURNAMENTS, dtype=np.int64)
    hold_tournaments(generation.fitness, judges, is_judge_drawn, rng, twin, drawn, winners)
    nearness, novelty = -generation.distances.astype(np.float64), generation.novelty
    measures = {
        "by_closeness": share_unbeaten(nearness, drawn, winners),
        "differential_closeness": differential(nearness, winners),
    }
    if novelty is not None:
        measures["by_novelty"] = share_unbeaten(novelty, drawn, winners)
        measures["differential_novelty"] = differential(novelty, winners)
    return measures


def _archive(generation: Generation, held: np.ndarray, held_before: np.ndarray, k: int) -> dict[str, float]:
    """Measures of the archive, from the numbers of its points in each cell, now and a generation before."""
    if generation.novelty is None:
        return {}
    points, scores = generation.archive
    return {
        "archive_size": len(points),
        "archive_cells": np.count_nonzero(held),
        "archive_lowest": scores.min() if len(scores) else np.nan,
        "entered": np.maximum(held - held_before, 0).sum(),
        "archived_neighbours": share_archived(generation.endpoints, _count(generation.endpoints, held.shape), held, k),
    }


# Compiled functions
#
# They call only each other and kernels of the science. An edit of either has them compiled anew (see `safe.kernel`).


@kernel
def moments(values: np.ndarray) -> tuple[float, float]:
    """Mean and standard deviation (ddof = 0). Values count from the first, so that equal ones deviate by exactly 0."""
    n, first = len(values), values[0]
    total = 0.0
    for i in range(n):
        total += values[i] - first
    mean = total / n
    squares = 0.0
    for i in range(n):
        deviation = values[i] - first - mean
        squares += deviation * deviation
    return first + mean, math.sqrt(squares / n)


@kernel
def hold_tournaments(
    fitness: np.ndarray,
    judges: Judges,
    is_judge_drawn: bool,
    rng: np.random.Generator,
    twin: np.random.Generator,
    drawn: np.ndarray,
    winners: np.ndarray,
) -> None:
    """Hold a tournament for each row of `drawn`, and put those who take part into this row.

    `twin` is a generator in the state of `rng`, and draws once more what a tournament has drawn.
    """
    n, size = len(fitness), drawn.shape[1]
    for t in range(len(drawn)):
        if is_judge_drawn:
            winners[t], _ = judged_tournament(judges, n, size, rng)
        else:
            winners[t] = tournament(fitness, size, rng)
        for place in range(size):
            drawn[t, place] = draw_index(twin, n)
        if is_judge_drawn:
            draw_index(twin, len(judges.objectives))


@kernel
def share_unbeaten(values: np.ndarray, drawn: np.ndarray, winners: np.ndarray) -> float:
    """The share of tournaments in which nobody drawn has a larger value than the winner."""
    unbeaten = 0
    for t in range(len(winners)):
        is_beaten = False
        for rival in drawn[t]:
            is_beaten |= values[rival] > values[winners[t]]
        unbeaten += not is_beaten
    return unbeaten / len(winners)


@kernel
def differential(values: np.ndarray, winners: np.ndarray) -> float:
    """The mean of the winners' values less that of all, in standard deviations; 0 if the values do not vary."""
    mean, sd = moments(values)
    return (moments(values[winners])[0] - mean) / sd if sd > 0 else 0.0


@kernel
def share_archived(cells: np.ndarray, alive: np.ndarray, held: np.ndarray, k: int) -> float:
    """The share of archived points among the k nearest neighbours, averaged over a population's cells.

    `alive` and `held` count the points of the population and of the archive in each cell of the maze.
    """
    wanted = min(k, len(cells) - 1 + held.sum())
    total = 0.0
    for i in range(len(cells)):
        total += _share_archived(cells[i, 0], cells[i, 1], alive, held, wanted)
    return total / len(cells)


@kernel
def _share_archived(row: int, column: int, alive: np.ndarray, held: np.ndarray, wanted: int) -> float:
    """The same share for one of the points that `alive` counts."""
    found, archived, radius = 0, 0.0, 0
    while found < wanted:
        in_population, in_archive = _on_ring(row, column, radius, alive, held)
        if radius == 0:
            in_population -= 1  # the point itself
        counting = min(in_population + in_archive, wanted - found)
        if counting > 0:
            archived += in_archive * counting / (in_population + in_archive)
            found += counting
        radius += 1
    return archived / wanted


@kernel
def _on_ring(row: int, column: int, radius: int, alive: np.ndarray, held: np.ndarray) -> tuple[int, int]:
    """The numbers of points, in the population and in the archive, at a taxicab distance from a cell."""
    height, width = alive.shape
    in_population, in_archive = 0, 0
    for r in range(max(row - radius, 0), min(row + radius, height - 1) + 1):
        aside = radius - abs(r - row)
        if column >= aside:
            in_population += alive[r, column - aside]
            in_archive += held[r, column - aside]
        if aside > 0 and column + aside < width:
            in_population += alive[r, column + aside]
            in_archive += held[r, column + aside]
    return in_population, in_archive


@kernel
def mark_visited(
    maze: MazeArrays, controllers: np.ndarray, steps: int, space: WalkSpace, is_visited: np.ndarray
) -> None:
    """Mark the cells that the robots of some controllers visit."""
    trail, stood_at, clock = space
    for i in range(len(controllers)):
        length, _ = walk(maze, controllers[i], steps, trail, stood_at, clock[0])
        clock[0] += steps + 1
        for cell in range(length):
            is_visited[trail[cell, 0], trail[cell, 1]] = True
