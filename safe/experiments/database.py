"""The SQLite file of a store: its tables, and how it is opened for writing and for reading.

    experiments   one row for each experiment: its content as JSON, and the names it was first run under
    batches       one row for each program, machine and session that made runs (see `Origin`)
    runs          one row for each finished run (see `Run`), with a checksum

Opened for writing, a file is switched to WAL mode, so that several processes can read and write it at once, and gets
the present layout. Reading changes no run and no layout: an earlier one is updated in memory alone. Beside a store that
is read-only or somebody else's SQLite would put files that lock its owner out. Such a store is read without locks if
there is no log, which means that nobody is writing, and from a copy if there is one. In a store of one's own a reader
does what any last user of a file in WAL mode does: it moves what is in the log to the file.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import sqlite3
import tempfile
import time
from collections.abc import Iterable, Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import fields
from pathlib import Path

from safe.evolution import Run

_PATIENCE = 60  # seconds to wait while another process writes
_LAYOUT = 3  # of the tables below
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
        time TEXT NOT NULL,
        sources TEXT
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


def columns(names: Iterable[str]) -> str:
    """Columns as SQL lists them, in brackets since COMMIT is a word of SQL."""
    return ", ".join(f"[{name}]" for name in names)


def insertion(table: str, *names: str) -> str:
    """The statement that inserts values of these columns."""
    return f"INSERT INTO {table} ({columns(names)}) VALUES ({', '.join('?' for _ in names)})"


def checksum(*values: object) -> str:
    """A checksum that changes if any of these values does: 64 bits of BLAKE2 over their repr."""
    return hashlib.blake2b(repr(values).encode(), digest_size=8).hexdigest()


RUN = ["run", *(field.name for field in fields(Run)), "seconds"]  # the columns that a checksum covers
INSERT_RUN = insertion("runs", "experiment", "batch", *RUN, "checksum")


def open_for_writing(path: str | os.PathLike | None) -> sqlite3.Connection:
    """Open a store, which is made if necessary, with its folder; in memory if the path is None.

    Raises
    ------
    PermissionError
        If the file or its folder cannot be written.
    OSError, TypeError, ValueError, sqlite3.Error
        If the file cannot be opened, is no store, or was made by a newer version of this package.
    """
    if path is None:
        connection = _connect(":memory:")
    else:
        file = _real(path)
        file.parent.mkdir(parents=True, exist_ok=True)
        for place, what in ((file, "the file"), (file.parent, "its folder")):
            if place.exists() and not _may(place, os.W_OK):
                raise PermissionError(f"permission denied: {what} is read-only")
        connection = _connect(file)
    with _closed_after_failure(connection):
        is_current = _is_current(connection)
        _switch_to_wal(connection)
        connection.execute("PRAGMA synchronous = NORMAL")
        if not is_current:
            _update(connection)
    return connection


def open_for_reading(path: str | os.PathLike | None, must_exist: bool) -> sqlite3.Connection:
    """Open a store that may be read-only or somebody else's, with whatever its log holds, and change nothing.

    Unless it must exist, a store that does not exist is empty.

    Raises
    ------
    OSError, TypeError, ValueError, sqlite3.Error
        If the file cannot be opened, is no store, or was made by a newer version of this package.
    """
    if path is None or not (file := _real(path)).exists():
        if must_exist:
            raise FileNotFoundError("there is no such file")
        connection = _connect(":memory:")
    elif mode := _mode_in_place(file):
        connection = _connect(f"{file.as_uri()}?mode={mode}", uri=True)
    elif any(_beside(file, ending).exists() for ending in ("-wal", "-journal")):
        connection = _copy(file)
    else:
        connection = _at_rest(file)
    with _closed_after_failure(connection):
        is_current = _is_current(connection)
    if not is_current:
        connection = _in_memory(connection)
        with _closed_after_failure(connection):
            _update(connection)
    connection.execute("PRAGMA query_only = 1")
    return connection


def _real(path: str | os.PathLike) -> Path:
    """The absolute path of the file itself, beside which SQLite puts its log, and not beside a link to it."""
    if not Path(path).name:  # "" would be a database that SQLite throws away at the end
        raise ValueError("no file name")
    return Path(os.path.realpath(path))


def _beside(file: Path, ending: str) -> Path:
    """What SQLite puts beside a file: its log (-wal), the index of the log (-shm), or its journal."""
    return file.with_name(file.name + ending)


def _may(place: Path, mode: int) -> bool:
    """May this process use a file or folder in this mode, os.R_OK or os.W_OK?"""
    return os.access(place, mode, effective_ids=os.access in os.supports_effective_ids)


def _connect(database: str | Path, **options: object) -> sqlite3.Connection:
    """Connect to a database. Transactions are begun by hand."""
    return sqlite3.connect(database, timeout=_PATIENCE, isolation_level=None, **options)


@contextmanager
def _closed_after_failure(connection: sqlite3.Connection) -> Iterator[None]:
    """Close the connection if this context fails: an interruption would leave it open, and the file locked."""
    try:
        yield
    except BaseException:
        connection.close()
        raise


def _is_current(connection: sqlite3.Connection) -> bool:
    """Has this store the present layout? A new file has none yet. Raises ValueError if it is no store that we know."""
    connection.execute("BEGIN")  # so that everything is read as of one moment
    (application,) = connection.execute("PRAGMA application_id").fetchone()
    layout = _layout(connection)
    is_new = not _has_tables(connection)
    connection.execute("COMMIT")
    if not is_new and application != _APPLICATION:
        raise ValueError("some other database")
    if layout > _LAYOUT:
        raise ValueError(f"made by a newer version, with layout {layout}; this one reads up to {_LAYOUT}")
    return not is_new and layout == _LAYOUT


def _layout(connection: sqlite3.Connection) -> int:
    return connection.execute("PRAGMA user_version").fetchone()[0]


def _has_tables(connection: sqlite3.Connection) -> bool:
    return connection.execute("SELECT count(*) FROM sqlite_master").fetchone() != (0,)


def _update(connection: sqlite3.Connection) -> None:
    """Make the tables of a new store, or give an old one the present layout."""
    connection.execute("BEGIN IMMEDIATE")  # of two processes that do so, one waits for the other
    if not _has_tables(connection):
        _execute_all(connection, _EXPERIMENTS_AND_BATCHES + _RUNS)
        connection.execute(f"PRAGMA application_id = {_APPLICATION}")
    else:
        layout = _layout(connection)
        if layout < 2:
            _add_checksums(connection)
        if layout < 3:
            connection.execute("ALTER TABLE batches ADD COLUMN sources TEXT")
    connection.execute(f"PRAGMA user_version = {_LAYOUT}")
    connection.execute("COMMIT")


def _add_checksums(connection: sqlite3.Connection) -> None:
    """Move the runs of a store of layout 1, which had no checksums, into the table of layout 2."""
    connection.execute("ALTER TABLE runs RENAME TO runs_without_checksums")
    _execute_all(connection, _RUNS)
    (size,) = connection.execute("SELECT count(*) FROM runs_without_checksums").fetchone()
    rows = connection.execute(
        f"SELECT digest, experiment, batch, {columns(RUN)}"
        " FROM runs_without_checksums JOIN experiments ON experiments.id = experiment"
    ).fetchall()
    if len(rows) != size:
        raise ValueError("some of its runs belong to no experiment")
    for digest, experiment, batch, *row in rows:
        connection.execute(INSERT_RUN, (experiment, batch, *row, checksum(digest, *row)))
    connection.execute("DROP TABLE runs_without_checksums")


def _execute_all(connection: sqlite3.Connection, statements: str) -> None:
    """Execute statements within the open transaction, which `executescript` would end first."""
    for statement in statements.split(";"):
        connection.execute(statement)


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


def _mode_in_place(file: Path) -> str | None:
    """The mode in which SQLite may read this file itself; None if it must read a copy.

    A file that this process itself has open for writing must not be copied: to open and close it by other means than
    SQLite cancels all of the process's locks on it (https://www.sqlite.org/howtocorrupt.html).
    """
    if not _may(file, os.W_OK):
        return None
    log, index, journal = (_beside(file, ending).exists() for ending in ("-wal", "-shm", "-journal"))
    is_own = not hasattr(os, "geteuid") or file.stat().st_uid == os.geteuid()
    if is_own and _may(file.parent, os.W_OK) and not journal:
        return "rw"  # "ro" would leave the log to the next writer if the last one ends during the reading
    return "ro" if log and index else None


class _AtRest(sqlite3.Connection):
    """A connection that reads a file without locks. If the file was written meanwhile, to close it fails."""

    file: Path
    stamp: tuple[int, int, int]

    def close(self) -> None:
        super().close()
        if _stamp(self.file) != self.stamp:
            raise sqlite3.OperationalError("it was written while it was read")


def _at_rest(file: Path) -> sqlite3.Connection:
    """A connection to a store without a log, which nobody is writing then, and beside which SQLite puts no file."""
    if not _may(file, os.R_OK):  # SQLite would not say why it fails
        raise PermissionError("permission denied")
    stamp = _stamp(file)
    connection = _connect(f"{file.as_uri()}?immutable=1", uri=True, factory=_AtRest)
    connection.file, connection.stamp = file, stamp
    return connection


def _copy(file: Path) -> sqlite3.Connection:
    """A copy in memory of a store with its log, as of one moment although others may be writing, without any lock.

    The log is copied after the file: what is missing or half written in the copy of the file is then in that of the
    log, unless the log was started again meanwhile.
    """
    deadline = time.monotonic() + _PATIENCE
    while time.monotonic() < deadline:
        with tempfile.TemporaryDirectory() as folder:
            copy, before = Path(folder, "store"), _state(file)
            for ending in ("", "-wal", "-journal"):
                with suppress(FileNotFoundError):
                    shutil.copyfile(_beside(file, ending), _beside(copy, ending))
            if _state(file) == before:
                return _in_memory(_connect(copy))
    raise TimeoutError("it is being written without a pause")


def _state(file: Path) -> list[object]:
    """What stays the same while nothing but the log grows."""
    state: list[object] = [_stamp(file)]
    with suppress(FileNotFoundError):
        state.append(_stamp(_beside(file, "-journal")))
    with suppress(FileNotFoundError), _beside(file, "-wal").open("rb") as log:
        state.append(log.read(32))  # its header, with a number that is drawn whenever it starts
    return state


def _stamp(file: Path) -> tuple[int, int, int]:
    found = file.stat()
    return found.st_ino, found.st_size, found.st_mtime_ns


def _in_memory(source: sqlite3.Connection) -> sqlite3.Connection:
    """A copy of a database in memory, in place of the database, which is closed."""
    connection = _connect(":memory:")
    with _closed_after_failure(connection), closing(source):
        source.backup(connection)
    return connection
