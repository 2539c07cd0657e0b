"""Unseen mazes: a design set and a test set of 60 deceptive mazes each, for algorithms that were not made for them.

    python -m safe.companion.held_out      makes both sets again

A set is made from its seed (SEEDS), candidate by candidate, numbered from 0. Each candidate draws from a stream of its
own, `Generator(SFC64(SeedSequence(seed, spawn_key=(number,))))`, and only by `random()`: an integer from low to high is
low + int(random() * (high - low + 1)). In this order:

1. The number of walls, 25 to 40. The maze has 100 by 100 cells, and its border is wall, too.
2. Each wall. The first, third, ... begin anywhere within the border: row, column. The others begin at the last cell of
   an earlier wall: its number. Then the direction (DIRECTIONS) and the length, 8 to 40 cells. A wall ends at the border
   at the latest. If that leaves fewer than 8 cells, all of it is drawn again.
3. Goal and start, each as row and column within the border, up to 100 times, until both are open cells, the goal
   without a wall within 2 cells (or else a robot would succeed on the other side of it), 20 to 90 cells apart by
   taxicab distance, and 100 to 400 by the shortest way, which has at least twice the distance. If no pair is like
   that, the candidate is rejected.

Then it must pass three tests, which are runs of experiments with seeds for nothing else; the first success ends a test:

1. None of 60 runs of the standard EA succeeds.
2. None of 150 runs of random search succeeds.
3. It is solvable: one of five contestants (CONTESTANTS) succeeds in one of 4 runs with five times the evaluations.

The set is the first 60 that pass, in the order of their numbers. All candidates up to the last of these are recorded in
the folder `held_out`, in one file of JSON lines for each set: what became of a candidate, and the maze if it passed the
first two tests.
"""

from __future__ import annotations

import argparse
import functools
import hashlib
import json
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy import ndimage

from safe import checks
from safe.algorithms import Algorithm, Parameters
from safe.experiments.experiment import Experiment, run
from safe.experiments.progress import bar
from safe.maze import Maze, ways_to_goal
from safe.maze_files import parse_maze

FOLDER = Path(__file__).with_name("held_out")
SEEDS = {"design": 7001, "test": 7002}  # of the candidates, by set
SIZE = 60  # mazes in a set
SIDE = 100  # cells
WALLS, LENGTHS = (25, 40), (8, 40)  # how many, and how long, both ends included
DIRECTIONS = ((0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1))  # rows and columns of a step
PAIRS = 100  # of start and goal that are drawn before a candidate is rejected
DISTANCES, WAYS = (20, 90), (100, 400)  # from the start to the goal: taxicab, and by the shortest way
DETOUR = 2  # times the distance that the way must have at least

Contestants = Sequence[tuple[Algorithm, Parameters]]

CERTIFYING, SOLVING = 7100, 7200  # seeds of the experiments of the first two tests, and of the third
FAILURES = {"standard": 60, "random": 150}  # algorithms that must not succeed, and in how many runs
_LONGER = Parameters(admission="random", crossover=0, mutation=1, generations=2500)
_WEIGHING = {"components": ("1 / distance", "novelty", "path rarity"), "scaling": "rank"}
_FAVOURITES = {"judging": "favourite", "pool": "repertoire"}
CONTESTANTS: Contestants = tuple(
    (Algorithm(name, **fields), _LONGER)
    for name, fields in {
        "novelty search": {"objectives": [(0, 1)]},
        "weighing": _WEIGHING | {"judging": "drawn judge"},
        "goals": _FAVOURITES | {"kind": "goal", "rating": "patience"},
        "goals and weighing": _FAVOURITES | {"kind": "mixed"} | _WEIGHING,
        "path rarity": {"components": ("path rarity",), "objectives": [(1,)]},
    }.items()
)
SOLVING_RUNS = 4  # of each contestant at most
_PORTIONS = (4, 16)  # runs after which it is looked whether one has succeeded

UNPLACED, UNSOLVED, PASSED = "no start and goal", "not solved", "passed"  # outcomes, besides the names in FAILURES


class Candidate(NamedTuple):
    """A maze that was drawn; a wall is the row and column of its first cell, and those of its last."""

    walls: list[list[int]]
    start: tuple[int, int]
    goal: tuple[int, int]
    distance: int  # from start to goal, taxicab, in cells
    way: int  # the same by the shortest way

    def maze(self, name: str) -> Maze:
        """The maze, with its border."""
        last = SIDE - 1
        border = [[0, 0, 0, last], [last, 0, last, last], [0, 0, last, 0], [0, last, last, last]]
        lines = [f"size {SIDE},{SIDE}", "start {},{}".format(*self.start), "goal {},{}".format(*self.goal)]
        return parse_maze("\n".join([*lines, *("wall {},{} {},{}".format(*w) for w in border + self.walls)]), name)


