"""Experiments: many independent runs of one algorithm on one maze.

What an experiment is follows from its content alone: the algorithm's objective functions and rating, the maze's cells,
the parameters, the seed, and the version of the rules by which runs are made. Labels and the number of runs do not
count: 500 runs are the 100 made before and 400 more. The randomness of run r is spawned from a digest of the content
and r, so a run depends on nothing else: not on the executor, on how many runs there are, or on what ran before.
"""

from __future__ import annotations

import hashlib
import json
import os
import time
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor, wait
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from queue import Empty, SimpleQueue
from typing import NamedTuple

import numpy as np
import pandas as pd

from safe import checks
from safe.algorithms import COEFFICIENTS, Algorithm, Parameters, get_algorithm
from safe.evolution import RULES, Generation, Run, compile_kernels, evolve_until_stopped, generations
from safe.experiments.progress import bar as progress_bar
from safe.experiments.store import Store, StoredExperiment, StoredRun, origin
from safe.maze import Maze
from safe.maze_files import load_maze
from safe.robot import WEIGHTS

MOST_SEEDS = 2**128  # as many as numpy draws from where it is asked for a seed
WEIGHT_COLUMNS = [f"p{i}" for i in range(1, WEIGHTS + 1)]


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
        How many; they are numbered from 0.
    seed : int
        Another seed gives other runs.
    parameters : Parameters
        Sizes and rates; the paper's by default.

    Raises
    ------
    ValueError
        Where a name is unknown or a number is out of range.

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
        """What makes this experiment this one and no other, ready for JSON.

        Parameters are listed where they depart from the paper's: one added later leaves old experiments what they are.
        """
        return {
            "rules": RULES,
            "seed": self.seed,
            "maze": self.maze.drawing(),
            "algorithm": {"objectives": self.algorithm.objectives, "rating": self.algorithm.rating},
            "parameters": self.parameters.departures,
        }

    @cached_property
    def digest(self) -> str:
        """SHA-256 of the content, in hexadecimal."""
        return hashlib.sha256(json.dumps(self.content, sort_keys=True).encode()).hexdigest()

    def seed_sequence(self, run: int) -> np.random.SeedSequence:
        """Where the randomness of one run starts from; `safe.evolve` makes that run of it (see also `replay`).

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
        """One run again, generation by generation, whether it is in a store or not.

        Examples
        --------
        >>> experiment = Experiment("standard", "maze1", parameters=Parameters(generations=3))
        >>> [generation.generation for generation in experiment.replay(7)]
        [0, 1, 2]
        """
        return generations(self.maze, self.algorithm, self.seed_sequence(run), self.parameters)


def run(
    experiment: Experiment,
    store: str | os.PathLike | None = None,
    executor: Executor | None = None,
    progress: bool = True,
) -> pd.DataFrame:
    """The results of an experiment: those in the store, and the missing ones, computed now.

    Runs are computed in batches of about half a second, and kept in the store as these come back, so an interrupted
    experiment goes on where it stopped.

    Parameters
    ----------
    experiment : Experiment
    store : path, optional
        The SQLite file that keeps the results; made where there is none. Without it nothing is kept.
    executor : concurrent.futures.Executor, optional
        What computes the runs; by default one thread for each core that this process may use.
    progress : bool
        Show a progress bar, where somebody watches: in a terminal or a notebook, not in a log.

    Returns
    -------
    pandas.DataFrame
        One row for each run, in order: run, success, generation (the last one; in a successful run the generations to
        success), distance (of the best solution, taxicab, in cells), p1..p16 (its controller), a, b (the objective
        function that gave it its fitness; not in random search), evaluations, seconds.

    Raises
    ------
    ValueError
        Where the store is none.

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
    with Store(store) as results:
        stored = results.experiment(
            experiment.content, experiment.digest, experiment.algorithm.name, experiment.maze.name
        )
        missing = sorted(set(range(experiment.runs)) - results.finished(stored))
        if missing:
            _compute(experiment, stored, missing, results, executor, progress)
        return _table(experiment, results.runs(stored, experiment.runs))


def run_all(
    algorithms: Sequence[Algorithm | str],
    mazes: Sequence[Maze | str],
    runs: int,
    seed: int,
    store: str | os.PathLike | None = None,
    executor: Executor | None = None,
) -> dict[Experiment, pd.DataFrame]:
    """The results of every algorithm on every maze, maze by maze; arguments and errors are those of Experiment and run.

    Examples
    --------
    >>> results = run_all(["random"], ["maze1", "maze2"], runs=1, seed=0)
    >>> [(experiment.maze.name, len(runs)) for experiment, runs in results.items()]
    [('maze1', 1), ('maze2', 1)]
    """
    experiments = [Experiment(algorithm, maze, runs, seed) for maze in mazes for algorithm in algorithms]
    return {experiment: run(experiment, store, executor) for experiment in experiments}


