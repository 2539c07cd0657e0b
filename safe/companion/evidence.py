"""Evidence beyond the paper, recorded: runs for which a reader should not have to wait.

    python -m safe.companion.evidence      makes everything in COLLECTIONS, and the records of it, again

A collection is what is designed and recorded together. Its record is a folder of three files::

    runs.csv.xz     how each run ended, experiment by experiment, the runs of each in order
    traces.csv.xz   what happened inside the traced runs: for each window of generations, the measures of their
                    mechanism (see `safe.results.mechanism` and `safe.results.exploration`)
    record.json     the rules; the experiments, by the first digits of their digests, whose places in this list, from 0,
                    are their numbers in the other files; what made their runs; and the SHA-256 of the other files

Coefficients and measures have three significant digits, and everything else is exact. What follows from a column is
left out: the evaluations from the generation, and a run's number from its place.
"""

from __future__ import annotations

import argparse
import hashlib
import importlib
import io
import json
import lzma
import os
import sqlite3
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor, as_completed
from contextlib import closing, nullcontext
from dataclasses import dataclass
from functools import lru_cache
from itertools import zip_longest
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

import numpy as np
import pandas as pd

from safe import checks
from safe.algorithms import COEFFICIENTS
from safe.companion import contest, designs
from safe.companion.designs import Recorded
from safe.evolution import RULES, evolve
from safe.experiments.cores import available_cores
from safe.experiments.exchange import blame
from safe.experiments.experiment import Experiment, row_of, run
from safe.experiments.progress import bar
from safe.experiments.provenance import Origin, origin
from safe.experiments.store import Store, sha256
from safe.results import exploration, mechanism

FOLDER = Path(__file__).with_name("record")
RUNS, TRACES, SUMMARY = "runs.csv.xz", "traces.csv.xz", "record.json"
_DIGITS = "%.3g"  # of a fraction: more would make the record much larger
_FILTERS = [{"id": lzma.FILTER_LZMA2, "preset": 9 | lzma.PRESET_EXTREME, "lc": 4, "pb": 0}]  # for text
_AGAIN = "make evidence makes it again"


@dataclass(frozen=True)
class Collection:
    """What is designed and recorded together."""

    name: str  # of the record's folder
    designed: Callable[[], list[Recorded]]
    coefficients: tuple[str, ...]  # that are recorded of a run
    observer: ModuleType  # which observes traced runs: it has MEASURES, observe and by_window

    @property
    def folder(self) -> Path:
        return FOLDER / self.name

    @property
    def columns(self) -> dict[str, list[str]]:
        """The columns of the tables, by file."""
        return {
            RUNS: ["experiment", "success", "generation", "distance", *self.coefficients],
            TRACES: ["experiment", "run", "window", *self.observer.MEASURES],
        }


COLLECTIONS = (
    Collection("designs", designs.everything, COEFFICIENTS, mechanism),
    Collection("contest", contest.everything, (), exploration),
    Collection("tried", contest.everything_tried, (), exploration),
)
DIGITS = 16  # of a digest, which tell an experiment from all others


class Entry(NamedTuple):
    """What a record says of an experiment."""

    digest: str  # the first digits of that of its content
    runs: int
    traced: int
    origins: list[int]  # of its runs and traces, by their places in the record's list


class Record(NamedTuple):
    """The contents of record.json."""

    rules: int
    experiments: list[Entry]
    origins: list[Origin]
    files: dict[str, str]  # SHA-256 by name


# What notebooks read