# What others use


def design_set() -> list[Maze]:
    """The mazes on which algorithms may be designed: "design 1" to "design 60"."""
    return list(_mazes("design"))


def test_set() -> list[Maze]:
    """The mazes that no algorithm was designed on: "test 1" to "test 60"."""
    return list(_mazes("test"))


def certificates(name: str) -> pd.DataFrame:
    """What became of the candidates of a set, in the order of their numbers.

    Parameters
    ----------
    name : {"design", "test"}

    Returns
    -------
    pandas.DataFrame, one row for each candidate, indexed by its number
        outcome ("passed", "not solved", "no start and goal", or the algorithm of the paper that succeeds), maze (its
        name in the set, or ""), walls (how many), distance, way (both in cells), and of each test how many runs were
        made and how many succeeded: standard_runs, standard_successes, random_runs, random_successes, solving_runs,
        solving_successes; solved_by (the contestant that did, or ""). What was not found out is missing.
    """
    rows, names = [], iter(range(1, SIZE + 1))
    for line in _recorded(name)[1]:
        row = {
            "number": line["number"],
            "outcome": line["outcome"],
            "maze": "",
            "solved_by": line.get("solved", [""])[0],
        }
        if line["outcome"] == PASSED:
            row["maze"] = f"{name} {next(names)}"
        if "walls" in line:
            row |= {"walls": len(line["walls"]), "distance": line["distance"], "way": line["way"]}
        for test, (runs, successes) in line["runs"].items():
            row |= {f"{test}_runs": runs, f"{test}_successes": successes}
        rows.append(row)
    columns = [f"{test}_{counted}" for test in (*FAILURES, "solving") for counted in ("runs", "successes")]
    numbers = ["walls", "distance", "way", *columns]
    table = pd.DataFrame(rows).set_index("number").reindex(columns=["outcome", "maze", *numbers, "solved_by"])
    return table.astype(dict.fromkeys(numbers, "Int64"))


def digest(mazes: Iterable[Maze]) -> str:
    """SHA-256, in hexadecimal, of the mazes' drawings, with an empty line between two.

    Examples
    --------
    >>> digest([Maze.from_drawing("S.G")]) == hashlib.sha256(b"S.G").hexdigest()
    True
    """
    return hashlib.sha256("\n\n".join(maze.drawing() for maze in mazes).encode()).hexdigest()


# Candidates


def candidate(seed: int, number: int) -> Candidate | None:
    """The candidate with this number of the set with this seed; None if no start and goal were found.

    Examples
    --------
    >>> found = next(filter(None, (candidate(1, number) for number in range(20))))
    >>> found.way >= 2 * found.distance
    True
    """
    rng = np.random.Generator(np.random.SFC64(np.random.SeedSequence(seed, spawn_key=(number,))))

    def draw(low: int, high: int) -> int:
        return low + int(rng.random() * (high - low + 1))

    walls = _draw_walls(draw)
    cells = np.zeros((SIDE, SIDE), dtype=bool)
    cells[[0, -1]] = cells[:, [0, -1]] = True
    for wall in walls:
        cells[_cells(*wall)] = True
    regions, _ = ndimage.label(~cells)  # 0 for wall
    to_wall = ndimage.distance_transform_cdt(~cells, metric="taxicab")
    for _ in range(PAIRS):
        goal, start = ((draw(1, SIDE - 2), draw(1, SIDE - 2)) for _ in range(2))
        distance = abs(goal[0] - start[0]) + abs(goal[1] - start[1])
        is_clear = to_wall[goal] > Parameters().success_distance
        if is_clear and DISTANCES[0] <= distance <= DISTANCES[1] and regions[goal] == regions[start]:
            way = int(ways_to_goal(Maze(cells, start, goal))[start])
            if WAYS[0] <= way <= WAYS[1] and way >= DETOUR * distance:
                return Candidate(walls, start, goal, distance, way)
    return None


def _draw_walls(draw: Callable[[int, int], int]) -> list[list[int]]:
    walls: list[list[int]] = []
    wanted = draw(*WALLS)
    while len(walls) < wanted:
        if len(walls) % 2:
            _, _, row, column = walls[draw(0, len(walls) - 1)]
        else:
            row, column = draw(1, SIDE - 2), draw(1, SIDE - 2)
        down, right = DIRECTIONS[draw(0, len(DIRECTIONS) - 1)]
        length = draw(*LENGTHS)
        room = [SIDE - 1 - at if step > 0 else at for at, step in ((row, down), (column, right)) if step]
        steps = min(length - 1, *room)
        if steps >= LENGTHS[0] - 1:
            walls.append([row, column, row + steps * down, column + steps * right])
    return walls


