import json
import lzma
import sqlite3
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import closing
from dataclasses import replace

import pandas as pd
import pytest

import safe
from safe.companion import evidence
from safe.companion.designs import Recorded
from safe.companion.evidence import Collection
from safe.experiments.provenance import Origin
from safe.results import exploration, mechanism

FEW = safe.Parameters(generations=4)
COEVOLVED = safe.Experiment("safe", "maze1", 6, 3, FEW)
RANDOM = safe.Experiment("random", "maze2", 4, 3, FEW)
DESIGN = [Recorded(COEVOLVED, traced=3), Recorded(RANDOM, traced=1), Recorded(replace(COEVOLVED, seed=4))]
COEFFICIENTS = safe.algorithms.COEFFICIENTS
FILES = (evidence.RUNS, evidence.TRACES, evidence.SUMMARY)


@pytest.fixture
def empty(tmp_path, monkeypatch):
    """The folder of a record that has not been made."""
    monkeypatch.setattr(evidence, "FOLDER", tmp_path)
    collect(monkeypatch)
    return tmp_path / "record"


def collect(monkeypatch, designed=DESIGN, coefficients=COEFFICIENTS, observer=mechanism):
    """Let one collection be all there is."""
    collection = Collection("record", lambda: designed, coefficients, observer)
    monkeypatch.setattr(evidence, "COLLECTIONS", (collection,))


@pytest.fixture
def record(empty):
    """The folder of a record that has been made."""
    make(empty)
    return empty


def make(record, **options):
    evidence.make(record.with_name("evidence.sqlite"), progress=False, **options)


def test_recorded_runs_are_those_of_the_experiments(record):
    for experiment, recorded in evidence.runs([COEVOLVED, RANDOM], {}).items():
        made = safe.run(experiment, progress=False)
        coefficients = [*COEFFICIENTS] if experiment is COEVOLVED else []
        assert recorded.columns.tolist() == ["run", "success", "generation", "distance", *coefficients, "evaluations"]
        exact = recorded.columns.drop(coefficients)
        pd.testing.assert_frame_equal(recorded[exact], made[exact])
        for name in coefficients:
            assert recorded[name].tolist() == [float(f"{value:.3g}") for value in made[name]]


def test_collections_are_made_read_and_verified_together(empty, monkeypatch):
    goals = replace(COEVOLVED, algorithm=safe.Algorithm("goals", kind="goal", judging="favourite"))
    more = Collection("more", lambda: [Recorded(goals, traced=2)], (), exploration)
    monkeypatch.setattr(evidence, "COLLECTIONS", (*evidence.COLLECTIONS, more))
    make(empty)
    assert evidence.verify(sample=100, traces=100) == (16 + 6, 4 + 2)
    assert evidence.verify(sample=3, traces=1) == (3 + 3, 1 + 1)
    runs = evidence.runs([goals, COEVOLVED])
    assert [*runs] == [goals, COEVOLVED]
    assert not {*COEFFICIENTS} & {*runs[goals]}
    assert runs[goals].generation.tolist() == safe.run(goals, progress=False).generation.tolist()
    traces = evidence.traces([COEVOLVED, goals], 5)
    observed = exploration.by_window(exploration.observe(goals, goals.replay(1)))
    assert (
        traces[goals].query("run == 1").path_cells.tolist()
        == observed.path_cells.map("{:.3g}".format).map(float).tolist()
    )
    assert "novelty" in traces[COEVOLVED]
    before = contents(empty)
    evidence.make(empty.with_name("other.sqlite"), progress=False, collections=["more"])
    assert contents(empty) == before
    with pytest.raises(ValueError, match="collections must be one of 'record', 'more'; got 'most'"):
        evidence.make(empty.with_name("other.sqlite"), collections=["most"])
    assert evidence.extent().loc["recorded", ["experiments", "runs", "traces"]].tolist() == [4, 22, 6]


def test_fewer_runs_than_are_recorded(record):
    fewer = replace(COEVOLVED, runs=2)
    runs = evidence.runs([fewer, COEVOLVED], {})
    pd.testing.assert_frame_equal(runs[fewer], runs[COEVOLVED].head(2))
    traces = evidence.traces([fewer, COEVOLVED], 3)
    assert set(traces[fewer].run) == {0, 1}
    pd.testing.assert_frame_equal(traces[fewer], traces[COEVOLVED].query("run < 2"))