def runs(
    experiments: Iterable[Experiment], resources: dict[str, object] | None = None
) -> dict[Experiment, pd.DataFrame]:
    """The runs of experiments: the recorded ones, or the results of `safe.run` if fewer are recorded than asked for.

    Parameters
    ----------
    experiments : iterable of Experiment
    resources : dict, optional
        The keyword arguments of `safe.run` for what is not recorded (see `safe.companion.notebook.resources`). Without
        them such experiments are left out.

    Returns
    -------
    dict of Experiment to DataFrame
        The columns of `safe.run`; of recorded runs without p1..p16 and seconds, and with a and b to three digits.

    Raises
    ------
    ValueError
        If the record is damaged, or for the reasons that `safe.run` has.
    """
    wanted, found = list(experiments), {}
    for collection in COLLECTIONS:
        record = _record(collection)
        numbers = {e: n for e, n in _numbers(wanted, record).items() if record.experiments[n].runs >= e.runs}
        if not numbers:
            continue
        table = _table(collection, RUNS, record)
        table.insert(0, "run", table.groupby("experiment").cumcount())
        number_of = table.pop("experiment").to_numpy()
        population = np.zeros(len(record.experiments), dtype=int)
        population[[*numbers.values()]] = [experiment.parameters.population for experiment in numbers]
        table["evaluations"] = (table.generation + 1) * population[number_of]
        begins = np.searchsorted(number_of, [*numbers.values()])
        for experiment, begin in zip(numbers, begins, strict=True):
            recorded = table[begin : begin + experiment.runs].reset_index(drop=True)
            if experiment.algorithm.objectives == ():  # nobody judges, so there are no coefficients
                recorded = recorded.drop(columns=[*collection.coefficients])
            found[experiment] = recorded
    if resources is not None:
        found |= {experiment: run(experiment, **resources) for experiment in wanted if experiment not in found}
    return {experiment: found[experiment] for experiment in wanted if experiment in found}


def traces(
    experiments: Sequence[Experiment],
    traced: int,
    resources: dict[str, object] | None = None,
    observer: ModuleType | None = None,
) -> dict[Experiment, pd.DataFrame]:
    """What happened inside the first runs of experiments.

    It is recorded of some experiments. In experiments of which not even runs are recorded, as on another maze or with
    another seed, it is observed now, which takes a second or so for each run. Others are left out.

    Parameters
    ----------
    experiments : sequence of Experiment
    traced : int
        Of how many runs at most.
    resources : dict, optional
        As in `runs`, for what is observed now. Without them nothing is.
    observer : module
        Of a collection, for what is observed now; by default `safe.results.mechanism`.

    Returns
    -------
    dict of Experiment to DataFrame
        One row for each window of each traced run: run, window (its first generation), and the measures.

    Raises
    ------
    ValueError
        If the record is damaged, or `traced` is no integer of at least 0.
    """
    traced = checks.integer("traced", traced, 0)
    unknown, found = list(experiments), {}
    for collection in COLLECTIONS:
        record = _record(collection)
        numbers = _numbers(experiments, record)
        unknown = [experiment for experiment in unknown if experiment not in numbers]
        if not any(record.experiments[number].traced for number in numbers.values()):
            continue
        tables = dict(iter(_table(collection, TRACES, record).groupby("experiment")))
        for experiment, number in numbers.items():
            if number in tables:
                found[experiment] = tables[number][tables[number].run < min(traced, experiment.runs)]
    if resources is not None:
        found |= _observed(unknown, traced, observer or mechanism, **resources)
    return {e: found[e].drop(columns="experiment").reset_index(drop=True) for e in experiments if len(found.get(e, ()))}


def _observed(
    experiments: Sequence[Experiment],
    traced: int,
    observer: ModuleType,
    executor: Executor | None,
    cores: int | None,
    **_: object,
) -> dict[Experiment, pd.DataFrame]:
    """The traces of the first runs of these experiments, made now."""
    collection = next(collection for collection in COLLECTIONS if collection.observer is observer)
    wanted = {(e.digest, number): e for e in experiments for number in range(min(traced, e.runs))}
    made: dict[Experiment, list[str]] = {}
    for key, trace in sorted(_computed_traces(wanted, observer, executor, cores), key=lambda one: one[0]):
        made.setdefault(wanted[key], []).extend(_trace_lines(0, key[1], trace))
    header = ",".join(collection.columns[TRACES])
    return {e: _parsed(collection, TRACES, "\n".join([header, *lines])) for e, lines in made.items()}


