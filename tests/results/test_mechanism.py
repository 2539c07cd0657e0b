"""Measures of what selects inside a run, against the same measures in plain Python."""

from collections import Counter
from dataclasses import replace
from math import nan
from statistics import fmean, pstdev

import numpy as np
import pandas as pd
import pytest

from safe import Algorithm, Experiment, Maze, Parameters
from safe.maze import ways_to_goal
from safe.novelty import ADMISSIONS
from safe.results import mechanism
from safe.results.mechanism import MEASURES, SINCE_START, WINDOWS, by_window, observe
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
SMALL = {"population": 12, "objectives": 10, "tournament": 3, "generations": 8, "archive": 30, "k": 4, "steps": 9}
ALGORITHMS = [
    "standard",
    "novelty",
    "safe",
    "fixed",
    "random",
    Algorithm("a panel", objectives=[(0.1, 0.9), (0.9, 0.1), (0.1, 0.9)]),
    Algorithm("drawn judge", rating="genotypic novelty", judging="drawn judge"),
    Algorithm("drawn judge of ranks", rating="genotypic novelty", scaling="rank", judging="drawn judge"),
    Algorithm("best rank", objectives=[(0.5, 0.5)], scaling="rank"),
]


def small(algorithm, seed=1, **parameters):
    return Experiment(algorithm, MAZE, seed=seed, parameters=Parameters(**{**SMALL, "threshold": 1.0, **parameters}))


CASES = {
    **{getattr(algorithm, "name", algorithm): small(algorithm) for algorithm in ALGORITHMS},
    **{f"novelty, {rule}": small("novelty", admission=rule) for rule in ADMISSIONS},
    "novelty, nothing over the threshold": small("novelty", admission="threshold", threshold=1e6),
    "safe, no archive": small("safe", archive=0),
    "safe, fewer neighbours than k": small("safe", archive=2, k=50),
    "novelty, until it succeeds": small("novelty", success_distance=6),
}


@pytest.fixture(scope="module")
def observed():
    """The generations of every case, and their table."""
    stories = {name: list(experiment.replay(0)) for name, experiment in CASES.items()}
    return {name: (story, observe(CASES[name], story)) for name, story in stories.items()}


def held_tournaments(experiment, generation):
    """The winner and the participants of each tournament."""
    rng = np.random.Generator(np.random.SFC64([generation.generation]))
    components = (generation.components if generation.scaled is None else generation.scaled).T.tolist()
    n, m = len(components), len(generation.objectives)
    for _ in range(500):
        drawn = [oracle.index(rng, n) for _ in range(experiment.parameters.tournament)]
        scores = generation.fitness
        if experiment.algorithm.judging == "drawn judge":
            judge = generation.objectives[oracle.index(rng, m)].tolist()
            scores = [oracle.score(judge, of_one) for of_one in components]
        yield max(drawn, key=lambda i: scores[i]), drawn


def differential(values, winners):
    spread = pstdev(values)
    return (fmean(values[i] for i in winners) - fmean(values)) / spread if len(set(values)) > 1 else 0.0


def archived_share(point, others, archive, k):
    """Of the k nearest neighbours of a point, the share in the archive; ties for the last places share them."""
    neighbours = [(oracle.taxicab(point, other), 0) for other in others]
    neighbours += [(oracle.taxicab(point, other), 1) for other in archive]
    wanted = min(k, len(neighbours))
    last = sorted(distance for distance, _ in neighbours)[wanted - 1]
    nearer = [is_archived for distance, is_archived in neighbours if distance < last]
    tied = [is_archived for distance, is_archived in neighbours if distance == last]
    return (sum(nearer) + fmean(tied) * (wanted - len(nearer))) / wanted


