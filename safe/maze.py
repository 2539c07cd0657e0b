"""The maze: a grid of open and wall cells, a start, a goal, and what a robot senses in each cell.

Positions are (row, column), counted from 0, with (0, 0) at the top left. A robot reads eight sensors,
in the paper's order (Section 3.1):

    dist_right, goal_right, dist_left, goal_left, dist_down, goal_down, dist_up, goal_up

dist_x is how many cells one can go in direction x up to and including the first wall cell, so a wall
next to the robot reads 1; where there is no wall it is how many cells are left to the edge.
goal_down is the height of the maze if the goal lies below the robot, otherwise goal_up is;
goal_right is the width if the goal lies to the right, otherwise goal_left is; the other two are 0.

What a robot senses depends only on where it stands, so all of it is computed once, when the maze is made.
"""

from __future__ import annotations

import errno
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy import ndimage, sparse

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
MAZE_FOLDER = Path(__file__).parent / "mazes"
LONGEST_SIDE = 2048  # cells; keeps a mistyped size out of memory


class MazeArrays(NamedTuple):
    """What the compiled functions need of a maze."""

    walls: np.ndarray  # bool, (height, width), True where a wall is
    sensors: np.ndarray  # float64, (height, width, 8), in the order of SENSORS
    start: tuple[int, int]
    goal: tuple[int, int]


@dataclass(frozen=True, eq=False)
class Maze:
    """A maze, checked when it is made.

    Parameters
    ----------
    walls : array of bool, shape (height, width)
        True where a cell is wall.
    start, goal : (row, column)
        Where the robot starts and where it should end; open cells, connected by open cells.
    name : str
        A label. Two mazes with the same cells, start and goal are equal, whatever they are called.

    Raises
    ------
    ValueError
        Where the walls are no rectangle, start or goal lie outside or in a wall or coincide,
        or no way leads from one to the other.

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
                f"walls must be a rectangle of 1 to {LONGEST_SIDE} cells a side; was {checks.shown(self.walls)}"
            )
        start = _open_cell("start", self.start, walls)
        goal = _open_cell("goal", self.goal, walls)
        if start == goal:
            raise ValueError(f"goal must be another cell than the start; was {goal}, which is both")
        regions, _ = ndimage.label(~walls)
        if regions[start] != regions[goal]:
            raise ValueError(
                f"goal must be reachable from the start {start} through open cells; was {goal}, cut off by walls"
            )
        sensors = _sense_everywhere(walls, goal)
        for array in (walls, sensors):
            array.setflags(write=False)
        for attribute, value in (("walls", walls), ("start", start), ("goal", goal), ("sensors", sensors)):
            object.__setattr__(self, attribute, value)

    @classmethod
    def from_drawing(cls, text: str, name: str = "drawing") -> Maze:
        """The maze drawn in characters: `.` or `0` open, `#` or `1` wall, `S` or `2` start, `G` or `3` goal.

        One line a row; blank lines and blanks around a line do not count.

        Raises
        ------
        ValueError
            Where the drawing is ragged, holds another character, or has not one start and one goal.
        """
        rows = [line.strip() for line in _lines(text) if line.strip()]
        if not rows:
            raise ValueError("the drawing of a maze must have at least one row; was empty")
        for number, row in enumerate(rows, start=1):
            if len(row) != len(rows[0]):
                raise ValueError(
                    f"the drawing of a maze must be a rectangle; was {len(row)} cells wide in row {number}, "
                    f"{len(rows[0])} in row 1"
                )
            for character in row:
                if character not in _CELL_OF_SYMBOL:
                    raise ValueError(
                        f"the drawing of a maze must use only {' '.join(_CELL_OF_SYMBOL)}; "
                        f"was {character!r} in row {number}"
                    )
        cells = np.array([[_CELL_OF_SYMBOL[character] for character in row] for row in rows])
        ends = {}
        for end, cell in (("start", _START), ("goal", _GOAL)):
            found = np.argwhere(cells == cell)
            if len(found) != 1:
                raise ValueError(f"the drawing of a maze must have exactly one {end}; had {len(found)}")
            ends[end] = tuple(found[0])
        return cls(cells == _WALL, ends["start"], ends["goal"], name)

    def drawing(self, symbols: str = ".#SG") -> str:
        """The maze as `from_drawing` reads it; `symbols` are those for open, wall, start and goal."""
        cells = self.walls.astype(int)
        cells[self.start], cells[self.goal] = _START, _GOAL
        return "\n".join("".join(symbols[cell] for cell in row) for row in cells)

    @property
    def shape(self) -> tuple[int, int]:
        """Height and width, in cells."""
        return self.walls.shape

    @property
    def arrays(self) -> MazeArrays:
        """What the compiled functions need of this maze."""
        return MazeArrays(self.walls, self.sensors, self.start, self.goal)

    def readings(self, cell: tuple[int, int]) -> dict[str, float]:
        """What a robot in an open cell (row, column) senses, by the name of the sensor, in the order of SENSORS.

        Raises
        ------
        ValueError
            Where the cell is outside or wall.

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

    def __reduce__(self):  # made anew, and so checked again, where it is unpickled
        return Maze, (self.walls, self.start, self.goal, self.name)


