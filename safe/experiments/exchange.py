"""Whole stores: several merged into one, and what one holds made again to see that it is right."""

from __future__ import annotations

import os

import numpy as np
import pandas as pd

from safe import checks
from safe.algorithms import Algorithm, Parameters
from safe.evolution import RULES, Run, evolve
from safe.experiments.experiment import Experiment
from safe.experiments.progress import bar
from safe.experiments.store import Store, StoredExperiment
from safe.maze import Maze


def merge(store: str | os.PathLike, other: str | os.PathLike) -> int:
    """Put all runs of another store into this one: those that it has already once, and where each comes from.

    Parameters
    ----------
    store : path
        The store that grows; made where there is none.
    other : path
        The other store. Nothing is added to it; one of an earlier layout is brought to that of today.

    Returns
    -------
    int
        How many runs are new in the store.

    Raises
    ------
    ValueError
        Where one of them is no store or damaged, or they have different outcomes of the same run. Nothing is merged
        then.
    """
    with Store(other, must_exist=True) as source, Store(store) as target:
        news = []
        for theirs in source.experiments():
            ours = {kept.number: kept.run for known in target.experiments(theirs.digest) for kept in target.runs(known)}
            by_batch: dict[int, list[tuple[int, Run, float]]] = {}
            for number, run, seconds, batch in source.runs(theirs):
                if number not in ours:
                    by_batch.setdefault(batch, []).append((number, run, seconds))
                elif ours[number] != run:
                    raise ValueError(
                        f"other must agree with the store; got {source}, where run {number} of {theirs.algorithm} on "
                        f"{theirs.maze} {_ending(run)}, and in {target} it {_ending(ours[number])}: see what made "
                        "either in their tables of batches"
                    )
            news.append((theirs, [(source.origin_of(batch), runs) for batch, runs in by_batch.items()]))
        for theirs, batches in news:
            experiment = target.experiment(theirs.content, theirs.digest, theirs.algorithm, theirs.maze)
            for origin, runs in batches:
                target.add(experiment, origin, runs)
    return sum(len(runs) for _, batches in news for _, runs in batches)


def verify(store: str | os.PathLike, sample: int = 10, seed: int | None = None, progress: bool = True) -> pd.DataFrame:
    """Make some of the runs in a store again, and compare them with what is stored, to the last bit.

    The checksums of all runs are looked at, too. Runs made by rules that have since changed are left out.

    Parameters
    ----------
    store : path
        The store.
    sample : int
        How many runs, drawn at random from all experiments; all where there are no more.
    seed : int, optional
        Of the draw; by default every time another.
    progress : bool
        As in `run`.

    Returns
    -------
    pandas.DataFrame
        One row for each run that was made again and is the same: algorithm, maze, seed, run, and its outcome.

    Raises
    ------
    ValueError
        Where the file is no store, or a run is not what its experiment makes.

    Examples
    --------
    >>> import tempfile
    >>> from safe import run
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     table = run(Experiment("standard", "maze1", 3, parameters=Parameters(generations=2)), f"{folder}/store")
    ...     len(verify(f"{folder}/store"))
    3
    """
    sample = checks.integer("sample", sample, 1)
    draw = np.random.default_rng(None if seed is None else checks.integer("seed", seed, 0))
    with Store(store, must_exist=True) as results:
        stored = [
            (found, kept.number)
            for found in results.experiments()
            if found.content.get("rules") == RULES
            for kept in results.runs(found)
        ]
        same, experiments = [], {}
        chosen = draw.choice(len(stored), min(sample, len(stored)), replace=False)
        for found, number in bar("verifying", progress, iterable=[stored[i] for i in chosen], unit="run"):
            if found.id not in experiments:
                experiments[found.id] = _as_experiment(found, results)
            experiment = experiments[found.id]
            seed_sequence = experiment.seed_sequence(number)
            remade = evolve(experiment.maze, experiment.algorithm, seed_sequence, experiment.parameters)
            for kept in results.runs(found, first=number, below=number + 1):
                if remade != kept.run:
                    raise ValueError(
                        f"store must hold what its experiments make; got {results}, where run {number} of "
                        f"{found.algorithm} on {found.maze}, seed {experiment.seed}, {_ending(kept.run)}, and made "
                        f"again it {_ending(remade)}"
                    )
            same.append((found.algorithm, found.maze, experiment.seed, number, remade.success, remade.generation))
    return pd.DataFrame(same, columns=["algorithm", "maze", "seed", "run", "success", "generation"])


def _ending(run: Run) -> str:
    """How a run ends, in words, with what tells two controllers apart."""
    return f"ends {run.distance} from the goal in generation {run.generation}, with p1 = {run.controller[0]}"


def _as_experiment(stored: StoredExperiment, store: Store) -> Experiment:
    content = stored.content
    try:
        experiment = Experiment(
            Algorithm(stored.algorithm, **content["algorithm"]),
            Maze.from_drawing(content["maze"], stored.maze),
            seed=content["seed"],
            parameters=Parameters(**content["parameters"]),
        )
        if experiment.digest == stored.digest:
            return experiment
    except (KeyError, TypeError, ValueError):
        pass  # of a version that knows more
    raise ValueError(
        f"store must hold experiments that this version can make; got {store}, with {stored.algorithm} on {stored.maze}"
    )