def _compute(
    experiment: Experiment,
    stored: StoredExperiment,
    missing: list[int],
    results: Store,
    executor: Executor | None,
    progress: bool,
) -> None:
    """Compute the missing runs, and keep them as they come back."""
    compile_kernels()
    pool = executor if executor is not None else ThreadPoolExecutor(_cores())
    stop = np.zeros(1, dtype=bool)  # seen by threads; other processes have a copy, and finish what they are at
    waiting = deque(missing)
    in_flight: set[Future] = set()
    back: SimpleQueue[Future] = SimpleQueue()
    runs, seconds, successes = 0, 0.0, results.successes(stored, experiment.runs)

    def send(most: int) -> None:
        """Batches of one run until it is known how long a run takes."""
        while waiting and len(in_flight) < most:
            size = _batch_size(len(waiting), seconds / runs) if runs else 1
            future = pool.submit(_make, experiment, [waiting.popleft() for _ in range(size)], stop)
            in_flight.add(future)
            future.add_done_callback(back.put)

    bar = progress_bar(
        f"{experiment.algorithm.name} on {experiment.maze.name}",
        progress,
        total=experiment.runs,
        initial=experiment.runs - len(missing),
        unit="run",
    )
    try:
        send(FIRST_IN_FLIGHT)
        while in_flight:
            try:
                future = back.get(timeout=None if runs else BATCH_SECONDS)
            except Empty:  # runs are long: each is a batch, and however many cores there are shall have one
                send(MOST_IN_FLIGHT)
                continue
            batch = _keep(future, results, stored)
            in_flight.discard(future)  # not before: what an interruption leaves is kept below
            if batch.failure is not None:
                raise batch.failure
            runs += len(batch.runs)
            seconds += sum(duration for _, _, duration in batch.runs)
            successes += sum(outcome.success for _, outcome, _ in batch.runs)
            bar.set_postfix(successes=successes, refresh=False)
            bar.update(len(batch.runs))
            send(MOST_IN_FLIGHT)
    except BaseException as error:
        stop[0] = True
        for future in in_flight:
            future.cancel()
        wait(in_flight, timeout=None if executor is None else 0.5)  # threads stop after a generation
        with suppress(ValueError):  # of the store, where that is what has gone wrong
            for future in in_flight:
                if future.done() and not future.cancelled() and future.exception() is None:
                    _keep(future, results, stored)
        with suppress(ValueError):
            error.add_note(_what_is_kept(experiment, results, stored))
        raise
    finally:
        bar.close()
        if executor is None:
            pool.shutdown()


def _keep(future: Future, results: Store, stored: StoredExperiment) -> Batch:
    """Keep what has come back."""
    batch = future.result()
    if batch.rules != RULES:
        raise ValueError(f"executor must compute by the rules {RULES} of this version; got {batch.rules}")
    results.add(stored, batch.origin, batch.runs)
    return batch


def _what_is_kept(experiment: Experiment, results: Store, stored: StoredExperiment) -> str:
    kept = len(results.finished(stored).intersection(range(experiment.runs)))
    if results.path is None:
        return f"{kept} of {experiment.runs} runs were finished; without a store they are not kept"
    return (
        f"{kept} of {experiment.runs} runs are kept in {results.path}; "
        "the same experiment asked for again computes the rest"
    )


FIRST_IN_FLIGHT = 16
MOST_IN_FLIGHT = 2000  # batches: enough for a thousand cores, and no burden to one
BATCH_SECONDS = 0.5  # of work, next to which sending it is little


def _batch_size(waiting: int, seconds: float) -> int:
    """How many runs of so many seconds each are sent at once; fewer towards the end, so that all cores end together."""
    return max(1, min(int(BATCH_SECONDS / seconds), waiting // 32))


class Batch(NamedTuple):
    """Finished runs, and what made them."""

    rules: int
    origin: dict[str, str | None]
    runs: list[tuple[int, Run, float]]  # number, outcome, seconds
    failure: Exception | None  # that of the run after these


def _make(experiment: Experiment, numbers: list[int], stop: np.ndarray) -> Batch:
    """Some runs of an experiment, wherever the executor sends them; those before `stop` where it is set meanwhile."""
    compile_kernels()
    runs: list[tuple[int, Run, float]] = []
    failure = None
    for number in numbers:
        started = time.perf_counter()
        seed = experiment.seed_sequence(number)
        try:
            outcome = evolve_until_stopped(stop, experiment.maze, experiment.algorithm, seed, experiment.parameters)
        except Exception as error:
            failure = error
            break
        if outcome is None:
            break
        runs.append((number, outcome, time.perf_counter() - started))
    return Batch(RULES, origin(), runs, failure)


def controller_of(row: pd.Series) -> np.ndarray:
    """The controller in one row of the results, array of float of shape (16,)."""
    return row[WEIGHT_COLUMNS].to_numpy(dtype=np.float64)


def _table(experiment: Experiment, runs: list[StoredRun]) -> pd.DataFrame:
    coefficients = [] if experiment.algorithm.is_random_search else COEFFICIENTS
    columns = ["run", "success", "generation", "distance", *WEIGHT_COLUMNS, *coefficients, "evaluations", "seconds"]
    rows = [
        (number, o.success, o.generation, o.distance, *o.controller, *o.coefficients, o.evaluations, seconds)
        for number, o, seconds, _ in runs
    ]
    return pd.DataFrame(rows, columns=columns)


def _cores() -> int:
    """How many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
