"""Texts to mazes: drawings in characters, lists of walls, line segments, and the files that hold them."""

from __future__ import annotations

import errno
import functools
import itertools
import math
import os
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from safe import checks
from safe.maze import LONGEST_SIDE, Maze

MAZE_FOLDER = Path(__file__).parent / "mazes"


def load_maze(name_or_path: str | Path | Maze) -> Maze:
    """A packaged maze by its name, or one from a file; a Maze is returned as it is.

    `parse_maze` says what a file may hold. It is read as UTF-16 if it begins with a byte order mark of it, otherwise as
    UTF-8. Bytes that are neither, such as accents in Windows-1252, are accepted in comments.

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
        data = path.read_bytes()
    except (OSError, ValueError) as error:  # ValueError: not a possible path
        reason = getattr(error, "strerror", None) or "not a path"
        raise ValueError(
            f"maze must be one of {', '.join(map(repr, names))} or the path of a maze file; "
            f"got {checks.shown(str(name_or_path))} ({reason})"
        ) from None
    return parse_maze(text_of(data), name=path.stem)


def load_mazes(names: str | list[str | Path | Maze]) -> list[Maze]:
    """Several mazes: a list of names or paths, or all in one text, separated by blanks.

    A text that is the path of one file, blanks included, stands for this file, unless all its words are mazes.

    Raises
    ------
    ValueError
        If there are none, or if `load_maze` refuses one.

    Examples
    --------
    >>> [maze.goal for maze in load_mazes("maze1 maze2")]
    [(41, 15), (31, 32)]
    >>> [maze.name for maze in load_mazes(["medium", "hard"])]
    ['medium', 'hard']
    """
    listed = names
    if isinstance(names, str):
        listed = names.split()
        are_mazes = all(name in maze_names() or os.path.isfile(name) for name in listed)
        if os.path.isfile(names) and not are_mazes:
            listed = [names]
    if not isinstance(listed, list | tuple) or not listed:
        raise ValueError(f"maze must be one or more mazes, in a list or separated by blanks; got {checks.shown(names)}")
    return [load_maze(name) for name in listed]


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


def text_of(data: bytes) -> str:
    """The text in a file: UTF-16 after a byte order mark of it, otherwise UTF-8, with U+FFFD for what is neither."""
    encoding = {b"\xff\xfe": "utf-16-le", b"\xfe\xff": "utf-16-be"}.get(data[:2], "utf-8")
    return data.decode(encoding, "replace")


def parse_maze(text: str, name: str = "maze") -> Maze:
    """The maze that a text describes: a list, line segments, or a drawing.

    - A list gives the size, the start, the goal and the walls. A wall is a straight line from the centre of a cell to
      the centre of another: every cell whose inside it crosses is wall, so no robot slips through. A text is a list if
      one of its lines begins with `size`.
    - Line segments are the form of Lehman and Stanley's maze files (Evolutionary Computation 19(2), 2011, doi
      10.1162/EVCO_a_00025). Each line holds numbers: how many walls there are; the start, x and y; the robot's heading;
      the goal, x and y; then for each wall its two ends, x y x y. x counts to the right, y downwards. Single numbers
      before the first, the heading, and a second point after the goal are ignored. The longer side of the rectangle
      around all points becomes 100 cells: a point at a distance d from its left edge lies in column
      99 d / (longer side), rounded, halves up; rows likewise, from its upper edge. Walls then run from cell to cell, as
      in a list. A text is line segments if it holds nothing but numbers, and several in some line.
    - Any other text is a drawing, see `Maze.from_drawing`.

    In the first two, `#` begins a comment, and there may be blanks around commas. In all, any end of line will do;
    non-breaking, full-width and all other blanks count as blanks; byte order marks do not count, nor does anything from
    a ^Z on, which once ended files.

    Raises
    ------
    ValueError
        If the text describes no maze; the message says where.

    Examples
    --------
    >>> maze = parse_maze('''
    ...     # a list
    ...     size 4,5            # height,width
    ...     start 0,0           # row,column, counted from 0 at the top left
    ...     goal 3,4
    ...     wall 1,0 1,3        # from cell to cell, both included
    ...     wall 2,2 3,3''')
    >>> print(maze.drawing())
    S....
    ####.
    ..#..
    ...#G
    >>> maze = parse_maze('''
    ...     3                   # walls
    ...     10 10               # the start
    ...     0                   # the heading
    ...     10 90               # the goal
    ...     0 0 100 0           # the walls
    ...     0 50 70.5 50
    ...     0 100 100 100''')
    >>> maze.shape, maze.start, maze.goal, int(maze.walls[50].sum())
    ((100, 100), (10, 10), (89, 10), 71)
    """
    lines = [line.split("#")[0] for line in _lines(text)]
    if "\0" in text:
        raise ValueError("a maze file must be text in UTF-8, or in UTF-16 with a byte order mark; got NUL characters")
    if any(line.split()[:1] == ["size"] for line in lines):
        return _read_list([",".join(map(str.strip, line.split(","))).split() for line in lines], name)
    numbers = [words for line in lines if (words := line.replace(",", " ").split())]
    if all(_NUMBER.fullmatch(word) for words in numbers for word in words) and any(len(words) > 1 for words in numbers):
        return _read_segments([list(map(float, words)) for words in numbers], name)
    return read_drawing(text, name)


def read_drawing(text: str, name: str) -> Maze:
    """The maze that a drawing shows; see `Maze.from_drawing`."""
    lines = _lines(text)
    drawn = [number for number, line in enumerate(lines) if line.strip()]
    if not drawn:
        raise ValueError("the drawing of a maze must have at least one row; got none")
    rows = [lines[number].strip() for number in drawn]
    for number, row in enumerate(rows, start=1):
        for character in row:
            if character not in _CELL_OF_SYMBOL:
                raise ValueError(
                    "a maze must be a drawing in . 0 or blanks (open), # 1 X + - | or blocks (wall), S 2 (start) and "
                    f"G E 3 (goal), or a list that gives its size, or line segments; got {character!r} in row {number}"
                )
    if any(" " in row for row in rows):
        rows = _rows_with_blanks(rows, lines, drawn)
    for number, row in enumerate(rows, start=1):
        if len(row) != len(rows[0]):
            raise ValueError(
                f"the drawing of a maze must be a rectangle; got {len(row)} cells wide in row {number}, "
                f"{len(rows[0])} in row 1"
            )
    cells = np.array([[_CELL_OF_SYMBOL[character] for character in row] for row in rows])
    ends = {}
    for end, cell in (("start", _START), ("goal", _GOAL)):
        found = np.argwhere(cells == cell)
        if len(found) != 1:
            raise ValueError(f"the drawing of a maze must have exactly one {end}; got {len(found)}")
        ends[end] = tuple(found[0])
    _check_sides("the drawing of a maze", *cells.shape)
    return Maze(cells == _WALL, ends["start"], ends["goal"], name)


_OPEN, _WALL, _START, _GOAL = range(4)
_SYMBOLS = {
    _OPEN: ".0 ",
    _WALL: "#1Xx+-|█▓■" + "".join(map(chr, range(0x2500, 0x2580))),  # the last: lines and corners of boxes
    _START: "S2s",
    _GOAL: "G3gEe",  # E: the end, or exit
}
_CELL_OF_SYMBOL = {symbol: cell for cell, symbols in _SYMBOLS.items() for symbol in symbols}
_FOLLOWS = {
    "size": "height,width",
    "start": "row,column",
    "goal": "row,column",
    "wall": "row,column row,column",
}
_NUMBER = re.compile(r"[+-]?[0-9]{1,9}(\.[0-9]{0,20})?(e[+-]?[0-9]{1,2})?")
_SEGMENTS_SIDE = 100  # cells on the longer side of a maze of line segments


def _lines(text: str) -> list[str]:
    """The lines of a text, with all blanks but tabs as spaces."""
    if not isinstance(text, str):
        raise ValueError(f"text must be a str; got {checks.shown(text)}")
    text = text.replace("\ufeff", "").split("\x1a")[0]
    return [re.sub(r"[^\S\t]", " ", line) for line in text.splitlines()]


def _rows_with_blanks(rows: list[str], lines: list[str], drawn: list[int]) -> list[str]:
    """The rows of a drawing in which blanks are open cells, from those without the blanks around them.

    `drawn` counts, from 0, its lines that are not blank.
    """
    for number, row in enumerate(rows, start=1):
        if "." in row or "0" in row:
            raise ValueError(
                "the drawing of a maze must show open cells by blanks, or by . and 0; "
                f"got blanks, and one of these in row {number}"
            )
    for number, following in itertools.pairwise(drawn):
        if following != number + 1:
            raise ValueError(
                "the drawing of a maze must have no blank line between its rows if blanks are open cells; "
                f"got one in line {number + 2}"
            )
    if len({len(row) for row in rows}) == 1:
        return rows
    rows = [lines[number].rstrip() for number in drawn]
    indent = min(len(row) - len(row.lstrip()) for row in rows)
    rows = [row[indent:] for row in rows]
    for number, row in enumerate(rows, start=1):
        if "\t" in row:
            raise ValueError(
                "the drawing of a maze must be indented by the same tabs in all rows if blanks are open cells; "
                f"got another in row {number}"
            )
    width = max(map(len, rows))
    return [row.ljust(width) for row in rows]


def _read_list(lines: list[list[str]], name: str) -> Maze:
    """The maze of a list, given by the words of each line."""
    single: dict[str, tuple[int, int]] = {}
    wall_lines = []
    for number, words in enumerate(lines, start=1):
        if not words:
            continue
        key, *pairs = words
        if key not in _FOLLOWS:
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
    _check_sides("size", height, width)
    for number, *ends in wall_lines:
        for row, column in ends:
            if row >= height or column >= width:
                raise ValueError(
                    f"wall must lie within the {height} by {width} cells; got {row},{column} in line {number}"
                )
    return Maze(_walls(height, width, [ends for _, *ends in wall_lines]), single["start"], single["goal"], name)


def _check_sides(name: str, height: int, width: int) -> None:
    if not (1 <= height <= LONGEST_SIDE and 1 <= width <= LONGEST_SIDE):
        raise ValueError(f"{name} must be 1 to {LONGEST_SIDE} cells a side; got {height},{width}")


def _pair(text: str, key: str, number: int) -> tuple[int, int]:
    parts = text.split(",")
    if len(parts) != 2 or not all(part.isascii() and part.isdigit() and len(part) < 10 for part in parts):
        raise ValueError(f"{key} must be followed by {_FOLLOWS[key]}; got {checks.shown(text)} in line {number}")
    return int(parts[0]), int(parts[1])


def _read_segments(lines: list[list[float]], name: str) -> Maze:
    """The maze of line segments, given by the numbers of each line."""
    counts = [len(numbers) for numbers in lines]
    before = counts.index(2) if 2 in counts else 0  # lines before the start
    after = before + (4 if counts[before + 3 : before + 4] == [2] else 3)  # lines before the walls
    if counts != [1] * before + [2, 1, 2, 2][: after - before] + [4] * (len(lines) - after) or not before:
        raise ValueError(
            "line segments must be lines of 1, 2, 1, 2 and then 4 numbers: how many, start, heading, goal, the ends of "
            f"each; got {checks.shown(counts)} numbers"
        )
    (said,), start, _, goal = lines[before - 1 : before + 3]
    if said != len(lines) - after:
        raise ValueError(f"line segments must be as many as the line before the start says; got {len(lines) - after}")
    points = [start, goal, *(ends[i : i + 2] for ends in lines[after:] for i in (0, 2))]
    left, top = map(min, zip(*points, strict=True))
    right, bottom = map(max, zip(*points, strict=True))
    longer = max(right - left, bottom - top) or 1  # or else all points are the same, and so in cell (0, 0)
    start, goal, *ends = (
        tuple(math.floor((_SEGMENTS_SIDE - 1) * distance / longer + 0.5) for distance in (y - top, x - left))
        for x, y in [*points, (right, bottom)]
    )
    height, width = (last + 1 for last in ends.pop())
    return Maze(_walls(height, width, zip(ends[::2], ends[1::2], strict=True)), start, goal, name)


def _walls(height: int, width: int, lines: Iterable[tuple[tuple[int, int], tuple[int, int]]]) -> np.ndarray:
    """The walls, array of bool, of lines from cell to cell."""
    walls = np.zeros((height, width), dtype=bool)
    for first, last in lines:
        for cell in _cells_between(first, last):
            walls[cell] = True
    return walls


def _cells_between(first: tuple[int, int], last: tuple[int, int]) -> Iterator[tuple[int, int]]:
    """The cells whose inside the line between the centres of two cells crosses, these two included."""
    (row, column), (last_row, last_column) = first, last
    height, width = abs(last_row - row), abs(last_column - column)
    down, right = (1 if last_row > row else -1), (1 if last_column > column else -1)
    i = j = 0
    yield first
    while (i, j) != (height, width):
        side = (2 * i + 1) * width - (2 * j + 1) * height  # through which it leaves a cell: < 0 below, > 0 beside
        i += side <= 0
        j += side >= 0
        yield row + i * down, column + j * right