def extent() -> pd.DataFrame:
    """How much is recorded, in a row: experiments, runs, traces, and evaluations of solutions."""
    total = dict.fromkeys(("experiments", "runs", "traces", "evaluations"), 0)
    for collection in COLLECTIONS:
        record = _record(collection)
        runs = _table(collection, RUNS, record)
        populations = dict(enumerate(one.experiment.parameters.population for one in collection.designed()))
        total["experiments"] += len(record.experiments)
        total["runs"] += len(runs)
        total["traces"] += sum(entry.traced for entry in record.experiments)
        total["evaluations"] += int(((runs.generation + 1) * runs.experiment.map(populations)).sum())
    return pd.DataFrame(total, index=["recorded"])


def _record(collection: Collection) -> Record:
    try:
        rules, experiments, origins, files = Record(**json.loads((collection.folder / SUMMARY).read_bytes()))
        return Record(rules, [Entry(*e) for e in experiments], [Origin(**o) for o in origins], dict(files))
    except (OSError, TypeError, ValueError) as error:
        raise _damaged(collection, SUMMARY, checks.reason(error)) from None


def _text(collection: Collection, name: str, record: Record) -> str:
    """The text of a file of a record, which must be the one that was written."""
    return lzma.decompress(_content(collection, name, record)).decode()


def _content(collection: Collection, name: str, record: Record) -> bytes:
    try:
        content = (collection.folder / name).read_bytes()
    except OSError as error:
        raise _damaged(collection, name, checks.reason(error)) from None
    if hashlib.sha256(content).hexdigest() != record.files.get(name):
        raise _damaged(collection, name, f"its SHA-256 is not the one in {SUMMARY}")
    return content


def _table(collection: Collection, name: str, record: Record) -> pd.DataFrame:
    return _unpacked(collection, name, _content(collection, name, record)).copy()


@lru_cache(maxsize=8)  # a notebook asks for the same files again and again
def _unpacked(collection: Collection, name: str, content: bytes) -> pd.DataFrame:
    return _parsed(collection, name, lzma.decompress(content).decode())


def _parsed(collection: Collection, name: str, text: str) -> pd.DataFrame:
    exact = ["experiment", "run", "window", "success", "generation", "distance"]
    fractions = dict.fromkeys([column for column in collection.columns[name] if column not in exact], float)
    return pd.read_csv(io.StringIO(text), dtype=fractions)


def _numbers(experiments: Iterable[Experiment], record: Record) -> dict[Experiment, int]:
    """The numbers in a record of those of the experiments that it has."""
    numbers = {entry.digest: number for number, entry in enumerate(record.experiments)}
    return {e: numbers[e.digest[:DIGITS]] for e in experiments if e.digest[:DIGITS] in numbers}


def _damaged(collection: Collection, name: str, reason: str) -> ValueError:
    path = str(collection.folder / name)
    return ValueError(f"record must hold what was written to it; got {path!r} ({reason}): {_AGAIN}")


# Making it


def make(
    store: str | os.PathLike,
    executor: Executor | None = None,
    cores: int | None = None,
    progress: bool = True,
    collections: Sequence[str] = (),
) -> None:
    """Make all runs and traces of collections, and the records of them.

    Runs are kept in the store, and traces in a file beside it, as soon as they come back. So an interrupted making
    continues where it stopped.

    Parameters
    ----------
    store, executor, cores, progress
        As in `safe.run`, also for errors.
    collections : sequence of str
        The names of those to make; by default all.
    """
    known = {collection.name: collection for collection in COLLECTIONS}
    for name in collections or known:
        _make(known[checks.choice("collections", name, known)], store, executor, cores, progress)


