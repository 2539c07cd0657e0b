import json

import numpy as np
import pytest

import safe
from safe.companion import held_out
from safe.companion.held_out import PASSED, SEEDS, UNSOLVED
from safe.experiments.experiment import Experiment
from safe.maze import ways_to_goal

SETS = {"design": held_out.design_set, "test": held_out.test_set}
DRAWN = [found for number in range(20) if (found := held_out.candidate(5, number))]
NOVELTY = safe.ALGORITHMS["novelty"]


# Candidates


def test_walls_are_straight_and_half_of_them_begin_at_the_end_of_an_earlier_one():
    directions = set()
    for found in DRAWN:
        assert 25 <= len(found.walls) <= 40
        for row, column, last_row, last_column in found.walls:
            down, right = last_row - row, last_column - column
            assert 0 in (down, right) or abs(down) == abs(right)
            assert 8 <= max(abs(down), abs(right)) + 1 <= 40
            directions.add((np.sign(down), np.sign(right)))
        for number in range(1, len(found.walls), 2):
            assert found.walls[number][:2] in [wall[2:] for wall in found.walls[:number]]
    assert len(directions) == 8


def test_the_maze_has_a_border_and_these_walls_and_nothing_else():
    for found in DRAWN:
        walls = np.zeros((100, 100), dtype=bool)
        walls[0] = walls[-1] = walls[:, 0] = walls[:, -1] = True
        for row, column, last_row, last_column in found.walls:
            for i in range(max(abs(last_row - row), abs(last_column - column)) + 1):
                walls[row + i * np.sign(last_row - row), column + i * np.sign(last_column - column)] = True
        assert found.maze("drawn") == safe.Maze(walls, found.start, found.goal)


def test_the_way_to_the_goal_is_long():
    for found in DRAWN:
        maze = found.maze("drawn")
        assert found.distance == maze.distance(maze.start)
        assert found.way == ways_to_goal(maze)[maze.start]
        assert 20 <= found.distance <= 90
        assert max(100, 2 * found.distance) <= found.way <= 400


def test_no_robot_succeeds_on_the_other_side_of_a_wall():
    for found in DRAWN:
        (row, column), walls = found.goal, found.maze("drawn").walls
        near = [(i, j) for i in range(-2, 3) for j in range(-2, 3) if abs(i) + abs(j) <= 2]
        assert not any(walls[row + i, column + j] for i, j in near)


def test_some_candidates_have_no_start_and_goal_and_are_none():
    assert 0 < len(DRAWN) < 20


def test_a_candidate_follows_from_the_seed_and_its_number_alone():
    backwards = [found for number in reversed(range(20)) if (found := held_out.candidate(5, number))]
    assert backwards[::-1] == DRAWN
    others = [found for number in range(20) if (found := held_out.candidate(6, number))]
    assert len({found.maze("drawn") for found in DRAWN + others}) == len(DRAWN + others)


# Tests that a maze must pass


TRAP = safe.load_maze("maze1")
SHORT = safe.Parameters(generations=40)
LONG = safe.Parameters(admission="random", crossover=0, mutation=1, generations=500)
HOPELESS = safe.Algorithm("hopeless", objectives=[(1, 0)]), SHORT
HOPEFUL = safe.Algorithm("hopeful", objectives=[(0, 1)]), LONG


@pytest.fixture
def few(monkeypatch):
    """Fewer runs, for all tests."""
    monkeypatch.setattr(held_out, "FAILURES", {"standard": 6, "random": 5})
    monkeypatch.setattr(held_out, "SOLVING_RUNS", 3)


def first_success(experiment):
    """By running them one after the other."""
    for number in range(experiment.runs):
        if safe.evolve(experiment.maze, experiment.algorithm, experiment.seed_sequence(number)).success:
            return number
    return None


@pytest.mark.parametrize("drawing", ["S....G", "S...\n.##.\n...G"])
def test_a_maze_in_which_closeness_leads_to_the_goal_is_rejected_at_once(few, drawing):
    found = held_out.examine(safe.Maze.from_drawing(drawing), (HOPEFUL,))
    assert found == {"outcome": "standard", "runs": {"standard": (1, 1)}}


def test_the_first_success_counts(monkeypatch):
    """The same one, however many runs are made at a time; and it must be within the number of runs."""
    medium = safe.load_maze("medium")
    first = first_success(Experiment("random", medium, 60, held_out.CERTIFYING))
    assert first > 4
    monkeypatch.setattr(held_out, "FAILURES", {"random": first + 1})
    for portions in ((), (4, 16), (first,), (first + 1,), (first + 9,)):
        monkeypatch.setattr(held_out, "_PORTIONS", portions)
        assert held_out.examine(medium, ()) == {"outcome": "random", "runs": {"random": (first + 1, 1)}}
    monkeypatch.setattr(held_out, "FAILURES", {"random": first})
    assert held_out.examine(medium, ())["outcome"] == UNSOLVED


def test_contestants_try_one_after_the_other_until_one_succeeds(few):
    certified = {"standard": (6, 0), "random": (5, 0)}
    found = held_out.examine(TRAP, (HOPELESS, HOPEFUL, HOPELESS))
    first = found["solved"][1]
    assert found == {
        "outcome": PASSED,
        "runs": certified | {"solving": (3 + first + 1, 1)},
        "solved": ["hopeful", first],
    }
    assert held_out.examine(TRAP, (HOPEFUL,))["solved"] == found["solved"]
    assert held_out.examine(TRAP, (HOPELESS,)) == {"outcome": UNSOLVED, "runs": certified | {"solving": (3, 0)}}


# Making


@pytest.fixture
def small(few, monkeypatch, tmp_path):
    """Sets of two mazes, made in a temporary folder, and read there."""
    monkeypatch.setattr(held_out, "SIZE", 2)
    monkeypatch.setattr(held_out, "FOLDER", tmp_path)
    held_out._mazes.cache_clear()
    yield tmp_path
    held_out._mazes.cache_clear()


def test_a_set_is_made_and_read(small):
    path = held_out.make("design", (HOPELESS, HOPEFUL), small / "store.sqlite", folder=small)
    header, *lines = map(json.loads, path.read_text().splitlines())
    mazes = held_out.design_set()
    assert [maze.name for maze in mazes] == ["design 1", "design 2"]
    assert header == {
        "set": "design",
        "seed": SEEDS["design"],
        "contestants": ["hopeless", "hopeful"],
        "digest": held_out.digest(mazes),
    }
    assert [line["number"] for line in lines] == [*range(len(lines))]
    passed = [line["number"] for line in lines if line["outcome"] == PASSED]
    assert mazes == [held_out.candidate(SEEDS["design"], number).maze("again") for number in passed]
    assert passed[-1] == len(lines) - 1


def test_making_continues_where_it_was_interrupted(small, monkeypatch):
    store = small / "store.sqlite"
    made = held_out.make("design", (HOPEFUL,), store, folder=small).read_text()
    numbers, examined = iter(range(3)), held_out.examine

    def interrupted(*arguments):
        if next(numbers) == 2:
            raise KeyboardInterrupt
        return examined(*arguments)

    store.unlink()
    monkeypatch.setattr(held_out, "examine", interrupted)
    with pytest.raises(KeyboardInterrupt):
        held_out.make("design", (HOPEFUL,), store, folder=small)
    monkeypatch.setattr(held_out, "examine", examined)
    assert held_out.make("design", (HOPEFUL,), store, folder=small).read_text() == made
    monkeypatch.setattr("safe.experiments.experiment.Dispatcher", None)  # computes runs
    assert held_out.make("design", (HOPEFUL,), store, folder=small).read_text() == made
