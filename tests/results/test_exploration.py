"""Measures of how a run explores, against the same measures in plain Python."""

from dataclasses import replace
from math import nan
from statistics import fmean, pstdev

import numpy as np
import pandas as pd
import pytest

from safe import Algorithm, Experiment, Maze, Parameters
from safe.maze import ways_to_goal
from safe.results import mechanism
from safe.results.exploration import MEASURES, SINCE_START, by_window, observe, places_of
from tests.helpers import oracle

DRAWING = """
S.......#...
.###.##.#.#.
...#..#...#.
.#.##.#####.
.#..........
.##.###.###.
..#...#...#G
"""
MAZE = Maze.from_drawing(DRAWING)
SMALL = {"population": 12, "objectives": 10, "tournament": 3, "generations": 7, "archive": 30, "k": 4, "steps": 9}
GOALS = {"kind": "goal", "judging": "favourite"}
MIXED = {"kind": "mixed", "judging": "favourite"}
ALGORITHMS = [
    Algorithm("standard", objectives=[(1, 0)]),
    Algorithm("safe", rating="genotypic novelty"),
    Algorithm("drawn judge", judging="drawn judge"),
    Algorithm("random", objectives=[]),
    Algorithm("unchanging goals", **GOALS),
    Algorithm("competing goals", **GOALS, rating="competition"),
    Algorithm("redrawn goals", **GOALS, rating="redrawn"),
    Algorithm("goals, best score", kind="goal", rating="mutualism"),
    Algorithm("goals and weights", **MIXED, components=("1 / distance", "novelty", "path rarity"), rating="redrawn"),
    Algorithm("goals, repertoire", **GOALS, rating="patience", pool="repertoire"),
    Algorithm("nobody, repertoire", objectives=[], pool="repertoire"),
]
CASES = {
    algorithm.name: Experiment(algorithm, MAZE, seed=1, parameters=Parameters(**SMALL)) for algorithm in ALGORITHMS
}
CASES["until it succeeds"] = Experiment(
    "novelty", MAZE, seed=1, parameters=Parameters(**SMALL | {"success_distance": 6})
)


@pytest.fixture(scope="module")
def observed():
    """The generations of every case, and their table."""
    stories = {name: list(experiment.replay(0)) for name, experiment in CASES.items()}
    return {name: (story, observe(CASES[name], story)) for name, story in stories.items()}


def differential(values, parents):
    spread = pstdev(values)
    return (fmean(values[parent] for parent in parents) - fmean(values)) / spread if len(set(values)) > 1 else 0.0


