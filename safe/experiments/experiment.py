"""Experiments: many independent runs of one algorithm on one maze.

Its content alone identifies an experiment: the algorithm's objective functions and choices, the maze's cells, the
parameters, the seed, and the version of the rules that runs follow. Names and the number of runs do not count: 500 runs
are the 100 made earlier and 400 more. The randomness of run r is spawned from a digest of the content and from r. So a
run depends on nothing else: not on the executor, on how many runs there are, or on what ran earlier.
"""

from __future__ import annotations

import os
import string
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, fields
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np

from safe import checks
from safe.algorithms import Algorithm, Parameters, get_algorithm
from safe.evolution import RULES, Generation, Run, generations
from safe.experiments.dispatch import Dispatcher
from safe.experiments.store import Store, StoredExperiment, content_text, sha256
from safe.maze import Maze
from safe.maze_files import load_maze
from safe.robot import WEIGHTS

if TYPE_CHECKING:  # imported where a table is made, since processes that only compute runs need none
    import pandas as pd

MOST_SEEDS = 2**128  # numpy, too, draws from so many if it is asked for a seed
WEIGHT_COLUMNS = [f"p{i}" for i in range(1, WEIGHTS + 1)]
# every other field of Run is one column
_COLUMNS_OF = {"controller": WEIGHT_COLUMNS, "coefficients": string.ascii_lowercase}


@dataclass(frozen=True)
class Experiment:
    """Independent runs of an algorithm on a maze.

    Parameters
    ----------
    algorithm : Algorithm or str
        The algorithm, or its name in `safe.ALGORITHMS`.
    maze : Maze or str
        The maze, its name, or the path of its file.
    runs : int
        How many runs; they are numbered from 0.
    seed : int
        Another seed gives other runs.
    parameters : Parameters
        Sizes and rates; the paper's by default.

    Raises
    ------
    ValueError
        If a name is unknown or a number is out of range.

    Examples
    --------
    >>> experiment = Experiment("safe", "maze1", seed=3)
    >>> experiment.runs, experiment.maze.goal, experiment.algorithm.rating
    (500, (41, 15), 'genotypic novelty')
    """

    algorithm: Algorithm | str
    maze: Maze | str
    runs: int = 500
    seed: int = 0
    parameters: Parameters = Parameters()

    def __post_init__(self) -> None:
        if not isinstance(self.parameters, Parameters):
            raise ValueError(f"parameters must be a Parameters; got {checks.shown(self.parameters)}")
        for name, value in (
            ("algorithm", get_algorithm(self.algorithm)),
            ("maze", load_maze(self.maze)),
            ("runs", checks.integer("runs", self.runs, 1, checks.MOST)),
            ("seed", checks.integer("seed", self.seed, 0, MOST_SEEDS - 1)),
        ):
            object.__setattr__(self, name, value)

    @property
    def content(self) -> dict:
        """What identifies this experiment, ready for JSON.

        Only parameters and choices that depart from the paper's are listed, so one that is added later changes no old
        experiment.
        """
        return {
            "rules": RULES,
            "seed": self.seed,
            "maze": _drawing(self.maze),
            "algorithm": self.algorithm.content,
            "parameters": self.parameters.departures,
        }

    @classmethod
    def from_content(cls, content: dict, algorithm: str, maze: str, runs: int = 500) -> Experiment:
        """The experiment with this content; `algorithm` and `maze` are names for what the content describes.

        Raises
        ------
        ValueError
            If this version cannot make the experiment: the content has other rules, or names or values unknown to it.

        Examples
        --------
        >>> experiment = Experiment("safe", "maze1", seed=3)
        >>> Experiment.from_content(experiment.content, "safe", "maze1") == experiment
        True
        """
        try:
            experiment = cls(
                Algorithm(algorithm, **content["algorithm"]),
                Maze.from_drawing(content["maze"], maze),
                runs,
                content["seed"],
                Parameters(**content["parameters"]),
            )
        except (KeyError, TypeError):  # a name is missing or unknown
            experiment = None
        if experiment is None or content_text(experiment.content) != content_text(content):
            raise ValueError(f"content must be one that this version writes; got {checks.shown(content)}")
        return experiment

    @cached_property
    def digest(self) -> str:
        """SHA-256 of the content, in hexadecimal."""
        return sha256(content_text(self.content))

    def seed_sequence(self, run: int) -> np.random.SeedSequence:
        """The seed of one run, from which `safe.evolve` makes the same run again (see also `replay`).

        Examples
        --------
        >>> experiment = Experiment("random", "maze1", parameters=Parameters(generations=2))
        >>> from safe import evolve
        >>> replayed = evolve("maze1", "random", experiment.seed_sequence(7), experiment.parameters)
        >>> replayed.distance == int(run(experiment, progress=False).distance[7])
        True
        """
        run = checks.integer("run", run, 0)
        return np.random.SeedSequence(int(self.digest, 16), spawn_key=(run,))

    def replay(self, run: int) -> Iterator[Generation]:
        """Make one run again, generation by generation, whether a store holds it or not.

        Examples
        --------
        >>> experiment = Experiment("standard", "maze1", parameters=Parameters(generations=3))
        >>> [generation.generation for generation in experiment.replay(7)]
        [0, 1, 2]
        """
        return generations(self.maze, self.algorithm, self.seed_sequence(run), self.parameters)


