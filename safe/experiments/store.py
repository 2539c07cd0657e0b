"""The results store: one SQLite file that holds every finished run, and where it came from.

    experiments   one row for each experiment: its content as JSON, and the names it was first run under
    batches       one row for each program, machine and session that made runs (see `Origin`)
    runs          one row for each finished run (see `Run`), with a checksum

Runs are committed as they come back. The file is in WAL mode, so several processes can read and write it at once, and
a process that is killed loses nothing that it has committed. Nothing in the file is trusted: the digest of its content
identifies an experiment, and a checksum guards each run, so an altered or damaged row is noticed and reaches no table.
"""

from __future__ import annotations

import hashlib
import json
import os
import sqlite3
import time
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import fields
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

from safe import checks
from safe.evolution import Run
from safe.experiments.provenance import Origin

_PATIENCE = 60  # seconds to wait while another process writes
_LONGEST_PATH = 120  # characters that an error message shows
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
# WITHOUT ROWID keeps the runs in one tree: there is no second one, an index, that damage could make disagree with it
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
_CELLS = {  # by the type of a field of Run: how its cell is written, and how it is read
    "bool": (int, bool),
    "int": (int, int),
    "tuple[float, ...]": (json.dumps, lambda text: tuple(json.loads(text))),
}
_RUN = ["run", *(field.name for field in fields(Run)), "seconds"]
_A_STORE = "be the path of a results store, or of a file to make"


def _list(columns: Iterable[str]) -> str:
    """Columns as SQL lists them, in brackets since COMMIT is a word of SQL."""
    return ", ".join(f"[{column}]" for column in columns)


def _insert(table: str, *columns: str) -> str:
    return f"INSERT INTO {table} ({_list(columns)}) VALUES ({', '.join('?' for _ in columns)})"