def load_maze(name_or_path: str | Path | Maze) -> Maze:
    """A maze of the paper by its name, or one from a file.

    A file holds either a drawing (see `Maze.from_drawing`) or a list (see `parse_maze`).

    Examples
    --------
    >>> load_maze("maze1").start
    (53, 5)
    """
    if isinstance(name_or_path, Maze):
        return name_or_path
    names = maze_names()
    if not isinstance(name_or_path, str | Path):
        raise ValueError(f"maze must be a Maze, a maze's name or a file's path; was {checks.shown(name_or_path)}")
    path = MAZE_FOLDER / f"{name_or_path}.maze" if name_or_path in names else Path(name_or_path)
    try:
        if path.exists() and not path.is_file():  # reading a pipe or a device might never end
            raise OSError(errno.EINVAL, "not a file")
        text = path.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:  # ValueError: no text file, or no path at all
        reason = getattr(error, "strerror", None) or "not a text file"
        raise ValueError(
            f"maze must be one of {', '.join(map(repr, names))} or the path of a maze file; "
            f"was {checks.shown(str(name_or_path))} ({reason})"
        ) from None
    return parse_maze(text, name=path.stem)


def load_mazes(names: str) -> list[Maze]:
    """Mazes by their names or paths, separated by blanks.

    Examples
    --------
    >>> [maze.goal for maze in load_mazes("maze1 maze2")]
    [(41, 15), (31, 32)]
    """
    if not isinstance(names, str) or not names.strip():
        raise ValueError(f"maze must be one or more mazes, separated by blanks; was {checks.shown(names)}")
    return [load_maze(name) for name in names.split()]


def ways_to_goal(maze: Maze) -> np.ndarray:
    """How many cells it is to the goal on the shortest way through open cells, moving along rows and columns.

    Returns
    -------
    array of int, shape (height, width)
        -1 in walls, and where the goal cannot be reached from.

    Examples
    --------
    >>> ways_to_goal(Maze.from_drawing("S#G\\n...")).tolist()
    [[4, -1, 0], [3, 2, 1]]
    """
    cells = np.arange(maze.walls.size).reshape(maze.shape)
    pairs = []
    for one, other in ((np.s_[:, :-1], np.s_[:, 1:]), (np.s_[:-1], np.s_[1:])):  # side by side, one above the other
        are_open = ~maze.walls[one] & ~maze.walls[other]
        pairs.append((cells[one][are_open], cells[other][are_open]))
    first, second = np.concatenate(pairs, axis=1)
    steps = sparse.csr_array((np.ones(len(first)), (first, second)), shape=(cells.size, cells.size))
    ways = sparse.csgraph.dijkstra(steps, directed=False, indices=cells[maze.goal], unweighted=True)
    return np.where(np.isinf(ways), -1, ways).astype(int).reshape(maze.shape)


def maze_names() -> list[str]:
    """The names of the mazes that come with the package."""
    return sorted(path.stem for path in MAZE_FOLDER.glob("*.maze"))


