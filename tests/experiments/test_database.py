"""How the file of a store is opened: its layouts, and reading that changes nothing."""

import hashlib
import os
import shutil
import sqlite3
import subprocess
import sys
from concurrent.futures import Executor
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from safe import StoreError, merge, run, verify
from safe.evolution import Run
from safe.experiments import database
from safe.experiments.provenance import origin
from safe.experiments.store import Store
from tests.experiments import EXPERIMENT
from tests.helpers.permissions import (
    IS_ROOT,
    as_somebody_who_may_only_read,
    forbid_writing,
    public_folder,
    state_of,
)

RUN = Run(True, 141, 2, (0.1, -1e-300, 1 / 3), (0.85, 0.99), 28_400)
CELLS = (1, 7, 1, 1, 141, 2, "[0.1, -1e-300, 0.3333333333333333]", "[0.85, 0.99]", 28_400, 0.25, "2a64fc6d5ba882c3")
CONTENT, DIGEST = '{"seed": 1}', "a4bbadc1c78966d28872dbe60ff40cb9c996f884e228ed4a08eb7d6c3a24f4b8"
SECOND_LAYOUT = (Path(__file__).parents[1] / "data" / "store_of_layout_2.sql").read_text()


def numbers(path):
    """The numbers of all runs that a reader finds in a store."""
    with Store.for_reading(path) as store:
        return [kept.number for entry in store.experiments() for kept in store.runs(entry)]


def add(store, *numbers):
    entry = store.entry({"seed": 1}, "safe", "maze1")
    store.add(entry, origin(), [(number, RUN, 0.25) for number in numbers])


# Layouts


def test_what_layout_3_writes(tmp_path):
    """As it was when layout 3 was new. If it changes, raise the layout, and update stores of this one."""
    with Store.for_writing(tmp_path / "s.sqlite") as store:
        add(store, 7)
    with closing(sqlite3.connect(tmp_path / "s.sqlite")) as connection:
        tables, experiments, runs, layout = (
            connection.execute(query).fetchall()
            for query in (
                "SELECT sql FROM sqlite_master WHERE sql IS NOT NULL",
                "SELECT content, digest FROM experiments",
                "SELECT * FROM runs",
                "PRAGMA user_version",
            )
        )
    assert layout == [(3,)]
    assert hashlib.sha256(repr(tables).encode()).hexdigest()[:16] == "bb28ffb3f0fac509"
    assert experiments == [(CONTENT, DIGEST)]
    assert runs == [CELLS]


@pytest.fixture
def second(tmp_path):
    """A store as layout 2 had it, with one run."""
    with closing(sqlite3.connect(tmp_path / "second.sqlite")) as connection:
        connection.executescript(SECOND_LAYOUT)
    return tmp_path / "second.sqlite"


def test_a_store_of_the_second_layout_is_read_as_it_is(second):
    before = state_of(second.parent)
    with Store.for_reading(second) as store:
        (entry,) = store.experiments()
        (kept,) = store.runs(entry)
        assert (kept.number, kept.run, kept.seconds) == (7, RUN, 0.25)
        assert store.origin_of(kept.batch)[:3] == ("0.1.0", None, "3.11.7")
        assert store.origin_of(kept.batch).sources is None
    assert state_of(second.parent) == before


def test_a_store_of_the_second_layout_keeps_its_checksums(second):
    with Store.for_writing(second) as store:
        add(store, 8)
        old, new = store.runs(store.experiments()[0])
        assert store.origin_of(old.batch).sources is None
        assert store.origin_of(new.batch).sources == origin().sources
    with closing(sqlite3.connect(second)) as connection:
        assert connection.execute("SELECT * FROM runs WHERE run = 7").fetchall() == [CELLS]
        assert connection.execute("PRAGMA user_version").fetchone() == (3,)