_INSERT_RUN = _insert("runs", "experiment", "batch", *_RUN, "checksum")
_INSERT_BATCH = _insert("batches", "experiment", *Origin._fields)


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
    """The store in a file, which is made if it does not exist; in memory if the path is None.

    Raises
    ------
    StoreError
        If the file cannot be opened, is no store, or was made by a newer version of this package; from the methods, if
        it cannot be read or written any more, or was altered or damaged.
    """

    def __init__(self, path: str | os.PathLike | None, must_exist: bool = False) -> None:
        self.path = path
        self._batches: dict[tuple[int, Origin], int] = {}
        try:
            self._connection = _connect(path, must_exist)
        except (OSError, TypeError, ValueError, sqlite3.Error) as error:
            raise self._refusal(_A_STORE, checks.reason(error)) from None
        try:
            with self._store_errors(_A_STORE):
                self._set_up()
        except BaseException:
            self._connection.close()  # or else an interruption would leave it open, and the file locked
            raise

    def _set_up(self) -> None:
        """Check that the file is a store; make the tables of a new one, and update an old one."""
        connection = self._connection
        connection.execute("BEGIN")  # so that everything is read as of one moment
        (application,) = connection.execute("PRAGMA application_id").fetchone()
        layout = _layout(connection)
        is_new = not _has_tables(connection)
        connection.execute("COMMIT")
        if not is_new and application != _APPLICATION:
            raise self._refusal(_A_STORE, "some other database")
        if layout > _LAYOUT:
            reason = f"made by a newer version, with layout {layout}; this one reads up to {_LAYOUT}"
            raise self._refusal(_A_STORE, reason)
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
            self._add_checksums()
            connection.execute(f"PRAGMA user_version = {_LAYOUT}")
        connection.execute("COMMIT")

    def _add_checksums(self) -> None:
        """Move the runs of a store of layout 1, which had no checksums, into the table of layout 2."""
        connection = self._connection
        connection.execute("ALTER TABLE runs RENAME TO runs_without_checksums")
        _execute_all(connection, _RUNS)
        (size,) = connection.execute("SELECT count(*) FROM runs_without_checksums").fetchone()
        rows = connection.execute(
            f"SELECT digest, experiment, batch, {_list(_RUN)}"
            " FROM runs_without_checksums JOIN experiments ON experiments.id = experiment"
        ).fetchall()
        if len(rows) != size:
            raise self._refusal(_A_STORE, "some of its runs belong to no experiment")
        for digest, experiment, batch, *row in rows:
            connection.execute(_INSERT_RUN, (experiment, batch, *row, _checksum(digest, *row)))
        connection.execute("DROP TABLE runs_without_checksums")

    def __enter__(self) -> Store:
        return self

    def __exit__(self, *_: object) -> None:
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
    def _store_errors(self, demand: str = "be in order, free to be written, and have room to grow") -> Iterator[None]:
        """Turn an error of SQLite into a StoreError."""
        try:
            yield
        except (sqlite3.Error, UnicodeDecodeError) as error:  # SQLite quotes what is damaged, which may not be UTF-8
            raise self._refusal(demand, checks.reason(error)) from None

    def _refusal(self, demand: str, reason: str) -> StoreError:
        return StoreError(f"store must {demand}; got {self} ({reason})")

    def _damaged(self, what: str) -> StoreError:
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
            raise self._damaged("its list of experiments")
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
                raise self._damaged(f"experiment {number}") from None
            labels = (label if checks.is_text(label) else checks.shown(label) for label in labels)
            found.append(StoredExperiment(number, its_digest, content, *labels))
        return found

    def finished(self, experiment: StoredExperiment) -> set[int]:
        """The numbers of an experiment's runs in the store."""
        with self._store_errors():
            rows = self._connection.execute("SELECT run FROM runs WHERE experiment = ?", (experiment.id,))
            return {number for (number,) in rows}

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
                    f"{_INSERT_RUN} ON CONFLICT DO NOTHING",
                    (experiment.id, batch, *row, _checksum(experiment.digest, *row)),
                )
        self._batches[key] = batch

    def origin_of(self, batch: int) -> Origin:
        """What made the runs of a batch, and when."""
        with self._store_errors():
            row = self._connection.execute(
                f"SELECT {_list(Origin._fields)} FROM batches WHERE id = ?", (batch,)
            ).fetchone()
        if row is None:
            raise self._damaged(f"batch {checks.shown(batch)}")
        return Origin(*row)

    def runs(self, experiment: StoredExperiment, below: int = 2**63 - 1, first: int = 0) -> list[StoredRun]:
        """The stored runs of an experiment with numbers from `first` to below `below`, in order."""
        with self._store_errors():
            rows = self._connection.execute(
                f"SELECT batch, checksum, {_list(_RUN)} FROM runs"
                " WHERE experiment = ? AND run >= ? AND run < ? ORDER BY run",
                (experiment.id, first, below),
            ).fetchall()
        found = []
        for batch, checksum, *row in rows:
            number, *cells, seconds = row
            try:
                if _checksum(experiment.digest, *row) != checksum:
                    raise ValueError
                found.append(StoredRun(number, _from_cells(cells), seconds, batch))
            except (TypeError, ValueError):
                raise self._damaged(f"run {checks.shown(number)} of {experiment.label}") from None
        return found


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
    return [_CELLS[field.type][0](getattr(run, field.name)) for field in fields(Run)]


def _from_cells(cells: Sequence) -> Run:
    """The inverse of `_to_cells`. Raises TypeError or ValueError if a cell holds something else."""
    return Run(*(_CELLS[field.type][1](cell) for field, cell in zip(fields(Run), cells, strict=True)))


def _checksum(*values: object) -> str:
    """A checksum that changes if any of these values does: 64 bits of BLAKE2 over their repr."""
    return hashlib.blake2b(repr(values).encode(), digest_size=8).hexdigest()


def _connect(path: str | os.PathLike | None, must_exist: bool) -> sqlite3.Connection:
    """Open a file, in a folder that is made if necessary. Transactions are begun by hand."""
    if must_exist and not Path(path).exists():
        raise FileNotFoundError("there is no such file")
    if path is None:
        return sqlite3.connect(":memory:", isolation_level=None)
    path = Path(path)
    if not path.name:  # "" would be a database that SQLite throws away at the end
        raise ValueError("no file name")
    path.parent.mkdir(parents=True, exist_ok=True)
    return sqlite3.connect(path, timeout=_PATIENCE, isolation_level=None)


def _execute_all(connection: sqlite3.Connection, statements: str) -> None:
    """Execute statements within the open transaction, which `executescript` would end first."""
    for statement in statements.split(";"):
        connection.execute(statement)


def _layout(connection: sqlite3.Connection) -> int:
    return connection.execute("PRAGMA user_version").fetchone()[0]


def _has_tables(connection: sqlite3.Connection) -> bool:
    return connection.execute("SELECT count(*) FROM sqlite_master").fetchone() != (0,)


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
