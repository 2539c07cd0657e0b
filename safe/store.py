"""The results store: one SQLite file with every run that was ever finished, and where it came from.

    experiments   one row each: the content that identifies it, as JSON, and the names it was first run under
    batches       one row for each time that runs were computed: what computed them, where and when
    runs          one row for each finished run

Runs are committed as they finish. The file is in WAL mode, so several processes can read and write it at once.
"""

from __future__ import annotations

import json
import os
import platform
import sqlite3
import subprocess
import time
from collections.abc import Iterable
from datetime import UTC, datetime
from pathlib import Path

import numba
import numpy as np

from safe import checks
from safe.evolution import Run
from safe.version import __version__

_PATIENCE = 60  # seconds to wait for other processes that write
_LAYOUT = 1  # of the tables below
_APPLICATION = 0x53414645  # "SAFE": tells a store from other SQLite files
_TABLES = """
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
        PRIMARY KEY (experiment, run)
    );
"""


class Store:
    """The store in a file, made where there is none; in memory where the path is None.

    Raises
    ------
    ValueError
        Where the file cannot be opened, is no store, or was made by a newer version of this package.
    """

    def __init__(self, path: str | os.PathLike | None) -> None:
        self.path = path
        self._connection = None
        try:
            self._connection = self._open(path)
            self._set_up(self._connection)
        except (sqlite3.Error, OSError, TypeError, ValueError) as error:
            if self._connection is not None:
                self._connection.close()
            raise ValueError(
                "store must be the path of a results store, or of a file to make; "
                f"was {checks.shown(str(path))} ({error})"
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
        (layout,) = connection.execute("PRAGMA user_version").fetchone()
        is_new = not _has_tables(connection)
        connection.execute("COMMIT")
        if not is_new and application != _APPLICATION:
            raise ValueError("some other database")
        if layout > _LAYOUT:
            raise ValueError(f"made by a newer version, with layout {layout}; this one reads up to {_LAYOUT}")
        _switch_to_wal(connection)
        connection.execute("PRAGMA synchronous = NORMAL")
        connection.execute("BEGIN IMMEDIATE")  # of two processes that make the file, one waits for the other
        if not _has_tables(connection):
            for statement in _TABLES.split(";"):
                connection.execute(statement)
            connection.execute(f"PRAGMA application_id = {_APPLICATION}")
            connection.execute(f"PRAGMA user_version = {_LAYOUT}")
        connection.execute("COMMIT")

    def __enter__(self) -> Store:
        return self

    def __exit__(self, *_: object) -> None:
        self._connection.close()

    def experiment(self, content: dict, digest: str, algorithm: str, maze: str) -> int:
        """The number of an experiment in this store; it is entered where it is new."""
        self._connection.execute(
            "INSERT OR IGNORE INTO experiments (digest, content, algorithm, maze) VALUES (?, ?, ?, ?)",
            (digest, json.dumps(content, sort_keys=True), algorithm, maze),
        )
        return self._connection.execute("SELECT id FROM experiments WHERE digest = ?", (digest,)).fetchone()[0]

    def batch(self, experiment: int) -> int:
        """The number of a new batch of runs, with where it comes from."""
        provenance = {**_provenance(), "time": datetime.now(UTC).isoformat(timespec="seconds")}
        columns = ", ".join(f'"{column}"' for column in provenance)
        marks = ", ".join("?" * len(provenance))
        return self._connection.execute(
            f"INSERT INTO batches (experiment, {columns}) VALUES (?, {marks})", (experiment, *provenance.values())
        ).lastrowid

    def finished(self, experiment: int) -> set[int]:
        """Which runs of an experiment are in the store."""
        rows = self._connection.execute("SELECT run FROM runs WHERE experiment = ?", (experiment,))
        return {number for (number,) in rows}

    def add(self, experiment: int, batch: int, number: int, run: Run, seconds: float) -> None:
        """Keep a finished run. One that another process has kept meanwhile stays: it is the same."""
        self._connection.execute(
            "INSERT OR IGNORE INTO runs VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
            (
                experiment,
                number,
                batch,
                run.success,
                run.generation,
                run.distance,
                json.dumps(run.controller),
                json.dumps(run.coefficients),
                run.evaluations,
                seconds,
            ),
        )

    def runs(self, experiment: int, below: int) -> Iterable[tuple[int, Run, float]]:
        """Number, run and seconds of the kept runs with a number below `below`, in order."""
        rows = self._connection.execute(
            "SELECT run, success, generation, distance, controller, coefficients, evaluations, seconds"
            " FROM runs WHERE experiment = ? AND run < ? ORDER BY run",
            (experiment, below),
        )
        for number, success, generation, distance, controller, coefficients, evaluations, seconds in rows:
            controller, coefficients = tuple(json.loads(controller)), tuple(json.loads(coefficients))
            run = Run(bool(success), generation, distance, controller, coefficients, evaluations)
            yield number, run, seconds


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


def _provenance() -> dict[str, str | None]:
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
