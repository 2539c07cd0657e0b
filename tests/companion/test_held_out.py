import json
from dataclasses import replace

import numpy as np
import pytest

import safe
from safe.companion import held_out
from safe.companion.held_out import FAILURES, PASSED, SEEDS, SIZE, SOLVING_RUNS, UNPLACED, UNSOLVED
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


def test_a_set_is_the_first_mazes_that_pass(small, monkeypatch):
    def scripted(maze, *_):
        outcome = (UNSOLVED, PASSED, "random")[int(maze.name.removeprefix("design, candidate ")) % 3]
        return {"outcome": outcome, "runs": {"standard": (6, 0)}} | (
            {"solved": ["hopeful", 0]} if outcome == PASSED else {}
        )

    monkeypatch.setattr(held_out, "examine", scripted)
    header, *lines = map(
        json.loads, held_out.make("design", (HOPELESS, HOPEFUL), folder=small).read_text().splitlines()
    )
    drawn = {number: held_out.candidate(SEEDS["design"], number) for number in range(len(lines))}
    assert [line["number"] for line in lines] == [*drawn]
    for number, line in enumerate(lines):
        assert line["outcome"] == ((UNSOLVED, PASSED, "random")[number % 3] if drawn[number] else UNPLACED)
    passed = [number for number in drawn if drawn[number] and number % 3 == 1]
    assert (len(passed), passed[-1]) == (2, len(lines) - 1)
    mazes = held_out.design_set()
    assert mazes == [drawn[number].maze("again") for number in passed]
    assert [maze.name for maze in mazes] == ["design 1", "design 2"]
    assert header == {
        "set": "design",
        "seed": SEEDS["design"],
        "contestants": ["hopeless", "hopeful"],
        "digest": held_out.digest(mazes),
    }


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


# The record


@pytest.fixture(params=SETS)
def name(request):
    return request.param


@pytest.fixture
def lines(name):
    return held_out._recorded(name)[1]


def test_sets_have_sixty_different_mazes_that_nobody_knew(name):
    mazes = SETS[name]()
    assert [maze.name for maze in mazes] == [f"{name} {number}" for number in range(1, 61)]
    others = [
        *map(safe.load_maze, ("maze1", "maze2", "medium", "hard")),
        *SETS["test" if name == "design" else "design"](),
    ]
    assert len({*mazes, *others}) == 60 + len(others)


def test_a_set_cannot_be_changed_by_who_got_it(name):
    SETS[name]().clear()
    assert len(SETS[name]()) == SIZE


def test_recorded_mazes_are_those_that_were_certified(name):
    header, _ = held_out._recorded(name)
    assert header["digest"] == held_out.digest(SETS[name]())
    assert (header["set"], header["seed"]) == (name, SEEDS[name])
    assert header["contestants"] == [algorithm.name for algorithm, _ in held_out.CONTESTANTS]


def test_recorded_candidates_are_those_of_the_seed(name, lines):
    """Of a sample, since a candidate takes 50 ms."""
    assert [line["number"] for line in lines] == [*range(len(lines))]
    drawn = np.random.default_rng().choice(lines, 20, replace=False).tolist()
    for line in [*drawn, lines[0], lines[-1]]:
        found = held_out.candidate(SEEDS[name], line["number"])
        assert (found is None) == (line["outcome"] == UNPLACED), line["number"]
        if "walls" in line:
            assert json.loads(json.dumps(found._asdict())) == {field: line[field] for field in found._fields}


def test_certificates_hold_the_tests_that_a_candidate_came_to(name):
    table = held_out.certificates(name)
    assert set(table.outcome) == {UNPLACED, *FAILURES, UNSOLVED, PASSED}
    certified = table[table.outcome.isin([UNSOLVED, PASSED])]
    for test, runs in FAILURES.items():
        assert (certified[[f"{test}_runs", f"{test}_successes"]] == [runs, 0]).all(axis=None)
        rejected = table[table.outcome == test]
        assert (rejected[f"{test}_successes"] == 1).all()
        assert rejected[f"{test}_runs"].between(1, runs).all()
    later = table[[column for column in table if column.startswith(("random", "solving"))]]
    assert later[table.outcome.isin([UNPLACED, "standard"])].isna().all(axis=None)
    assert table.walls.notna().equals(table.outcome.isin([UNSOLVED, PASSED]))
    most = SOLVING_RUNS * len(held_out.CONTESTANTS)
    assert (table[table.outcome == UNSOLVED][["solving_runs", "solving_successes"]] == [most, 0]).all(axis=None)


def test_a_set_is_the_first_sixty_candidates_that_passed(name):
    table = held_out.certificates(name)
    passed = table[table.outcome == PASSED]
    assert passed.maze.tolist() == [maze.name for maze in SETS[name]()]
    assert passed.index[-1] == table.index[-1]
    assert (passed.solving_successes == 1).all()
    assert passed.solved_by.isin([algorithm.name for algorithm, _ in held_out.CONTESTANTS]).all()
    assert (table[table.outcome != PASSED][["maze", "solved_by"]] == "").all(axis=None)
    for maze, (_, row) in zip(SETS[name](), passed.iterrows(), strict=True):
        assert (row.distance, row.way) == (maze.distance(maze.start), ways_to_goal(maze)[maze.start])


@pytest.mark.parametrize("outcome", [*FAILURES, PASSED])
def test_a_recorded_success_can_be_made_again(name, lines, outcome):
    line = np.random.default_rng().choice([line for line in lines if line["outcome"] == outcome])
    maze = held_out.candidate(SEEDS[name], line["number"]).maze("again")
    if outcome == PASSED:
        who, run = line["solved"]
        algorithm, parameters = {contestant[0].name: contestant for contestant in held_out.CONTESTANTS}[who]
        experiment = Experiment(algorithm, maze, seed=held_out.SOLVING, parameters=parameters)
    else:
        experiment, run = Experiment(outcome, maze, seed=held_out.CERTIFYING), line["runs"][outcome][0] - 1
    for number in {run, max(run - 1, 0)}:
        made = safe.evolve(maze, experiment.algorithm, experiment.seed_sequence(number), experiment.parameters)
        assert made.success == (number == run), (line["number"], number)


def test_a_set_that_does_not_exist():
    with pytest.raises(ValueError, match="name must be one of 'design', 'test'; got 'mine'"):
        held_out.certificates("mine")


def test_the_digest_depends_on_cells_and_order():
    mazes = [safe.Maze.from_drawing(drawing) for drawing in ("S.G", "S..G")]
    assert len({held_out.digest(order) for order in (mazes, mazes[::-1], mazes[:1], mazes[1:])}) == 4
    assert held_out.digest([replace(mazes[0], name="another")]) == held_out.digest(mazes[:1])