def give_layout(path, layout, change=""):
    """Turn a store into one of an earlier layout."""
    without_checksums = """
        CREATE TABLE old AS SELECT * FROM runs;
        ALTER TABLE old DROP COLUMN checksum;
        DROP TABLE runs;
        ALTER TABLE old RENAME TO runs;
    """
    with closing(sqlite3.connect(path)) as connection:
        connection.executescript(f"""
            {"ALTER TABLE batches DROP COLUMN sources" if layout < 3 else ""};
            {without_checksums if layout < 2 else ""};
            {change};
            PRAGMA user_version = {layout};
        """)


def test_a_store_of_the_first_layout_gets_checksums(store):
    before = run(EXPERIMENT, store, progress=False)
    give_layout(store, 1)
    more = run(replace(EXPERIMENT, runs=13), store, progress=False)
    pd.testing.assert_frame_equal(more[:12], before)
    assert len(verify(store, sample=3, progress=False)) == 3
    with closing(sqlite3.connect(store)) as connection:
        connection.execute("UPDATE runs SET seconds = 0 WHERE run = 7")
        connection.commit()
    with pytest.raises(StoreError, match="where run 7 of safe on maze1 was altered or damaged"):
        run(EXPERIMENT, store, progress=False)


@pytest.mark.parametrize(
    "change",
    [
        "UPDATE runs SET controller = 'x' WHERE run = 7",
        "UPDATE runs SET coefficients = '7' WHERE run = 7",
        "UPDATE runs SET coefficients = '[\"a\", 1.0]' WHERE run = 7",
        "UPDATE runs SET controller = '[0.5]' WHERE run = 7",
        "UPDATE runs SET distance = 'near' WHERE run = 7",
        "UPDATE runs SET seconds = 'few' WHERE run = 7",
    ],
)
def test_damage_that_has_got_a_checksum(store, change):
    give_layout(store, 1, change)
    with pytest.raises(StoreError, match="where run 7 of safe on maze1 was altered or damaged"):
        run(EXPERIMENT, store, progress=False)


def test_a_store_of_the_first_layout_with_runs_of_no_experiment(store):
    give_layout(store, 1, "UPDATE runs SET experiment = 99")
    for read in (run, verify):
        with pytest.raises(StoreError, match=r"^store must .*; got .*\(some of its runs belong to no experiment\)$"):
            read(*[EXPERIMENT] * (read is run), store, progress=False)


# Opening


def test_files_that_are_no_store(tmp_path):
    (tmp_path / "text").write_text("run,success\n" * 100)
    foreign = sqlite3.connect(tmp_path / "foreign")
    foreign.execute("CREATE TABLE t (x)")
    foreign.close()
    Store.for_writing(tmp_path / "newer").__exit__()
    newer = sqlite3.connect(tmp_path / "newer")
    newer.execute("PRAGMA user_version = 99")
    newer.close()
    before = state_of(tmp_path)
    for open_store, below_a_file in (
        (Store.for_writing, "File exists|cannot find"),
        (Store.for_reading, "there is no such file"),
    ):
        for name, reason in [
            ("text", "file is not a database"),
            ("foreign", "some other database"),
            ("newer", "made by a newer version, with layout 99"),
            ("text/below", below_a_file),
            ("", "unable to open"),
        ]:
            with pytest.raises(StoreError, match=rf"store must be the path of a results store.*\(.*({reason})"):
                open_store(tmp_path / name)
        for nonsense in (7, "", "a\0b", "\ud800"):
            with pytest.raises(StoreError, match="store must be the path"):
                open_store(nonsense)
    assert state_of(tmp_path) == before


def test_an_interruption_while_a_store_is_opened_leaves_no_lock(tmp_path, monkeypatch):
    def interrupted(connection, statements):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(database, "_execute_all", interrupted)
        with pytest.raises(KeyboardInterrupt):
            Store.for_writing(tmp_path / "s.sqlite")
    with Store.for_writing(tmp_path / "s.sqlite") as store:
        add(store, 0)


def test_after_the_last_writer_there_is_the_file_alone(tmp_path):
    with Store.for_writing(tmp_path / "s.sqlite") as one, Store.for_writing(tmp_path / "s.sqlite") as other:
        add(one, 1)
        add(other, 2)
        assert numbers(tmp_path / "s.sqlite") == [1, 2]
    assert [file.name for file in tmp_path.iterdir()] == ["s.sqlite"]


