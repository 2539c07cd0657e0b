"""The results store: one SQLite file with every run that was ever finished, and where it came from.

    experiments   one row each: the content that identifies it, as JSON, and the names it was first run under
    batches       one row for each program, machine and time that made runs
    runs          one row for each finished run, with a checksum

Runs are committed as they come back. The file is in WAL mode, so several processes can read and write it at once, and
one that is killed loses nothing that was committed. Nothing in the file is trusted: an experiment is told by the digest
of its content, a run by its checksum, so that what was altered or damaged is noticed, and never part of a table.
"""

from __future__ import annotations

import functools
import hashlib
import json
import os
import platform
import sqlite3
import subprocess
import time
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

import numba
import numpy as np

from safe import checks
from safe.evolution import Run
from safe.version import __version__

_PATIENCE = 60  # seconds to wait for other processes that write
_LAYOUT = 2  # of the tables below
_APPLICATION = 0x53414645  # "SAFE": tells a store from other SQLite files
_EXPERIMENTS_AND_BATCHES = """
    CREATE TABLE experiments (
        id INTEGER PRIMARY KEY,
        digest TEXT NOT NULL UNIQUE,
        content TEXT NOT NULL,
        algorithm TEXT NOT NULL,
        maze TEXT NOT NULL
    );
    CREATE TABLE batches (
        id INTEGER PRIMARY KEY,
        experiment INTEGER NOT NULL REFERENCES experiments,
        version TEXT NOT NULL,
        "commit" TEXT,
        python TEXT NOT NULL,
        numpy TEXT NOT NULL,
        numba TEXT NOT NULL,
        platform TEXT NOT NULL,
        time TEXT NOT NULL
    );
"""
# without row numbers there is one tree of rows and no second one, an index, that might be damaged and disagree
_RUNS = """
    CREATE TABLE runs (
        experiment INTEGER NOT NULL REFERENCES experiments,
        run INTEGER NOT NULL,
        batch INTEGER NOT NULL REFERENCES batches,
        success INTEGER NOT NULL,
        generation INTEGER NOT NULL,
        distance INTEGER NOT NULL,
        controller TEXT NOT NULL,
        coefficients TEXT NOT NULL,
        evaluations INTEGER NOT NULL,
        seconds REAL NOT NULL,
        checksum TEXT NOT NULL,
        PRIMARY KEY (experiment, run)
    ) WITHOUT ROWID;
"""
_OUTCOME = "success, generation, distance, controller, coefficients, evaluations, seconds"
_INSERT_RUN = (
    f"INSERT INTO runs (experiment, batch, run, {_OUTCOME}, checksum) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"
)


class StoredExperiment(NamedTuple):
    """An experiment as it is in a store."""

    id: int  # in this store
    digest: str
    content: dict
    algorithm: str  # what it was called
    maze: str


class StoredRun(NamedTuple):
    """A run as it is in a store."""

    number: int
    run: Run
    seconds: float
    batch: int


