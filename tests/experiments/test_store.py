import hashlib
import json
import os
import sqlite3
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from safe import StoreError, run, verify
from safe.evolution import Run
from safe.experiments.provenance import origin
from safe.experiments.store import Store
from tests.experiments import EXPERIMENT

RUN = Run(True, 141, 2, (0.1, -1e-300, 1 / 3), (0.85, 0.99), 28_400)


def entry(store, seed=1):
    return store.entry({"seed": seed}, "safe", "maze1")


def kept(store, **limits):
    return [(run.number, run.run, run.seconds) for run in store.runs(entry(store), **limits)]


def test_a_run_comes_back_to_the_last_bit(tmp_path):
    with Store(tmp_path / "new" / "folder" / "s.sqlite") as store:
        store.add(entry(store), origin(), [(7, RUN, 0.25)])
    with Store(tmp_path / "new" / "folder" / "s.sqlite") as store:
        assert kept(store) == kept(store, below=8) == [(7, RUN, 0.25)]
        assert kept(store, below=7) == []
        assert store.finished(entry(store)) == {7}
        assert store.finished(entry(store, seed=2)) == set()


def test_a_run_is_stored_once():
    with Store(None) as store:
        for seconds in (1.0, 2.0):
            store.add(entry(store), origin(), [(0, RUN, seconds)])
        assert kept(store) == [(0, RUN, 1.0)]


def test_a_transaction_left_open_by_an_interruption_hinders_nothing():
    with Store(None) as store:
        entry(store)
        store._connection.execute("BEGIN IMMEDIATE")
        store.add(entry(store), origin(), [(0, RUN, 1.0)])
        assert kept(store) == [(0, RUN, 1.0)]


def test_an_interruption_while_a_store_is_opened_leaves_no_lock(tmp_path, monkeypatch):
    def interrupted(connection, statements):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr("safe.experiments.store._execute_all", interrupted)
        with pytest.raises(KeyboardInterrupt):
            Store(tmp_path / "s.sqlite")
    with Store(tmp_path / "s.sqlite") as store:
        assert kept(store) == []


def test_every_batch_says_where_it_comes_from(tmp_path):
    with Store(tmp_path / "s.sqlite") as store:
        store.add(entry(store), origin(), [(0, RUN, 1.0)])
    connection = sqlite3.connect(tmp_path / "s.sqlite")
    connection.row_factory = sqlite3.Row
    (batch,) = map(dict, connection.execute("SELECT * FROM batches"))
    (row,) = map(dict, connection.execute("SELECT * FROM experiments"))
    connection.close()
    assert all(batch[key] for key in ("version", "python", "numpy", "numba", "platform", "time"))
    assert (json.loads(row["content"]), row["algorithm"], row["maze"]) == ({"seed": 1}, "safe", "maze1")


def test_two_processes_may_have_a_store_open(tmp_path):
    with Store(tmp_path / "s.sqlite") as one, Store(tmp_path / "s.sqlite") as other:
        one.add(entry(one), origin(), [(0, RUN, 1.0), (1, RUN, 1.0)])
        other.add(entry(other), origin(), [(1, RUN, 2.0), (2, RUN, 2.0)])
        assert kept(one) == kept(other) == [(0, RUN, 1.0), (1, RUN, 1.0), (2, RUN, 2.0)]
        assert [run.batch for run in one.runs(entry(one))] == [1, 1, 2]


def test_files_that_are_no_store(tmp_path):
    (tmp_path / "text").write_text("run,success\n" * 100)
    foreign = sqlite3.connect(tmp_path / "foreign")
    foreign.execute("CREATE TABLE t (x)")
    foreign.close()
    Store(tmp_path / "newer").__exit__()
    newer = sqlite3.connect(tmp_path / "newer")
    newer.execute("PRAGMA user_version = 99")
    newer.close()
    before = (tmp_path / "foreign").read_bytes()
    for name, reason in [
        ("text", "file is not a database"),
        ("foreign", "some other database"),
        ("newer", "made by a newer version, with layout 99"),
        ("text/below", "text"),
        ("", "unable to open|no file name"),
    ]:
        with pytest.raises(StoreError, match=rf"store must be the path of a results store.*\(.*({reason})"):
            Store(tmp_path / name)
    for nonsense in (7, "", "a\0b", "\ud800"):
        with pytest.raises(StoreError, match="store must be the path"):
            Store(nonsense)
    assert (tmp_path / "foreign").read_bytes() == before


def test_a_message_shows_the_whole_path_or_its_end():
    for length in (90, 200):
        folder = Path("none") / ("x" * length)
        with pytest.raises(StoreError, match=r"s\.sqlite' \(there is no such file\)$") as caught:
            Store(folder / "s.sqlite", must_exist=True)
        assert (f"got '{folder}" in str(caught.value)) == (length == 90)
        assert len(str(caught.value)) < 300


# Whatever happens to a store, a table is right, or one line says what is wrong


def test_damage_that_sqlite_quotes_and_no_text_can_hold(store):
    """Regression: a byte that is not UTF-8, in the text of a table's definition."""
    healthy = store.read_bytes()
    store.write_bytes(healthy.replace(b"coefficients TEXT NOT NULL", b"coefficients TEXT NOT \x80ULL"))
    assert store.read_bytes() != healthy
    with pytest.raises(StoreError, match=r"^store must be the path of a results store"):
        Store(store)