def parse_maze(text: str, name: str = "maze") -> Maze:
    """The maze that a text describes: a drawing, or a list such as

        # a comment
        size 100,100            height,width
        start 53,5              row,column
        goal 41,15
        wall 6,18 23,18         a straight line of cells, both ends included

    Walls run along a row, a column or a diagonal. A text is a list where one of its lines begins with `size`.
    """
    lines = [line.split("#")[0].split() for line in _lines(text)]
    if not any(words and words[0] == "size" for words in lines):
        return Maze.from_drawing(text, name)
    single: dict[str, tuple[int, int]] = {}
    wall_lines = []
    for number, words in enumerate(lines, start=1):
        if not words:
            continue
        key, *pairs = words
        if key not in ("size", "start", "goal", "wall"):
            raise ValueError(
                f"a line of a maze file must begin with size, start, goal or wall; "
                f"was {checks.shown(key)} in line {number}"
            )
        if len(pairs) != (2 if key == "wall" else 1):
            raise ValueError(f"{key} must be followed by {_FOLLOWS[key]}; was not in line {number}")
        places = [_pair(pair, key, number) for pair in pairs]
        if key == "wall":
            wall_lines.append((number, *places))
        elif key in single:
            raise ValueError(f"{key} must be given once; was given again in line {number}")
        else:
            single[key] = places[0]
    for key in ("size", "start", "goal"):
        if key not in single:
            raise ValueError(f"a maze file must give the {key}; had none")
    height, width = single["size"]
    if not (1 <= height <= LONGEST_SIDE and 1 <= width <= LONGEST_SIDE):
        raise ValueError(f"size must be 1 to {LONGEST_SIDE} cells a side; was {height},{width}")
    walls = np.zeros((height, width), dtype=bool)
    for number, first, last in wall_lines:
        rows, columns = _straight_line(first, last, (height, width), number)
        walls[rows, columns] = True
    return Maze(walls, single["start"], single["goal"], name)


_OPEN, _WALL, _START, _GOAL = range(4)
_CELL_OF_SYMBOL = {
    ".": _OPEN,
    "0": _OPEN,
    "#": _WALL,
    "1": _WALL,
    "S": _START,
    "2": _START,
    "G": _GOAL,
    "3": _GOAL,
}
_FOLLOWS = {
    "size": "height,width",
    "start": "row,column",
    "goal": "row,column",
    "wall": "row,column row,column",
}


def _lines(text: str) -> list[str]:
    if not isinstance(text, str):
        raise ValueError(f"text must be a str; was {checks.shown(text)}")
    return text.splitlines()


def _pair(text: str, key: str, number: int) -> tuple[int, int]:
    parts = text.split(",")
    if len(parts) != 2 or not all(part.isascii() and part.isdigit() and len(part) < 10 for part in parts):
        raise ValueError(f"{key} must be followed by {_FOLLOWS[key]}; was {checks.shown(text)} in line {number}")
    return int(parts[0]), int(parts[1])


def _straight_line(
    first: tuple[int, int], last: tuple[int, int], shape: tuple[int, int], number: int
) -> tuple[np.ndarray, np.ndarray]:
    """Rows and columns of the cells from `first` to `last`, both included."""
    for row, column in (first, last):
        if row >= shape[0] or column >= shape[1]:
            raise ValueError(
                f"wall must lie within the {shape[0]} by {shape[1]} cells; was at {row},{column} in line {number}"
            )
    down, right = last[0] - first[0], last[1] - first[1]
    if down and right and abs(down) != abs(right):
        raise ValueError(f"wall must be horizontal, vertical or diagonal; was not in line {number}")
    step = np.arange(max(abs(down), abs(right)) + 1)
    return first[0] + np.sign(down) * step, first[1] + np.sign(right) * step


def _open_cell(name: str, cell: object, walls: np.ndarray) -> tuple[int, int]:
    height, width = walls.shape
    try:
        row, column = cell
        row, column = checks.integer("row", row, 0, height - 1), checks.integer("column", column, 0, width - 1)
    except (TypeError, ValueError):
        raise ValueError(
            f"{name} must be a (row, column) within the {height} by {width} cells; was {checks.shown(cell)}"
        ) from None
    if walls[row, column]:
        raise ValueError(f"{name} must be an open cell; was {(row, column)}, which is wall")
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