def goals_among(experiment, objectives):
    """The genomes of the goals: all objective functions, the second half of them, or none."""
    first = {"goal": 0, "mixed": len(objectives) // 2}.get(experiment.algorithm.kind, len(objectives))
    return objectives[first:].tolist()


def plain_measures(experiment, story):
    """The measures of each generation, in plain Python."""
    drawing, ways = MAZE.drawing().split("\n"), ways_to_goal(MAZE)
    is_generation = experiment.algorithm.pool == "generation" and experiment.algorithm.name != "random"
    ends_so_far, visits = set(), {}
    for generation, following in zip(story, [*story[1:], None], strict=True):
        ends = list(map(tuple, generation.endpoints.tolist()))
        paths = [
            set(oracle.path(drawing, genome, experiment.parameters.steps)) for genome in generation.genomes.tolist()
        ]
        ends_so_far.update(ends)
        for path in paths:
            for cell in path:
                visits[cell] = visits.get(cell, 0) + 1
        row = {
            "end_cells": len(ends_so_far),
            "path_cells": len(visits),
            "progress": max(1 - ways[cell] / ways[MAZE.start] for cell in visits),
        }
        goals = goals_among(experiment, generation.objectives)
        if goals:
            nearest = [min(oracle.taxicab(oracle.place(goal, 7, 12), end) for end in ends) for goal in goals]
            row |= {"reached": fmean(d <= 1 for d in nearest), "goal_distance": fmean(nearest)}
        if following is not None:
            if goals:
                later = goals_among(experiment, following.objectives)
                row["changed"] = fmean(one != other for one, other in zip(goals, later, strict=True))
            parents, choosers = following.parents.tolist(), set(following.chosen_by.tolist()) - {-1}
            if choosers:
                row["choosers"] = len(choosers)
            if experiment.algorithm.name != "random":
                row["parents"] = len(set(parents)) / len(parents)
            if is_generation:
                values = {
                    "closeness": [-float(d) for d in generation.distances],
                    "way": [-float(ways[end]) for end in ends],
                    "rarity": [sum(visits[cell] ** -0.5 for cell in path) for path in paths],
                }
                if generation.novelty is not None:
                    values["novelty"] = generation.novelty.tolist()
                row |= {f"differential_{name}": differential(of_all, parents) for name, of_all in values.items()}
        yield row


@pytest.mark.parametrize("name", CASES)
def test_measures_are_those_of_plain_python(name, observed):
    story, table = observed[name]
    assert list(table) == list(MEASURES)
    assert set(table.dtypes) == {np.dtype("float64")}
    assert table.index.name == "generation"
    assert table.index.tolist() == list(range(len(story)))
    for number, expected in enumerate(plain_measures(CASES[name], story)):
        assert table.loc[number].dropna().to_dict() == pytest.approx(expected, rel=1e-9, abs=1e-9)


def test_the_cases_differ_in_what_they_show(observed):
    """Otherwise measures could be mistaken without any of them showing it."""
    tables = pd.concat([table for _, table in observed.values()])
    assert (tables.nunique() > 2).all()
    assert len(observed["until it succeeds"][0]) < SMALL["generations"]


def test_what_does_not_apply_is_not_a_number(observed):
    def missing(name):
        _, table = observed[name]
        return set(table.columns[table.iloc[:-1].isna().all()])

    of_goals = {"reached", "goal_distance", "changed"}
    of_selection = {name for name in MEASURES if name.startswith("differential_")}
    assert missing("safe") == of_goals
    assert missing("standard") == {*of_goals, "differential_novelty"}
    assert missing("unchanging goals") == {"differential_novelty"}
    assert missing("goals and weights") == set()
    assert missing("random") == {*of_goals, *of_selection, "parents", "choosers"}
    assert missing("nobody, repertoire") == {*of_goals, *of_selection, "choosers"}
    assert missing("goals, repertoire") == of_selection


def test_the_selection_in_the_last_generation_is_unknown(observed):
    for story, table in observed.values():
        last = table.iloc[-1]
        known = ["end_cells", "path_cells", "progress"]
        assert last.drop([*known, "reached", "goal_distance"]).isna().all()
        assert last[known].notna().all()
        assert last.name == story[-1].generation


def test_goals_change_as_their_rating_says(observed):
    def changed(name):
        return observed[name][1].changed.iloc[:-1]

    assert (changed("unchanging goals") == 0).all()
    assert (changed("redrawn goals") == 1).all()
    assert 0 < changed("competing goals").mean() < 1


def test_only_goals_count_as_changed_goals():
    """Of ten objective functions the last five are goals, of which one changes; so do all weights."""
    experiment = CASES["goals and weights"]
    first, second = list(experiment.replay(0))[:2]
    objectives = first.objectives.copy()
    objectives[:6] /= 2
    story = [first, replace(second, objectives=objectives)]
    assert observe(experiment, story).changed[0] == 1 / 5


def test_without_spread_there_is_no_selection_differential():
    experiment = CASES["safe"]
    first, second = list(experiment.replay(0))[:2]
    alike = replace(first, distances=np.full(12, 7), novelty=np.full(12, 0.1))  # whose sum is rounded
    row = observe(experiment, [alike, second]).loc[0]
    assert row[["differential_closeness", "differential_novelty"]].tolist() == [0, 0]


def test_an_empty_story_has_no_rows():
    table = observe(CASES["safe"], [])
    for empty in (table, by_window(table)):
        assert empty.shape == (0, len(MEASURES))
        assert empty.index.name == "generation"


def test_windows_have_means_and_the_last_of_what_counts_since_the_start():
    numbers = pd.RangeIndex(12, name="generation")
    table = pd.DataFrame({name: numbers.to_numpy(np.float64) for name in MEASURES}, numbers)
    table.loc[[4, 11], "parents"] = nan
    windows = by_window(table)
    assert windows.index.tolist() == list(mechanism.WINDOWS[:4])
    for name in MEASURES:
        expected = [0, 2, 9, 11] if name in SINCE_START else [0, 1.5, 6, 10.5]
        expected = [0, 1.5, 38 / 6, 10] if name == "parents" else expected
        assert windows[name].tolist() == pytest.approx(expected)


@pytest.mark.parametrize(
    ("goal", "cell"),
    [((0, 0), (0, 0)), ((1, 1), (6, 11)), ((0.5, 0.5), (3, 6)), ((1 / 7, 0.999), (1, 11)), ((0.142, 1 / 12), (0, 1))],
)
def test_a_goal_names_a_cell_of_the_maze(goal, cell):
    assert places_of(MAZE, np.array([[*goal, 0.3]])).tolist() == [list(cell)]
    assert tuple(oracle.place(goal, 7, 12)) == cell
