from itertools import combinations

import pytest
from hypothesis import given
from hypothesis import strategies as st

import safe
from safe.results.labels import differences, labels, maze_labels, row_labels

MINE, OTHER = (safe.Maze.from_drawing(drawing, "mine") for drawing in ("S.G", "G.S"))


def test_names_that_differ_are_labels_as_they_are():
    experiments = [safe.Experiment(a, m, seed=s) for s, m in enumerate(("maze1", "maze2")) for a in ("safe", "random")]
    assert labels(experiments) == [(e.maze.name, e.algorithm.name) for e in experiments]
    assert labels([]) == row_labels([]) == maze_labels([]) == differences([]) == []


@pytest.mark.parametrize(
    ("variants", "names"),
    [
        ([{"seed": 0}, {"seed": 1}], ["safe (seed 0)", "safe (seed 1)"]),
        ([{"parameters": safe.Parameters(k=k)} for k in (5, 15)], ["safe (k = 5)", "safe (k = 15)"]),
        (
            [{"parameters": safe.Parameters(mutation=0.1)}, {"seed": 7}],
            ["safe (mutation = 0.1, seed 0)", "safe (mutation = 0.4, seed 7)"],
        ),
        (
            [{}, {"parameters": safe.Parameters(admission="random")}],
            ["safe (admission = lowest replaced)", "safe (admission = random)"],
        ),
        ([{"runs": 20}, {"runs": 100}], ["safe (20 runs)", "safe (100 runs)"]),
        ([{"runs": 20}, {"runs": 100, "seed": 1}], ["safe (seed 0)", "safe (seed 1)"]),
    ],
)
def test_the_same_names_are_told_apart_by_what_differs(variants, names):
    experiments = [safe.Experiment("safe", "maze1", **variant) for variant in variants]
    assert labels(experiments) == [("maze1", name) for name in names]
    assert row_labels(experiments) == [f"maze1: {name}" for name in names]
    everywhere = [safe.Experiment("safe", maze, **variant) for maze in ("maze1", "maze2") for variant in variants]
    assert [algorithm for _, algorithm in labels(everywhere)] == names * 2


def test_mazes_and_algorithms_that_share_a_name_are_told_apart_by_digests():
    first, second = maze_labels([MINE, OTHER])
    assert first != second
    assert first.startswith("mine (digest ")
    assert labels([safe.Experiment("safe", MINE), safe.Experiment("novelty", OTHER)]) == [
        (first, "safe"),
        (second, "novelty"),
    ]
    assert maze_labels([MINE, MINE]) == ["mine", "mine"]
    algorithms = [safe.Algorithm("fixed", objectives=[(a, 1 - a)]) for a in (0.1, 0.2)]
    (maze, one), (same, other) = labels([safe.Experiment(algorithm, MINE) for algorithm in algorithms])
    assert maze == same == "mine"
    assert one != other
    assert one.startswith("fixed (digest ")


@given(
    st.lists(
        st.builds(
            safe.Experiment,
            st.sampled_from(["safe", "novelty", safe.Algorithm("safe", objectives=[(1, 0)])]),
            st.sampled_from([MINE, OTHER, "maze1"]),
            runs=st.sampled_from([1, 2]),
            seed=st.sampled_from([0, 1]),
            parameters=st.sampled_from([safe.Parameters(), safe.Parameters(k=3), safe.Parameters(k=3, steps=9)]),
        ),
        unique=True,
        max_size=6,
    )
)
def test_no_two_experiments_have_the_same_label(experiments):
    for texts in (labels(experiments), row_labels(experiments), differences(experiments)):
        assert len(set(texts)) == len(experiments)
    for pair in combinations(experiments, 2):
        assert len(set(labels(pair))) == 2
