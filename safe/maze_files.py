"""Texts to mazes: drawings in characters, lists of walls, and the files that hold either."""

from __future__ import annotations

import errno
import functools
from pathlib import Path

import numpy as np

from safe import checks
from safe.maze import LONGEST_SIDE, Maze

MAZE_FOLDER = Path(__file__).parent / "mazes"


def load_maze(name_or_path: str | Path | Maze) -> Maze:
    """A packaged maze by its name, or one from a file; a Maze is returned as it is.

    A file holds either a drawing (see `Maze.from_drawing`) or a list (see `parse_maze`).

    Raises
    ------
    ValueError
        If there is no such maze or file, or the file does not describe a maze.

    Examples
    --------
    >>> load_maze("maze1").start
    (53, 5)
    """
    if isinstance(name_or_path, Maze):
        return name_or_path
    names = maze_names()
    if not isinstance(name_or_path, str | Path):
        raise ValueError(f"maze must be a Maze, a maze's name or a file's path; got {checks.shown(name_or_path)}")
    path = MAZE_FOLDER / f"{name_or_path}.maze" if name_or_path in names else Path(name_or_path)
    try:
        if path.exists() and not path.is_file():  # reading a pipe or a device might never end
            raise OSError(errno.EINVAL, "not a file")
        text = path.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:  # ValueError: not a text file, or not a possible path
        reason = getattr(error, "strerror", None) or "not a text file"
        raise ValueError(
            f"maze must be one of {', '.join(map(repr, names))} or the path of a maze file; "
            f"got {checks.shown(str(name_or_path))} ({reason})"
        ) from None
    return parse_maze(text, name=path.stem)


def load_mazes(names: str) -> list[Maze]:
    """Several mazes: their names or paths in one text, separated by blanks.

    Examples
    --------
    >>> [maze.goal for maze in load_mazes("maze1 maze2")]
    [(41, 15), (31, 32)]
    """
    if not isinstance(names, str) or not names.strip():
        raise ValueError(f"maze must be one or more mazes, separated by blanks; got {checks.shown(names)}")
    return [load_maze(name) for name in names.split()]


def maze_names() -> list[str]:
    """The names of the mazes that come with the package."""
    return sorted(path.stem for path in MAZE_FOLDER.glob("*.maze"))


def is_packaged(maze: Maze) -> bool:
    """Is this the maze that comes with the package under its name?"""
    return packaged_mazes().get(maze.name) == maze


@functools.cache
def packaged_mazes() -> dict[str, Maze]:
    """The mazes that come with the package, by name."""
    return {name: load_maze(name) for name in maze_names()}


def parse_maze(text: str, name: str = "maze") -> Maze:
    """The maze that a text describes: a drawing, or a list such as

        # a comment
        size 100,100            height,width
        start 53,5              row,column
        goal 41,15
        wall 6,18 23,18         a straight line of cells, both ends included

    Walls run along a row, a column or a diagonal. A text is read as a list if one of its lines begins with `size`.

    Raises
    ------
    ValueError
        If the text describes no maze; the message names the line.
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
                f"got {checks.shown(key)} in line {number}"
            )
        if len(pairs) != (2 if key == "wall" else 1):
            raise ValueError(f"{key} must be followed by {_FOLLOWS[key]}; got something else in line {number}")
        places = [_pair(pair, key, number) for pair in pairs]
        if key == "wall":
            wall_lines.append((number, *places))
        elif key in single:
            raise ValueError(f"{key} must be given once; got it again in line {number}")
        else:
            single[key] = places[0]
    for key in ("size", "start", "goal"):
        if key not in single:
            raise ValueError(f"a maze file must give the {key}; got none")
    height, width = single["size"]
    if not (1 <= height <= LONGEST_SIDE and 1 <= width <= LONGEST_SIDE):
        raise ValueError(f"size must be 1 to {LONGEST_SIDE} cells a side; got {height},{width}")
    walls = np.zeros((height, width), dtype=bool)
    for number, first, last in wall_lines:
        rows, columns = _straight_line(first, last, (height, width), number)
        walls[rows, columns] = True
    return Maze(walls, single["start"], single["goal"], name)


def read_drawing(text: str, name: str) -> Maze:
    """The maze that a drawing shows; see `Maze.from_drawing`."""
    rows = [line.strip() for line in _lines(text) if line.strip()]
    if not rows:
        raise ValueError("the drawing of a maze must have at least one row; got none")
    for number, row in enumerate(rows, start=1):
        if len(row) != len(rows[0]):
            raise ValueError(
                f"the drawing of a maze must be a rectangle; got {len(row)} cells wide in row {number}, "
                f"{len(rows[0])} in row 1"
            )
        for character in row:
            if character not in _CELL_OF_SYMBOL:
                raise ValueError(
                    f"the drawing of a maze must use only {' '.join(_CELL_OF_SYMBOL)}; "
                    f"got {character!r} in row {number}"
                )
    cells = np.array([[_CELL_OF_SYMBOL[character] for character in row] for row in rows])
    ends = {}
    for end, cell in (("start", _START), ("goal", _GOAL)):
        found = np.argwhere(cells == cell)
        if len(found) != 1:
            raise ValueError(f"the drawing of a maze must have exactly one {end}; got {len(found)}")
        ends[end] = tuple(found[0])
    return Maze(cells == _WALL, ends["start"], ends["goal"], name)


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
        raise ValueError(f"text must be a str; got {checks.shown(text)}")
    return text.splitlines()


def _pair(text: str, key: str, number: int) -> tuple[int, int]:
    parts = text.split(",")
    if len(parts) != 2 or not all(part.isascii() and part.isdigit() and len(part) < 10 for part in parts):
        raise ValueError(f"{key} must be followed by {_FOLLOWS[key]}; got {checks.shown(text)} in line {number}")
    return int(parts[0]), int(parts[1])


def _straight_line(
    first: tuple[int, int], last: tuple[int, int], shape: tuple[int, int], number: int
) -> tuple[np.ndarray, np.ndarray]:
    """Rows and columns of the cells from `first` to `last`, both included."""
    for row, column in (first, last):
        if row >= shape[0] or column >= shape[1]:
            raise ValueError(
                f"wall must lie within the {shape[0]} by {shape[1]} cells; got {row},{column} in line {number}"
            )
    down, right = last[0] - first[0], last[1] - first[1]
    if down and right and abs(down) != abs(right):
        raise ValueError(f"wall must be horizontal, vertical or diagonal; got something else in line {number}")
    step = np.arange(max(abs(down), abs(right)) + 1)
    return first[0] + np.sign(down) * step, first[1] + np.sign(right) * step
