"""The results store: one SQLite file that holds every finished run, and where it came from.

Runs are committed as they come back, so a process that is killed loses nothing that it has committed. Nothing in the
file is trusted: the digest of its content identifies an experiment, and a checksum guards each run, so an altered or
damaged row is noticed and reaches no table. For the tables, and for how the file is opened, see `database.py`.
"""

from __future__ import annotations

import hashlib
import json
import os
import sqlite3
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import fields
from datetime import UTC, datetime
from functools import partial
from typing import NamedTuple

import numpy as np

from safe import checks
from safe.evolution import Run
from safe.experiments.database import (
    INSERT_RUN,
    RUN,
    checksum,
    columns,
    insertion,
    open_for_reading,
    open_for_writing,
)
from safe.experiments.provenance import Origin

_LONGEST_PATH = 120  # characters that an error message shows
_CELLS = {  # by the type of a field of Run: how its cell is written, and how it is read
    "bool": (int, bool),
    "int": (int, int),
    "tuple[float, ...]": (json.dumps, lambda text: tuple(map(float, json.loads(text)))),
}
_WRITERS, _READERS = zip(*(_CELLS[field.type] for field in fields(Run)), strict=True)
_INSERT_BATCH = insertion("batches", "experiment", *Origin._fields)


class StoreError(ValueError):
    """A file that is no results store, cannot be read or written, is damaged, or disagrees with another."""


class StoredExperiment(NamedTuple):
    """An experiment in a store."""

    id: int  # in this store
    digest: str
    content: dict
    algorithm: str  # the name it was first run under
    maze: str

    @property
    def label(self) -> str:
        """The experiment as error messages name it."""
        return f"{self.algorithm} on {self.maze}"[:80]


class StoredRun(NamedTuple):
    """A run in a store."""

    number: int
    run: Run
    seconds: float
    batch: int