@pytest.mark.parametrize("change", [{"runs": 7}, {"seed": 5}])
def test_what_is_not_recorded_is_computed(record, tmp_path, change):
    another = replace(COEVOLVED, **change)
    store = tmp_path / "s.sqlite"
    runs = evidence.runs([COEVOLVED, another], {"store": store, "progress": False})
    assert "seconds" not in runs[COEVOLVED]
    pd.testing.assert_frame_equal(runs[another], safe.run(another, store))
    assert [*runs] == [COEVOLVED, another]
    without_resources = evidence.runs([another, COEVOLVED])
    assert [*without_resources] == [COEVOLVED]
    pd.testing.assert_frame_equal(without_resources[COEVOLVED], runs[COEVOLVED])


def test_recorded_traces_are_the_mechanism_of_the_runs(record):
    recorded = evidence.traces([COEVOLVED, RANDOM, DESIGN[2].experiment], 5)
    assert [*recorded] == [COEVOLVED, RANDOM]
    assert set(recorded[COEVOLVED].run) == {0, 1, 2}
    observed = mechanism.by_window(mechanism.observe(COEVOLVED, COEVOLVED.replay(1)))[[*mechanism.MEASURES]]
    of_run = recorded[COEVOLVED].query("run == 1").drop(columns="run").set_index("window")
    rounded = observed.map(lambda value: float(f"{value:.3g}"))
    pd.testing.assert_frame_equal(of_run, rounded, check_names=False, check_index_type=False)


def test_no_trace_that_is_not_recorded_is_observed_if_the_runs_are_recorded(record, monkeypatch):
    monkeypatch.setattr(evidence, "make_trace", None)
    more = [replace(COEVOLVED, runs=7), RANDOM, DESIGN[2].experiment]
    assert {e: set(table.run) for e, table in evidence.traces(more, 7).items()} == {more[0]: {0, 1, 2}, RANDOM: {0}}
    assert [set(table.run) for table in evidence.traces(more, 1).values()] == [{0}, {0}]
    assert evidence.traces(more, 0) == {}


def test_runs_of_which_nothing_is_recorded_are_observed_now(record, monkeypatch):
    recorded = evidence.traces([COEVOLVED, RANDOM], 2)
    rewrite(record, entries=lambda entry: entry._replace(digest="0" * 16))
    few = [replace(COEVOLVED, runs=2), replace(RANDOM, runs=1)]  # of which there are two traces, and one
    here = {"executor": None, "cores": 2, "store": None}
    for (experiment, observed), table in zip(evidence.traces(few, 5, here).items(), recorded.values(), strict=True):
        pd.testing.assert_frame_equal(observed, table)
        first = evidence.traces([experiment], 1, here)[experiment]
        pd.testing.assert_frame_equal(first, table.query("run == 0"))
    monkeypatch.setattr(evidence, "make_trace", None)
    assert evidence.traces(few, 0, here) == {}
    assert evidence.traces(few, 5) == {}


@pytest.mark.parametrize("traced", [-1, 1.5])
def test_numbers_of_traces_that_are_refused(record, traced):
    with pytest.raises(ValueError, match=f"traced must be an integer of at least 0; got {traced}"):
        evidence.traces([COEVOLVED], traced)


def test_the_record_says_where_it_comes_from(record):
    text = (record / evidence.SUMMARY).read_text()
    contents = json.loads(text)
    assert contents["experiments"][:2] == [
        [COEVOLVED.digest[:16], 6, 3, [0]],
        [RANDOM.digest[:16], 4, 1, [0]],
    ]
    lines = [line.rstrip(",") for line in text.splitlines()]
    assert all(json.dumps(entry) in lines for entry in contents["experiments"]), "one a line, to compare versions"
    assert contents["rules"] == safe.evolution.RULES
    assert [Origin(**made_by) for made_by in contents["origins"]] == [safe.experiments.provenance.origin()]


def test_pandas_reads_the_files(record):
    table = pd.read_csv(record / evidence.RUNS)
    assert table.experiment.value_counts().to_dict() == {0: 6, 1: 4, 2: 6}
    assert set(pd.read_csv(record / evidence.TRACES).experiment) == {0, 1}


def test_how_much_is_recorded(record):
    runs = evidence.runs([recorded.experiment for recorded in DESIGN])
    evaluations = sum(int(table.evaluations.sum()) for table in runs.values())
    assert evidence.extent().to_dict("index") == {
        "recorded": {"experiments": 3, "runs": 16, "traces": 4, "evaluations": evaluations}
    }


def contents(record):
    return [(record / name).read_bytes() for name in FILES]


