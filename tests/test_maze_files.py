import hashlib
import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import ndimage

from safe import Maze, load_maze
from safe.maze import ways_to_goal
from safe.maze_files import is_packaged, load_mazes, maze_names, parse_maze
from tests.helpers import maze_texts, oracle
from tests.helpers.strategies import mazes

DIGESTS = {  # of 100 lines of 100 characters: 0 open, 1 wall, 2 start, 3 goal
    "maze1": "6d6e7a511392fc8b9bc2c6ef9c0173abe4c5dc610cfd83a3dd3b939a4ccefcfc",
    "maze2": "f87e03aac30a4046da93e033a1adb64a6df2f29cee7dab8548d6b08790f8ede5",
}


@pytest.mark.parametrize("name", DIGESTS)
def test_the_papers_mazes_cell_by_cell(name):
    digits = load_maze(name).drawing("0123")
    assert hashlib.sha256(digits.encode()).hexdigest() == DIGESTS[name]


DATA = Path(__file__).parent / "data"


@pytest.mark.parametrize("name", ["medium", "hard"])
def test_lehman_and_stanleys_mazes_from_their_line_segments(name):
    maze = load_maze(name)
    assert maze == load_maze(DATA / f"{name}_maze.txt")
    assert max(maze.shape) == 100
    _, parts = ndimage.label(maze.walls, np.ones((3, 3)))
    assert parts == 1  # every wall meets another, or else a robot would slip through where theirs, 16 wide, did not
    edge = np.pad(np.zeros(np.subtract(maze.shape, 2), dtype=bool), 1, constant_values=True)
    assert (ways_to_goal(maze)[edge] < 0).all()  # what lies outside is out of reach


def test_the_mazes_that_come_along():
    assert maze_names() == ["hard", "maze1", "maze2", "medium"]


@given(mazes())
def test_a_drawing_gives_the_maze_back(maze):
    assert Maze.from_drawing(maze.drawing()) == maze
    assert parse_maze(maze.drawing("0123")) == maze


@pytest.mark.parametrize(("text", "plain"), maze_texts.SAME)
def test_texts_of_the_same_maze(text, plain):
    assert parse_maze(text) == parse_maze(plain)


def test_a_drawing_is_read_as_one_also_where_only_drawings_are():
    for text, plain in maze_texts.SAME_DRAWINGS:
        assert Maze.from_drawing(text) == Maze.from_drawing(plain)


@pytest.mark.parametrize(("text", "complaint"), maze_texts.BAD)
def test_texts_of_no_maze(text, complaint):
    with pytest.raises(ValueError, match=complaint):
        parse_maze(text)


@pytest.mark.parametrize("data", maze_texts.SAME_FILES)
def test_files_of_the_same_maze(data, tmp_path):
    (tmp_path / "small.txt").write_bytes(data)
    maze = load_maze(tmp_path / "small.txt")
    assert maze == load_maze(str(tmp_path / "small.txt")) == Maze.from_drawing(maze_texts.SMALL)
    assert maze.name == "small"


@pytest.mark.parametrize(("data", "complaint"), maze_texts.BAD_FILES)
def test_files_of_no_maze(data, complaint, tmp_path):
    (tmp_path / "noise").write_bytes(data)
    with pytest.raises(ValueError, match=complaint):
        load_maze(tmp_path / "noise")


@given(st.tuples(*[st.integers(0, 12)] * 2), st.tuples(*[st.integers(0, 12)] * 2))
def test_a_wall_is_the_cells_whose_inside_its_line_crosses(first, last):
    ends = f"{first[0]},{first[1]} {last[0]},{last[1]}"
    maze = parse_maze(f"size 14,14\nstart 13,0\ngoal 13,13\nwall {ends}")
    for cell in np.ndindex(14, 14):
        assert maze.walls[cell] == oracle.crosses(first, last, cell), cell


@pytest.mark.parametrize("name", ["maze3", "", "no/such/file", ".", "a\0b", 7, None])
def test_bad_names(name):
    with pytest.raises(ValueError, match="maze must be"):
        load_maze(name)


@pytest.mark.parametrize("text", [None, 7, b"S.G", ["S.G"]])
def test_a_maze_from_what_is_no_text(text):
    for parse in (Maze.from_drawing, parse_maze):
        with pytest.raises(ValueError, match="text must be a str; got"):
            parse(text)


@pytest.mark.parametrize("line", ["x" * 999, "wall 1,1 " + "x" * 999])
def test_a_long_line_of_a_maze_file_makes_no_long_message(line):
    with pytest.raises(ValueError, match="must be") as refused:
        parse_maze(maze_texts.GOOD + line)
    assert len(str(refused.value)) < 200


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="a pipe has a name only on Unix")
def test_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(ValueError, match=r"the path of a maze file; got .* \(not a file\)"):
        load_maze(tmp_path / "pipe")


@pytest.mark.parametrize("names", ["", "  ", None, 3, [], {"maze1": 1}])
def test_no_mazes_at_all(names):
    with pytest.raises(ValueError, match="maze must be one or more mazes, in a list or separated by blanks; got"):
        load_mazes(names)


def test_several_mazes(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("a b.txt", "c.txt"):
        Path(name).write_text(maze_texts.SMALL)

    def names(mazes):
        return [maze.name for maze in load_mazes(mazes)]

    assert names(" c.txt\tmaze2\n") == ["c", "maze2"]
    assert names(["a b.txt", Path("c.txt"), "maze2", load_maze("hard")]) == ["a b", "c", "maze2", "hard"]
    assert names("a b.txt") == ["a b"]
    Path("b.txt").write_text(maze_texts.SMALL)
    Path("a").write_text(maze_texts.SMALL)
    assert names("a b.txt") == ["a", "b"]  # as ever, if each of them is a maze
    for unknown in ("a none.txt", ["a b.txt maze2"], [["maze1"]]):
        with pytest.raises(ValueError, match="maze must be"):
            load_mazes(unknown)


def test_a_packaged_maze_has_the_cells_of_its_name():
    maze1 = load_maze("maze1")
    assert is_packaged(maze1)
    assert not is_packaged(Maze(maze1.walls, maze1.start, maze1.goal, "maze2"))
    assert not is_packaged(Maze(maze1.walls, maze1.start, maze1.goal, "mine"))
