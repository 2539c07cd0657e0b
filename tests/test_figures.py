import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest

import safe
from safe import figures, statistics
from tests.test_statistics import runs

mpl.use("agg")
MAZE = safe.Maze.from_drawing("S..#\n.#..\n...G", name="small")


@pytest.fixture(autouse=True)
def _closed():
    yield
    plt.close("all")


def test_a_maze_is_drawn_with_rows_downwards():
    _, axes = plt.subplots()
    figures.draw_maze(axes, MAZE)
    (image,) = axes.get_images()
    assert (image.get_array() == MAZE.walls).all()
    start, goal = axes.get_lines()
    assert start.get_xydata().tolist() == [[0, 0]]
    assert goal.get_xydata().tolist() == [[3, 2]]
    assert axes.yaxis_inverted()


def test_a_path_goes_from_start_to_end():
    _, axes = plt.subplots()
    figures.draw_path(axes, np.array([[0, 0], [1, 0], [2, 1]]))
    path, end = axes.get_lines()
    assert path.get_xydata().tolist() == [[0, 0], [0, 1], [1, 2]]
    assert end.get_xydata().tolist() == [[1, 2]]


def test_one_drawing_for_each_maze_and_path():
    path = safe.path(MAZE, [0.0] * 16, 5)
    figure, grid = figures.plot_paths([[(MAZE, path, "one"), (MAZE, None, "two")], [(MAZE, path, "three")]])
    assert grid.shape == (2, 2)
    assert [axes.get_title() for axes in grid.flat] == ["one", "two", "three", ""]
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["start", "goal", "path", "end of the path"]
    figure, grid = figures.plot_mazes([MAZE, MAZE, MAZE])
    assert grid.shape == (1, 3)
    assert grid[0, 2].get_title() == "small"


def test_sensors_are_shown_with_their_readings():
    _, axes = figures.plot_sensors(MAZE, (2, 1))
    texts = {text.get_text() for text in axes.texts}
    assert {"dist_right = 2\ngoal_right = 4", "dist_left = 1", "dist_down = 0", "dist_up = 1\ngoal_up = 3"} <= texts


def test_rates_of_success_with_the_papers():
    table = statistics.success_table(
        {safe.Experiment("safe", "maze1"): runs(3, 4), safe.Experiment("random", "maze1"): runs(0, 4)}
    )
    _, (axes,) = figures.plot_success(table)
    assert [label.get_text() for label in axes.get_yticklabels()] == ["random", "safe"]
    ours, *_, paper = (line for line in axes.get_lines() if len(line.get_xdata()) == 2 and line.get_marker() in "ox")
    assert ours.get_xdata().tolist() == [0, 75]
    assert paper.get_xdata().tolist() == pytest.approx([100 * 9 / 500, 100 * 328 / 500])


def test_the_style_is_one_that_matplotlib_knows():
    with plt.rc_context():
        figures.use_style()
        assert plt.rcParams["axes.prop_cycle"].by_key()["color"][0] == "#0072B2"
