import numpy as np
import pandas as pd
import pytest

import safe
from safe.algorithms import COEFFICIENTS
from safe.companion import claims, ledger, paper, verdicts
from safe.experiments.experiment import WEIGHT_COLUMNS
from tests.helpers import record


@pytest.fixture(scope="module")
def recorded_runs():
    return record.recorded_runs()


@pytest.fixture
def results(recorded_runs):
    return {experiment: recorded_runs[record.key(experiment)].copy() for experiment in record.experiments()}


@pytest.fixture
def repeats(recorded_runs, results):
    return {
        repetition: recorded_runs[record.key(repetition)]
        for experiment in ledger.deviating_experiments(results)
        for repetition in record.repetitions(experiment)
    }


@pytest.mark.parametrize("experiment", record.experiments(), ids=record.key)
def test_the_recorded_runs_are_those_that_the_package_makes(recorded_runs, experiment):
    recorded = recorded_runs[record.key(experiment)]
    assert len(recorded) == 500
    solved = np.flatnonzero(recorded.success)[:2]
    for number in {0, *solved.tolist()}:
        made = safe.evolve(experiment.maze, experiment.algorithm, experiment.seed_sequence(number))
        row = recorded.loc[number]
        assert (made.success, made.generation, made.distance) == (row.success, row.generation, row.distance)
        if row[WEIGHT_COLUMNS].notna().all():
            assert made.controller == tuple(row[WEIGHT_COLUMNS])
            assert made.coefficients == tuple(row[[*COEFFICIENTS]])


def test_no_verdict_has_changed(results, repeats):
    table = ledger.ledger(results, repeats)
    assert ledger.changed(table) == []
    record = ledger.recorded()
    assert table.index.tolist() == record.index.tolist()
    assert table.evidence.tolist() == record.evidence.tolist()
    assert set(table.verdict) <= set(verdicts.VERDICTS)
    for column in ("difference", "low", "high", "p_value", "p_adjusted", "effect", "p_equivalence"):
        assert table[column].to_numpy(float) == pytest.approx(record[column].to_numpy(float), rel=1e-3, nan_ok=True)


@pytest.mark.parametrize(
    ("maze", "algorithm", "claim", "verdict"),
    [
        ("maze1", "novelty", "maze1 novelty successes", "not reproduced"),
        ("maze1", "safe", "maze1 safe > maze1 standard", "not reproduced"),
        ("maze1", "safe", "maze1 safe generations", "no difference detectable at this size"),
    ],
)
def test_a_verdict_that_changes_is_noticed(results, maze, algorithm, claim, verdict):
    (experiment,) = [e for e in results if (e.maze.name, e.algorithm.name) == (maze, algorithm)]
    results[experiment]["success"] = False
    lines = ledger.changed(ledger.ledger(results))
    assert f"{claim}: was 'reproduced', is '{verdict}'" in lines


def of(results, maze, algorithm):
    (runs,) = [runs for e, runs in results.items() if (e.maze.name, e.algorithm.name) == (maze, algorithm)]
    return runs


def test_a_single_run_contradicts_that_all_get_stuck(results):
    before = ledger.ledger(results).verdict
    assert before["maze1 always stuck"] == verdicts.REPRODUCED
    assert before["maze2 always stuck"] == verdicts.NOT_REPRODUCED
    of(results, "maze1", "standard").loc[7, "success"] = True
    of(results, "maze2", "standard")["success"] = False
    after = ledger.ledger(results).verdict
    assert after["maze1 always stuck"] == verdicts.NOT_REPRODUCED
    assert after["maze2 always stuck"] == verdicts.REPRODUCED


def test_a_few_runs_cannot_show_that_all_get_stuck(results):
    few = {experiment: runs.head(200) for experiment, runs in results.items()}
    assert ledger.ledger(few).verdict["maze1 always stuck"] == verdicts.UNDECIDED


@pytest.mark.parametrize(
    ("sooner", "verdict"), [(-100, verdicts.REPRODUCED), (0, verdicts.NOT_REPRODUCED), (100, verdicts.NOT_REPRODUCED)]
)
def test_safe_needs_fewer_generations_if_it_succeeds_sooner(results, sooner, verdict):
    of(results, "maze1", "safe")["generation"] += sooner
    assert ledger.ledger(results).verdict["maze1 safe < maze1 novelty, generations"] == verdict


@pytest.mark.parametrize(
    ("maze", "sums", "larger", "smaller"),
    [
        ("maze1", "h", "right down up", "left"),
        ("maze1", "h", "right", "left down up"),
        ("maze1", "v", "right", "left down up"),
        ("maze2", "hv", "left", "right down up"),
        ("maze2", "hv", "down", "right up"),
        ("maze2", "hv", "left", "down"),
    ],
)
@pytest.mark.parametrize("sign", [1, -1])
def test_what_is_read_from_weights_concerns_their_sizes(results, maze, sums, larger, smaller, sign):
    first = {"right": 1, "left": 3, "down": 5, "up": 7}  # in the order of Table 3: dist and goal, h and then v

    def weights(directions):
        numbers = [first[direction] + 8 * (total == "v") for total in sums for direction in directions.split()]
        return [f"p{number + more}" for number in numbers for more in (0, 1)]

    runs = of(results, maze, "safe")
    name = f"{maze} {sums}: {larger} > {smaller}"
    for high, low, verdict in ((larger, smaller, verdicts.REPRODUCED), (smaller, larger, verdicts.NOT_REPRODUCED)):
        runs[WEIGHT_COLUMNS] = 0.5
        runs[weights(high)], runs[weights(low)] = sign * 0.6, sign * 0.4
        assert ledger.ledger(results).verdict[name] == verdict


