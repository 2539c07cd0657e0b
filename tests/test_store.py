import hashlib
import json
import sqlite3

import pytest

from safe.evolution import Run
from safe.store import Store, origin

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