class Store:
    """The store in a file, made where there is none; in memory where the path is None.

    Raises
    ------
    ValueError
        Where the file cannot be opened, is no store, or was made by a newer version of this package; later, where it
        cannot be read or written any more, or holds what was not put there.
    """

    def __init__(self, path: str | os.PathLike | None, must_exist: bool = False) -> None:
        self.path = path
        self._connection = None
        self._batches: dict[tuple, int] = {}
        try:
            if must_exist and not Path(path).exists():
                raise ValueError("there is no such file")
            self._connection = self._open(path)
            self._set_up(self._connection)
        except BaseException as error:
            if self._connection is not None:
                self._connection.close()  # or else an interruption would leave it open, and the file locked
            if not isinstance(error, sqlite3.Error | OSError | TypeError | ValueError):
                raise
            raise ValueError(
                "store must be the path of a results store, or of a file to make; "
                f"got {checks.shown(path)} ({checks.reason(error)})"
            ) from None

    @staticmethod
    def _open(path: str | os.PathLike | None) -> sqlite3.Connection:
        if path is None:
            return sqlite3.connect(":memory:")
        path = Path(path)
        if not path.name:  # "" would be a database that SQLite throws away at the end
            raise ValueError("no file name")
        path.parent.mkdir(parents=True, exist_ok=True)
        return sqlite3.connect(path, timeout=_PATIENCE)

    @staticmethod
    def _set_up(connection: sqlite3.Connection) -> None:
        connection.isolation_level = None  # transactions are begun by hand
        connection.execute("BEGIN")  # all that is read here is of one moment
        (application,) = connection.execute("PRAGMA application_id").fetchone()
        layout = _layout(connection)
        is_new = not _has_tables(connection)
        connection.execute("COMMIT")
        if not is_new and application != _APPLICATION:
            raise ValueError("some other database")
        if layout > _LAYOUT:
            raise ValueError(f"made by a newer version, with layout {layout}; this one reads up to {_LAYOUT}")
        _switch_to_wal(connection)
        connection.execute("PRAGMA synchronous = NORMAL")
        if not is_new and layout == _LAYOUT:
            return
        connection.execute("BEGIN IMMEDIATE")  # of two processes that make the file, one waits for the other
        if not _has_tables(connection):
            _execute_all(connection, _EXPERIMENTS_AND_BATCHES + _RUNS)
            connection.execute(f"PRAGMA application_id = {_APPLICATION}")
            connection.execute(f"PRAGMA user_version = {_LAYOUT}")
        elif _layout(connection) == 1:
            _add_checksums(connection)
            connection.execute(f"PRAGMA user_version = {_LAYOUT}")
        connection.execute("COMMIT")

    def __enter__(self) -> Store:
        return self

    def __exit__(self, *_: object) -> None:
        self._connection.close()

    @contextmanager
    def _changing(self) -> Iterator[sqlite3.Connection]:
        """All changes that are made in this context, or none of them."""
        with self._telling():
            if self._connection.in_transaction:  # which an interruption has left
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
    def _telling(self) -> Iterator[None]:
        """Turn an error of SQLite into one that tells which store it is about."""
        try:
            yield
        except sqlite3.Error as error:
            raise ValueError(
                "store must be in order, free to be written, and have room to grow; "
                f"got {self} ({checks.reason(error)})"
            ) from None

    def _damaged(self, what: str) -> ValueError:
        return ValueError(f"store must be as it was left; got {self}, where {what} was altered or damaged")

    def __str__(self) -> str:
        return checks.shown(str(self.path))

    def experiment(self, content: dict, digest: str, algorithm: str, maze: str) -> StoredExperiment:
        """An experiment of this store; it is entered where it is new."""
        with self._changing() as connection:
            connection.execute(
                "INSERT INTO experiments (digest, content, algorithm, maze) VALUES (?, ?, ?, ?) ON CONFLICT DO NOTHING",
                (digest, json.dumps(content, sort_keys=True), algorithm, maze),
            )
        found = self.experiments(digest)
        if len(found) != 1:  # as many as a damaged index says
            raise self._damaged("its list of experiments")
        return found[0]

    def experiments(self, digest: str | None = None) -> list[StoredExperiment]:
        """The experiments in this store, or that with this digest."""
        with self._telling():
            rows = self._connection.execute(
                "SELECT id, digest, content, algorithm, maze FROM experiments"
                " WHERE ?1 IS NULL OR digest = ?1 ORDER BY id",
                (digest,),
            ).fetchall()
        found = []
        for number, its_digest, content, algorithm, maze in rows:
            if not isinstance(content, str) or hashlib.sha256(content.encode()).hexdigest() != its_digest:
                raise self._damaged(f"experiment {number}")
            labels = (label if checks.is_text(label) else checks.shown(label) for label in (algorithm, maze))
            found.append(StoredExperiment(number, its_digest, json.loads(content), *labels))
        return found

    def finished(self, experiment: StoredExperiment) -> set[int]:
        """Which runs of an experiment are in the store."""
        with self._telling():
            rows = self._connection.execute("SELECT run FROM runs WHERE experiment = ?", (experiment.id,))
            return {number for (number,) in rows}

    def successes(self, experiment: StoredExperiment, below: int) -> int:
        """How many of the kept runs with a number below `below` succeeded."""
        with self._telling():
            query = "SELECT count(*) FROM runs WHERE experiment = ? AND run < ? AND success"
            return self._connection.execute(query, (experiment.id, below)).fetchone()[0]

    def add(
        self, experiment: StoredExperiment, origin: dict[str, str | None], runs: Sequence[tuple[int, Run, float]]
    ) -> None:
        """Keep finished runs (number, run, seconds). One that another process kept meanwhile stays: it is the same."""
        if not runs:
            return
        key = experiment.id, *origin.values()
        with self._changing() as connection:
            batch = self._batches.get(key) or self._enter_batch(connection, experiment, origin)
            for number, run, seconds in runs:
                row = number, *_outcome(run, seconds)
                connection.execute(
                    f"{_INSERT_RUN} ON CONFLICT DO NOTHING",
                    (experiment.id, batch, *row, _checksum(experiment.digest, *row)),
                )
        self._batches[key] = batch

    @staticmethod
    def _enter_batch(
        connection: sqlite3.Connection, experiment: StoredExperiment, origin: dict[str, str | None]
    ) -> int:
        provenance = {"time": datetime.now(UTC).isoformat(timespec="seconds"), **origin}
        marks = ", ".join("?" * len(provenance))
        return connection.execute(
            f"INSERT INTO batches (experiment, {_quoted(provenance)}) VALUES (?, {marks})",
            (experiment.id, *provenance.values()),
        ).lastrowid

    def origin_of(self, batch: int) -> dict[str, str | None]:
        """What made the runs of a batch, and when."""
        columns = [*origin(), "time"]
        with self._telling():
            query = f"SELECT {_quoted(columns)} FROM batches WHERE id = ?"
            row = self._connection.execute(query, (batch,)).fetchone()
        if row is None:
            raise self._damaged(f"batch {checks.shown(batch)}")
        return dict(zip(columns, row, strict=True))

    def runs(self, experiment: StoredExperiment, below: int | None = None, first: int = 0) -> list[StoredRun]:
        """The kept runs of an experiment, those with a number from `first` to below `below`, in order."""
        with self._telling():
            rows = self._connection.execute(
                f"SELECT batch, checksum, run, {_OUTCOME} FROM runs"
                " WHERE experiment = ? AND run >= ? AND run < ? ORDER BY run",
                (experiment.id, first, np.iinfo(np.int64).max if below is None else below),
            ).fetchall()
        found = []
        for batch, checksum, *row in rows:
            if _checksum(experiment.digest, *row) != checksum:
                label = f"{checks.shown(experiment.algorithm)} on {checks.shown(experiment.maze)}"
                raise self._damaged(f"run {checks.shown(row[0])} of {label}")
            number, success, generation, distance, controller, coefficients, evaluations, seconds = row
            controller, coefficients = tuple(json.loads(controller)), tuple(json.loads(coefficients))
            run = Run(bool(success), generation, distance, controller, coefficients, evaluations)
            found.append(StoredRun(number, run, seconds, batch))
        return found