def test_other_evidence_may_lead_to_another_verdict(results):
    few = {experiment: runs.head(20) for experiment, runs in results.items()}
    table = ledger.ledger(few)
    assert table.loc["maze1 novelty successes", "verdict"] == verdicts.UNDECIDED
    assert ledger.changed(table) == []


def test_every_number_of_the_paper_is_a_claim(results):
    table = ledger.ledger(results)
    numbers = paper.published().query("table != '1'")
    assert len(table[table.family.isin([claims.SUCCESSES, claims.GENERATIONS, claims.EVOLVED])]) == len(numbers)


def test_deviating_numbers_get_a_second_look(results, repeats):
    assert [record.key(experiment) for experiment in ledger.deviating_experiments(results)] == [
        "maze1 fixed 0",
        "maze2 novelty 0",
    ]
    table = ledger.ledger(results, repeats)
    second = table[table.family == ledger.SECOND_LOOK]
    assert second.index.tolist() == ["maze1 fixed successes, second look", "maze2 novelty generations, second look"]
    successes, generations = (row for _, row in second.iterrows())
    assert successes.here.endswith(" of 2000")
    assert successes.evidence == "fixed on maze1: 2000 runs, seed 1, 2, 3, 4"
    assert successes.p_adjusted == pytest.approx(10 * successes.p_value)
    assert generations.p_adjusted == pytest.approx(min(1, 4 * generations.p_value))
    assert ledger.summary(table).loc["all"].sum() == len(table) - 2


def test_a_few_runs_of_one_maze_are_a_ledger_too():
    few = {
        safe.Experiment(algorithm, "maze2", 2): pd.DataFrame(
            {
                "success": False,
                "generation": 499,
                "distance": 9,
                **dict.fromkeys([*COEFFICIENTS, *WEIGHT_COLUMNS], 0.0),
            },
            index=range(2),
        )
        for algorithm in ("standard", "novelty", "safe", "random")
    }
    table = ledger.ledger(few)
    assert not table.index.str.contains("maze1|fixed").any()
    words = ledger.readable_ledger(table)
    assert words[table.index == "maze2 safe generations"].here.item() == "no success"
    assert (
        words.loc[
            "p1 on maze2, the weight of dist_right in h", ["difference (95 % interval)", "p (Holm)", "p (equivalence)"]
        ].tolist()
        == ["–"] * 3
    )
    assert ledger.summary(table).loc["all"].sum() == len(table)


def test_other_mazes_and_parameters_bear_on_no_claim():
    mine = safe.Maze.from_drawing("S.G", name="maze1")
    ended = pd.DataFrame({"success": [True], "generation": [0], "distance": [0]})
    others = {
        safe.Experiment("safe", mine): ended,
        safe.Experiment("safe", "maze2", parameters=safe.Parameters(k=3)): ended,
    }
    assert set(ledger.ledger(others).verdict) == {verdicts.UNTESTABLE}


def test_behind_a_claim_are_the_experiments_that_its_evidence_names(results, repeats):
    table = ledger.ledger(results, repeats)
    behind = dict(zip(table.index, ledger.experiments_behind(table, results, repeats), strict=True))

    def names(claim):
        assert all(runs is (results | repeats)[experiment] for experiment, runs in behind[claim].items())
        return [(e.maze.name, e.algorithm.name, e.seed) for e in behind[claim]]

    assert names("maze1 safe successes") == names("maze1 p3") == [("maze1", "safe", 0)]
    assert names("maze1 novelty > maze1 random") == [("maze1", "novelty", 0), ("maze1", "random", 0)]
    assert names("maze1 safe < maze1 novelty, generations") == [("maze1", "safe", 0), ("maze1", "novelty", 0)]
    assert names("maze2 hv: left > down") == [("maze2", "safe", 0)]
    assert names("maze2 deceived") == [("maze2", "standard", 0)]
    second = names("maze1 fixed successes, second look")
    assert second == [("maze1", "fixed", seed) for seed in (1, 2, 3, 4)]
    untestable = table.family == verdicts.UNTESTABLE
    assert all(bool(behind[claim]) != untestable[claim] for claim in table.index)


def test_no_claim_rests_on_an_experiment_that_only_shares_a_name_with_the_papers(results):
    own = safe.Experiment("safe", safe.Maze.from_drawing("S.G", "maze1"))
    of_paper = next(e for e in results if (e.maze.name, e.algorithm.name) == ("maze1", "safe"))
    table = ledger.ledger(results)
    behind = ledger.experiments_behind(table, results | {own: results[of_paper]})
    assert all(own not in experiments for experiments in behind)


def test_the_record_is_reproduced(results, repeats, tmp_path):
    file = tmp_path / "ledger.csv"
    ledger.ledger(results, repeats).to_csv(file, float_format="%.4g", lineterminator="\n")
    assert file.read_bytes() == ledger.RECORD.read_bytes()


def test_two_seeds_of_one_experiment_are_not_one_claim(results):
    """Regression: the second seed replaced the evidence of the first."""
    first = next(iter(results))
    again = record.repetitions(first)[0]
    message = "results must have one experiment for each algorithm and maze; got 2 of standard on maze1"
    for function in (ledger.ledger, lambda both: ledger.experiments_behind(ledger.ledger(results), both)):
        with pytest.raises(ValueError, match=message):
            function(results | {again: results[first]})


def test_a_second_look_is_at_the_papers_experiments_alone(results, repeats):
    others = {
        safe.Experiment(e.algorithm, e.maze, e.runs, e.seed, safe.Parameters(k=3)): runs for e, runs in repeats.items()
    }
    alone, mixed = ledger.ledger(results, repeats), ledger.ledger(results, repeats | others)
    pd.testing.assert_frame_equal(alone, mixed)
