"""How a run explores: where its robots have been, which of them become parents, who chooses them, and its goals.

These are measures of each generation, and their means over windows of the run, as in `safe.results.mechanism`. They
take parents as they were: a generation's selection is known from the parents of the next, so the last has none.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pandas as pd

from safe.evolution import Generation
from safe.experiments.experiment import Experiment
from safe.judges import REACHED
from safe.maze import Maze, ways_to_goal
from safe.paths import empty_paths, score_paths
from safe.results import mechanism
from safe.results.mechanism import differential
from safe.robot import walk_all, walk_space

MEASURES = {
    "end_cells": "distinct cells in which robots have ended since the start of the run",
    "path_cells": "distinct cells that robots have visited since the start of the run",
    "progress": "1 - fewest steps to the goal from a cell visited since the start of the run / steps from the start",
    "parents": "distinct parents of the next generation, over its size",
    "choosers": "distinct objective functions that choose one of them",
    "differential_closeness": "selection differential of minus the distance to the goal, in standard deviations",
    "differential_way": "selection differential of minus the length of the shortest way to the goal, likewise",
    "differential_novelty": "selection differential of novelty, likewise",
    "differential_rarity": "selection differential of path rarity, likewise",
    "reached": "share of goals near which a robot of the generation ends",
    "goal_distance": "mean distance from a goal to the nearest end point of the generation, in cells",
    "changed": "share of goals that are others in the next generation",
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
        The columns of MEASURES. A measure that does not apply is not a number: those of selection in the last
        generation, in random search, and if parents come from the repertoire; those of goals if there are none.

    Notes
    -----
    A selection differential is the mean over the parents of the next generation, less the mean of the generation,
    divided by its standard deviation (ddof = 0); it is 0 if the generation does not vary. A goal is reached if a robot
    ends within 1 cell.

    Examples
    --------
    >>> from safe import Algorithm, Parameters
    >>> goals = Algorithm("goals", kind="goal", judging="favourite")
    >>> experiment = Experiment(goals, "maze1", parameters=Parameters(generations=3))
    >>> observe(experiment, experiment.replay(0)).changed.tolist()
    [0.0, 0.0, nan]
    """
    maze, steps = experiment.maze, experiment.parameters.steps
    ways, space = ways_to_goal(maze), walk_space(maze.shape, steps)
    paths = empty_paths(experiment.parameters.population, maze.shape, steps)
    ends = np.empty((experiment.parameters.population, 2), dtype=np.int64)
    has_end = np.zeros(maze.shape, dtype=bool)
    is_generation = experiment.algorithm.pool == "generation" and not experiment.algorithm.is_random_search
    numbers, rows, values, goals = [], [], {}, None
    for generation in story:
        if rows:
            rows[-1] |= _selected(values, generation) if is_generation else _choosers(generation)
            rows[-1] |= _changed(goals, generation.objectives)
        walk_all(maze.arrays, generation.genomes, steps, space, ends, paths)
        rarity = np.empty(len(ends))
        score_paths(paths, rarity)
        has_end[tuple(ends.T)] = True
        is_visited = paths.visits.reshape(maze.shape) > 0
        values = {
            "closeness": -generation.distances.astype(np.float64),
            "way": -ways[tuple(ends.T)].astype(np.float64),
            "novelty": generation.novelty,
            "rarity": rarity,
        }
        goals = _goals(experiment, generation.objectives)
        numbers.append(generation.generation)
        rows.append(
            {
                "end_cells": np.count_nonzero(has_end),
                "path_cells": np.count_nonzero(is_visited),
                "progress": 1 - ways[is_visited].min() / ways[maze.start],
            }
            | _goal_measures(goals, ends, maze)
        )
    return pd.DataFrame(rows, pd.Index(numbers, name="generation", dtype=int), list(MEASURES), dtype=np.float64)


def by_window(table: pd.DataFrame) -> pd.DataFrame:
    """A table of `observe` by windows of the run, see `safe.results.mechanism.by_window`."""
    return mechanism.by_window(table, SINCE_START)


def places_of(maze: Maze, goals: np.ndarray) -> np.ndarray:
    """The cells that goals name.

    Parameters
    ----------
    maze : Maze
    goals : array of float, shape (n, 2 or more)
        Their genomes (a, b), in the unit square.

    Returns
    -------
    array of int, shape (n, 2)
        Row and column.
    """
    shape = np.array(maze.shape)
    return np.minimum((goals[:, :2] * shape).astype(np.int64), shape - 1)


def _goals(experiment: Experiment, objectives: np.ndarray) -> np.ndarray:
    """Those of the objective functions that are goals."""
    return objectives[experiment.algorithm.first_goal(len(objectives)) :]


def _goal_measures(goals: np.ndarray, ends: np.ndarray, maze: Maze) -> dict[str, float]:
    if len(goals) == 0:
        return {}
    distances = np.abs(places_of(maze, goals)[:, np.newaxis] - ends).sum(axis=2).min(axis=1)
    return {"reached": np.mean(distances <= REACHED), "goal_distance": distances.mean()}


def _choosers(generation: Generation) -> dict[str, float]:
    """Whose parents this generation has, of those before."""
    choosers = generation.chosen_by[generation.chosen_by >= 0]
    measures = {"choosers": len(np.unique(choosers))} if len(choosers) else {}
    if (generation.parents >= 0).all():
        measures["parents"] = len(np.unique(generation.parents)) / len(generation.parents)
    return measures


def _selected(values: dict[str, np.ndarray | None], generation: Generation) -> dict[str, float]:
    """As `_choosers`, and what distinguished these parents, from the values of the generation before."""
    measures = {
        f"differential_{name}": differential(of_all, generation.parents)
        for name, of_all in values.items()
        if of_all is not None
    }
    return _choosers(generation) | measures


def _changed(goals: np.ndarray, objectives: np.ndarray) -> dict[str, float]:
    if len(goals) == 0:
        return {}
    return {"changed": np.mean((goals != objectives[-len(goals) :]).any(axis=1))}
