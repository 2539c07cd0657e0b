"""Whole stores: several merged into one, and what one holds made again to see that it is right."""

from __future__ import annotations

import os

import numpy as np
import pandas as pd

from safe import checks
from safe.algorithms import Algorithm, Parameters
from safe.evolution import RULES, evolve
from safe.experiment import Experiment
from safe.maze import Maze
from safe.progress import bar
from safe.store import Store, StoredExperiment


def merge(store: str | os.PathLike, other: str | os.PathLike) -> int:
    """Put all runs of another store into this one: those that it has already once, and where each comes from.

    Parameters
    ----------
    store : path
        The store that grows; made where there is none.
    other : path
        The other store; it stays as it is.

    Returns
    -------
    int
        How many runs are new in the store.

    Raises
    ------
    ValueError
        Where one of them is no store, or they have different outcomes of the same run. Nothing is merged then.
    """
    with Store(other, must_exist=True) as source, Store(store) as target:
        news = []
        for theirs in source.experiments():
            ours = {kept.number: kept.run for known in target.experiments(theirs.digest) for kept in target.runs(known)}
            runs = source.runs(theirs)
            for number, run, _, _ in runs:
                if ours.get(number, run) != run:
                    raise ValueError(
                        f"other must agree with the store; was {checks.shown(str(other))}, where run {number} of "
                        f"{theirs.algorithm} on {theirs.maze} ends {run.distance} from the goal in generation "
                        f"{run.generation}, and in {store} {ours[number].distance} in {ours[number].generation}, "
                        "or with another controller: see what made either in their tables of batches"
                    )
            news.append((theirs, [kept for kept in runs if kept.number not in ours]))
        for theirs, runs in news:
            experiment = target.experiment(theirs.content, theirs.digest, theirs.algorithm, theirs.maze)
            for batch in {kept.batch for kept in runs}:
                target.add(experiment, source.origin_of(batch), [kept[:3] for kept in runs if kept.batch == batch])
    return sum(len(runs) for _, runs in news)


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
            (experiment, kept)
            for experiment in results.experiments()
            if experiment.content["rules"] == RULES
            for kept in results.runs(experiment)
        ]
    same = []
    chosen = draw.choice(len(stored), min(sample, len(stored)), replace=False)
    for which in bar("verifying", iterable=chosen, unit="run", **({} if progress else {"disable": True})):
        found, kept = stored[which]
        experiment = _as_experiment(found)
        remade = evolve(
            experiment.maze, experiment.algorithm, experiment.seed_sequence(kept.number), experiment.parameters
        )
        if remade != kept.run:
            raise ValueError(
                f"store must hold what its experiments make; was {checks.shown(str(store))}, where run {kept.number} "
                f"of {found.algorithm} on {found.maze}, seed {experiment.seed}, ends {kept.run.distance} from the "
                f"goal in generation {kept.run.generation}, and made again {remade.distance} in {remade.generation}, "
                "or with another controller"
            )
        same.append((found.algorithm, found.maze, experiment.seed, kept.number, remade.success, remade.generation))
    return pd.DataFrame(same, columns=["algorithm", "maze", "seed", "run", "success", "generation"])


def _as_experiment(stored: StoredExperiment) -> Experiment:
    content = stored.content
    experiment = Experiment(
        Algorithm(stored.algorithm, **content["algorithm"]),
        Maze.from_drawing(content["maze"], stored.maze),
        seed=content["seed"],
        parameters=Parameters(**content["parameters"]),
    )
    if experiment.digest != stored.digest:
        raise ValueError(f"store must hold experiments of this version; had {stored.algorithm} on {stored.maze}")
    return experiment
