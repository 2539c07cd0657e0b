import re

import pandas as pd
import pytest

import safe
from safe.companion.paper import reported
from safe.experiments.experiment import WEIGHT_COLUMNS as WEIGHTS
from safe.results import tables
from tests.helpers.results import experiment, mazes_of_one_name, runs, seeds, values_of_k


def some_results():
    mine = safe.Maze.from_drawing("S.G", name="my maze")
    return {
        experiment("maze1", "safe"): runs(2, 4, [10, 20]),
        experiment("maze1", "standard"): runs(0, 4),
        experiment("maze1", "random"): runs(1, 4),
        experiment(mine, "safe"): runs(4, 4, [1, 1, 1, 5]),
    }


def test_a_table_beside_the_papers():
    table = tables.success_table(some_results(), reported)
    ours = table.loc["maze1", "safe"]
    assert (ours.successes, ours.runs, ours.paper_successes, ours.paper_runs) == (2, 4, 328, 500)
    assert ours.difference == pytest.approx(0.5 - 328 / 500)
    assert ours.p_value == pytest.approx(0.6117, abs=1e-3)
    assert table.loc[("my maze", "safe"), ["paper_successes", "difference", "p_value"]].isna().all()

    words = tables.readable_success_table(table)
    assert words.index.names == ["maze", "algorithm"]
    assert words.loc["maze1", "safe"].tolist()[:3] == ["2 of 4", "0.6 to 3.4", "328 of 500"]
    assert re.fullmatch(r"-15.6 \(-50.* to \+19.*\)", words.loc["maze1", "safe"].iloc[3])
    assert words.loc["maze1", "safe"].iloc[4] == "0.61"
    assert words.loc["my maze", "safe"].tolist() == ["4 of 4", "2.04 to 4", "–", "–", "–"]


def test_two_algorithms_compared():
    table = tables.difference_table(
        {experiment("maze1", "safe"): runs(328, 500), experiment("maze1", "novelty"): runs(322, 500)}, "safe", "novelty"
    )
    assert table.loc["maze1"].tolist() == ["328 of 500", "322 of 500", "+1.2 (-4.7 to +7.1)", "0.74", "0.003"]


def test_generations_to_success_beside_the_papers():
    table = tables.generations_table(some_results(), reported)
    assert table.index.tolist() == [("maze1", "safe"), ("maze1", "standard"), ("my maze", "safe")]
    ours = table.loc["maze1", "safe"]
    assert (ours["mean"], ours.sd, ours.n) == (15, 5, 2)
    assert (ours.paper_mean, ours.paper_sd, ours.paper_n, ours.difference) == (141, 130, 328, -126)

    words = tables.readable_means_table(table, digits=0)
    assert words.loc["maze1", "safe"].tolist()[:3] == [2, "15 (5)", "141 (130)"]
    assert words.loc["maze1", "safe"].iloc[3].startswith("-126 (-")
    assert words.loc["maze1", "standard"].tolist() == [0, "–", "–", "–", "–"]
    assert words.loc["my maze", "safe"].tolist() == [4, "2 (2)", "–", "–", "–"]


def test_what_was_evolved_beside_the_papers():
    evolved = {"a": [0.8, 0.6, 0.0], "b": [1.0, 1.0, 0.0]} | {f"p{i}": [i / 100, i / 50, 9.0] for i in range(1, 17)}
    mine = safe.Maze.from_drawing("S.G", name="my maze")
    table = tables.evolved_table(
        {
            experiment("maze2", "safe"): runs(2, 3, **evolved),
            experiment(mine, "safe"): runs(2, 3, **evolved),
            experiment("maze1", "fixed"): runs(2, 3, **evolved),
        },
        ["a", "b", *WEIGHTS],
        reported,
    )
    a = table.loc["maze2", "a", "1 / distance"]
    assert (a["mean"], a.sd, a.n) == pytest.approx((0.7, 0.1, 2))
    assert (a.paper_mean, a.paper_sd, a.paper_n) == (0.83, 0.18, 17)
    assert a.difference == pytest.approx(-0.13)
    p12 = table.loc["maze2", "p12", "goal_left in v"]
    assert (p12["mean"], p12.paper_mean, p12.paper_sd) == pytest.approx((0.18, 0.54, 0.29))
    for maze in ("maze1", "my maze"):
        assert table.loc[maze, ["paper_mean", "difference", "low", "p_value"]].isna().all(axis=None)

    words = tables.readable_means_table(table)
    assert words.index.names == ["maze", "item", "weighs"]
    assert len(words) == 3 * 18
    ours = words.loc["maze2", "a", "1 / distance"]
    assert ours.tolist()[:3] == [2, "0.70 (0.10)", "0.83 (0.18)"]
    assert re.fullmatch(r"-0.130 \(-\S+ to \+\S+\)", ours.iloc[3])
    assert words.loc["my maze", "a", "1 / distance"].tolist() == [2, "0.70 (0.10)", "–", "–", "–"]