def test_the_last_reader_moves_what_is_in_the_log_to_the_file(tmp_path):
    """Or else somebody who copies the file alone would lose the runs of a writer that ended during the reading."""
    with Store.for_writing(tmp_path / "s.sqlite") as writer:
        add(writer, 1)
        reader = Store.for_reading(tmp_path / "s.sqlite")
        assert len(reader.experiments()) == 1
    with reader:
        assert (tmp_path / "s.sqlite-wal").exists()
    assert [file.name for file in tmp_path.iterdir()] == ["s.sqlite"]
    assert numbers(tmp_path / "s.sqlite") == [1]


def test_on_systems_without_users_all_files_are_ones_own(tmp_path, monkeypatch):
    monkeypatch.delattr(os, "geteuid", raising=False)
    monkeypatch.setattr(os, "supports_effective_ids", set())
    really = os.access

    def access(place, mode, *, effective_ids=False):
        if effective_ids:
            raise NotImplementedError
        return really(place, mode)

    monkeypatch.setattr(os, "access", access)
    with Store.for_writing(tmp_path / "s.sqlite") as store:
        add(store, 1)
    assert numbers(tmp_path / "s.sqlite") == [1]


# Reading a store that is not one's own, or read-only, which changes nothing


@pytest.fixture
def shared(store):
    """A folder that everybody can reach, with the store of twelve runs in it."""
    with public_folder() as folder:
        shutil.copy(store, folder)
        yield folder


@pytest.mark.parametrize("is_open", [False, True], ids=["folder", "file"])
@pytest.mark.parametrize("journal", ["wal", "delete"])
@pytest.mark.parametrize("layout", [1, 2, 3])
def test_a_read_only_store_is_read_and_stays_as_it_is(shared, uninterrupted, layout, journal, is_open):
    path = shared / "s.sqlite"
    give_layout(path, layout)
    with closing(sqlite3.connect(path)) as connection:
        assert connection.execute(f"PRAGMA journal_mode = {journal}").fetchone() == (journal,)
    forbid_writing(shared, but_new_files=is_open)
    before = state_of(shared)
    with public_folder() as own:
        own.chmod(0o777)
        with as_somebody_who_may_only_read():
            assert len(verify(path, sample=2, progress=False)) == 2
            pd.testing.assert_frame_equal(run(EXPERIMENT, path, progress=False).drop(columns="seconds"), uninterrupted)
            assert merge(own / "all", path) == 12
            assert numbers(own / "all") == list(range(12))
    assert state_of(shared) == before


class Idle(Executor):
    def submit(self, *_):
        raise AssertionError("a run is computed")


def test_runs_that_a_read_only_store_lacks_are_not_computed(shared):
    path = shared / "s.sqlite"
    for but_new_files in (False, True):
        forbid_writing(shared, but_new_files)
        before = state_of(shared)
        reason = r"s\.sqlite' \(permission denied: the file is read-only\)"
        with (
            as_somebody_who_may_only_read(),
            pytest.raises(StoreError, match=rf"^store must be a file that can be written.*{reason}$"),
        ):
            run(replace(EXPERIMENT, runs=13), path, Idle(), progress=False)
        assert state_of(shared) == before
    shared.chmod(0o555)
    path.chmod(0o666)
    reason = r"s\.sqlite' \(permission denied: its folder is read-only\)"
    with as_somebody_who_may_only_read(), pytest.raises(StoreError, match=rf"can be written.*; got .*{reason}$"):
        run(replace(EXPERIMENT, runs=13), path, Idle(), progress=False)
    assert [file.name for file in shared.iterdir()] == ["s.sqlite"]


def test_a_new_store_in_a_folder_that_cannot_be_written():
    with public_folder() as folder:
        forbid_writing(folder)
        for path in (folder / "s.sqlite", folder / "new" / "s.sqlite"):
            with as_somebody_who_may_only_read(), pytest.raises(StoreError, match=r"\(.*[Pp]ermission denied.*\)$"):
                run(EXPERIMENT, path, Idle(), progress=False)


