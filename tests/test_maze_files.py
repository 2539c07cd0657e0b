import hashlib
import os

import pytest
from hypothesis import given

from safe import Maze, load_maze
from safe.maze_files import is_packaged, load_mazes, maze_names, parse_maze
from tests.helpers.maze_texts import BAD_DRAWINGS, BAD_LISTS, GOOD
from tests.helpers.strategies import mazes

DIGESTS = {  # of 100 lines of 100 characters: 0 open, 1 wall, 2 start, 3 goal
    "maze1": "6d6e7a511392fc8b9bc2c6ef9c0173abe4c5dc610cfd83a3dd3b939a4ccefcfc",
    "maze2": "f87e03aac30a4046da93e033a1adb64a6df2f29cee7dab8548d6b08790f8ede5",
}


@pytest.mark.parametrize("name", DIGESTS)
def test_the_papers_mazes_cell_by_cell(name):
    digits = load_maze(name).drawing("0123")
    assert hashlib.sha256(digits.encode()).hexdigest() == DIGESTS[name]


def test_the_papers_mazes_are_the_ones_that_come_along():
    assert maze_names() == sorted(DIGESTS)


@given(mazes())
def test_a_drawing_gives_the_maze_back(maze):
    assert Maze.from_drawing(maze.drawing()) == maze
    assert parse_maze(maze.drawing("0123")) == maze


def test_a_list_and_a_drawing_give_the_same_maze(tmp_path):
    text = "# three walls\nsize 4,5\nstart 0,0\ngoal 3,4\nwall 0,1 2,3  # a diagonal\nwall 3,0 3,1\nwall 1,0 1,0\n"
    drawing = "S#...\n#.#..\n...#.\n##..G"
    with pytest.raises(ValueError, match="goal must be reachable"):
        parse_maze(text)
    text, drawing = text.replace("wall 1,0 1,0\n", ""), drawing.replace("#.#..", "..#..")
    (tmp_path / "m.txt").write_text(text)
    (tmp_path / "d.txt").write_text(drawing)
    assert load_maze(tmp_path / "m.txt") == load_maze(str(tmp_path / "d.txt")) == Maze.from_drawing(drawing)
    assert load_maze(tmp_path / "m.txt").name == "m"


@pytest.mark.parametrize(("text", "complaint"), BAD_DRAWINGS)
def test_bad_drawings(text, complaint):
    with pytest.raises(ValueError, match=complaint):
        Maze.from_drawing(text)


@pytest.mark.parametrize(("text", "complaint"), BAD_LISTS)
def test_bad_lists(text, complaint):
    with pytest.raises(ValueError, match=complaint):
        parse_maze(text)


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
        parse_maze(GOOD + line)
    assert len(str(refused.value)) < 200


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="a pipe has a name only on Unix")
def test_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(ValueError, match=r"the path of a maze file; got .* \(not a file\)"):
        load_maze(tmp_path / "pipe")


def test_a_file_that_is_no_text(tmp_path):
    (tmp_path / "noise").write_bytes(bytes(range(128, 256)))
    with pytest.raises(ValueError, match=r"maze must be one of 'maze1', 'maze2' or the path .* \(not a text file\)"):
        load_maze(tmp_path / "noise")


@pytest.mark.parametrize("names", ["", "  ", None, 3])
def test_no_mazes_at_all(names):
    with pytest.raises(ValueError, match="maze must be one or more mazes, separated by blanks; got"):
        load_mazes(names)


def test_a_packaged_maze_has_the_cells_of_its_name():
    maze1 = load_maze("maze1")
    assert is_packaged(maze1)
    assert not is_packaged(Maze(maze1.walls, maze1.start, maze1.goal, "maze2"))
    assert not is_packaged(Maze(maze1.walls, maze1.start, maze1.goal, "mine"))