@lru_cache(maxsize=1000)
def _drawing(maze: Maze) -> str:
    """The drawing of a maze, which thousands of experiments may share."""
    return maze.drawing()


def run(
    experiment: Experiment,
    store: str | os.PathLike | None = None,
    executor: Executor | None = None,
    progress: bool = True,
    cores: int | None = None,
) -> pd.DataFrame:
    """The results of an experiment: the runs in the store, and the missing ones, which are computed now.

    Runs are stored as soon as they come back, so an interrupted experiment continues where it stopped.

    Parameters
    ----------
    experiment : Experiment
    store : path, optional
        The SQLite file that keeps the results; it is made if it does not exist. If it holds all runs, it is only read,
        and may be read-only. Without a store nothing is kept.
    executor : concurrent.futures.Executor, optional
        What computes the runs; by default threads of this process.
    progress : bool
        Show a progress bar if somebody watches: in a terminal or a notebook, but not in a log.
    cores : int, optional
        How many threads compute the runs; by default one for each core that this process may use, by its affinity (or
        PYTHON_CPU_COUNT in the environment) and by the quotas of its control groups, rounded up.

    Returns
    -------
    pandas.DataFrame
        One row for each run, in order: run, success, generation (the last one; in a successful run the generations to
        success), distance (of the best solution, taxicab, in cells), p1..p16 (its controller), a, b, ... (the objective
        function that gave it its fitness; absent if nobody judges), evaluations, seconds.

    Raises
    ------
    StoreError
        If the store is no results store, cannot be read or written, or is damaged.
    ValueError
        If `executor` is not an Executor, or computes by other rules; if `cores` is no integer of at least 1, or given
        together with an executor.

    Examples
    --------
    >>> experiment = Experiment("standard", "maze1", runs=3, parameters=Parameters(generations=5))
    >>> run(experiment, progress=False)[["run", "success", "evaluations"]]
       run  success  evaluations
    0    0    False         1000
    1    1    False         1000
    2    2    False         1000
    """
    if executor is not None and not isinstance(executor, Executor):
        raise ValueError(f"executor must be a concurrent.futures.Executor; got {checks.shown(executor)}")
    if cores is not None:
        cores = checks.integer("cores", cores, 1)
        if executor is not None:
            raise ValueError(f"cores must be left out if an executor or a scheduler is given; got {cores}")
    with Store.for_reading(store, must_exist=False) as results:
        entries = results.experiments(experiment.digest)
        is_complete = len(entries) == 1 and not _missing(experiment, results, entries[0])
        if is_complete:
            return _table(experiment, results, entries[0])
    with Store.for_writing(store) as results:
        entry = results.entry(experiment.content, experiment.algorithm.name, experiment.maze.name)
        missing = _missing(experiment, results, entry)
        if missing:
            Dispatcher(experiment, results, entry, executor, cores).compute(missing, progress)
        return _table(experiment, results, entry)


def _missing(experiment: Experiment, store: Store, entry: StoredExperiment) -> list[int]:
    """The numbers of the runs that the experiment's entry in a store lacks."""
    is_missing = np.ones(experiment.runs, dtype=bool)
    is_missing[store.finished(entry, experiment.runs)] = False
    return np.flatnonzero(is_missing).tolist()


def _table(experiment: Experiment, store: Store, entry: StoredExperiment) -> pd.DataFrame:
    """The table of an experiment that is complete, made without a copy, since it may need much of the memory."""
    import pandas as pd

    columns: dict[str, np.ndarray] = {}
    size = 0
    for number, run, seconds, _ in store.runs(entry, experiment.runs):
        row = {"run": number, **row_of(run), "seconds": seconds}
        if size == 0:
            columns = {name: np.empty(experiment.runs, dtype=type(value)) for name, value in row.items()}
        for name, value in row.items():
            columns[name][size] = value
        size += 1
    if size < experiment.runs:  # an index may name runs that its table no longer has
        raise store.damaged(f"the list of the runs of {entry.label}")
    return pd.DataFrame(columns, copy=False)


def run_all(
    algorithms: Sequence[Algorithm | str],
    mazes: Sequence[Maze | str],
    runs: int,
    seed: int,
    store: str | os.PathLike | None = None,
    executor: Executor | None = None,
    cores: int | None = None,
) -> dict[Experiment, pd.DataFrame]:
    """The results of every algorithm on every maze, maze by maze; for arguments and errors see Experiment and run.

    Examples
    --------
    >>> results = run_all(["random"], ["maze1", "maze2"], runs=1, seed=0)
    >>> [(experiment.maze.name, len(runs)) for experiment, runs in results.items()]
    [('maze1', 1), ('maze2', 1)]
    """
    experiments = [Experiment(algorithm, maze, runs, seed) for maze in mazes for algorithm in algorithms]
    return {experiment: run(experiment, store, executor, cores=cores) for experiment in experiments}


def controller_of(row: pd.Series) -> np.ndarray:
    """The controller in one row of the results, array of float of shape (16,)."""
    return row[WEIGHT_COLUMNS].to_numpy(dtype=np.float64)


def row_of(run: Run) -> dict[str, bool | int | float]:
    """A run as a row of the results."""
    row = {}
    for field in fields(Run):
        value = getattr(run, field.name)
        if field.name in _COLUMNS_OF:
            row |= zip(_COLUMNS_OF[field.name], value, strict=False)  # as many coefficients as there are
        else:
            row[field.name] = value
    return row
