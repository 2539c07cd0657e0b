"""The maze: a grid of open and wall cells, a start, a goal, and what a robot senses in each cell.

Positions are (row, column), counted from 0, with (0, 0) at the top left. A robot reads eight sensors,
in the order of the paper's Section 5:

    dist_right, goal_right, dist_left, goal_left, dist_down, goal_down, dist_up, goal_up

dist_x counts the cells in direction x up to and including the first wall cell, so a wall next to the robot reads 1; if
there is no wall, it counts the cells up to the edge. goal_down is the height of the maze if the goal lies below the
robot, otherwise goal_up is; goal_right is its width if the goal lies to the right, otherwise goal_left is; the other
two are 0.

The readings depend only on the cell, so they are computed once for all cells, when the maze is made.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from safe import checks

SENSORS = (
    "dist_right",
    "goal_right",
    "dist_left",
    "goal_left",
    "dist_down",
    "goal_down",
    "dist_up",
    "goal_up",
)
LONGEST_SIDE = 2048  # cells; keeps a mistyped size out of memory


class MazeArrays(NamedTuple):
    """A maze as the compiled functions take it."""

    walls: np.ndarray  # bool, (height, width), True for a wall
    sensors: np.ndarray  # float64, (height, width, 8), in the order of SENSORS
    start: tuple[int, int]
    goal: tuple[int, int]


@dataclass(frozen=True, eq=False)
class Maze:
    """A maze, checked when it is made.

    Parameters
    ----------
    walls : array of bool, shape (height, width)
        True for wall, False for open.
    start, goal : (row, column)
        Where a robot starts, and where it should end: two open cells, connected by open cells.
    name : str
        A label. Two mazes with the same cells, start and goal are equal, whatever they are called.

    Raises
    ------
    ValueError
        If the walls do not form a rectangle, if start or goal lies outside or in a wall, if they coincide, or if no
        way leads from one to the other.

    Examples
    --------
    >>> maze = Maze.from_drawing('''
    ...     #####
    ...     #S.G#
    ...     #####''')
    >>> maze.start, maze.goal, maze.shape
    ((1, 1), (1, 3), (3, 5))
    >>> dict(zip(SENSORS, maze.sensors[1, 1].tolist()))["dist_right"]
    3.0
    """

    walls: np.ndarray
    start: tuple[int, int]
    goal: tuple[int, int]
    name: str = "maze"
    sensors: np.ndarray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        checks.text("name", self.name)
        try:
            walls = np.array(self.walls, dtype=bool, order="C")
        except (TypeError, ValueError):  # rows of different lengths
            walls = np.array([], dtype=bool)
        if walls.ndim != 2 or walls.size == 0 or max(walls.shape) > LONGEST_SIDE:
            raise ValueError(
                f"walls must be a rectangle of 1 to {LONGEST_SIDE} cells a side; got {checks.shown(self.walls)}"
            )
        start = _open_cell("start", self.start, walls)
        goal = _open_cell("goal", self.goal, walls)
        if start == goal:
            raise ValueError(f"goal must differ from the start; got {goal} for both")
        if not _are_connected(start, goal, walls):
            raise ValueError(
                f"goal must be reachable from the start {start} through open cells; got {goal}, cut off by walls"
            )
        sensors = _sense_everywhere(walls, goal)
        for array in (walls, sensors):
            array.setflags(write=False)
        for attribute, value in (("walls", walls), ("start", start), ("goal", goal), ("sensors", sensors)):
            object.__setattr__(self, attribute, value)

    @classmethod
    def from_drawing(cls, text: str, name: str = "drawing") -> Maze:
        """The maze drawn in characters.

        - Open: `.` or `0`, or a blank.
        - Wall: `#`, `1`, `X`, `+`, `-` or `|`, the blocks █ ▓ ■, and all lines and corners of boxes.
        - Start: `S` or `2`.
        - Goal: `G`, `E` (the end, or exit) or `3`.

        Letters may be small. Each line is a row; blank lines, and blanks around a line, do not count.

        Blanks are open cells if one stands between two other characters of a line. Then there must be no blank line
        between rows. If the rows are not of the same length, the blanks around them are open cells, too: rows begin in
        the column of the leftmost character, and end in that of the rightmost, whether or not an editor has removed
        the blanks behind them.

        Raises
        ------
        ValueError
            If the drawing is ragged and has no blanks for open cells, if it has both blanks and `.` or `0` for them,
            if it holds another character, or if it does not have exactly one start and one goal.

        Examples
        --------
        >>> maze = Maze.from_drawing('''
        ...     +---+--
        ...     |S  |
        ...     +-+   |
        ...     |   | E
        ...     +---+--''')
        >>> print(maze.drawing())
        #######
        #S..#..
        ###...#
        #...#.G
        #######
        """
        from safe.maze_files import read_drawing  # which makes mazes, and so imports this module

        return read_drawing(text, name)

    def drawing(self, symbols: str = ".#SG") -> str:
        """The maze as `from_drawing` reads it; `symbols` are those for open, wall, start and goal."""
        cells = self.walls.astype(int)
        cells[self.start], cells[self.goal] = 2, 3  # their places in `symbols`
        return "\n".join(map("".join, np.array(list(symbols))[cells]))

    @property
    def shape(self) -> tuple[int, int]:
        """Height and width, in cells."""
        return self.walls.shape

    @property
    def arrays(self) -> MazeArrays:
        """The maze as the compiled functions take it."""
        return MazeArrays(self.walls, self.sensors, self.start, self.goal)

    def readings(self, cell: tuple[int, int]) -> dict[str, float]:
        """The sensors' readings in an open cell (row, column), by name, in the order of SENSORS.

        Raises
        ------
        ValueError
            If the cell is outside or wall.

        Examples
        --------
        >>> Maze.from_drawing("S..#\\n...G").readings((0, 1))["dist_right"]
        2.0
        """
        return dict(zip(SENSORS, self.sensors[_open_cell("cell", cell, self.walls)].tolist(), strict=True))

    def distance(self, points: np.ndarray) -> np.ndarray:
        """Taxicab distance, in cells, from points of shape (..., 2), row and column, to the goal."""
        return np.abs(np.asarray(points) - np.array(self.goal)).sum(axis=-1)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Maze):
            return NotImplemented
        return (self.start, self.goal) == (other.start, other.goal) and np.array_equal(self.walls, other.walls)

    def __hash__(self) -> int:
        return hash((self.shape, self.walls.tobytes(), self.start, self.goal))

    def __reduce__(self):  # unpickling makes a new maze, and so checks it
        return Maze, (self.walls, self.start, self.goal, self.name)


def ways_to_goal(maze: Maze) -> np.ndarray:
    """The length, in cells, of the shortest way from each cell to the goal, along rows and columns of open cells.

    Returns
    -------
    array of int, shape (height, width)
        -1 for walls, and for cells that no way connects with the goal.

    Examples
    --------
    >>> ways_to_goal(Maze.from_drawing("S#G\\n...")).tolist()
    [[4, -1, 0], [3, 2, 1]]
    """
    from scipy import sparse  # few programs need it, and its import takes longer than all others

    cells = np.arange(maze.walls.size).reshape(maze.shape)
    pairs = []
    for one, other in ((np.s_[:, :-1], np.s_[:, 1:]), (np.s_[:-1], np.s_[1:])):  # side by side, one above the other
        are_open = ~maze.walls[one] & ~maze.walls[other]
        pairs.append((cells[one][are_open], cells[other][are_open]))
    first, second = np.concatenate(pairs, axis=1)
    steps = sparse.csr_array((np.ones(len(first)), (first, second)), shape=(cells.size, cells.size))
    ways = sparse.csgraph.dijkstra(steps, directed=False, indices=cells[maze.goal], unweighted=True)
    return np.where(np.isinf(ways), -1, ways).astype(int).reshape(maze.shape)


def _are_connected(start: tuple[int, int], goal: tuple[int, int], walls: np.ndarray) -> bool:
    """Does a way through open cells lead from start to goal? Without scipy, whose import takes longer."""
    width = walls.shape[1] + 2
    is_new = np.pad(~walls, 1).ravel().tolist()
    first, last = ((row + 1) * width + column + 1 for row, column in (start, goal))
    waiting = [first]
    is_new[first] = False
    while waiting and is_new[last]:
        cell = waiting.pop()
        for neighbour in (cell - width, cell - 1, cell + 1, cell + width):
            if is_new[neighbour]:
                is_new[neighbour] = False
                waiting.append(neighbour)
    return not is_new[last]


def _open_cell(name: str, cell: object, walls: np.ndarray) -> tuple[int, int]:
    height, width = walls.shape
    try:
        row, column = cell
        row, column = checks.integer("row", row, 0, height - 1), checks.integer("column", column, 0, width - 1)
    except (TypeError, ValueError):
        raise ValueError(
            f"{name} must be a (row, column) within the {height} by {width} cells; got {checks.shown(cell)}"
        ) from None
    if walls[row, column]:
        raise ValueError(f"{name} must be an open cell; got {(row, column)}, which is wall")
    return row, column


def _sense_everywhere(walls: np.ndarray, goal: tuple[int, int]) -> np.ndarray:
    """The eight sensors of every cell: float64, (height, width, 8), in the order of SENSORS."""
    height, width = walls.shape
    below = (goal[0] > np.arange(height))[:, np.newaxis]
    right = (goal[1] > np.arange(width))[np.newaxis, :]
    reading = {
        "dist_left": _cells_to_the_left(walls),
        "dist_right": _cells_to_the_left(walls[:, ::-1])[:, ::-1],
        "dist_up": _cells_to_the_left(walls.T).T,
        "dist_down": _cells_to_the_left(walls[::-1].T).T[::-1],
        "goal_down": height * below,
        "goal_up": height * ~below,
        "goal_right": width * right,
        "goal_left": width * ~right,
    }
    sensors = np.empty((height, width, len(SENSORS)))  # not integers: converting them would cost a fifth of a walk
    for index, sensor in enumerate(SENSORS):
        sensors[:, :, index] = reading[sensor]
    return sensors


def _cells_to_the_left(walls: np.ndarray) -> np.ndarray:
    """How many cells one can go left up to and including the first wall, or else up to the edge."""
    distance = np.zeros(walls.shape, dtype=np.int16)
    for column in range(1, walls.shape[1]):
        distance[:, column] = np.where(walls[:, column - 1], 1, distance[:, column - 1] + 1)
    return distance
