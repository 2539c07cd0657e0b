import re

import numpy as np
import pandas as pd
import pytest

import safe
from safe.experiments.experiment import WEIGHT_COLUMNS as WEIGHTS
from safe.results import tables


def runs(successes, n, generations=(), **columns):
    success = np.arange(n) < successes
    generation = np.full(n, 499)
    generation[: len(generations)] = generations
    return pd.DataFrame({"run": np.arange(n), "success": success, "generation": generation, **columns})


def test_the_papers_numbers_come_along():
    paper = tables.published()
    assert paper.table.value_counts().to_dict() == {"3": 32, "2": 12, "1": 11, "text": 6}
    assert set(paper.maze.dropna()) == {"maze1", "maze2"}
    assert paper[paper.quantity.str.startswith("weight of")].groupby("maze").size().tolist() == [16, 16]


def test_parameters_beside_the_papers():
    table = tables.parameter_table(safe.Parameters(k=7, crossover=0.25))
    assert table.index.tolist() == list(vars(safe.Parameters()))
    assert table.loc["k"].tolist() == ["nearest neighbours that count for novelty", "7", "15"]
    assert table.loc["crossover", ["value", "in the paper"]].tolist() == ["0.25", "0.8"]


def test_the_default_parameters_are_the_papers():
    table = tables.parameter_table()
    assert (table["value"] == table["in the paper"]).all()


def experiment(maze, algorithm, **options):
    return safe.Experiment(algorithm, maze, **options)


def some_results():
    mine = safe.Maze.from_drawing("S.G", name="my maze")
    return {
        experiment("maze1", "safe"): runs(2, 4, [10, 20]),
        experiment("maze1", "standard"): runs(0, 4),
        experiment("maze1", "random"): runs(1, 4),
        experiment(mine, "safe"): runs(4, 4, [1, 1, 1, 5]),
    }


def test_a_table_beside_the_papers():
    table = tables.success_table(some_results())
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


def test_two_algorithms_set_against_each_other():
    table = tables.difference_table(
        {experiment("maze1", "safe"): runs(328, 500), experiment("maze1", "novelty"): runs(322, 500)}, "safe", "novelty"
    )
    assert table.loc["maze1"].tolist() == ["328 of 500", "322 of 500", "+1.2 (-4.7 to +7.1)", "0.74", "0.003"]


def test_generations_to_success_beside_the_papers():
    table = tables.generations_table(some_results())
    assert table.index.tolist() == [("maze1", "safe"), ("maze1", "standard"), ("my maze", "safe")]
    ours = table.loc["maze1", "safe"]
    assert (ours["mean"], ours.sd, ours.n) == (15, 5, 2)
    assert (ours.paper_mean, ours.paper_sd, ours.paper_n, ours.difference) == (141, 130, 328, -126)

    words = tables.readable_means_table(table, digits=0)
    assert words.loc["maze1", "safe"].tolist()[:3] == [2, "15 (5)", "141 (130)"]
    assert words.loc["maze1", "safe"].iloc[3].startswith("-126 (-")
    assert words.loc["maze1", "standard"].tolist() == [0, "–", "–", "–", "–"]
    assert words.loc["my maze", "safe"].tolist() == [4, "2 (2)", "–", "–", "–"]


@pytest.mark.parametrize(
    "change",
    [
        {"maze": safe.Maze.from_drawing("S.G", name="maze1")},
        {"algorithm": safe.Algorithm("safe", objectives=[(1, 0)])},
        {"parameters": safe.Parameters(k=14)},
    ],
)
def test_what_is_only_called_like_the_papers_is_not_compared_with_it(change):
    table = tables.success_table({safe.Experiment(**{"algorithm": "safe", "maze": "maze1", **change}): runs(2, 4)})
    assert table.index.tolist() == [("maze1", "safe")]
    assert np.isnan(table.paper_successes.iloc[0])


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


def test_the_papers_weights_are_named_as_ours():
    paper = tables.published()
    named = dict(zip(paper["item"], paper.quantity, strict=True))
    table = tables.evolved_table({experiment("maze1", "safe"): runs(1, 1, **dict.fromkeys(WEIGHTS, 0))}, WEIGHTS)
    for _, item, weighs in table.index:
        assert named[item] == f"weight of {weighs}"


def test_nothing_evolved():
    table = tables.evolved_table({experiment("maze1", "safe"): runs(0, 2, a=1, b=1)}, ["a", "b"])
    words = tables.readable_means_table(table)
    assert words.iloc[0].tolist() == [0, "–", "0.85 (0.16)", "–", "–"]


def test_first_solutions_are_successes_in_order_and_then_the_nearest():
    table = pd.DataFrame({"run": range(5), "success": [False, True, False, True, False], "distance": [9, 2, 4, 0, 4]})
    assert tables.first_solutions(table, 4).run.tolist() == [1, 3, 2, 4]
    assert tables.first_solutions(table, 9).run.tolist() == [1, 3, 2, 4, 0]
    assert list(tables.first_solutions(table, 1)) == list(table)
    with pytest.raises(ValueError, match="n must be an integer of at least 1; got 0"):
        tables.first_solutions(table, 0)