def _make(
    collection: Collection, store: str | os.PathLike, executor: Executor | None, cores: int | None, progress: bool
) -> None:
    designed = collection.designed()
    tables = {r.experiment: run(r.experiment, store, executor, progress, cores) for r in designed}
    kept = _made_traces(collection.observer, designed, Path(store), executor, cores, progress)
    origins: dict[Origin, int] = {}
    entries, lines = [], []
    with Store.for_reading(store) as results:
        for number, recorded in enumerate(designed):
            experiment = recorded.experiment
            (stored,) = results.experiments(experiment.digest)
            batches = {kept_run.batch for kept_run in results.runs(stored, experiment.runs)}
            mine = [kept[experiment.digest, run_number] for run_number in range(recorded.traced)]
            made_by = [results.origin_of(batch) for batch in sorted(batches)] + [trace.origin for trace in mine]
            places = sorted({origins.setdefault(o._replace(time=None), len(origins)) for o in made_by})
            entries.append(Entry(experiment.digest[:DIGITS], experiment.runs, recorded.traced, places))
            for run_number, trace in enumerate(mine):
                lines += _trace_lines(number, run_number, trace)
    ended = [line for number, table in enumerate(tables.values()) for line in _run_lines(collection, number, table)]
    _write(collection, entries, list(origins), {RUNS: ended, TRACES: lines})


def _run_lines(collection: Collection, number: int, table: pd.DataFrame) -> list[str]:
    """How these runs of an experiment ended, as lines of the record."""
    return _csv(table.assign(experiment=number).reindex(columns=collection.columns[RUNS]).set_index("experiment"))


def _trace_lines(number: int, run_number: int, trace: Trace) -> list[str]:
    """A trace as lines of the record."""
    return [f"{number},{run_number},{line}" for line in trace.lines]


def _csv(table: pd.DataFrame) -> list[str]:
    return table.to_csv(header=False, float_format=_DIGITS, lineterminator="\n").splitlines()


def _write(
    collection: Collection, entries: Sequence[Entry], origins: Sequence[Origin], lines: dict[str, Sequence[str]]
) -> None:
    """Write a record; the same content always gives the same bytes."""
    collection.folder.mkdir(parents=True, exist_ok=True)
    files = {}
    for name, rows in lines.items():
        text = "\n".join([",".join(collection.columns[name]), *rows, ""])
        content = lzma.compress(text.encode(), filters=_FILTERS)
        (collection.folder / name).write_bytes(content)
        files[name] = hashlib.sha256(content).hexdigest()
    record = Record(RULES, list(entries), [o._asdict() for o in origins], files)
    parts = [f"{json.dumps(name)}: {_lines(value)}" for name, value in record._asdict().items()]
    (collection.folder / SUMMARY).write_text("{" + ",\n".join(parts) + "}\n", encoding="utf-8", newline="\n")


def _lines(value: object) -> str:
    """A value as JSON, a list with a line for each of its items."""
    return "[\n" + ",\n".join(map(json.dumps, value)) + "\n]" if isinstance(value, list) else json.dumps(value)


TraceKey = tuple[str, int]  # the digest of an experiment, and the number of its run


class Trace(NamedTuple):
    """What happened inside a run, and what found it out."""

    rules: int
    origin: Origin
    lines: list[str]  # one for each window: its first generation, then the measures


def make_trace(observer: str, experiment: Experiment, run_number: int) -> Trace:
    """Make a run again and let a module with this name observe it, wherever the executor does so."""
    module = importlib.import_module(observer)
    observed = module.observe(experiment, experiment.replay(run_number))
    return Trace(RULES, origin(), _csv(module.by_window(observed)[[*module.MEASURES]]))