def _outcome(run: Run, seconds: float) -> tuple:
    """The values of the columns _OUTCOME."""
    return (
        int(run.success),
        run.generation,
        run.distance,
        json.dumps(run.controller),
        json.dumps(run.coefficients),
        run.evaluations,
        seconds,
    )


def _checksum(*values: object) -> str:
    """What tells whether any of these was altered: 64 bits of BLAKE2 over how Python writes them."""
    return hashlib.blake2b(repr(values).encode(), digest_size=8).hexdigest()


def _quoted(columns: Iterable[str]) -> str:
    """The names of columns as SQL wants them: "commit" is a word of its own."""
    return ", ".join(f'"{column}"' for column in columns)


def _execute_all(connection: sqlite3.Connection, statements: str) -> None:
    """Statements within the transaction that is open: `executescript` would end it first."""
    for statement in statements.split(";"):
        connection.execute(statement)


def _add_checksums(connection: sqlite3.Connection) -> None:
    """Bring the runs of a store of layout 1, which had no checksums, into the table of today."""
    connection.execute("ALTER TABLE runs RENAME TO runs_without_checksums")
    _execute_all(connection, _RUNS)
    (size,) = connection.execute("SELECT count(*) FROM runs_without_checksums").fetchone()
    rows = connection.execute(
        f"SELECT digest, experiment, batch, run, {_OUTCOME}"
        " FROM runs_without_checksums JOIN experiments ON experiments.id = experiment"
    ).fetchall()
    if len(rows) != size:
        raise ValueError("some of its runs are of no experiment")
    for digest, experiment, batch, *row in rows:
        connection.execute(_INSERT_RUN, (experiment, batch, *row, _checksum(digest, *row)))
    connection.execute("DROP TABLE runs_without_checksums")


def _layout(connection: sqlite3.Connection) -> int:
    return connection.execute("PRAGMA user_version").fetchone()[0]


def _switch_to_wal(connection: sqlite3.Connection) -> None:
    """Set the journal mode, which the file then keeps. SQLite does not wait for other processes here, so this does."""
    deadline = time.monotonic() + _PATIENCE
    while True:
        try:
            connection.execute("PRAGMA journal_mode = WAL")
            return
        except sqlite3.OperationalError as error:
            if "locked" not in str(error) or time.monotonic() > deadline:
                raise
            time.sleep(0.01)


def _has_tables(connection: sqlite3.Connection) -> bool:
    return connection.execute("SELECT count(*) FROM sqlite_master").fetchone() != (0,)


@functools.cache
def origin() -> dict[str, str | None]:
    """What makes runs in this process."""
    return {
        "version": __version__,
        "commit": _commit(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "numba": numba.__version__,
        "platform": platform.platform(),
    }


def _commit() -> str | None:
    """The commit of the checkout that this package runs from, with "+" where files were changed; None elsewhere."""
    folder = Path(__file__).parent

    def git(*arguments: str) -> str:
        command = ["git", "-C", str(folder), *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=True, timeout=10).stdout.strip()

    try:
        git("ls-files", "--error-unmatch", Path(__file__).name)  # a checkout of this, not one that it is installed in
        return git("rev-parse", "HEAD") + ("+" if git("status", "--porcelain", ".") else "")
    except (OSError, subprocess.SubprocessError):
        return None
