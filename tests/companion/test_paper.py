import numpy as np
import pytest

import safe
from safe.companion import paper
from safe.experiments.experiment import WEIGHT_COLUMNS as WEIGHTS
from safe.results import tables
from tests.helpers.results import experiment, runs


def test_the_papers_numbers_come_along():
    published = paper.published()
    assert published.table.value_counts().to_dict() == {"3": 32, "2": 12, "1": 11, "text": 6}
    assert set(published.maze.dropna()) == {"maze1", "maze2"}
    assert published[published.quantity.str.startswith("weight of")].groupby("maze").size().tolist() == [16, 16]


def test_parameters_beside_the_papers():
    table = paper.parameter_table(safe.Parameters(k=7, crossover=0.25, admission="random"))
    assert table.index.tolist() == list(vars(safe.Parameters()))[:11]  # the others are choices beyond the paper
    assert table.loc["k"].tolist() == ["nearest neighbours that count for novelty", "7", "15"]
    assert table.loc["crossover", ["value", "in the paper"]].tolist() == ["0.25", "0.8"]


def test_the_default_parameters_are_the_papers():
    table = paper.parameter_table()
    assert (table["value"] == table["in the paper"]).all()


@pytest.mark.parametrize(
    "change",
    [
        {"maze": safe.Maze.from_drawing("S.G", name="maze1")},
        {"algorithm": safe.Algorithm("safe", objectives=[(1, 0)])},
        {"parameters": safe.Parameters(k=14)},
    ],
)
def test_an_experiment_that_only_shares_names_with_the_papers_is_not_compared_with_it(change):
    table = tables.success_table(
        {safe.Experiment(**{"algorithm": "safe", "maze": "maze1", **change}): runs(2, 4)}, paper.reported
    )
    assert table.index.tolist() == [("maze1", "safe")]
    assert np.isnan(table.paper_successes.iloc[0])


def test_a_maze_that_comes_along_need_not_be_the_papers():
    assert paper.is_the_papers(safe.Experiment("safe", "maze2"))
    assert not paper.is_the_papers(safe.Experiment("safe", "medium"))


def test_the_papers_weights_are_named_as_ours():
    published = paper.published()
    named = dict(zip(published["item"], published.quantity, strict=True))
    table = tables.evolved_table({experiment("maze1", "safe"): runs(1, 1, **dict.fromkeys(WEIGHTS, 0))}, WEIGHTS)
    for _, item, weighs in table.index:
        assert named[item] == f"weight of {weighs}"