def _made_traces(
    observer: ModuleType,
    designed: Sequence[Recorded],
    store: Path,
    executor: Executor | None,
    cores: int | None,
    progress: bool,
) -> dict[TraceKey, Trace]:
    """All traces: those in the file beside the store, and the missing ones, which are computed now and kept there."""
    wanted = {(r.experiment.digest, number): r.experiment for r in designed for number in range(r.traced)}
    measured_by = sha256(Path(observer.__file__).read_text(encoding="utf-8"))  # other measures are never mixed in
    file = store.with_name(f"{store.stem}-traces.sqlite")
    with closing(sqlite3.connect(file, timeout=60, isolation_level=None)) as kept:
        kept.execute(
            "CREATE TABLE IF NOT EXISTS traces (measured_by TEXT, digest TEXT, run INTEGER, trace TEXT NOT NULL,"
            " PRIMARY KEY (measured_by, digest, run))"
        )
        rows = kept.execute("SELECT digest, run, trace FROM traces WHERE measured_by = ?", (measured_by,))
        traces = {(digest, number): _read_trace(text) for digest, number, text in rows}
        missing = {key: experiment for key, experiment in wanted.items() if key not in traces}
        with (
            bar("traces", progress, total=len(wanted), initial=len(wanted) - len(missing), unit="trace") as shown,
            closing(_computed_traces(missing, observer, executor, cores)) as computed,
        ):
            for key, trace in computed:
                kept.execute("INSERT OR IGNORE INTO traces VALUES (?, ?, ?, ?)", (measured_by, *key, json.dumps(trace)))
                traces[key] = trace
                shown.update()
    return traces


def _computed_traces(
    wanted: dict[TraceKey, Experiment], observer: ModuleType, executor: Executor | None, cores: int | None
) -> Iterator[tuple[TraceKey, Trace]]:
    """Traces as they come back. If this is closed earlier, those that have not begun are cancelled."""
    with nullcontext(executor) if executor is not None else ThreadPoolExecutor(cores or available_cores()) as pool:
        futures = {
            pool.submit(make_trace, observer.__name__, experiment, key[1]): key for key, experiment in wanted.items()
        }
        try:
            for future in as_completed(futures):
                trace = future.result()
                if trace.rules != RULES:
                    raise ValueError(f"executor must compute by the rules {RULES} of this version; got {trace.rules}")
                yield futures[future], trace
        finally:
            for future in futures:
                future.cancel()


def _read_trace(text: str) -> Trace:
    rules, made_by, lines = json.loads(text)
    return Trace(rules, Origin(*made_by), lines)


# Verifying it


def verify(sample: int = 5, traces: int = 1, seed: int | None = None) -> tuple[int, int]:
    """Make some of the recorded runs and traces again, and compare all that is recorded of them.

    Parameters
    ----------
    sample, traces : int
        How many runs and how many traces of each collection, drawn at random; all if there are no more.
    seed : int, optional
        The seed of the draw; by default every draw differs.

    Returns
    -------
    tuple of int
        How many runs and how many traces were made again.

    Raises
    ------
    ValueError
        If a record is damaged, follows other rules, holds other experiments than those of its collection, or differs
        from what they make; if an argument is no integer in range.
    """
    sample, traces = checks.integer("sample", sample, 0), checks.integer("traces", traces, 0)
    draw = np.random.default_rng(None if seed is None else checks.integer("seed", seed, 0))
    counts = [_verify(collection, sample, traces, draw) for collection in COLLECTIONS]
    return sum(runs for runs, _ in counts), sum(traces for _, traces in counts)


def _verify(collection: Collection, sample: int, traces: int, draw: np.random.Generator) -> tuple[int, int]:
    record, designed = _record(collection), collection.designed()
    _check_design(record, designed)
    (_, *ended), (header, *traced) = (_text(collection, name, record).splitlines() for name in (RUNS, TRACES))
    if header != ",".join(collection.columns[TRACES]):
        raise ValueError(f"record must hold the measures of this version; got {checks.shown(header)}: {_AGAIN}")

    drawn_runs = _drawn(draw, sample, [entry.runs for entry in record.experiments])
    for number, i in drawn_runs:
        e, place = designed[number].experiment, sum(entry.runs for entry in record.experiments[:number]) + i
        remade = evolve(e.maze, e.algorithm, e.seed_sequence(i), e.parameters)
        lines = _run_lines(collection, number, pd.DataFrame([row_of(remade)]))
        _compare(collection, RUNS, [ended[place]], lines, e, i)
    drawn_traces = _drawn(draw, traces, [entry.traced for entry in record.experiments])
    for number, i in drawn_traces:
        recorded = [line for line in traced if line.startswith(f"{number},{i},")]
        e = designed[number].experiment
        lines = _trace_lines(number, i, make_trace(collection.observer.__name__, e, i))
        _compare(collection, TRACES, recorded, lines, e, i)
    return len(drawn_runs), len(drawn_traces)


