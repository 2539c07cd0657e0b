import sqlite3
from contextlib import closing
from dataclasses import replace

import pytest

from safe import StoreError, merge, run, verify
from safe.experiments.provenance import origin
from safe.experiments.store import Store
from tests.experiments import EXPERIMENT


def test_stores_of_a_class_are_merged(tmp_path):
    """Each has made some of the runs, and some runs were made twice."""
    for name, (runs, seed) in {"a": (5, 3), "b": (8, 3), "c": (4, 4)}.items():
        run(replace(EXPERIMENT, runs=runs, seed=seed), tmp_path / name, progress=False)
    assert merge(tmp_path / "all", tmp_path / "a") == 5
    assert merge(tmp_path / "all", tmp_path / "b") == 3
    assert merge(tmp_path / "all", tmp_path / "c") == 4
    assert merge(tmp_path / "all", tmp_path / "b") == merge(tmp_path / "all", tmp_path / "all") == 0
    assert set(verify(tmp_path / "all", sample=100, progress=False).value_counts("seed").items()) == {(3, 8), (4, 4)}
    with Store(tmp_path / "all") as together, Store(tmp_path / "b") as b:
        runs, originals = (store.runs(store.experiments()[0]) for store in (together, b))
        assert together.origin_of(runs[7].batch) == b.origin_of(originals[7].batch)
        assert [r.seconds for r in runs[5:]] == [r.seconds for r in originals[5:]]


def test_stores_that_disagree_are_not_merged(store, tmp_path):
    with Store(tmp_path / "other") as other, Store(store) as right:
        (found,) = right.experiments()
        runs = right.runs(found)
        distance = runs[3].run.distance
        wrong = replace(runs[3].run, distance=distance + 1)
        entry = other.entry(found.content, found.algorithm, found.maze)
        other.add(entry, origin(), [(3, wrong, 1.0), (100, wrong, 1.0)])
    before = store.read_bytes()
    with pytest.raises(
        StoreError,
        match=r"other must agree with the store; got .*other', where run 3 of safe on maze1 "
        rf"has distance {distance + 1} instead of {distance}",
    ):
        merge(store, tmp_path / "other")
    with pytest.raises(StoreError, match=r"store must be the path of a results store.*there is no such file"):
        merge(store, tmp_path / "none")
    assert store.read_bytes() == before
    assert not (tmp_path / "none").exists()


def test_a_run_that_its_experiment_does_not_make(store):
    """Its checksum is right: only making the run again shows the error."""
    assert len(verify(store, sample=5, seed=1, progress=False)) == 5
    assert verify(store, sample=5, seed=1, progress=False).equals(verify(store, sample=5, seed=1, progress=False))
    with Store(store) as results:
        (found,) = results.experiments()
        (first, *_) = results.runs(found)
        results.add(found, origin(), [(12, first.run, 1.0)])
    with pytest.raises(StoreError, match=r"store must hold what its experiments make; got .* run 12 of safe on maze1"):
        verify(store, sample=13, progress=False)


@pytest.mark.parametrize(("sample", "seed"), [(0, None), ("all", None), (1, -1)])
def test_bad_samples(store, sample, seed):
    with pytest.raises(ValueError, match=r"(sample|seed) must be an integer"):
        verify(store, sample, seed)


def test_a_store_that_has_lost_its_batches_is_not_merged(store, tmp_path):
    with closing(sqlite3.connect(store)) as connection:
        connection.execute("DELETE FROM batches")
        connection.commit()
    with pytest.raises(StoreError, match=r"store must hold what was written.*s\.sqlite', where batch 1 was altered"):
        merge(tmp_path / "all", store)
    with Store(tmp_path / "all") as together:
        assert together.experiments() == []


def test_experiments_of_a_version_that_knows_more(store):
    with Store(store) as results:
        (found,) = results.experiments()
        content = found.content | {"parameters": {"weather": "fine"}}
        entry = results.entry(content, "safe", "maze1")
        results.add(entry, origin(), [(0, results.runs(found)[0].run, 1.0)])
    with pytest.raises(StoreError, match=r"store must hold experiments that this version can make; got .*s\.sqlite"):
        verify(store, sample=100, progress=False)
