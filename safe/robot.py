"""The robot: a controller of 16 weights that walks the maze for a fixed number of steps (Section 5 of the paper).

At every step the robot reads its eight sensors s_1..s_8 (see `safe.maze`) once, and forms two weighted sums:

    h = p_1 s_1 + ... + p_8 s_8            v = p_9 s_1 + ... + p_16 s_8

It moves one cell right if h >= 0, otherwise left; if that cell is wall or outside, it stays. Then, from its new
column, it moves one cell down if v >= 0, otherwise up, in the same way. It does not stop at the goal.

The controller has no memory: the robot's next cell depends only on the present one. Once a path returns to a cell
it repeats from there for ever, so its end point follows without walking on. This is exact.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from safe import checks
from safe.kernel import index, kernel
from safe.maze import SENSORS, Maze, MazeArrays
from safe.maze_files import load_maze
from safe.paths import Paths, keep_path

READINGS = len(SENSORS)  # s_1..s_8
WEIGHTS = 2 * READINGS  # p_1..p_16
STEPS = 300


def path(maze: Maze | str, controller: np.ndarray, steps: int = STEPS) -> np.ndarray:
    """The cells that the robot stands on, the start first.

    Parameters
    ----------
    maze : Maze or str
        The maze, or its name.
    controller : array of float, shape (16,)
        The weights p_1..p_16, each in [-1, 1].
    steps : int
        How many steps the robot takes, 0 to 1,000,000.

    Returns
    -------
    array of int, shape (steps + 1, 2)
        Row and column after each step.

    Raises
    ------
    ValueError
        If the controller does not hold 16 finite numbers in [-1, 1], or if steps is out of range.

    Examples
    --------
    A controller of zeros has h = v = 0, so it goes right and down.

    >>> from safe import Maze
    >>> maze = Maze.from_drawing("S..\\n..#\\n..G")
    >>> path(maze, [0] * 16, steps=3).tolist()
    [[0, 0], [1, 1], [2, 1], [2, 2]]
    """
    maze = load_maze(maze)
    controller = checks.array("controller", controller, (WEIGHTS,), -1, 1)
    steps = checks.integer("steps", steps, 0, checks.MOST)
    cells = np.empty((steps + 1, 2), dtype=np.int64)
    walk_path(maze.arrays, controller, steps, walk_space(maze.shape, steps), cells)
    return cells


def endpoints(maze: Maze | str, controllers: np.ndarray, steps: int = STEPS) -> np.ndarray:
    """The end points of n robots.

    Parameters
    ----------
    maze : Maze or str
        The maze, or its name.
    controllers : array of float, shape (n, 16)
        The weights p_1..p_16 of each robot, each in [-1, 1].
    steps : int
        How many steps each robot takes, 0 to 1,000,000.

    Returns
    -------
    array of int, shape (n, 2)
        Row and column of each robot after its last step.

    Raises
    ------
    ValueError
        As `path`.

    Examples
    --------
    >>> endpoints("maze1", [[0] * 16])
    array([[77, 30]])
    """
    maze = load_maze(maze)
    controllers = checks.array("controllers", controllers, (None, WEIGHTS), -1, 1)
    steps = checks.integer("steps", steps, 0, checks.MOST)
    ends = np.empty((len(controllers), 2), dtype=np.int64)
    walk_all(maze.arrays, controllers, steps, walk_space(maze.shape, steps), ends)
    return ends


class WalkSpace(NamedTuple):
    """Working memory of walks; its contents mean nothing between them."""

    trail: np.ndarray  # int16, (most cells of a walk, 2): row and column of the cells that the robot has stood on
    stood_at: np.ndarray  # int64, (height, width): the time when it last stood on a cell
    clock: np.ndarray  # int64, (1,): the time, which goes on from walk to walk, so nothing needs clearing


def walk_space(shape: tuple[int, int], steps: int) -> WalkSpace:
    """Working memory for walks of `steps` steps in a maze of this shape."""
    most_cells = min(steps, shape[0] * shape[1]) + 1
    return WalkSpace(
        trail=np.empty((most_cells, 2), dtype=np.int16),
        stood_at=np.full(shape, -1, dtype=np.int64),
        clock=np.zeros(1, dtype=np.int64),
    )


# Compiled functions


@kernel
def walk(
    maze: MazeArrays, controller: np.ndarray, steps: int, trail: np.ndarray, stood_at: np.ndarray, clock: int
) -> tuple[int, int]:
    """Walk until the steps are over or the robot returns to a cell it has stood on.

    The cells go into `trail`. Returns their number, and the index of the cell to which the path has returned
    (of the last cell if it has not).

    A cell that holds less than `clock` in `stood_at` was last stood on in another walk.
    """
    walls, sensors, (row, column), _ = maze
    height, width = walls.shape
    p1, p2, p3, p4, p5, p6, p7, p8, p9, p10, p11, p12, p13, p14, p15, p16 = controller
    for step in range(steps + 1):
        r, c = index(row), index(column)
        if stood_at[r, c] >= clock:
            return step, stood_at[r, c] - clock
        stood_at[r, c] = clock + step
        trail[step, 0] = row
        trail[step, 1] = column
        s1, s2, s3, s4 = sensors[r, c, 0], sensors[r, c, 1], sensors[r, c, 2], sensors[r, c, 3]
        s5, s6, s7, s8 = sensors[r, c, 4], sensors[r, c, 5], sensors[r, c, 6], sensors[r, c, 7]
        h = p1 * s1 + p2 * s2 + p3 * s3 + p4 * s4 + p5 * s5 + p6 * s6 + p7 * s7 + p8 * s8
        v = p9 * s1 + p10 * s2 + p11 * s3 + p12 * s4 + p13 * s5 + p14 * s6 + p15 * s7 + p16 * s8
        # Branches, not selects: the processor predicts them and starts on the next step meanwhile (3 times faster).
        if h >= 0:
            if column + 1 < width and not walls[r, index(column + 1)]:
                column += 1
        elif column > 0 and not walls[r, index(column - 1)]:
            column -= 1
        c = index(column)
        if v >= 0:
            if row + 1 < height and not walls[index(row + 1), c]:
                row += 1
        elif row > 0 and not walls[index(row - 1), c]:
            row -= 1
    return steps + 1, steps


@kernel
def cell_at_step(step: int, length: int, loop_start: int) -> int:
    """The index into the trail of a walk (see `walk`) of the robot's cell at a step."""
    return step if step < length else loop_start + (step - loop_start) % (length - loop_start)