class Store:
    """The store in a file. `Store.for_writing` and `Store.for_reading` open it.

    Raises
    ------
    StoreError
        If the file cannot be opened, is no store, or was made by a newer version of this package; from the methods, if
        it cannot be read or written any more, or was altered or damaged.
    """

    def __init__(self, path: str | os.PathLike | None, connect: Callable[..., sqlite3.Connection], use: str) -> None:
        self.path = path
        self._batches: dict[tuple[int, Origin], int] = {}
        try:
            self._connection = connect(path)
        except PermissionError as error:
            raise self._refusal(f"be a file that can be {use}", checks.reason(error)) from None
        except (OSError, TypeError, ValueError, sqlite3.Error) as error:
            demand = "be the path of a results store, or of a file to make"
            raise self._refusal(demand, checks.reason(error)) from None

    @classmethod
    def for_writing(cls, path: str | os.PathLike | None) -> Store:
        """Open a store, which is made if it does not exist; in memory if the path is None."""
        return cls(path, open_for_writing, "written, to take runs that it lacks")

    @classmethod
    def for_reading(cls, path: str | os.PathLike | None, must_exist: bool = True) -> Store:
        """Open a store, which may be read-only, and change nothing. Unless it must exist, a missing one is empty."""
        return cls(path, partial(open_for_reading, must_exist=must_exist), "read")

    def __enter__(self) -> Store:
        return self

    def __exit__(self, *_: object) -> None:
        with self._store_errors():
            self._connection.close()

    def __str__(self) -> str:
        """The path as error messages show it: whole, or the end of it, which names the file."""
        if not isinstance(self.path, str | os.PathLike):
            return checks.shown(self.path)
        text = repr(os.fspath(self.path))
        return text if len(text) <= _LONGEST_PATH else "'..." + text[4 - _LONGEST_PATH :]

    @contextmanager
    def _transaction(self) -> Iterator[sqlite3.Connection]:
        """Make all changes of this context, or none of them."""
        with self._store_errors():
            if self._connection.in_transaction:  # left open by an interruption
                self._connection.execute("ROLLBACK")
            try:
                self._connection.execute("BEGIN IMMEDIATE")
                yield self._connection
                self._connection.execute("COMMIT")
            except BaseException:
                if self._connection.in_transaction:
                    self._connection.execute("ROLLBACK")
                raise

    @contextmanager
    def _store_errors(self) -> Iterator[None]:
        """Turn an error of SQLite into a StoreError."""
        try:
            yield
        except (sqlite3.Error, UnicodeDecodeError) as error:  # SQLite quotes what is damaged, which may not be UTF-8
            demand = "be in order, free to be written, and have room to grow"
            raise self._refusal(demand, checks.reason(error)) from None

    def _refusal(self, demand: str, reason: str) -> StoreError:
        return StoreError(f"store must {demand}; got {self} ({reason})")

    def damaged(self, what: str) -> StoreError:
        """The error that says what of this store was altered or damaged."""
        return StoreError(f"store must hold what was written to it; got {self}, where {what} was altered or damaged")

    def entry(self, content: dict, algorithm: str, maze: str) -> StoredExperiment:
        """The entry of the experiment with this content, which is added if the store has none."""
        text = content_text(content)
        with self._transaction() as connection:
            connection.execute(
                "INSERT INTO experiments (digest, content, algorithm, maze) VALUES (?, ?, ?, ?) ON CONFLICT DO NOTHING",
                (sha256(text), text, algorithm, maze),
            )
        found = self.experiments(sha256(text))
        if len(found) != 1:  # as a damaged index can have it
            raise self.damaged("its list of experiments")
        return found[0]

    def experiments(self, digest: str | None = None) -> list[StoredExperiment]:
        """The experiments in this store, or the one with this digest."""
        with self._store_errors():
            rows = self._connection.execute(
                "SELECT id, digest, content, algorithm, maze FROM experiments"
                " WHERE :digest IS NULL OR digest = :digest ORDER BY id",
                {"digest": digest},
            ).fetchall()
        found = []
        for number, its_digest, text, *labels in rows:
            try:
                content = _read_content(text, its_digest)
            except (TypeError, ValueError):
                raise self.damaged(f"experiment {number}") from None
            labels = (label if checks.is_text(label) else checks.shown(label) for label in labels)
            found.append(StoredExperiment(number, its_digest, content, *labels))
        return found

    def finished(self, experiment: StoredExperiment, below: int = 2**63 - 1) -> np.ndarray:
        """The numbers of an experiment's runs in the store that are below `below`, in order, array of int64."""
        query = "SELECT run FROM runs WHERE experiment = ? AND run >= 0 AND run < ? ORDER BY run"
        with self._store_errors():
            rows = self._connection.execute(query, (experiment.id, below))
            return np.fromiter((number for (number,) in rows), dtype=np.int64)

    def successes(self, experiment: StoredExperiment, below: int) -> int:
        """How many of the stored runs with a number below `below` succeeded."""
        with self._store_errors():
            query = "SELECT count(*) FROM runs WHERE experiment = ? AND run < ? AND success"
            return self._connection.execute(query, (experiment.id, below)).fetchone()[0]

    def add(self, experiment: StoredExperiment, origin: Origin, runs: Sequence[tuple[int, Run, float]]) -> None:
        """Store finished runs (number, run, seconds), except those that another process has stored meanwhile."""
        if not runs:
            return
        key = experiment.id, origin
        with self._transaction() as connection:
            batch = self._batches.get(key)
            if batch is None:
                stamped = origin._replace(time=origin.time or datetime.now(UTC).isoformat(timespec="seconds"))
                batch = connection.execute(_INSERT_BATCH, (experiment.id, *stamped)).lastrowid
            for number, run, seconds in runs:
                row = number, *_to_cells(run), seconds
                connection.execute(
                    f"{INSERT_RUN} ON CONFLICT DO NOTHING",
                    (experiment.id, batch, *row, checksum(experiment.digest, *row)),
                )
        self._batches[key] = batch

    def origin_of(self, batch: int) -> Origin:
        """What made the runs of a batch, and when."""
        with self._store_errors():
            row = self._connection.execute(
                f"SELECT {columns(Origin._fields)} FROM batches WHERE id = ?", (batch,)
            ).fetchone()
        if row is None:
            raise self.damaged(f"batch {checks.shown(batch)}")
        return Origin(*row)

    def runs(self, experiment: StoredExperiment, below: int = 2**63 - 1, first: int = 0) -> Iterator[StoredRun]:
        """The stored runs of an experiment with numbers from `first` to below `below`, one at a time.

        They are in order, and their controllers are alike in length, as are their coefficients.
        """
        query = f"SELECT batch, checksum, {columns(RUN)} FROM runs WHERE experiment = ? AND run >= ? AND run < ?"
        last, lengths = first - 1, None
        with self._store_errors():
            rows = self._connection.execute(f"{query} ORDER BY run", (experiment.id, first, below))
            for batch, expected, *row in rows:
                number, *cells, seconds = row
                try:
                    if checksum(experiment.digest, *row) != expected:
                        raise ValueError
                    found = StoredRun(int(number), _from_cells(cells), float(seconds), batch)
                    lengths = lengths or _lengths(found.run)
                    if found.number <= last or _lengths(found.run) != lengths:
                        raise ValueError
                except (TypeError, ValueError):
                    raise self.damaged(f"run {checks.shown(number)} of {experiment.label}") from None
                yield found
                last = found.number


def content_text(content: dict) -> str:
    """The content of an experiment as JSON, always in the same form."""
    return json.dumps(content, sort_keys=True)


def sha256(text: str) -> str:
    """The SHA-256 of a text, in hexadecimal."""
    return hashlib.sha256(text.encode()).hexdigest()


def _read_content(text: object, digest: str) -> dict:
    """The inverse of `content_text`. Raises TypeError or ValueError if the digest is that of another content."""
    if not isinstance(text, str) or sha256(text) != digest:
        raise ValueError
    return dict(json.loads(text))


def _to_cells(run: Run) -> list:
    """A run as the cells of a row."""
    return [write(getattr(run, field.name)) for write, field in zip(_WRITERS, fields(Run), strict=True)]


def _from_cells(cells: Sequence) -> Run:
    """The inverse of `_to_cells`. Raises TypeError or ValueError if a cell holds something else."""
    return Run(*(read(cell) for read, cell in zip(_READERS, cells, strict=True)))


def _lengths(run: Run) -> tuple[int, int]:
    return len(run.controller), len(run.coefficients)