def _cells(row: int, column: int, last_row: int, last_column: int) -> tuple[np.ndarray, np.ndarray]:
    """The rows and the columns of a wall's cells."""
    number = max(abs(last_row - row), abs(last_column - column)) + 1
    return np.linspace(row, last_row, number, dtype=int), np.linspace(column, last_column, number, dtype=int)


# Making


def make(
    name: str,
    contestants: Contestants = CONTESTANTS,
    store: str | os.PathLike | None = None,
    cores: int | None = None,
    folder: Path | None = None,
) -> Path:
    """Examine candidates until the set is complete, and record them; finished runs in the store are not made again.

    Parameters
    ----------
    name : {"design", "test"}
    contestants : sequence of (Algorithm, Parameters)
        Of the third test, in the order in which they try. One more makes no maze unsolved, so it needs no further
        candidates; but the set may have other mazes then.
    store, cores
        As in `safe.run`.
    folder : Path, optional
        Where the record is written; by default into the package.

    Returns
    -------
    Path
        The record.
    """
    seed = SEEDS[checks.choice("name", name, SEEDS)]
    lines: list[dict] = []
    passed: list[Maze] = []
    with bar(f"{name} set", True, total=SIZE, unit="maze") as shown:
        while len(passed) < SIZE:
            found = candidate(seed, len(lines))
            line = {"number": len(lines), "outcome": UNPLACED, "runs": {}}
            if found is not None:
                line |= examine(found.maze(f"{name}, candidate {len(lines)}"), contestants, store, cores)
            if line["outcome"] in (PASSED, UNSOLVED):
                line |= found._asdict()
            if line["outcome"] == PASSED:
                passed.append(found.maze(f"{name} {len(passed) + 1}"))
                shown.update()
            lines.append(line)
            shown.set_postfix(candidates=len(lines))
    header = {"set": name, "seed": seed, "contestants": [a.name for a, _ in contestants], "digest": digest(passed)}
    path = (folder or FOLDER) / f"{name}.jsonl"
    path.write_text("".join(json.dumps(line) + "\n" for line in [header, *lines]), encoding="utf-8", newline="\n")
    return path


def examine(
    maze: Maze,
    contestants: Contestants = CONTESTANTS,
    store: str | os.PathLike | None = None,
    cores: int | None = None,
) -> dict:
    """Put a maze to the three tests, until it fails one; arguments are those of `make`.

    Returns
    -------
    dict
        outcome; runs, by test: how many were made, and how many succeeded; and, if the maze was solved, by which
        contestant, and in which of its runs.
    """
    tests: dict[str, tuple[int, int]] = {}
    for algorithm, most in FAILURES.items():
        first = _first_success(Experiment(algorithm, maze, most, CERTIFYING), store, cores)
        tests[algorithm] = (most, 0) if first is None else (first + 1, 1)
        if first is not None:
            return {"outcome": algorithm, "runs": tests}
    for earlier, (algorithm, parameters) in enumerate(contestants):
        first = _first_success(Experiment(algorithm, maze, SOLVING_RUNS, SOLVING, parameters), store, cores)
        if first is not None:
            tests["solving"] = earlier * SOLVING_RUNS + first + 1, 1
            return {"outcome": PASSED, "runs": tests, "solved": [algorithm.name, first]}
    return {"outcome": UNSOLVED, "runs": tests | {"solving": (len(contestants) * SOLVING_RUNS, 0)}}


def _first_success(experiment: Experiment, store: str | os.PathLike | None, cores: int | None) -> int | None:
    """The first run that succeeds, or None; made in growing portions, so that an early one spares the others."""
    for runs in (*(portion for portion in _PORTIONS if portion < experiment.runs), experiment.runs):
        success = run(replace(experiment, runs=runs), store, progress=False, cores=cores).success
        if success.any():
            return int(success.idxmax())
    return None


# The record


@functools.cache
def _mazes(name: str) -> tuple[Maze, ...]:
    passed = [line for line in _recorded(name)[1] if line["outcome"] == PASSED]
    return tuple(
        Candidate(*(line[field] for field in Candidate._fields)).maze(f"{name} {place}")
        for place, line in enumerate(passed, start=1)
    )


def _recorded(name: str) -> tuple[dict, list[dict]]:
    """The header of a set's record, and a dict for each candidate."""
    path = FOLDER / f"{checks.choice('name', name, SEEDS)}.jsonl"
    header, *lines = map(json.loads, path.read_text(encoding="utf-8").splitlines())
    return header, lines


def main() -> None:
    parser = argparse.ArgumentParser(description="Make the design set and the test set again.")
    parser.add_argument("--store", default="held-out.sqlite", help="where finished runs are kept (held-out.sqlite)")
    parser.add_argument("--cores", type=int, help="how many cores of this machine; by default all")
    options = parser.parse_args()
    for name in SEEDS:
        print(make(name, store=options.store, cores=options.cores), flush=True)


if __name__ == "__main__":
    main()