@kernel
def walk_path(
    maze: MazeArrays,
    controller: np.ndarray,
    steps: int,
    space: WalkSpace,
    cells: np.ndarray,
) -> None:
    """Put the cell of every step of one controller's walk into `cells`."""
    trail, stood_at, clock = space
    length, loop_start = walk(maze, controller, steps, trail, stood_at, clock[0])
    clock[0] += steps + 1
    for step in range(steps + 1):
        cell = cell_at_step(step, length, loop_start)
        cells[step, 0] = trail[cell, 0]
        cells[step, 1] = trail[cell, 1]


@kernel
def walk_all(
    maze: MazeArrays,
    controllers: np.ndarray,
    steps: int,
    space: WalkSpace,
    ends: np.ndarray,
    paths: Paths | None = None,
    known: np.ndarray | None = None,
) -> None:
    """Put the end of each controller's walk into `ends`, and count its path if there is room for it in `paths`.

    `known` holds the ends that are known before, which need no walk unless paths count, and -1 for others.
    """
    trail, stood_at, clock = space
    keeping = False
    if paths is not None:
        keeping = len(paths.lengths) > 0
    for i in range(len(controllers)):
        if known is not None and known[i, 0] >= 0 and not keeping:
            ends[i, 0] = known[i, 0]
            ends[i, 1] = known[i, 1]
            continue
        length, loop_start = walk(maze, controllers[i], steps, trail, stood_at, clock[0])
        clock[0] += steps + 1
        cell = cell_at_step(steps, length, loop_start)
        ends[i, 0] = trail[cell, 0]
        ends[i, 1] = trail[cell, 1]
        if paths is not None and keeping:
            keep_path(paths, i, trail, length, maze.walls.shape[1])
