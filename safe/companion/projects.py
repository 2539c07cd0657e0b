"""For the book's projects: the generational loop in plain Python, with places for ideas of your own, and a comparison.

`search` follows the paper's rules, and makes the same runs as `safe.evolve`, bit for bit, as long as it is given
nothing else. It is slower, and everything in it can be replaced by a function or an object from a notebook.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Protocol

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from safe import checks
from safe.algorithms import Parameters
from safe.evolution import Run, Seed, seed_sequence
from safe.maze import Maze
from safe.maze_files import load_maze
from safe.novelty import NoveltyArchive
from safe.operators import Breeding, breed, empty_offspring
from safe.results import figures, formats
from safe.results.statistics import compare_rates, holm, success_interval
from safe.robot import WEIGHTS, endpoints

SHARE = 20  # a project begins with a twentieth of the runs that the book makes of an experiment


class Archive(Protocol):
    """What `search` asks for novelty."""

    def score(self, points: np.ndarray) -> np.ndarray:
        """The novelty, shape (n,), of a generation's end points, shape (n, 2)."""


def closeness_and_novelty(
    maze: Maze, genomes: np.ndarray, ends: np.ndarray, closeness: np.ndarray, novelty: np.ndarray
) -> list[np.ndarray]:
    """What the paper's objective functions weigh."""
    return [closeness, novelty]


def search(
    maze: Maze | str,
    seed: Seed,
    parameters: Parameters = Parameters(),
    *,
    genes: int = WEIGHTS,
    walk: Callable[[Maze, np.ndarray, int], np.ndarray] = endpoints,
    archive: Archive | None = None,
    components: Callable[..., Sequence[np.ndarray]] = closeness_and_novelty,
    objectives: Sequence[Sequence[float]] | None = ((0.0, 1.0),),
    rate: Callable[..., np.ndarray] | None = None,
) -> Run:
    """One run, until a success or to the last generation; by default of novelty search.

    Parameters
    ----------
    maze : Maze or str
        The maze, or its name.
    seed : int, sequence of int, or numpy.random.SeedSequence
        The seed of the run's random numbers.
    parameters : Parameters
        Sizes and rates. Choices beyond the paper, such as `admission`, have no effect.
    genes : int
        How many numbers from -1 to 1 make a solution.
    walk : function of the maze, the genomes, shape (n, genes), and the number of steps
        Gives the end points, integers of shape (n, 2).
    archive : object with a method `score`
        Gives the novelty of a generation's end points; a `safe.NoveltyArchive` if there is none. Make a new one for
        every run.
    components : function of the maze, the genomes, the end points, closeness and novelty
        Gives what objective functions weigh: several arrays of shape (n,).
    objectives : sequence of coefficients, or None
        The objective functions, with a coefficient for each component. None draws them uniformly from [0, 1].
    rate : function of the objective functions, shape (m, c), the components, shape (c, n), and distances to the goal
        Gives the fitness, shape (m,), by which objective functions are bred. Without it they never change.

    Returns
    -------
    Run
        As of `safe.evolve`.

    Raises
    ------
    ValueError
        As `safe.evolve`.

    Examples
    --------
    >>> run = search("maze1", seed=1, parameters=Parameters(generations=3))
    >>> run.success, run.generation, run.evaluations
    (False, 2, 600)
    """
    maze, rng = load_maze(maze), np.random.Generator(np.random.SFC64(seed_sequence(seed)))
    if archive is None:
        archive = NoveltyArchive(parameters.archive, parameters.k)
    rates = parameters.tournament, parameters.elites, parameters.crossover, parameters.mutation
    genomes = -1.0 + 2.0 * rng.random((parameters.population, genes))
    best, nearest = None, np.inf
    for generation in range(parameters.generations):
        ends = walk(maze, genomes, parameters.steps)
        distances = maze.distance(ends)
        closeness = 1 / np.maximum(distances, 0.5)
        weighed = np.array(components(maze, genomes, ends, closeness, archive.score(ends)))
        if objectives is None:
            objectives = rng.random((parameters.objectives, len(weighed)))
        objectives = np.asarray(objectives, dtype=float)
        scores = (objectives[:, :, np.newaxis] * weighed).sum(axis=1)  # of every solution from every objective function
        fitness = scores.max(axis=0)
        first = int(distances.argmin())
        if distances[first] < nearest:
            nearest = distances[first]
            best = tuple(genomes[first].tolist()), tuple(objectives[scores[:, first].argmax()].tolist())
        if nearest <= parameters.success_distance or generation + 1 == parameters.generations:
            break
        ratings = None if rate is None else rate(objectives, weighed, distances)
        genomes = _bred(genomes, fitness, Breeding(*rates, low=-1.0, high=1.0), rng)
        if ratings is not None:
            objectives = _bred(objectives, ratings, Breeding(*rates, low=0.0, high=1.0), rng)
    success = bool(nearest <= parameters.success_distance)
    return Run(success, generation, int(nearest), *best, (generation + 1) * parameters.population)


