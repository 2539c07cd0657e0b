import pickle

import numpy as np
import pytest
from hypothesis import given

from safe import Maze, load_maze
from safe.maze import SENSORS, ways_to_goal
from tests.helpers import oracle
from tests.helpers.strategies import mazes


def test_a_maze_is_its_cells_and_not_its_name():
    one, other = Maze.from_drawing("S.G", name="one"), Maze.from_drawing("S.G", name="other")
    assert one == other
    assert hash(one) == hash(other)
    assert one != Maze.from_drawing("G.S")
    assert pickle.loads(pickle.dumps(one)) == one


def test_a_maze_does_not_change():
    maze = load_maze("maze1")
    with pytest.raises(ValueError, match="read-only"):
        maze.walls[0, 0] = False


def test_distance_is_taxicab():
    maze = Maze.from_drawing("S....\n....G")
    assert maze.distance([[0, 0], [1, 4], [0, 4]]).tolist() == [5, 0, 1]


SIX_BY_SEVEN = """
    #######
    #.....#
    #..S..#
    #.....#
    #....G#
    #######
"""


@pytest.mark.parametrize(
    ("drawing", "cell", "expected"),
    [
        # walls all around: 3 cells to each side wall, 2 up, 3 down; the goal below and to the right
        (SIX_BY_SEVEN, (2, 3), {"right": 3, "left": 3, "up": 2, "down": 3, "goal": ("down", "right")}),
        # in a corner: adjacent walls read 1
        (SIX_BY_SEVEN, (1, 1), {"right": 5, "left": 1, "up": 1, "down": 4, "goal": ("down", "right")}),
        # the goal in the same row counts as up, in the same column as left
        (SIX_BY_SEVEN, (4, 1), {"right": 5, "left": 1, "up": 4, "down": 1, "goal": ("up", "right")}),
        (SIX_BY_SEVEN, (1, 5), {"right": 1, "left": 5, "up": 1, "down": 4, "goal": ("down", "left")}),
        (SIX_BY_SEVEN, (4, 5), {"right": 1, "left": 5, "up": 4, "down": 1, "goal": ("up", "left")}),
        # no walls: the cells that are left to the edge
        ("S...\n....\n...G", (0, 0), {"right": 3, "left": 0, "up": 0, "down": 2, "goal": ("down", "right")}),
        ("S...\n....\n...G", (2, 2), {"right": 1, "left": 2, "up": 2, "down": 0, "goal": ("up", "right")}),
        # only the first wall counts
        ("S.#.#\n....G", (0, 0), {"right": 2, "left": 0, "up": 0, "down": 1, "goal": ("down", "right")}),
        ("S.#.#\n....G", (0, 3), {"right": 1, "left": 1, "up": 0, "down": 1, "goal": ("down", "right")}),
    ],
)
def test_sensors_by_hand(drawing, cell, expected):
    maze = Maze.from_drawing(drawing)
    height, width = maze.shape
    readings = maze.readings(cell)
    for direction in ("right", "left", "up", "down"):
        assert readings[f"dist_{direction}"] == expected[direction], direction
        side = height if direction in ("up", "down") else width
        assert readings[f"goal_{direction}"] == (side if direction in expected["goal"] else 0), direction


@pytest.mark.parametrize("cell", [(0, 0), (6, 0), (-1, 2), (2, 2, 2), None, "11"])
def test_nothing_is_sensed_in_a_wall_or_outside(cell):
    with pytest.raises(ValueError, match="cell must be"):
        Maze.from_drawing(SIX_BY_SEVEN).readings(cell)


@given(mazes())
def test_sensors_are_those_of_the_oracle_in_every_cell(maze):
    drawing = maze.drawing().split("\n")
    for row, column in np.argwhere(~maze.walls):
        expected = oracle.sense(drawing, row, column)
        assert tuple(expected) == SENSORS
        assert maze.sensors[row, column].tolist() == list(expected.values())


@pytest.mark.parametrize(
    ("walls", "start", "goal", "complaint"),
    [
        ([[0, 0], [0]], (0, 0), (0, 1), "walls must be a rectangle"),
        ([], (0, 0), (0, 1), "walls must be a rectangle"),
        (np.zeros((1, 5000)), (0, 0), (0, 1), "walls must be a rectangle of 1 to 2048 cells a side"),
        ([[0, 0]], (0, 2), (0, 1), "start must be a"),
        ([[0, 0]], (0, -1), (0, 1), "start must be a"),
        ([[0, 0]], "start", (0, 1), "start must be a"),
        ([[0, 0]], (0.5, 0), (0, 1), "start must be a"),
        ([[0, 0]], None, (0, 1), "start must be a"),
    ],
)
def test_bad_mazes(walls, start, goal, complaint):
    with pytest.raises(ValueError, match=complaint):
        Maze(walls, start, goal)


@pytest.mark.parametrize("name", ["", "a\nb", "\udcff", None, 7])
def test_a_maze_whose_name_no_store_or_page_could_hold(name):
    with pytest.raises(ValueError, match="name must be a text of printable characters; got"):
        Maze([[0, 0]], (0, 0), (0, 1), name)


@given(mazes())
def test_the_way_to_the_goal_is_one_cell_longer_than_from_the_best_neighbour(maze):
    ways = ways_to_goal(maze)
    assert ways[maze.goal] == 0
    assert ways[maze.start] >= maze.distance(maze.start)
    assert (ways[maze.walls] == -1).all()
    around = np.pad(ways, 1, constant_values=-1)
    beside = np.stack([around[:-2, 1:-1], around[2:, 1:-1], around[1:-1, :-2], around[1:-1, 2:]])
    nearest = np.where(beside < 0, ways.size, beside).min(axis=0)
    assert (nearest[ways > 0] + 1 == ways[ways > 0]).all()
    assert (beside.max(axis=0)[(ways < 0) & ~maze.walls] < 0).all()  # what is cut off has no neighbour that is not


def test_equal_mazes_are_one_key():
    drawing = "S.G"
    one, other = Maze.from_drawing(drawing, "one"), Maze.from_drawing(drawing, "other")
    assert one == other
    assert len({one, other, Maze.from_drawing("G.S")}) == 2
    assert one != drawing
