import sqlite3
from contextlib import closing
from dataclasses import replace

import pytest

from safe import StoreError, merge, run, verify
from safe.evolution import evolve
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
    with Store.for_reading(tmp_path / "all") as together, Store.for_reading(tmp_path / "b") as b:
        runs, originals = (list(store.runs(store.experiments()[0])) for store in (together, b))
        assert together.origin_of(runs[7].batch) == b.origin_of(originals[7].batch)
        assert [r.seconds for r in runs[5:]] == [r.seconds for r in originals[5:]]


def test_stores_that_disagree_are_not_merged(store, tmp_path):
    with Store.for_writing(tmp_path / "other") as other, Store.for_writing(store) as right:
        (found,) = right.experiments()
        runs = list(right.runs(found))
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
    with Store.for_writing(store) as results:
        (found,) = results.experiments()
        (first, *_) = results.runs(found)
        results.add(found, origin(), [(12, first.run, 1.0)])
    with pytest.raises(StoreError, match=r"store must hold what its experiments make; got .* run 12 of safe on maze1"):
        verify(store, sample=13, progress=False)


@pytest.mark.parametrize("called", ["same", "other", "unknown"])
def test_runs_made_from_other_sources_are_repeated_and_said_to_be(store, called):
    recorded = {"same": origin().sources, "other": "0123456789abcdef", "unknown": None}[called]
    made_by = origin()._replace(version="0.0.9", commit="c0ffee0123456789", sources=recorded)
    with Store.for_writing(store) as results:
        (found,) = results.experiments()
        (first, *_) = results.runs(found)
        remade = evolve("maze1", "safe", EXPERIMENT.seed_sequence(12), EXPERIMENT.parameters)
        results.add(found, made_by, [(12, remade, 1.0)])
    same = verify(store, sample=13, progress=False).set_index("run").sources
    assert (same[12], {*same.drop(12)}) == (called, {"same"})
    with Store.for_writing(store) as results:
        results.add(found, made_by, [(13, first.run, 1.0)])
    with pytest.raises(StoreError, match="where run 13 of safe on maze1, seed 3, has ") as caught:
        verify(store, sample=14, progress=False)
    named = f"; it was made from {called} sources (version 0.0.9, commit c0ffee01, sources {str(recorded)[:8]})"
    assert str(caught.value).endswith(named) == (called != "same")
    assert ("sources" in str(caught.value)) == (called != "same")


def test_after_a_reload_of_edited_sources_nothing_is_said_to_be_the_same(store, monkeypatch):
    monkeypatch.setattr("safe.kernel._LOADED", {"one", "another"})
    assert {*verify(store, sample=2, progress=False).sources} == {"unknown"}


def test_merged_runs_keep_their_sources(store, tmp_path):
    with closing(sqlite3.connect(store)) as connection:
        connection.execute("UPDATE batches SET sources = '0123456789abcdef'")
        connection.commit()
    merge(tmp_path / "all", store)
    assert {*verify(tmp_path / "all", sample=2, progress=False).sources} == {"other"}


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
    with Store.for_reading(tmp_path / "all") as together:
        assert together.experiments() == []


def test_experiments_of_a_version_that_knows_more(store):
    with Store.for_writing(store) as results:
        (found,) = results.experiments()
        content = found.content | {"parameters": {"weather": "fine"}}
        entry = results.entry(content, "safe", "maze1")
        results.add(entry, origin(), [(0, next(results.runs(found)).run, 1.0)])
    with pytest.raises(StoreError, match=r"store must hold experiments that this version can make; got .*s\.sqlite"):
        verify(store, sample=100, progress=False)