def plain_measures(experiment, story):
    """The measures of each generation, in plain Python."""
    drawing, ways = experiment.maze.drawing().split("\n"), ways_to_goal(experiment.maze)
    start, goal = oracle.find(drawing, "S"), oracle.find(drawing, "G")
    ends_so_far, visited, archive_before = set(), set(), Counter()
    for generation in story:
        ends = list(map(tuple, generation.endpoints.tolist()))
        distances = [oracle.taxicab(end, goal) for end in ends]
        closeness = [1 / distance if distance else 2.0 for distance in distances]
        ends_so_far.update(ends)
        for controller in generation.genomes.tolist():
            visited.update(oracle.path(drawing, controller, experiment.parameters.steps))
        row = {
            "closeness": fmean(closeness),
            "closeness_max": max(closeness),
            "end_cells": len(ends_so_far),
            "path_cells": len(visited),
            "progress": max(1 - ways[cell] / ways[start] for cell in visited),
        }
        if not experiment.algorithm.is_random_search:
            given = Counter(generation.winners.tolist())
            most = max(sorted(given), key=given.get)
            a, b = generation.objectives.T.tolist()
            held = list(held_tournaments(experiment, generation))
            winners = [winner for winner, _ in held]
            nearness = [-float(distance) for distance in distances]
            row |= {
                "judges": len(given),
                "sole": float(len(given) == 1),
                "share": given[most] / len(ends),
                "a": a[most],
                "b": b[most],
                "mean_a": fmean(a),
                "sd_a": pstdev(a),
                "mean_b": fmean(b),
                "sd_b": pstdev(b),
                "by_closeness": fmean(distances[w] == min(distances[i] for i in drawn) for w, drawn in held),
                "differential_closeness": differential(nearness, winners),
            }
        if generation.novelty is not None:
            novelty = generation.novelty.tolist()
            archive = list(map(tuple, generation.archive[0].tolist()))
            others = [ends[:i] + ends[i + 1 :] for i in range(len(ends))]
            shares = [
                archived_share(end, rest, archive, experiment.parameters.k)
                for end, rest in zip(ends, others, strict=True)
            ]
            row |= {
                "novelty": fmean(novelty),
                "novelty_sd": pstdev(novelty),
                "novelty_max": max(novelty),
                "by_novelty": fmean(novelty[w] == max(novelty[i] for i in drawn) for w, drawn in held),
                "differential_novelty": differential(novelty, winners),
                "archive_size": len(archive),
                "archive_cells": len(set(archive)),
                "archive_lowest": min(generation.archive[1].tolist(), default=nan),
                "entered": (Counter(archive) - archive_before).total(),
                "archived_neighbours": fmean(shares),
            }
            archive_before = Counter(archive)
        yield row


@pytest.mark.parametrize("name", CASES)
def test_measures_are_those_of_plain_python(name, observed):
    story, table = observed[name]
    assert list(table) == list(MEASURES)
    assert set(table.dtypes) == {np.dtype("float64")}
    assert table.index.name == "generation"
    assert table.index.tolist() == list(range(len(story)))
    for number, expected in enumerate(plain_measures(CASES[name], story)):
        assert table.loc[number].dropna().to_dict() == pytest.approx(
            {measure: value for measure, value in expected.items() if value == value}, rel=1e-12, abs=1e-12
        )


@pytest.mark.parametrize("name", ["safe", "drawn judge of ranks"])
def test_compiled_sums_are_those_of_plain_python_bit_for_bit(name, observed, monkeypatch):
    story, table = observed[name]
    for function, value in vars(mechanism).copy().items():
        if hasattr(value, "py_func") and value.__module__ == mechanism.__name__:
            monkeypatch.setattr(mechanism, function, value.py_func)
    pd.testing.assert_frame_equal(observe(CASES[name], story), table, check_exact=True)


def test_the_cases_differ_in_what_they_show(observed):
    """Otherwise measures could be mistaken without any of them showing it."""
    tables = pd.concat([table for _, table in observed.values()])
    assert (tables.nunique() > 2).drop("sole").all()
    assert set(tables.sole.dropna()) == {0, 1}
    assert len(observed["novelty, until it succeeds"][0]) < SMALL["generations"]


@pytest.mark.parametrize("name", CASES)
def test_measures_are_in_their_ranges(name, observed):
    _, table = observed[name]
    for measure in ("sole", "share", "by_novelty", "by_closeness", "archived_neighbours", "progress"):
        assert table[measure].dropna().between(0, 1).all()
    assert (table[list(SINCE_START)].diff().dropna() >= 0).all(axis=None)
    assert (table.end_cells <= table.path_cells).all()
    assert (table.filter(regex="^(sd_|novelty_sd)").fillna(0) >= 0).all(axis=None)