def test_a_file_that_cannot_be_read(shared):
    (shared / "s.sqlite").chmod(0)
    with (
        as_somebody_who_may_only_read(),
        pytest.raises(StoreError, match=r"^store must be a file that can be read; got .*denied"),
    ):
        verify(shared / "s.sqlite", progress=False)


@pytest.mark.parametrize("beside", [[], ["-wal"], ["-wal", "-shm"]], ids=len)
def test_what_a_killed_writer_left_is_read(tmp_path, beside):
    with Store.for_writing(tmp_path / "s.sqlite") as store, public_folder() as folder:
        add(store, 1)
        store._connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
        add(store, 2)
        for ending in ("", *beside):
            shutil.copy(tmp_path / f"s.sqlite{ending}", folder)
        expected = [1, 2] if beside else [1]
        (folder / "link").symlink_to("s.sqlite")
        forbid_writing(folder)
        before = state_of(folder)
        with as_somebody_who_may_only_read():
            assert numbers(folder / "s.sqlite") == numbers(folder / "link") == expected
        assert state_of(folder) == before
        folder.chmod(0o755)
        for file in folder.iterdir():
            file.chmod(0o644)
        assert numbers(folder / "link") == expected
        assert {file.name for file in folder.iterdir()} == {"s.sqlite", "link"}
        shutil.copy(folder / "s.sqlite", tmp_path / "alone")
        assert numbers(tmp_path / "alone") == expected


def test_a_journal_that_a_killed_writer_left_is_obeyed(shared, tmp_path):
    """Such a writer is no version of this package, but some tool for SQLite."""
    path = tmp_path / "s.sqlite"
    with closing(sqlite3.connect(path, isolation_level=None)) as connection:
        connection.execute("PRAGMA journal_mode = DELETE")
        connection.execute("PRAGMA cache_size = 1")  # changes are written before they are committed
        connection.execute("BEGIN")
        connection.execute("UPDATE runs SET seconds = 0")
        connection.execute("CREATE TABLE large AS SELECT a.* FROM runs a, runs b")
        for file in (path, tmp_path / "s.sqlite-journal"):
            shutil.copy(file, shared)
    assert (shared / "s.sqlite").read_bytes() != path.read_bytes()
    before = state_of(shared)
    assert numbers(shared / "s.sqlite") == list(range(12))
    assert state_of(shared) == before


SELECT = "import sqlite3, sys; sqlite3.connect(sys.argv[1]).execute('SELECT * FROM runs').fetchall()"


def test_reading_cancels_no_lock_of_a_writer_in_the_same_process(tmp_path):
    """If it did, the next process would take itself for the last one, and remove the log from under the writer."""
    with Store.for_writing(tmp_path / "s.sqlite") as store:
        add(store, 1)
        assert numbers(tmp_path / "s.sqlite") == [1]
        subprocess.run([sys.executable, "-c", SELECT, tmp_path / "s.sqlite"], check=True)
        add(store, 2)
        assert numbers(tmp_path / "s.sqlite") == [1, 2]
        assert (tmp_path / "s.sqlite-wal").exists()
    assert numbers(tmp_path / "s.sqlite") == [1, 2]


@pytest.mark.skipif(not IS_ROOT, reason="only root can be two users")
def test_a_store_that_others_may_write_as_well_is_read_without_files_of_the_readers(shared):
    shared.chmod(0o777)
    (shared / "s.sqlite").chmod(0o666)
    with as_somebody_who_may_only_read(), Store.for_reading(shared / "s.sqlite") as store:
        assert len(list(store.runs(*store.experiments()))) == 12
        assert [file.name for file in shared.iterdir()] == ["s.sqlite"]


