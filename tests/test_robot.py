import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import safe
from safe import Maze
from safe.paths import empty_paths
from safe.robot import walk_all, walk_space
from tests.helpers import oracle
from tests.helpers.reference import reference_endpoints
from tests.helpers.strategies import controllers, mazes

RIGHT_DOWN, RIGHT_UP = [0.0] * 16, [0.0] * 8 + [-1.0] * 8


def test_every_reference_end_point():
    rows = list(reference_endpoints())
    assert len(rows) == 320
    for maze, steps, controller, end in rows:
        assert tuple(safe.endpoints(maze, [controller], steps)[0]) == end
        assert tuple(safe.path(maze, controller, steps)[-1]) == end


@given(mazes(), controllers(), st.integers(0, 60))
def test_a_path_is_that_of_the_oracle(maze, controller, steps):
    expected = oracle.path(maze.drawing().split("\n"), controller, steps)
    assert safe.path(maze, controller, steps).tolist() == [list(cell) for cell in expected]


@given(mazes(), controllers())
def test_a_path_keeps_to_the_rules(maze, controller):
    cells = safe.path(maze, controller)
    assert cells.shape == (301, 2)
    assert tuple(cells[0]) == maze.start
    assert not maze.walls[cells[:, 0], cells[:, 1]].any()
    assert np.abs(np.diff(cells, axis=0)).max() <= 1
    assert safe.endpoints(maze, [controller])[0].tolist() == cells[-1].tolist()


@given(mazes(), controllers(count=7), st.integers(0, 500))
def test_a_batch_is_its_controllers_one_by_one(maze, batch, steps):
    together = safe.endpoints(maze, batch, steps)
    assert together.tolist() == [safe.path(maze, controller, steps)[-1].tolist() for controller in batch]


@given(mazes(), controllers(), st.integers(0, 400), st.integers(0, 400))
def test_a_longer_path_begins_with_the_shorter(maze, controller, steps, more):
    shorter, longer = safe.path(maze, controller, steps), safe.path(maze, controller, steps + more)
    assert longer[: steps + 1].tolist() == shorter.tolist()


def test_horizontal_before_vertical():
    # right and down from S: both ways round lead to the cell diagonally below, unless one of them is blocked
    assert safe.path(Maze.from_drawing("S#\n.G"), RIGHT_DOWN, 1)[-1].tolist() == [1, 0]  # blocked right, then down
    assert safe.path(Maze.from_drawing("S.\n#G"), RIGHT_DOWN, 1)[-1].tolist() == [1, 1]  # right, then down from there
    assert safe.path(Maze.from_drawing("S.G\n.#."), RIGHT_DOWN, 1)[-1].tolist() == [0, 1]  # right; there, down is wall


def test_both_sums_are_formed_before_either_move():
    # v = -dist_right: -1 in the left column, so up, where the edge stops it; formed after the move right it would be 0
    controller = [0.0] * 16
    controller[8] = -1.0
    assert safe.path(Maze.from_drawing("S.\n.G"), controller, 1)[-1].tolist() == [0, 1]


def test_a_sum_of_zero_goes_right_and_down_and_one_below_zero_does_not():
    maze = Maze.from_drawing("...\n.S.\n..G")
    assert safe.path(maze, RIGHT_DOWN, 1)[-1].tolist() == [2, 2]
    assert safe.path(maze, RIGHT_UP, 1)[-1].tolist() == [0, 2]
    assert safe.path(maze, [-1e-300] * 16, 1)[-1].tolist() == [0, 0]
    assert safe.path(maze, [-0.0] * 16, 1)[-1].tolist() == [2, 2]


def test_the_robot_does_not_stop_at_the_goal():
    assert safe.path(Maze.from_drawing("SG..."), RIGHT_DOWN, 4)[:, 1].tolist() == [0, 1, 2, 3, 4]


def test_a_path_that_repeats_ends_where_a_plain_walk_ends():
    maze = Maze.from_drawing("#......#\n#S....G#")
    batch = np.random.default_rng(5).uniform(-1, 1, (50, 16))
    for steps in (999, 1000):
        expected = [list(oracle.path(maze.drawing().split("\n"), c, steps)[-1]) for c in batch]
        assert safe.endpoints(maze, batch, steps).tolist() == expected


@pytest.mark.parametrize(
    ("controller", "complaint"),
    [
        ([0.0] * 15, r"controller must have the shape \(16\); got shape \(15,\)"),
        ([[0.0] * 16], r"controller must have the shape \(16\); got shape \(1, 16\)"),
        ([0.0] * 15 + [1.5], r"controller must be finite and in \[-1, 1\]; got 1.5 at index \(15,\)"),
        ([0.0] * 15 + [np.nan], "controller must be finite"),
        ([-np.inf] + [0.0] * 15, "controller must be finite"),
        (["a"] * 16, "controller must be an array of numbers"),
        (None, "controller must"),
        ([1j] * 16, "controller must be an array of numbers"),
    ],
)
def test_bad_controllers(controller, complaint):
    with pytest.raises(ValueError, match=complaint):
        safe.path("maze1", controller)
    with pytest.raises(ValueError, match=complaint.split(" must")[0] + "s must"):
        safe.endpoints("maze1", [controller])


@pytest.mark.parametrize("steps", [-1, 1.5, "300", True, None, 10**9])
def test_bad_steps(steps):
    with pytest.raises(ValueError, match="steps must be an integer from 0 to 1000000"):
        safe.path("maze1", RIGHT_DOWN, steps)
    with pytest.raises(ValueError, match="steps must be an integer from 0 to 1000000"):
        safe.endpoints("maze1", [RIGHT_DOWN], steps)


def test_no_robots_at_all():
    assert safe.endpoints("maze1", np.empty((0, 16))).shape == (0, 2)


def test_a_known_end_needs_no_walk_unless_paths_count():
    maze, known = safe.load_maze("maze1"), np.array([[-1, -1], [1, 2]])
    true = safe.endpoints(maze, [RIGHT_DOWN] * 2)
    for robots, expected in [(0, [true[0], known[1]]), (2, true)]:
        ends = np.empty((2, 2), dtype=np.int64)
        paths = empty_paths(robots, maze.shape, 300)
        walk_all(maze.arrays, np.array([RIGHT_DOWN] * 2), 300, walk_space(maze.shape, 300), ends, paths, known)
        assert (ends == expected).all()