def test_what_one_objective_function_weighs_decides(observed):
    novelty, standard = observed["novelty"][1], observed["standard"][1]
    assert (novelty.by_novelty == 1).all()
    assert (standard.by_closeness == 1).all()
    assert (novelty.by_closeness < 1).any()
    for table, a, b in ((novelty, 0, 1), (standard, 1, 0)):
        assert (table[["judges", "sole", "share", "mean_a", "mean_b"]] == [1, 1, 1, a, b]).all(axis=None)
        assert (table[["sd_a", "sd_b"]] == 0).all(axis=None)


def test_what_makes_no_sense_is_not_a_number(observed):
    def missing(name):
        _, table = observed[name]
        assert (table.isna().all() == table.isna().any()).all()
        return set(table.columns[table.isna().any()])

    of_novelty = {"novelty", "novelty_sd", "novelty_max", "by_novelty", "differential_novelty", "archive_size"}
    of_novelty |= {"archive_cells", "archive_lowest", "entered", "archived_neighbours"}
    measured_in_random_search = {"closeness", "closeness_max", *SINCE_START}
    assert missing("safe") == set()
    assert missing("standard") == of_novelty
    assert missing("random") == set(MEASURES) - measured_in_random_search
    assert missing("safe, no archive") == {"archive_lowest"}
    assert (observed["safe, no archive"][1].filter(regex="^archive_[sc]|^entered|^archived") == 0).all(axis=None)


def test_without_spread_there_is_no_selection_differential():
    experiment = CASES["novelty"]
    first = next(experiment.replay(0))
    novelty = np.full(12, 0.1)  # whose sum is rounded
    alike = replace(first, distances=np.full(12, 7), novelty=novelty)
    row = observe(experiment, [alike]).loc[0]
    assert row[["differential_closeness", "differential_novelty", "novelty_sd"]].tolist() == [0, 0, 0]
    assert row.novelty == 0.1


def test_the_draws_of_a_generation_depend_on_its_number_alone(observed):
    story, table = observed["safe"]
    later = observe(CASES["safe"], story[3:])
    accumulated = ["entered", *SINCE_START]
    pd.testing.assert_frame_equal(
        later.drop(columns=accumulated), table.loc[3:].drop(columns=accumulated), check_exact=True
    )
    again = observe(CASES["safe"], [replace(story[3], generation=4)]).loc[4]
    assert again.differential_novelty != table.differential_novelty[3]


def test_an_empty_story_has_no_rows():
    table = observe(CASES["safe"], [])
    for empty in (table, by_window(table)):
        assert empty.shape == (0, len(MEASURES))
        assert empty.index.name == "generation"


def counting(generations):
    """A table in which all measures are the number of the generation."""
    numbers = pd.RangeIndex(generations, name="generation")
    return pd.DataFrame({name: numbers.to_numpy(np.float64) for name in MEASURES}, numbers)


def test_windows_of_a_whole_run():
    windows = by_window(counting(500))
    assert windows.index.tolist() == list(WINDOWS)
    assert windows.index.name == "generation"
    assert list(windows) == list(MEASURES)
    assert windows.novelty.tolist() == [0, 1.5, 6, 19.5, 64.5, 149.5, 249.5, 349.5, 449.5]
    for name in SINCE_START:
        assert windows[name].tolist() == [0, 2, 9, 29, 99, 199, 299, 399, 499]


@pytest.mark.parametrize(
    ("generations", "reached", "last"),
    [(1, [0], 0), (2, [0, 1], 1), (12, [0, 1, 3, 10], 10.5), (301, [*WINDOWS[:-1]], 300)],
)
def test_windows_that_a_run_reached(generations, reached, last):
    windows = by_window(counting(generations))
    assert windows.index.tolist() == reached
    assert windows.novelty.iloc[-1] == last
    assert windows.end_cells.iloc[-1] == generations - 1


def test_the_mean_over_a_window_leaves_out_what_is_not_a_number():
    table = counting(10)
    table.loc[[0, 3, 4], "archive_lowest"] = nan
    windows = by_window(table)
    assert np.isnan(windows.archive_lowest[0])
    assert windows.archive_lowest.tolist()[1:] == [1.5, 7]