def assert_refused(store, reason):
    with pytest.raises(StoreError, match=rf"^store must .*; got .*{reason}") as caught:
        run(EXPERIMENT, store, progress=False)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "change",
    [
        "UPDATE runs SET success = 1 WHERE run = 7",
        "UPDATE runs SET distance = distance + 1 WHERE run = 7",
        "UPDATE runs SET controller = replace(controller, '0.1', '0.2') WHERE run = 7",
        "UPDATE runs SET seconds = 0 WHERE run = 7",
        "UPDATE runs SET run = 70 WHERE run = 7",
        "UPDATE runs SET generation = NULL WHERE run = 7",
        "UPDATE experiments SET content = replace(content, '3', '4')",
    ],
)
def test_altered_by_hand(store, change):
    with closing(sqlite3.connect(store)) as connection:
        try:
            connection.execute(change)
        except sqlite3.IntegrityError:  # the file itself refuses
            return
        connection.commit()
    if "run = 70" in change:  # not one of the twelve: the missing run is made again
        assert len(run(EXPERIMENT, store, progress=False)) == 12
        assert_refused_by(lambda: run(replace(EXPERIMENT, runs=80), store, progress=False))
    else:
        assert_refused(store, "was altered or damaged")
    assert_refused_by(lambda: verify(store, progress=False))


def assert_refused_by(call):
    with pytest.raises(StoreError, match=r"^store must hold what was written to it; got .* was altered or damaged"):
        call()


def test_a_deleted_run_is_made_again(store):
    before = run(EXPERIMENT, store, progress=False)
    with closing(sqlite3.connect(store)) as connection:
        connection.execute("DELETE FROM runs WHERE run = 7")
        connection.commit()
    pd.testing.assert_frame_equal(
        run(EXPERIMENT, store, progress=False).drop(columns="seconds"), before.drop(columns="seconds")
    )


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_cut_off(store, share):
    content = store.read_bytes()
    store.write_bytes(content[: int(share * len(content))])
    assert_refused(store, r"\(database disk image is malformed\)")


def test_disk_full(tmp_path, monkeypatch):
    really = Store._set_up

    def on_a_small_disk(store):
        really(store)
        store._connection.execute("PRAGMA max_page_count = 10")

    with monkeypatch.context() as patch:
        patch.setattr(Store, "_set_up", on_a_small_disk)
        with pytest.raises(StoreError, match=r"store must .*; got .*\(database or disk is full\)") as caught:
            run(replace(EXPERIMENT, runs=200), tmp_path / "s.sqlite", progress=False)
    kept = int(caught.value.__notes__[0].split()[0])
    assert 0 < kept < 200
    with Store(tmp_path / "s.sqlite") as store:
        assert len(store.runs(store.experiments()[0])) == kept
    assert len(run(replace(EXPERIMENT, runs=200), tmp_path / "s.sqlite", progress=False)) == 200


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="a folder has these permissions only on Unix")
def test_a_folder_that_cannot_be_written(tmp_path):
    tmp_path.chmod(0o555)
    user = os.geteuid()
    if user == 0:  # root may write everywhere
        os.seteuid(65534)
    try:
        assert_refused(tmp_path / "s.sqlite", r"\((unable to open database file|.*[Pp]ermission denied).*\)")
    finally:
        os.seteuid(user)
        tmp_path.chmod(0o755)


def make_first_layout(store, change=""):
    with closing(sqlite3.connect(store)) as connection:
        connection.executescript(f"""
            CREATE TABLE old AS SELECT * FROM runs;
            ALTER TABLE old DROP COLUMN checksum;
            DROP TABLE runs;
            ALTER TABLE old RENAME TO runs;
            {change};
            PRAGMA user_version = 1;
        """)


def test_a_store_of_the_first_layout_gets_checksums(store):
    before = run(EXPERIMENT, store, progress=False)
    make_first_layout(store)
    pd.testing.assert_frame_equal(run(EXPERIMENT, store, progress=False), before)
    assert len(verify(store, sample=3, progress=False)) == 3


@pytest.mark.parametrize(
    "change",
    [
        "UPDATE runs SET controller = 'x' WHERE run = 7",
        "UPDATE runs SET coefficients = '7' WHERE run = 7",
        "UPDATE runs SET distance = 'near' WHERE run = 7",
    ],
)
def test_damage_that_has_got_a_checksum(store, change):
    make_first_layout(store, change)
    assert_refused(store, "where run 7 of safe on maze1 was altered or damaged")


def test_a_store_of_the_first_layout_with_runs_of_no_experiment(store):
    make_first_layout(store, "UPDATE runs SET experiment = 99")
    assert_refused(store, r"\(some of its runs belong to no experiment\)")


def test_what_layout_2_writes(tmp_path):
    """As it was when layout 2 was new. If it changes, raise the layout, and update stores of this one."""
    with Store(tmp_path / "s.sqlite") as store:
        store.add(entry(store), origin(), [(7, RUN, 0.25)])
    with closing(sqlite3.connect(tmp_path / "s.sqlite")) as connection:
        tables, experiments, runs = (
            connection.execute(query).fetchall()
            for query in (
                "SELECT sql FROM sqlite_master WHERE sql IS NOT NULL",
                "SELECT content, digest FROM experiments",
                "SELECT * FROM runs",
            )
        )
    assert hashlib.sha256(repr(tables).encode()).hexdigest()[:16] == "1cab8cb0124d5c87"
    assert experiments == [('{"seed": 1}', "a4bbadc1c78966d28872dbe60ff40cb9c996f884e228ed4a08eb7d6c3a24f4b8")]
    controller, coefficients = "[0.1, -1e-300, 0.3333333333333333]", "[0.85, 0.99]"
    assert runs == [(1, 7, 1, 1, 141, 2, controller, coefficients, 28_400, 0.25, "2a64fc6d5ba882c3")]
