import json
import sqlite3
from contextlib import closing
from dataclasses import replace
from itertools import islice
from pathlib import Path

import pandas as pd
import pytest

from safe import StoreError, run, verify
from safe.evolution import Run
from safe.experiments.database import open_for_writing
from safe.experiments.provenance import origin
from safe.experiments.store import Store
from safe.kernel import sources
from tests.experiments import EXPERIMENT

RUN = Run(True, 141, 2, (0.1, -1e-300, 1 / 3), (0.85, 0.99), 28_400)


def entry(store, seed=1):
    return store.entry({"seed": seed}, "safe", "maze1")


def kept(store, **limits):
    return [(run.number, run.run, run.seconds) for run in store.runs(entry(store), **limits)]


def test_a_run_comes_back_to_the_last_bit(tmp_path):
    with Store.for_writing(tmp_path / "new" / "folder" / "s.sqlite") as store:
        store.add(entry(store), origin(), [(7, RUN, 0.25)])
    with Store.for_writing(tmp_path / "new" / "folder" / "s.sqlite") as store:
        assert kept(store) == kept(store, below=8) == [(7, RUN, 0.25)]
        assert kept(store, below=7) == []
        assert store.finished(entry(store)).tolist() == store.finished(entry(store), below=8).tolist() == [7]
        assert store.finished(entry(store), below=7).tolist() == store.finished(entry(store, seed=2)).tolist() == []


def test_a_run_is_stored_once():
    with Store.for_writing(None) as store:
        for seconds in (1.0, 2.0):
            store.add(entry(store), origin(), [(0, RUN, seconds)])
        assert kept(store) == [(0, RUN, 1.0)]


def test_a_transaction_left_open_by_an_interruption_hinders_nothing():
    with Store.for_writing(None) as store:
        entry(store)
        store._connection.execute("BEGIN IMMEDIATE")
        store.add(entry(store), origin(), [(0, RUN, 1.0)])
        assert kept(store) == [(0, RUN, 1.0)]


def test_every_batch_says_where_it_comes_from(tmp_path):
    with Store.for_writing(tmp_path / "s.sqlite") as store:
        store.add(entry(store), origin(), [(0, RUN, 1.0)])
    connection = sqlite3.connect(tmp_path / "s.sqlite")
    connection.row_factory = sqlite3.Row
    (batch,) = map(dict, connection.execute("SELECT * FROM batches"))
    (row,) = map(dict, connection.execute("SELECT * FROM experiments"))
    connection.close()
    assert all(batch[key] for key in ("version", "python", "numpy", "numba", "platform", "time"))
    assert batch["sources"] == sources()
    assert (json.loads(row["content"]), row["algorithm"], row["maze"]) == ({"seed": 1}, "safe", "maze1")


def test_two_processes_may_have_a_store_open(tmp_path):
    with Store.for_writing(tmp_path / "s.sqlite") as one, Store.for_writing(tmp_path / "s.sqlite") as other:
        one.add(entry(one), origin(), [(0, RUN, 1.0), (1, RUN, 1.0)])
        other.add(entry(other), origin(), [(1, RUN, 2.0), (2, RUN, 2.0)])
        assert kept(one) == kept(other) == [(0, RUN, 1.0), (1, RUN, 1.0), (2, RUN, 2.0)]
        assert [run.batch for run in one.runs(entry(one))] == [1, 1, 2]


def test_a_message_shows_the_whole_path_or_its_end():
    for length in (90, 200):
        folder = Path("none") / ("x" * length)
        with pytest.raises(StoreError, match=r"s\.sqlite' \(there is no such file\)$") as caught:
            Store.for_reading(folder / "s.sqlite")
        assert (f"got '{folder}" in str(caught.value)) == (length == 90)
        assert len(str(caught.value)) < 300


# Whatever happens to a store, a table is right, or one line says what is wrong


def test_damage_that_sqlite_quotes_and_no_text_can_hold(store):
    """Regression: a byte that is not UTF-8, in the text of a table's definition."""
    healthy = store.read_bytes()
    store.write_bytes(healthy.replace(b"coefficients TEXT NOT NULL", b"coefficients TEXT NOT \x80ULL"))
    assert store.read_bytes() != healthy
    for open_store in (Store.for_writing, Store.for_reading):
        with pytest.raises(StoreError, match=r"^store must be the path of a results store"):
            open_store(store)


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


def test_runs_that_are_counted_but_cannot_be_read(store, monkeypatch):
    """Regression: the index of a damaged file named runs that its table had no longer, and the table came out short."""
    read = Store.runs
    monkeypatch.setattr(Store, "runs", lambda *arguments: islice(read(*arguments), 11))
    assert_refused_by(lambda: run(EXPERIMENT, store, progress=False))


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
    def on_a_small_disk(path):
        connection = open_for_writing(path)
        connection.execute("PRAGMA max_page_count = 10")
        return connection

    with monkeypatch.context() as patch:
        patch.setattr("safe.experiments.store.open_for_writing", on_a_small_disk)
        with pytest.raises(StoreError, match=r"store must .*; got .*\(database or disk is full\)") as caught:
            run(replace(EXPERIMENT, runs=200), tmp_path / "s.sqlite", progress=False)
    kept = int(caught.value.__notes__[0].split()[0])
    assert 0 < kept < 200
    with Store.for_writing(tmp_path / "s.sqlite") as store:
        assert len(list(store.runs(store.experiments()[0]))) == kept
    assert len(run(replace(EXPERIMENT, runs=200), tmp_path / "s.sqlite", progress=False)) == 200
