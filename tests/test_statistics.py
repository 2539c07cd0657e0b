import numpy as np
import pandas as pd
import pytest

import safe
from safe import statistics
from safe.experiment import WEIGHT_COLUMNS as WEIGHTS


def runs(successes, n, generations=(), **columns):
    success = np.arange(n) < successes
    generation = np.full(n, 499)
    generation[: len(generations)] = generations
    return pd.DataFrame({"run": np.arange(n), "success": success, "generation": generation, **columns})


def test_the_papers_numbers_come_along():
    paper = statistics.published()
    assert len(paper) == 50
    assert set(paper.maze) == {"maze1", "maze2"}
    assert paper[paper.quantity.str.startswith("weight of")].groupby("maze").size().tolist() == [16, 16]


@pytest.mark.parametrize(
    ("successes", "n", "low", "high"),
    # Newcombe, Statistics in Medicine 17 (1998) 857-872, Table I, method 3
    [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718)],
)
def test_wilsons_interval(successes, n, low, high):
    assert statistics.success_interval(successes, n) == pytest.approx((low, high), abs=5e-5)


def experiment(maze, algorithm, **options):
    return safe.Experiment(algorithm, maze, **options)


def test_a_table_beside_the_papers():
    mine = safe.Maze.from_drawing("S.G", name="my maze")
    table = statistics.success_table(
        {
            experiment("maze1", "safe"): runs(2, 4, [10, 20]),
            experiment("maze1", "standard"): runs(0, 4),
            experiment("maze1", "random"): runs(1, 4),
            experiment(mine, "safe"): runs(4, 4, [1, 1, 1, 5]),
        }
    )
    ours = table.loc["maze1", "safe"]
    assert (ours.successes, ours.runs, ours["mean"], ours.sd) == (2, 4, 15, 5)
    assert (ours.paper_successes, ours.paper_runs, ours.paper_mean, ours.paper_sd) == (328, 500, 141, 130)
    assert ours.p_value == pytest.approx(0.6117, abs=1e-3)
    assert np.isnan(table.loc[("maze1", "standard"), "mean"])
    assert np.isnan(table.loc[("maze1", "random"), "mean"])
    assert np.isnan(table.loc[("my maze", "safe"), ["paper_successes", "p_value"]].to_numpy(float)).all()

    words = statistics.readable_success_table(table)
    assert words.index.names == ["maze", "algorithm"]
    assert words.loc["maze1", "safe"].tolist() == [
        "2 of 4",
        "0.6 to 3.4",
        "328 of 500",
        "yes",
        "0.61",
        "15 (5)",
        "141 (130)",
    ]
    assert words.loc["my maze", "safe"].tolist() == ["4 of 4", "2.04 to 4", "–", "–", "–", "2 (2)", "–"]


@pytest.mark.parametrize(
    "change",
    [
        {"maze": safe.Maze.from_drawing("S.G", name="maze1")},
        {"algorithm": safe.Algorithm("safe", objectives=[(1, 0)])},
        {"parameters": safe.Parameters(k=14)},
    ],
)
def test_what_is_only_called_like_the_papers_is_not_compared_with_it(change):
    table = statistics.success_table({safe.Experiment(**{"algorithm": "safe", "maze": "maze1", **change}): runs(2, 4)})
    assert table.index.tolist() == [("maze1", "safe")]
    assert np.isnan(table.paper_successes.iloc[0])


def test_whether_the_paper_lies_within():
    inside = {"maze1": 328, "maze2": 17}
    outside = {"maze1": 250, "maze2": 100}
    for expected, counts in (("yes", inside), ("no", outside)):
        results = {experiment(maze, "safe"): runs(count, 500) for maze, count in counts.items()}
        words = statistics.readable_success_table(statistics.success_table(results))
        assert set(words["paper within"]) == {expected}


def test_what_was_evolved_beside_the_papers():
    evolved = {"a": [0.8, 0.6, 0.0], "b": [1.0, 1.0, 0.0]} | {f"p{i}": [i / 100, i / 50, 9.0] for i in range(1, 17)}
    mine = safe.Maze.from_drawing("S.G", name="my maze")
    table = statistics.evolved_table(
        {
            experiment("maze2", "safe"): runs(2, 3, **evolved),
            experiment(mine, "safe"): runs(2, 3, **evolved),
            experiment("maze1", "fixed"): runs(2, 3, **evolved),
        }
    )
    a = table.loc["maze2", "a"]
    assert (a["mean"], a.sd, a.n) == pytest.approx((0.7, 0.1, 2))
    assert (a.paper_mean, a.paper_sd, a.paper_n) == (0.83, 0.18, 17)
    assert a.difference == pytest.approx(-0.13)
    assert a.allowed == pytest.approx(1.95996 * np.sqrt(0.1**2 / 2 + 0.18**2 / 17), rel=1e-5)
    p12 = table.loc["maze2", "p12"]
    assert (p12["mean"], p12.paper_mean, p12.paper_sd) == pytest.approx((0.18, 0.54, 0.29))
    assert table.loc["maze1", ["paper_mean", "difference", "allowed"]].isna().all(axis=None)
    assert table.loc["my maze", ["paper_mean", "difference", "allowed"]].isna().all(axis=None)

    words = statistics.readable_evolved_table(table)
    assert len(words) == 18
    assert words.index[0] == ("a", "1 / distance")
    assert words.index[13] == ("p12", "goal_left in v")
    assert words["maze2"].iloc[0].tolist() == ["0.70 (0.10)", "0.83 (0.18)", "-0.13 (±0.16)"]
    assert words["my maze"].iloc[0].tolist() == ["0.70 (0.10)", "–", "–"]


def test_the_papers_weights_are_named_as_ours():
    paper = statistics.published()
    named = dict(zip(paper["item"], paper.quantity, strict=True))
    table = statistics.evolved_table({experiment("maze1", "safe"): runs(1, 1, a=1, b=1, **dict.fromkeys(WEIGHTS, 0))})
    for item, weighs in statistics.readable_evolved_table(table).index[2:]:
        assert named[item] == f"weight of {weighs}"


def test_nothing_evolved():
    table = statistics.evolved_table({experiment("maze1", "safe"): runs(0, 2, a=1, b=1, **dict.fromkeys(WEIGHTS, 0))})
    words = statistics.readable_evolved_table(table)
    assert words["maze1"].iloc[0].tolist() == ["–", "0.85 (0.16)", "–"]


def test_first_solutions_are_successes_in_order_and_then_the_nearest():
    table = pd.DataFrame({"run": range(5), "success": [False, True, False, True, False], "distance": [9, 2, 4, 0, 4]})
    assert statistics.first_solutions(table, 4).run.tolist() == [1, 3, 2, 4]
    assert statistics.first_solutions(table, 9).run.tolist() == [1, 3, 2, 4, 0]
    assert list(statistics.first_solutions(table, 1)) == list(table)
    with pytest.raises(ValueError, match="n must be an integer of at least 1; was 0"):
        statistics.first_solutions(table, 0)
