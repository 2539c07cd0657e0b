"""Whole stores: merge two of them, and verify one by making some of its runs again."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import numpy as np

from safe import checks
from safe.evolution import RULES, Run, evolve
from safe.experiments.experiment import Experiment, row_of
from safe.experiments.progress import bar
from safe.experiments.provenance import Origin
from safe.experiments.store import Store, StoredExperiment, StoreError
from safe.kernel import loaded_sources

if TYPE_CHECKING:
    import pandas as pd


def merge(store: str | os.PathLike, other: str | os.PathLike) -> int:
    """Add the runs of another store that this one lacks, and where they come from.

    Parameters
    ----------
    store : path
        The store that grows; it is made if it does not exist.
    other : path
        The other store, which is only read, and may be read-only.

    Returns
    -------
    int
        How many runs were added.

    Raises
    ------
    StoreError
        If one of them is no store or is damaged, or if they hold different outcomes of the same run. Nothing is merged
        then.
    """
    with Store.for_reading(other) as source, Store.for_writing(store) as target:
        additions = [(experiment, _lacking(target, experiment, source)) for experiment in source.experiments()]
        for experiment, batches in additions:
            entry = target.entry(experiment.content, experiment.algorithm, experiment.maze)
            for origin, runs in batches:
                target.add(entry, origin, runs)
    return sum(len(runs) for _, batches in additions for _, runs in batches)


def _lacking(
    target: Store, experiment: StoredExperiment, source: Store
) -> list[tuple[Origin, list[tuple[int, Run, float]]]]:
    """The runs (number, run, seconds) of an experiment that `target` lacks and `source` has, by their origins."""
    stored = {kept.number: kept.run for entry in target.experiments(experiment.digest) for kept in target.runs(entry)}
    batches: dict[int, list[tuple[int, Run, float]]] = {}
    for number, run, seconds, batch in source.runs(experiment):
        if number not in stored:
            batches.setdefault(batch, []).append((number, run, seconds))
        elif run != stored[number]:
            raise StoreError(
                f"other must agree with the store; got {source}, where run {number} of {experiment.label} "
                f"has {_difference(run, stored[number])}: see in their tables of batches what made either"
            )
    return [(source.origin_of(batch), runs) for batch, runs in batches.items()]


def verify(store: str | os.PathLike, sample: int = 10, seed: int | None = None, progress: bool = True) -> pd.DataFrame:
    """Make some of the runs in a store again, and compare them with the stored ones, to the last bit.

    The checksums of all runs are checked, too. Runs that follow earlier rules are left out. Runs that were made from
    other sources of the science are repeated like the others, and marked.

    Parameters
    ----------
    store : path
        The store, which is only read, and may be read-only.
    sample : int
        How many runs, drawn at random from all experiments; all runs if there are no more.
    seed : int, optional
        The seed of the draw; by default every draw differs.
    progress : bool
        As in `run`.

    Returns
    -------
    pandas.DataFrame
        One row for each run that was made again and is the same: algorithm, maze, seed, run, success, generation,
        sources. The last says whether it was made from the "same" sources as this time, from "other" ones, or from
        "unknown" ones, which early versions did not record.

    Raises
    ------
    StoreError
        If the file is no store or is damaged, or if a run in it differs from the one that its experiment makes.
    ValueError
        If the sample or seed is no integer in range.

    Examples
    --------
    >>> import tempfile
    >>> from safe import Parameters, run
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     table = run(Experiment("standard", "maze1", 3, parameters=Parameters(generations=2)), f"{folder}/store")
    ...     len(verify(f"{folder}/store"))
    3
    """
    sample = checks.integer("sample", sample, 1)
    draw = np.random.default_rng(None if seed is None else checks.integer("seed", seed, 0))
    with Store.for_reading(store) as results:
        entries = [entry for entry in results.experiments() if entry.content.get("rules") == RULES]
        numbers = [np.fromiter((kept.number for kept in results.runs(entry)), np.int64) for entry in entries]
        starts = np.cumsum([0, *map(len, numbers)])
        chosen = draw.choice(starts[-1], min(sample, starts[-1]), replace=False)
        kept_runs = []
        for place in chosen:
            which = int(np.searchsorted(starts, place, side="right")) - 1
            number = int(numbers[which][place - starts[which]])
            (kept,) = results.runs(entries[which], first=number, below=number + 1)
            kept_runs.append((entries[which], kept, results.origin_of(kept.batch)))
    import pandas as pd

    same, experiments = [], {}
    for entry, (number, kept, *_), origin in bar("verifying", progress, iterable=kept_runs, unit="run"):
        if entry.id not in experiments:
            experiments[entry.id] = _experiment(entry, results)
        experiment = experiments[entry.id]
        remade = evolve(experiment.maze, experiment.algorithm, experiment.seed_sequence(number), experiment.parameters)
        sources = _sources(origin)
        if kept != remade:
            raise StoreError(
                f"store must hold what its experiments make; got {results}, where run {number} of {entry.label}, "
                f"seed {experiment.seed}, has {_difference(kept, remade)}{blame(origin)}"
            )
        row = entry.algorithm, entry.maze, experiment.seed, number, remade.success, remade.generation, sources
        same.append(row)
    return pd.DataFrame(same, columns=["algorithm", "maze", "seed", "run", "success", "generation", "sources"])


def _sources(origin: Origin) -> str:
    """Were these runs made from the sources that this process has loaded: the same, other or unknown ones?"""
    if origin.sources is None or loaded_sources() is None:
        return "unknown"
    return "same" if origin.sources == loaded_sources() else "other"


def blame(origin: Origin) -> str:
    """The end of an error message: what made a run, unless it was made from the same sources."""
    sources = _sources(origin)
    if sources == "same":
        return ""
    made_by = f"version {str(origin.version)[:20]}, commit {str(origin.commit)[:8]}, sources {str(origin.sources)[:8]}"
    return f"; it was made from {sources} sources ({made_by})"


def _experiment(entry: StoredExperiment, store: Store) -> Experiment:
    try:
        return Experiment.from_content(entry.content, entry.algorithm, entry.maze)
    except ValueError as error:  # a newer version made it
        raise StoreError(
            f"store must hold experiments that this version can make; got {store}, with {entry.label} "
            f"({checks.reason(error)})"
        ) from None


def _difference(run: Run, expected: Run) -> str:
    """The first column of the results in which a run differs from the expected one."""
    row, expected_row = row_of(run), row_of(expected)
    column = next(column for column in row | expected_row if row.get(column) != expected_row.get(column))
    return f"{column} {row.get(column)} instead of {expected_row.get(column)}"