def test_nothing_evolved():
    table = tables.evolved_table({experiment("maze1", "safe"): runs(0, 2, a=1, b=1)}, ["a", "b"], reported)
    words = tables.readable_means_table(table)
    assert words.iloc[0].tolist() == [0, "–", "0.85 (0.16)", "–", "–"]


def test_first_solutions_are_successes_in_order_and_then_the_nearest():
    table = pd.DataFrame({"run": range(5), "success": [False, True, False, True, False], "distance": [9, 2, 4, 0, 4]})
    assert tables.first_solutions(table, 4).run.tolist() == [1, 3, 2, 4]
    assert tables.first_solutions(table, 9).run.tolist() == [1, 3, 2, 4, 0]
    assert list(tables.first_solutions(table, 1)) == list(table)
    with pytest.raises(ValueError, match="n must be an integer of at least 1; got 0"):
        tables.first_solutions(table, 0)


def test_without_a_paper_its_columns_are_empty():
    evolved = {experiment("maze1", "safe"): runs(2, 4, [10, 20], a=0.5)}
    for table in (
        tables.success_table(evolved),
        tables.generations_table(evolved),
        tables.evolved_table(evolved, ["a"]),
    ):
        assert table.filter(like="paper").isna().all(axis=None)
        assert table[["difference", "p_value"]].isna().all(axis=None)


@pytest.mark.parametrize("make", [mazes_of_one_name, values_of_k, seeds])
def test_each_experiment_has_its_row(make):
    """Regression: rows were kept by names, and an experiment replaced another of the same names."""
    experiments, maze, algorithm = make()
    results = {e: runs(n, 9, range(n), a=n / 10) for n, e in enumerate(experiments, start=1)}
    numbers = list(range(1, len(experiments) + 1))

    success = tables.success_table(results)
    assert success.successes.tolist() == numbers
    generations = tables.generations_table(results)
    assert generations.n.tolist() == numbers
    for table in (success, generations, tables.readable_success_table(success)):
        assert table.index.is_unique
        assert all(re.fullmatch(maze, m) and re.fullmatch(algorithm, a) for m, a in table.index)
    evolved = tables.evolved_table(results, ["a"])
    assert evolved.index.is_unique
    assert evolved["mean"].tolist() == pytest.approx([n / 10 for n in numbers])

    others = {experiment(e.maze, "novelty"): runs(9, 9, range(9)) for e in experiments}
    both = results | others
    difference = tables.difference_table(both, "safe", "novelty")
    assert difference.index.is_unique
    assert difference.safe.tolist() == [f"{n} of 9" for n in numbers]
    times = tables.times_table(both, [("safe", "novelty")])
    assert times.index.is_unique
    assert [(first, second.algorithm.name) for first, second in tables.pairs(both, [("safe", "novelty")])] == [
        (e, "novelty") for e in experiments
    ]


def test_times_compared():
    results = {experiment("maze1", "safe"): runs(2, 2, [1, 2]), experiment("maze1", "novelty"): runs(2, 4, [5, 6])}
    table = tables.times_table(results, [("safe", "novelty"), ("novelty", "safe"), ("safe", "random")])
    assert table.index.tolist() == [("maze1", "safe", "novelty"), ("maze1", "novelty", "safe")]
    assert table.A12.tolist() == ["1.00", "0.00"]
    assert table.p.tolist() == ["0.018", "0.018"]
    assert table["p (Holm)"].tolist() == ["0.035", "0.035"]
    same = {experiment("maze1", name): runs(0, 2) for name in ("safe", "novelty")}
    assert tables.times_table(same, [("safe", "novelty")]).iloc[0].tolist() == ["–"] * 3