def _bred(genomes: np.ndarray, fitness: np.ndarray, rates: Breeding, rng: np.random.Generator) -> np.ndarray:
    offspring = empty_offspring(*genomes.shape)
    breed(genomes, np.asarray(fitness, dtype=float), None, None, rates, rng, offspring)
    return offspring.genomes


def few(runs: int) -> int:
    """The runs of each search with which a project begins: a twentieth of `runs`, but at least two.

    Examples
    --------
    >>> few(500)
    25
    """
    return max(2, checks.integer("runs", runs, 1, checks.MOST) // SHARE)


def compare(successes: Mapping[str, Sequence[bool]], baseline: str) -> pd.DataFrame:
    """Searches against a baseline: rates of success, their differences, and Fisher's exact test.

    Parameters
    ----------
    successes : mapping
        Whether each run of a search succeeded, by the name of the search. The runs of two searches are independent.
    baseline : str
        The search with which the others are compared.

    Returns
    -------
    pandas.DataFrame, one row for each search
        successes, runs; rate, low and high, with the ends of its 95 % interval; difference to the baseline's rate,
        difference_low and difference_high; and p_value, with Holm's correction for all rows.

    Examples
    --------
    >>> table = compare({"mine": [True] * 9 + [False], "theirs": [True] * 3 + [False] * 7}, "theirs")
    >>> table.rate.tolist(), round(float(table.p_value["mine"]), 3)
    ([0.9, 0.3], 0.02)
    """
    counts = {name: (int(np.sum(of_runs)), len(of_runs)) for name, of_runs in successes.items()}
    rows = []
    for name, (count, runs) in counts.items():
        low, high = success_interval(count, runs)
        row = {"successes": count, "runs": runs, "rate": count / runs, "low": low, "high": high}
        if name != baseline:
            found = compare_rates(count, runs, *counts[baseline])
            row |= {"difference": found.difference, "difference_low": found.low, "difference_high": found.high}
            row["p_value"] = found.p_value
        rows.append(row)
    table = pd.DataFrame(rows, pd.Index(counts, name="search"))
    return table.assign(p_value=holm(table.p_value))


def readable(table: pd.DataFrame) -> pd.DataFrame:
    """A table of `compare` to read."""
    return pd.DataFrame(
        {
            "successes": [formats.count(row.successes, row.runs) for row in table.itertuples()],
            "95 % interval": [f"{100 * row.low:.0f} to {100 * row.high:.0f} %" for row in table.itertuples()],
            "difference, percentage points": [
                formats.difference_of_rates(row.difference, row.difference_low, row.difference_high)
                for row in table.itertuples()
            ],
            "p": table.p_value.map(formats.p_value),
        },
        table.index,
    )


def plot(table: pd.DataFrame, title: str) -> tuple[Figure, np.ndarray]:
    """The rates of success in a table of `compare`, with their intervals."""
    rates = table.reset_index().assign(title=title, shown="rate of success, with 95 % interval")
    return figures.plot_rates(rates, "title", "search", "shown")