@pytest.mark.skipif(not IS_ROOT, reason="only root can be two users")
def test_reading_while_the_owner_writes_does_not_lock_the_owner_out():
    with public_folder() as folder:
        folder.chmod(0o777)
        with Store.for_writing(folder / "s.sqlite") as store:
            add(store, 1)
            before = state_of(folder)
            assert len(before) == 3
            with as_somebody_who_may_only_read():
                assert numbers(folder / "s.sqlite") == [1]
            assert state_of(folder) == before
            add(store, 2)
            with as_somebody_who_may_only_read():
                assert numbers(folder / "s.sqlite") == [1, 2]
        with as_somebody_who_may_only_read():
            assert numbers(folder / "s.sqlite") == [1, 2]
        assert [(file.name, file.stat().st_uid) for file in folder.iterdir()] == [("s.sqlite", 0)]


def test_a_log_that_starts_again_while_it_is_copied(tmp_path, monkeypatch):
    """Regression: the copy of the file would be too early, and that of the log too late, for what lies between."""
    really, copied = shutil.copyfile, []

    def copyfile(source, target):
        really(source, target)
        copied.append(source)
        if len(copied) == 1:  # the file, but not yet the log
            add(store, 2)
            store._connection.execute("PRAGMA wal_checkpoint(RESTART)")
            add(store, 3)

    monkeypatch.setattr(database, "_mode_in_place", lambda file: None)
    monkeypatch.setattr(database.shutil, "copyfile", copyfile)
    with Store.for_writing(tmp_path / "s.sqlite") as store:
        add(store, 1)
        assert numbers(tmp_path / "s.sqlite") == [1, 2, 3]
    assert len(copied) > 2


def test_a_file_that_never_rests_is_not_copied(tmp_path, monkeypatch):
    monkeypatch.setattr(database, "_mode_in_place", lambda file: None)
    monkeypatch.setattr(database, "_state", lambda file: object())
    monkeypatch.setattr(database, "_PATIENCE", 0.01)
    with Store.for_writing(tmp_path / "s.sqlite"), pytest.raises(StoreError, match="written without a pause"):
        Store.for_reading(tmp_path / "s.sqlite")


def test_a_store_that_nobody_writes_is_not_copied(shared, monkeypatch):
    monkeypatch.setattr(database, "_copy", None)
    forbid_writing(shared)
    with as_somebody_who_may_only_read(), Store.for_reading(shared / "s.sqlite") as store:
        ((_, _, file),) = store._connection.execute("PRAGMA database_list")
        assert file == os.path.realpath(shared / "s.sqlite")


def test_a_store_that_is_written_while_it_is_read_without_locks(tmp_path, monkeypatch):
    def write(number):
        with Store.for_writing(tmp_path / "s.sqlite") as store:
            add(store, number)

    write(1)
    monkeypatch.setattr(database, "_mode_in_place", lambda file: None)
    reader = Store.for_reading(tmp_path / "s.sqlite")
    write(2)
    with pytest.raises(StoreError, match=r"^store must .*s\.sqlite' \(it was written while it was read\)$"), reader:
        next(reader.runs(*reader.experiments()))
    assert numbers(tmp_path / "s.sqlite") == [1, 2]


def test_a_log_that_begins_while_a_store_is_read_without_locks(tmp_path, monkeypatch):
    with Store.for_writing(tmp_path / "s.sqlite") as store:
        add(store, 1)
    monkeypatch.setattr(database, "_mode_in_place", lambda file: None)
    reader = Store.for_reading(tmp_path / "s.sqlite")
    with Store.for_writing(tmp_path / "s.sqlite") as store:
        with reader:
            add(store, 2)
            assert [kept.number for kept in reader.runs(*reader.experiments())] == [1]
        assert numbers(tmp_path / "s.sqlite") == [1, 2]


def test_a_store_that_is_open_for_reading_takes_no_runs(tmp_path):
    with Store.for_writing(tmp_path / "s.sqlite") as store:
        add(store, 1)
    for path in (tmp_path / "s.sqlite", tmp_path / "none"):
        with (
            Store.for_reading(path, must_exist=False) as reader,
            pytest.raises(StoreError, match=r"^store must .*\(attempt to write a readonly database\)$"),
        ):
            add(reader, 2)
    assert [file.name for file in tmp_path.iterdir()] == ["s.sqlite"]