def test_made_anew_from_one_store_the_record_is_the_same(record, monkeypatch):
    before = contents(record)
    for name in FILES:
        (record / name).unlink()
    monkeypatch.setattr(evidence, "make_trace", None)
    make(record)
    assert contents(record) == before


def test_the_executor_does_not_matter(record):
    before = contents(record)[:2]
    for number, pool in enumerate((ThreadPoolExecutor(3), ProcessPoolExecutor(1))):
        with pool:
            evidence.make(record.with_name(f"{number}.sqlite"), pool, progress=False)
            assert pool.submit(int).result() == 0
        assert contents(record)[:2] == before


def kept_traces(record):
    with closing(sqlite3.connect(record.with_name("evidence-traces.sqlite"))) as file:
        return file.execute("SELECT digest, run FROM traces").fetchall()


def test_an_interruption_loses_only_what_is_in_flight(empty, monkeypatch):
    made, make_trace = [], evidence.make_trace

    def interrupted(observer, experiment, number):
        while number == 2 and len(kept_traces(empty)) < 3:
            time.sleep(0.01)
        if number == 2:
            raise KeyboardInterrupt
        return make_trace(observer, experiment, number)

    def counted(observer, experiment, number):
        made.append((experiment.digest, number))
        return make_trace(observer, experiment, number)

    monkeypatch.setattr(evidence, "make_trace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        make(empty, cores=2)
    assert not empty.exists()
    monkeypatch.setattr(evidence, "make_trace", counted)
    make(empty)
    assert made == [(COEVOLVED.digest, 2)]
    assert evidence.verify(sample=100, traces=100) == (16, 4)


def test_traces_by_other_measures_are_not_mixed_in(record, tmp_path, monkeypatch):
    other = tmp_path / "mechanism.py"
    other.write_text("# other measures")
    monkeypatch.setattr(mechanism, "__file__", str(other))
    make(record)
    assert len(kept_traces(record)) == 2 * 4


def test_traces_by_other_rules_are_refused(empty, monkeypatch):
    make_trace = evidence.make_trace
    monkeypatch.setattr(evidence, "make_trace", lambda *arguments: make_trace(*arguments)._replace(rules=99))
    with pytest.raises(ValueError, match="executor must compute by the rules 1 of this version; got 99"):
        make(empty)
    assert kept_traces(empty) == []


@pytest.mark.parametrize("damage", [None, b"", b"{}", b"\xfd7zXZ"])
@pytest.mark.parametrize("name", FILES)
def test_a_damaged_file_is_refused(record, name, damage):
    if damage is None:
        (record / name).unlink()
    else:
        (record / name).write_bytes(damage)
    with pytest.raises(
        ValueError, match=rf"^record must hold what was written .*{name}.*make evidence makes it again$"
    ):
        evidence.verify()
    with pytest.raises(ValueError, match=rf"^record must hold what was written to it; got .*{name}"):
        evidence.traces([COEVOLVED], 1) if name == evidence.TRACES else evidence.runs([COEVOLVED])


def rewrite(record, change=lambda name, line: line, entries=lambda entry: entry, origins=None):
    """Write the record again with some lines and entries changed, or with other origins."""
    (collection,) = evidence.COLLECTIONS
    kept = evidence._record(collection)
    lines = {
        name: [change(name, line) for line in lzma.decompress((record / name).read_bytes()).decode().splitlines()[1:]]
        for name in (evidence.RUNS, evidence.TRACES)
    }
    evidence._write(collection, [*map(entries, kept.experiments)], origins or kept.origins, lines)


def test_a_record_that_is_written_again_is_the_same(record):
    before = contents(record)
    rewrite(record)
    assert contents(record) == before


@pytest.mark.parametrize("name", [evidence.RUNS, evidence.TRACES])
@pytest.mark.parametrize("sources", ["same", "other"])
def test_a_changed_digit_is_noticed(record, name, sources):
    """The SHA-256 is that of the changed file: only making the run again shows the error."""

    def change(file, line):
        cells = line.split(",")
        if file == name and cells[0] == "0":
            cells[3] = "7e7"
        return ",".join(cells)

    origins = evidence._record(*evidence.COLLECTIONS).origins
    if sources == "other":
        origins = [o._replace(version="0.0.9", commit="c0ffee0123456789", sources="0123456789") for o in origins]
    rewrite(record, change, origins=origins)
    column = r", has distance" if name == evidence.RUNS else rf", window \d, has {next(iter(mechanism.MEASURES))}"
    with pytest.raises(
        ValueError,
        match=rf"^record must hold what its experiments make; got '.*{name}', where run \d of "
        rf"safe on maze1, seed 3 \({COEVOLVED.digest[:8]}\){column} '7e7' instead of '[0-9.]+'",
    ) as caught:
        evidence.verify(sample=100, traces=100)
    named = "; it was made from other sources (version 0.0.9, commit c0ffee01, sources 01234567)"
    assert str(caught.value).endswith(named) == (sources == "other")


def test_a_missing_window_is_noticed(record):
    rewrite(record, lambda name, line: "1" + line if name == evidence.TRACES and line.startswith("0,1,3,") else line)
    with pytest.raises(
        ValueError, match=r"run 1 of safe on maze1, seed 3 \(\w{8}\), window 3, has experiment '' instead of '0'"
    ):
        evidence.verify(sample=0, traces=100)


def test_a_record_by_other_rules_is_refused(record):
    summary = json.loads((record / evidence.SUMMARY).read_text())
    (record / evidence.SUMMARY).write_text(json.dumps(summary | {"rules": 0}))
    with pytest.raises(
        ValueError, match="must follow the rules 1 of this version; got 0: make evidence makes it again"
    ):
        evidence.verify()


@pytest.mark.parametrize(
    ("design", "number", "got", "missed"),
    [
        ([Recorded(replace(COEVOLVED, runs=5), 3), *DESIGN[1:]], 0, r"\w{16}", r"safe on maze1, seed 3 \(\w{8}\)"),
        ([Recorded(COEVOLVED, 2), *DESIGN[1:]], 0, r"\w{16}", r"safe on maze1, seed 3 \(\w{8}\)"),
        ([DESIGN[0], DESIGN[2], DESIGN[1]], 1, r"\w{16}", r"safe on maze1, seed 4 \(\w{8}\)"),
        (DESIGN[:2], 2, r"\w{16}", "no more"),
        ([*DESIGN, Recorded(replace(RANDOM, seed=9))], 3, "none", r"random on maze2, seed 9 \(\w{8}\)"),
    ],
)
def test_a_record_of_another_design_is_refused(record, monkeypatch, design, number, got, missed):
    collect(monkeypatch, design)
    with pytest.raises(
        ValueError, match=rf"got {got} as number {number}, which should be {missed}: make evidence makes it again"
    ):
        evidence.verify()


def test_a_record_of_other_measures_is_refused(record, monkeypatch):
    collect(monkeypatch, observer=exploration)
    with pytest.raises(ValueError, match="record must hold the measures of this version; got 'experiment,run,window,"):
        evidence.verify()


def test_a_sample_is_drawn(record, monkeypatch):
    made, evolve = [], evidence.evolve
    monkeypatch.setattr(evidence, "evolve", lambda *run: made.append(run[2].spawn_key) or evolve(*run))
    assert evidence.verify(seed=1) == (5, 1)
    assert evidence.verify(seed=1) == (5, 1)
    assert made[:5] == made[5:]
    assert evidence.verify(sample=2, traces=0) == (2, 0)
    with pytest.raises(ValueError, match="sample must be an integer of at least 0; got -1"):
        evidence.verify(sample=-1)


def test_the_command_line(monkeypatch, capsys):
    made = []
    monkeypatch.setattr(evidence, "make", lambda **options: made.append(options))
    monkeypatch.setattr("sys.argv", ["evidence", "contest", "--store", "mine.sqlite", "--cores", "3"])
    evidence.main()
    monkeypatch.setattr("sys.argv", ["evidence"])
    evidence.main()
    assert made == [
        {"store": "mine.sqlite", "executor": None, "cores": 3, "collections": ["contest"]},
        {"store": "evidence.sqlite", "executor": None, "cores": None, "collections": []},
    ]
    monkeypatch.setattr("sys.argv", ["evidence", "--cores", "-1"])
    with pytest.raises(SystemExit, match="2"):
        evidence.main()
    assert "cores must be an integer of at least 0; got -1" in capsys.readouterr().err


# The record in the package


def test_a_sample_of_the_record_is_reproduced():
    assert evidence.verify()[0] > 0


def test_the_records_are_small():
    files = [file for file in evidence.FOLDER.rglob("*") if file.is_file()]
    assert len(files) == 3 * len(evidence.COLLECTIONS) + 1  # and the runs of peers
    assert sum(file.stat().st_size for file in files) < 1_500_000