def _drawn(draw: np.random.Generator, sample: int, sizes: Sequence[int]) -> list[tuple[int, int]]:
    """So many runs, drawn from experiments with these numbers of runs: the experiment's number and the run's."""
    places = [(number, i) for number, size in enumerate(sizes) for i in range(size)]
    return [places[place] for place in draw.permutation(len(places))[:sample]]


def _check_design(record: Record, designed: Sequence[Recorded]) -> None:
    """Raise a ValueError unless this is the record of these experiments, by the rules of this version."""
    if record.rules != RULES:
        raise ValueError(f"record must follow the rules {RULES} of this version; got {record.rules}: {_AGAIN}")
    recorded = [(entry.digest, entry.runs, entry.traced) for entry in record.experiments]
    wanted = [(design.experiment.digest[:DIGITS], design.experiment.runs, design.traced) for design in designed]
    if recorded != wanted:
        first = next(n for n, (one, other) in enumerate(zip_longest(recorded, wanted)) if one != other)
        found = record.experiments[first].digest if first < len(recorded) else "none"
        missed = _label(designed[first].experiment) if first < len(designed) else "no more"
        raise ValueError(
            "record must hold the experiments that were designed, with as many runs and traces; "
            f"got {found} as number {first}, which should be {missed}: {_AGAIN}"
        )


def _compare(
    collection: Collection,
    name: str,
    recorded: Sequence[str],
    made: Sequence[str],
    experiment: Experiment,
    run_number: int,
) -> None:
    """Raise a ValueError, which names the first difference, unless these lines of a run are the same."""
    for line, expected in zip_longest(recorded, made, fillvalue=""):
        for column, found, wanted in zip_longest(
            collection.columns[name], line.split(","), expected.split(","), fillvalue=""
        ):
            if found != wanted:
                record, path = _record(collection), str(collection.folder / name)
                entry = record.experiments[_numbers([experiment], record)[experiment]]
                where = f", window {(line or expected).split(',')[2]}" if name == TRACES else ""
                raise ValueError(
                    f"record must hold what its experiments make; got {path!r}, where run {run_number} "
                    f"of {_label(experiment)}{where}, has {column} {found!r} instead of {wanted!r}"
                    + "".join(blame(record.origins[place]) for place in entry.origins)
                )


def _label(experiment: Experiment) -> str:
    return f"{experiment.algorithm.name} on {experiment.maze.name}, seed {experiment.seed} ({experiment.digest[:8]})"


def main() -> None:
    parser = argparse.ArgumentParser(description="Make everything that is recorded beyond the paper, and the record.")
    parser.add_argument("--store", default="evidence.sqlite", help="where finished runs are kept (evidence.sqlite)")
    parser.add_argument("--cores", type=int, default=0, help="how many cores of this machine; by default all")
    parser.add_argument("--scheduler", default="", help="the address of a Dask scheduler whose workers make the runs")
    parser.add_argument("collections", nargs="*", help="which collections; by default all")
    options = parser.parse_args()
    from safe.companion import notebook  # it imports matplotlib, which a build of the book must not do yet

    try:
        make(**notebook.resources(options.store, options.scheduler, options.cores), collections=options.collections)
    except ValueError as error:
        parser.error(str(error))


if __name__ == "__main__":
    from safe.companion import evidence  # other processes know what they are sent by this name, not as __main__

    evidence.main()
