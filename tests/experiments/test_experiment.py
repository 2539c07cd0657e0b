import json
import tracemalloc
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import pytest

import safe
from safe import Algorithm, Experiment, Maze, Parameters, run
from safe.experiments import experiment as module
from safe.experiments.provenance import origin
from safe.experiments.store import Store
from tests.experiments import EXPERIMENT


def test_one_row_a_run(uninterrupted):
    assert list(uninterrupted) == [
        *("run", "success", "generation", "distance"),
        *(f"p{i}" for i in range(1, 17)),
        *("a", "b", "evaluations"),
    ]
    assert uninterrupted.run.tolist() == list(range(12))
    assert uninterrupted.success.dtype == bool
    for row in uninterrupted.itertuples():
        replayed = safe.evolve("maze1", "safe", EXPERIMENT.seed_sequence(row.run), EXPERIMENT.parameters)
        assert (row.success, row.generation, row.distance) == (
            replayed.success,
            replayed.generation,
            replayed.distance,
        )
        assert row[5:21] == replayed.controller
        assert (row.a, row.b) == replayed.coefficients
        assert row.evaluations == replayed.evaluations


def test_random_search_has_no_coefficients():
    table = run(replace(EXPERIMENT, algorithm="random", runs=2), progress=False)
    assert [*table][-3:] == ["p16", "evaluations", "seconds"]
    assert len(table) == 2


def test_a_table_takes_at_most_twice_its_memory(uninterrupted, tmp_path):
    experiment = replace(EXPERIMENT, runs=10_000)
    outcome = safe.evolve("maze1", "safe", 1, EXPERIMENT.parameters)
    with Store.for_writing(tmp_path / "s.sqlite") as store:
        entry = store.entry(experiment.content, "safe", "maze1")
        store.add(entry, origin(), [(number, outcome, number / 7) for number in range(experiment.runs)])
    tracemalloc.start()
    try:
        table = run(experiment, tmp_path / "s.sqlite", progress=False)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert table.drop(columns="seconds").dtypes.equals(uninterrupted.dtypes)
    assert table.seconds.tolist() == [number / 7 for number in range(experiment.runs)]
    assert peak < 2 * table.memory_usage().sum()


@pytest.mark.parametrize("executor", [7, "threads", ThreadPoolExecutor])
def test_bad_executors(executor):
    with pytest.raises(ValueError, match=r"executor must be a concurrent\.futures\.Executor; got"):
        run(EXPERIMENT, executor=executor)


def test_what_identifies_an_experiment():
    same = [
        replace(EXPERIMENT, runs=500),
        replace(EXPERIMENT, algorithm=Algorithm("by another name", rating="genotypic novelty")),
        replace(EXPERIMENT, maze=Maze.from_drawing(safe.load_maze("maze1").drawing(), name="copy")),
    ]
    others = [
        replace(EXPERIMENT, seed=4),
        replace(EXPERIMENT, algorithm="novelty"),
        replace(EXPERIMENT, maze="maze2"),
        replace(EXPERIMENT, parameters=Parameters(generations=4, k=14)),
        replace(EXPERIMENT, parameters=Parameters(generations=4, admission="random")),
        *(
            replace(EXPERIMENT, algorithm=replace(EXPERIMENT.algorithm, **choice))
            for choice in ({"rating": "pearson"}, {"scaling": "rank"}, {"judging": "drawn judge"})
        ),
    ]
    assert {experiment.digest for experiment in same} == {EXPERIMENT.digest}
    assert len({experiment.digest for experiment in [EXPERIMENT, *others]}) == 9
    assert EXPERIMENT.content["parameters"] == {"generations": 4}
    assert EXPERIMENT.content["algorithm"] == {"objectives": None, "rating": "genotypic novelty"}


def test_rules_that_have_changed_make_another_experiment(monkeypatch):
    before = replace(EXPERIMENT).digest
    monkeypatch.setattr(module, "RULES", module.RULES + 1)
    assert replace(EXPERIMENT).digest != before


def test_the_digest_that_random_streams_are_spawned_from():
    """If this changes, so does every table: raise RULES, and say so in the changelog."""
    assert Experiment("safe", "maze1").digest[:16] == "33ae0854440296ca"


@pytest.mark.parametrize(
    "experiment",
    [
        *(Experiment(algorithm, "maze2", runs=7, seed=2**100) for algorithm in safe.ALGORITHMS),
        EXPERIMENT,
        Experiment(Algorithm("frozen", objectives=None), Maze.from_drawing("S.G", "tiny")),
        Experiment(Algorithm("two", [(0.1, 1 / 3), (0, 1)], "genotypic novelty"), "maze1"),
        Experiment("safe", "maze1", parameters=Parameters(mutation=0.1, k=3, elites=0)),
        Experiment("novelty", "maze1", parameters=Parameters(admission="threshold", threshold=3.0, admitted=7)),
        Experiment(Algorithm("judged", rating="spearman", scaling="maximum", judging="drawn judge"), "maze2"),
    ],
    ids=lambda experiment: experiment.algorithm.name,
)
def test_an_experiment_follows_from_its_content(experiment):
    content = json.loads(json.dumps(experiment.content))
    same = Experiment.from_content(content, experiment.algorithm.name, experiment.maze.name, experiment.runs)
    assert same == experiment
    assert same.digest == experiment.digest
    assert (same.algorithm.name, same.maze.name) == (experiment.algorithm.name, experiment.maze.name)


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        ({"rules": 99}, "content must be one that this version writes"),
        ({"weather": "fine"}, "content must be one"),
        ({"algorithm": {"rating": "none", "objectives": [], "pool": "generation"}}, "content must be one"),
        ({"algorithm": {"rating": "by taste", "objectives": None}}, "rating must be one of"),
        ({"algorithm": {"rating": "none", "objectives": None, "scaling": "raw"}}, "content must be one"),  # the paper's
        ({"algorithm": None}, "content must be one"),
        ({"parameters": {"weather": "fine"}}, "content must be one"),
        ({"parameters": {"k": 15}}, "content must be one"),  # the paper's, which no content lists
        ({"parameters": {"k": -1}}, "k must be an integer"),
        ({"maze": "S?G"}, "must"),
    ],
)
def test_contents_that_this_version_cannot_make(change, complaint):
    with pytest.raises(ValueError, match=f"{complaint}.*; got ") as caught:
        Experiment.from_content(EXPERIMENT.content | change, "safe", "maze1")
    assert "\n" not in str(caught.value)
    with pytest.raises(ValueError, match="content must be one"):
        Experiment.from_content({}, "safe", "maze1")


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ({"algorithm": "x"}, "algorithm must be one of"),
        ({"maze": "x"}, "maze must be one of"),
        ({"runs": 0}, "runs must be an integer from 1 to 1000000; got 0"),
        ({"runs": 10**12}, "runs must be an integer from 1 to 1000000; got 1000000000000"),
        ({"runs": "500"}, "runs must be an integer from 1 to 1000000; got '500'"),
        ({"seed": -1}, "seed must be an integer from 0 to 340282366920938463463374607431768211455; got -1"),
        ({"seed": 10**5000}, "seed must be an integer from 0"),  # which JSON could not write down
        ({"seed": None}, "seed must be an integer from 0 to 340282366920938463463374607431768211455; got None"),
        ({"parameters": {}}, "parameters must be a Parameters; got {}"),
    ],
)
def test_bad_experiments(arguments, complaint):
    with pytest.raises(ValueError, match=complaint):
        Experiment(**{"algorithm": "safe", "maze": "maze1", **arguments})
