import hashlib
import json
import os
import sqlite3
from contextlib import closing
from dataclasses import replace

import pandas as pd
import pytest

from safe import Experiment, Parameters, run, verify
from safe.evolution import Run
from safe.experiments.store import Store, origin

EXPERIMENT = Experiment("safe", "maze1", runs=12, seed=3, parameters=Parameters(generations=4))
RUN = Run(True, 141, 2, (0.1, -1e-300, 1 / 3), (0.85, 0.99), 28_400)


def experiment(store, seed=1):
    content = {"seed": seed}
    digest = hashlib.sha256(json.dumps(content).encode()).hexdigest()
    return store.experiment(content, digest, "safe", "maze1")


def kept(store, below=None):
    return [(run.number, run.run, run.seconds) for run in store.runs(experiment(store), below)]


def test_a_run_comes_back_to_the_last_bit(tmp_path):
    with Store(tmp_path / "new" / "folder" / "s.sqlite") as store:
        store.add(experiment(store), origin(), [(7, RUN, 0.25)])
    with Store(tmp_path / "new" / "folder" / "s.sqlite") as store:
        assert kept(store) == kept(store, below=8) == [(7, RUN, 0.25)]
        assert kept(store, below=7) == []
        assert store.finished(experiment(store)) == {7}
        assert store.finished(experiment(store, seed=2)) == set()


def test_a_run_is_kept_once():
    with Store(None) as store:
        for seconds in (1.0, 2.0):
            store.add(experiment(store), origin(), [(0, RUN, seconds)])
        assert kept(store) == [(0, RUN, 1.0)]


def test_a_transaction_that_an_interruption_has_left_is_no_hindrance():
    with Store(None) as store:
        experiment(store)
        store._connection.execute("BEGIN IMMEDIATE")
        store.add(experiment(store), origin(), [(0, RUN, 1.0)])
        assert kept(store) == [(0, RUN, 1.0)]


def test_an_interruption_while_it_is_opened_leaves_no_lock(tmp_path, monkeypatch):
    def interrupted(connection, statements):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr("safe.experiments.store._execute_all", interrupted)
        with pytest.raises(KeyboardInterrupt):
            Store(tmp_path / "s.sqlite")
    with Store(tmp_path / "s.sqlite") as store:
        assert kept(store) == []


def test_every_batch_tells_where_it_comes_from(tmp_path):
    with Store(tmp_path / "s.sqlite") as store:
        store.add(experiment(store), origin(), [(0, RUN, 1.0)])
    connection = sqlite3.connect(tmp_path / "s.sqlite")
    connection.row_factory = sqlite3.Row
    (batch,) = map(dict, connection.execute("SELECT * FROM batches"))
    (row,) = map(dict, connection.execute("SELECT * FROM experiments"))
    connection.close()
    assert all(batch[key] for key in ("version", "python", "numpy", "numba", "platform", "time"))
    assert (json.loads(row["content"]), row["algorithm"], row["maze"]) == ({"seed": 1}, "safe", "maze1")


def test_two_processes_may_have_it_open(tmp_path):
    with Store(tmp_path / "s.sqlite") as one, Store(tmp_path / "s.sqlite") as other:
        one.add(experiment(one), origin(), [(0, RUN, 1.0), (1, RUN, 1.0)])
        other.add(experiment(other), origin(), [(1, RUN, 2.0), (2, RUN, 2.0)])
        assert kept(one) == kept(other) == [(0, RUN, 1.0), (1, RUN, 1.0), (2, RUN, 2.0)]
        assert [run.batch for run in one.runs(experiment(one))] == [1, 1, 2]


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
        with pytest.raises(ValueError, match=rf"store must be the path of a results store.*\(.*({reason})"):
            Store(tmp_path / name)
    for nonsense in (7, "", "a\0b"):
        with pytest.raises(ValueError, match="store must be the path"):
            Store(nonsense)
    assert (tmp_path / "foreign").read_bytes() == before


# What a store may have gone through: a table is right, or there is one clear line


@pytest.fixture
def store(tmp_path):
    """The path of a store with an experiment of twelve runs."""
    path = tmp_path / "s.sqlite"
    run(EXPERIMENT, path, progress=False)
    return path


def assert_refused(store, reason):
    with pytest.raises(ValueError, match=rf"^store must .*; got .*{reason}") as caught:
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
    if "run = 70" in change:  # not one of the twelve: that which is missing is made again
        assert len(run(EXPERIMENT, store, progress=False)) == 12
        assert_refused_by(lambda: run(replace(EXPERIMENT, runs=80), store, progress=False))
    else:
        assert_refused(store, "was altered or damaged")
    assert_refused_by(lambda: verify(store, progress=False))


def assert_refused_by(call):
    with pytest.raises(ValueError, match=r"^store must be as it was left; got .* was altered or damaged"):
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

    def on_a_small_disk(connection):
        really(connection)
        connection.execute("PRAGMA max_page_count = 10")

    with monkeypatch.context() as patch:
        patch.setattr(Store, "_set_up", staticmethod(on_a_small_disk))
        with pytest.raises(ValueError, match=r"store must .*; got .*\(database or disk is full\)") as caught:
            run(replace(EXPERIMENT, runs=200), tmp_path / "s.sqlite", progress=False)
    kept = int(caught.value.__notes__[0].split()[0])
    assert 0 < kept < 200
    with Store(tmp_path / "s.sqlite") as store:
        assert len(store.runs(store.experiments()[0])) == kept
    assert len(run(replace(EXPERIMENT, runs=200), tmp_path / "s.sqlite", progress=False)) == 200


def test_a_folder_that_cannot_be_written(tmp_path):
    tmp_path.chmod(0o555)
    user = os.geteuid()
    if user == 0:  # who may write everywhere
        os.seteuid(65534)
    try:
        assert_refused(tmp_path / "s.sqlite", r"\((unable to open database file|.*[Pp]ermission denied).*\)")
    finally:
        os.seteuid(user)
        tmp_path.chmod(0o755)


def test_a_store_of_the_first_layout_gets_checksums(store):
    before = run(EXPERIMENT, store, progress=False)
    with closing(sqlite3.connect(store)) as connection:
        connection.executescript("""
            CREATE TABLE old AS SELECT * FROM runs;
            ALTER TABLE old DROP COLUMN checksum;
            DROP TABLE runs;
            ALTER TABLE old RENAME TO runs;
            PRAGMA user_version = 1;
        """)
    pd.testing.assert_frame_equal(run(EXPERIMENT, store, progress=False), before)
    assert len(verify(store, sample=3, progress=False)) == 3
