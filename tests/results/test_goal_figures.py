import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest

from safe import Algorithm, Experiment, Maze, Parameters
from safe.results.figures.goals import plot_autocorrelations, plot_choices, plot_goals
from tests.helpers import oracle

mpl.use("agg")
MAZE = Maze.from_drawing(
    """
    S....#....
    .###...##.
    .#.....#..
    ...##....G
    """,
    name="_$mine",
)


@pytest.fixture(autouse=True)
def _closed():
    yield
    plt.close("all")


@pytest.fixture(scope="module")
def story():
    goals = Algorithm("goals", kind="goal", judging="favourite", rating="competition")
    parameters = Parameters(population=6, objectives=8, generations=3, steps=4, success_distance=0)
    return list(Experiment(goals, MAZE, seed=3, parameters=parameters).replay(0))


def drawn(axes, marker):
    (points,) = (line for line in axes.get_lines() if line.get_marker() == marker)
    return list(zip(points.get_ydata(), points.get_xdata(), strict=True))


def test_every_place_has_a_line_to_the_robot_that_ends_nearest(story):
    _, grid = plot_goals(MAZE, [[(story[1], "one")]])
    ends = [tuple(end) for end in story[1].endpoints.tolist()]
    places = [(int(4 * a), int(10 * b)) for a, b in story[1].objectives.tolist()]
    assert drawn(grid[0, 0], "x") == places
    assert drawn(grid[0, 0], ".") == ends
    (lines,) = grid[0, 0].collections
    joined = [[(row, column) for column, row in segment] for segment in lines.get_segments()]
    nearest = [min(ends, key=lambda end: oracle.taxicab(place, end)) for place in places]
    assert joined == [list(pair) for pair in zip(places, nearest, strict=True)]
    assert len(set(ends)) > 1


def test_choices_lead_from_goals_to_the_parents_that_they_chose():
    both = Algorithm(
        "both", kind="mixed", judging="favourite", pool="repertoire", components=("novelty",), rating="redrawn"
    )
    parameters = Parameters(population=12, objectives=8, generations=4, steps=6, success_distance=0)
    before, after = list(Experiment(both, MAZE, seed=3, parameters=parameters).replay(0))[2:4]
    _, (axes,) = plot_choices(MAZE, both, [(before, after)])
    chosen, weighed = [], []
    for parent, judge in zip(after.parents, after.chosen_by, strict=True):
        if judge >= 4:  # half of the eight are goals
            a, b = before.objectives[judge][:2]
            chosen.append([(int(4 * a), int(10 * b)), tuple(before.repertoire[1][parent])])
        elif judge >= 0:
            weighed.append(tuple(before.endpoints[parent]))
    assert chosen
    assert weighed
    (lines,) = axes.collections
    assert [[(row, column) for column, row in segment] for segment in lines.get_segments()] == chosen
    assert drawn(axes, "x") == [goal for goal, _ in chosen]
    assert drawn(axes, "+") == weighed
    assert axes.get_title() == "generation 2"


def test_rows_may_be_shorter_and_titles_are_no_mathematics(story):
    figure, grid = plot_goals(MAZE, [[(story[0], "a $1 place"), (story[2], "later")], [(story[0], "alone")]])
    assert grid.shape == (2, 2)
    assert [axes.axison for axes in grid.flat] == [True, True, True, False]
    assert [axes.get_title() for axes in grid.flat] == [r"a \$1 place", "later", "alone", ""]
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [
        "start",
        "goal",
        "end points of robots",
        "places that judge",
    ]
    figure.draw_without_rendering()


def test_autocorrelations_have_a_line_for_each_run_and_their_mean():
    curves = {"some": [np.array([1.0, 0.5, -0.5]), np.array([1.0, 0.1, 0.3])], "none": []}
    figure, (some, none) = plot_autocorrelations(curves)
    lines = [line.get_ydata() for line in some.get_lines()]
    assert np.allclose(lines[:2], curves["some"])
    assert np.allclose(lines[2], [1.0, 0.3, -0.1])
    assert len(none.get_lines()) == 1  # the axis
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["a run", "mean: some"]
    figure.draw_without_rendering()
