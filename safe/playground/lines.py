"""A class that shares the runs of experiments, and the lines of text in which its members send the outcomes.

In a class of n seats with r runs each, seat s makes the runs (s - 1) r to s r - 1 of an experiment for each algorithm.
No two seats share a run, and all together make the runs 0 to n r - 1, the same that `safe.run` makes. The playground
makes the runs of a seat in a browser, and writes their outcomes in one line::

    SAFE-class-RULES;address of the class;seat;outcomes;checksum;

An outcome is `+` and the generation of the success, or `-` and how many cells the best robot was from the goal. Commas
separate algorithms. The checksum is the beginning of the SHA-256 of all before it. A line may be broken anywhere, as
programs for mail do.
"""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd

from safe import checks
from safe.algorithms import Algorithm, Parameters, get_algorithm
from safe.evolution import RULES, Run, evolve
from safe.experiments.experiment import Experiment
from safe.experiments.store import Store, sha256
from safe.maze import Maze
from safe.maze_files import text_of
from safe.playground.address import class_address, read_class_address

MOST_SEATS = 1000
_LONGEST_NAME = 40  # characters
_HEAD = "SAFE-class-"
_PARTS = 5  # of a line, each with a semicolon behind it
_BREAKS = re.compile("[\\s>\u00ad\u200b\ufeff]")  # what mail and chat put into a line, also before a quoted one


class Outcome(NamedTuple):
    """What a run has come to, in short."""

    success: bool
    number: int  # the generation of the success, or the distance at the end

    def __str__(self) -> str:
        return f"success in generation {self.number}" if self.success else f"failure {self.number} cells from the goal"

    @classmethod
    def of(cls, run: Run) -> Outcome:
        """The outcome of a run."""
        return cls(run.success, run.generation if run.success else run.distance)


@dataclass(frozen=True)
class Course:
    """A class that shares the runs of an experiment for each algorithm.

    Parameters
    ----------
    name : str
        Its name, of at most 40 characters.
    algorithms : sequence of Algorithm or str
    maze : Maze or str
    runs : int
        How many runs of each algorithm a seat makes.
    seats : int
    seed : int
        Of the experiments.
    parameters : Parameters

    Raises
    ------
    ValueError
        If a name is unknown or a number out of range; more than a million runs of an algorithm are too many.

    Examples
    --------
    >>> course = Course("monday", ["novelty", "safe"], "maze1", runs=20)
    >>> course.address
    'view=runs&maze=maze1&algorithm=novelty&algorithm=safe&seed=0&runs=20&class=monday&seats=30'
    >>> course.numbers(seat=7)
    range(120, 140)
    """

    name: str
    algorithms: Sequence[Algorithm | str]
    maze: Maze | str
    runs: int = 20
    seats: int = 30
    seed: int = 0
    parameters: Parameters = Parameters()

    def __post_init__(self) -> None:
        if not 1 <= len(checks.text("class", self.name).strip()) <= len(self.name) <= _LONGEST_NAME:
            raise ValueError(
                f"class must have a name of 1 to {_LONGEST_NAME} characters; got {checks.shown(self.name)}"
            )
        checks.integer("seats", self.seats, 1, MOST_SEATS)
        checks.integer("runs", self.runs, 1, checks.MOST)
        checks.integer("seats times runs", self.seats * self.runs, 1, checks.MOST)
        object.__setattr__(self, "algorithms", tuple(map(get_algorithm, self.algorithms)))
        self.experiments  # noqa: B018, which checks the rest

    @cached_property
    def experiments(self) -> tuple[Experiment, ...]:
        """For each algorithm the experiment whose runs the class makes."""
        runs = self.seats * self.runs
        return tuple(Experiment(a, self.maze, runs, self.seed, self.parameters) for a in self.algorithms)

    @property
    def address(self) -> str:
        """The part of the playground's address behind the `#` that all in the class open."""
        maze = self.experiments[0].maze
        return class_address(self.name, self.seats, self.runs, self.algorithms, maze, self.seed, self.parameters)

    @property
    def key(self) -> tuple:
        """What tells classes apart."""
        return self.name, self.seats, self.runs, *(experiment.digest for experiment in self.experiments)

    def numbers(self, seat: int) -> range:
        """The numbers of a seat's runs."""
        seat = checks.integer("seat", seat, 1, self.seats)
        return range((seat - 1) * self.runs, seat * self.runs)

    def make(self, seat: int) -> list[list[Outcome]]:
        """Make the runs of a seat; their outcomes for each algorithm.

        Examples
        --------
        >>> course = Course("monday", ["random"], "maze1", 2, 3, parameters=Parameters(population=10, generations=2))
        >>> course.make(seat=3)
        [[Outcome(success=False, number=9), Outcome(success=False, number=23)]]
        """
        numbers = self.numbers(seat)
        return [[_made(experiment, number) for number in numbers] for experiment in self.experiments]


class Line(NamedTuple):
    """A line of a class."""

    at: int  # the number of the line of the text in which it begins
    course: Course
    seat: int
    outcomes: list[list[Outcome]]  # of the seat's runs, for each algorithm

    def runs(self) -> Iterable[tuple[Experiment, int, Outcome]]:
        """Its runs: the experiment, the number, the outcome."""
        for experiment, outcomes in zip(self.course.experiments, self.outcomes, strict=True):
            for number, outcome in zip(self.course.numbers(self.seat), outcomes, strict=True):
                yield experiment, number, outcome


class Refusal(NamedTuple):
    """A line that does not count."""

    at: int
    reason: str


class Pool(NamedTuple):
    """What the lines of a class come to."""

    course: Course | None  # of most lines, or the one that was asked for
    seats: dict[int, Line]  # the lines that count
    repeated: list[Line]  # those given again
    refused: list[Refusal]

    @property
    def missing(self) -> list[int]:
        """The seats of which no line counts."""
        return [seat for seat in range(1, self.course.seats + 1) if seat not in self.seats] if self.course else []

    @property
    def results(self) -> dict[Experiment, pd.DataFrame]:
        """A table for each experiment, with a row for each run; its columns are run, success and number."""
        rows = {experiment: [] for experiment in (self.course.experiments if self.course else ())}
        for line in self.seats.values():
            for experiment, run, outcome in line.runs():
                rows[experiment].append((run, *outcome))
        columns = ["run", "success", "number"]
        return {
            experiment: pd.DataFrame(those, columns=columns).sort_values("run", ignore_index=True)
            for experiment, those in rows.items()
        }


def write_line(course: Course, seat: int, outcomes: Sequence[Sequence[Outcome]]) -> str:
    """The line of a seat.

    Examples
    --------
    >>> course = Course("monday", ["random"], "maze1", 2, 3, parameters=Parameters(population=10, generations=2))
    >>> line = write_line(course, 3, course.make(3))
    >>> line[:60]
    'SAFE-class-1;view=runs&maze=maze1&algorithm=random&seed=0&po'
    >>> line[-27:]
    'y&seats=3;3;-9-23;c754feab;'
    """
    seat = checks.integer("seat", seat, 1, course.seats)
    lists = ("".join(f"{'+' if success else '-'}{number}" for success, number in those) for those in outcomes)
    text = f"{_HEAD}{RULES};{course.address};{seat};{','.join(lists)};"
    return f"{text}{_checksum(text)};"


def read_text(path: str | os.PathLike) -> str:
    """The text of a file of lines, whatever of the usual encodings it has.

    Raises
    ------
    ValueError
        If it cannot be read.
    """
    try:
        return text_of(Path(path).read_bytes())
    except (OSError, TypeError, ValueError) as error:
        raise ValueError(
            f"lines must be the path of a file; got {checks.shown(path)} ({checks.reason(error)})"
        ) from None


def read_lines(text: str) -> list[Line | Refusal]:
    """All lines of classes in a text, in order. What is between them is skipped, unless it was part of one."""
    found: list[Line | Refusal] = []
    at = 1
    for piece in re.split(f"(?={_HEAD})", text):
        *parts, _ = piece.split(";", _PARTS) if piece.startswith(_HEAD) else ("",)
        is_whole = len(parts) == _PARTS
        length = len(";".join(parts)) + 1 if is_whole else 0
        if is_whole:
            found.append(_attempted(at, [_BREAKS.sub("", part) for part in parts]))
        elif parts:
            found.append(Refusal(at, "is cut off before its end"))
        rest = [] if parts and not is_whole else piece[length:].split("\n")
        before = piece[:length].count("\n")
        lost = (number for number, line in enumerate(rest) if "class=" in line)
        found += [Refusal(at + before + number, "is damaged at its beginning") for number in lost]
        at += piece.count("\n")
    return found


def _attempted(at: int, parts: list[str]) -> Line | Refusal:
    try:
        return Line(at, *_read_line(*parts))
    except ValueError as error:
        return Refusal(at, str(error))


def _read_line(head: str, address: str, seat: str, lists: str, check: str) -> tuple[Course, int, list[list[Outcome]]]:
    if _checksum(f"{head};{address};{seat};{lists};") != check:
        raise ValueError("is damaged: its checksum does not fit")
    if head != f"{_HEAD}{RULES}":
        raise ValueError(f"follows the rules of another version: {head.removeprefix(_HEAD)} instead of {RULES}")
    course = Course(**read_class_address(address))
    number = checks.integer("seat", int(seat) if re.fullmatch("[0-9]{1,4}", seat) else float("nan"), 1, course.seats)
    outcomes = [list(map(_read_outcome, re.findall("[+-][^+-]*", those))) for those in lists.split(",")]
    if len(outcomes) != len(course.algorithms) or any(len(those) != course.runs for those in outcomes):
        raise ValueError(f"must hold {course.runs} outcomes of each of {len(course.algorithms)} algorithms")
    for success, reached in (outcome for those in outcomes for outcome in those):
        if success:
            checks.integer("the generation of a success", reached, 0, course.parameters.generations - 1)
        else:
            checks.integer("the distance at the end of a failure", reached, course.parameters.success_distance + 1)
    return course, number, outcomes


def _read_outcome(text: str) -> Outcome:
    if not re.fullmatch("[+-][0-9]{1,7}", text):
        raise ValueError(f"has an outcome that is none: {text}")
    return Outcome(text[0] == "+", int(text[1:]))


def _checksum(text: str) -> str:
    return sha256(text)[:8]


def pool(lines: Iterable[Line | Refusal], course: Course | None = None) -> Pool:
    """What the lines of a class come to.

    Lines of other classes are refused. The same line given again counts once. If two lines of a seat disagree about a
    run, neither counts, and the reasons name both.

    Parameters
    ----------
    lines : iterable of Line and Refusal
        As `read_lines` gives them.
    course : Course, optional
        The class; by default that of most lines.

    Examples
    --------
    >>> course = Course("monday", ["random"], "maze1", 2, 3, parameters=Parameters(population=10, generations=2))
    >>> text = "\\n".join(write_line(course, seat, course.make(seat)) for seat in (3, 1, 3))
    >>> pooled = pool(read_lines(text))
    >>> list(pooled.seats), pooled.missing, len(pooled.repeated), pooled.refused
    ([1, 3], [2], 1, [])
    """
    lines = list(lines)
    refused = [line for line in lines if isinstance(line, Refusal)]
    whole = [line for line in lines if isinstance(line, Line)]
    if course is None and whole:
        ((most, _),) = Counter(line.course.key for line in whole).most_common(1)
        course = next(line.course for line in whole if line.course.key == most)
    seats: dict[int, Line] = {}
    repeated, doubted = [], set()
    for line in whole:
        kept = seats.get(line.seat)
        if line.course.key != course.key:
            is_other = line.course.name != course.name
            reason = f"is of the class {line.course.name}" if is_other else "is of a class with other settings"
            refused.append(Refusal(line.at, reason))
        elif kept is None:
            seats[line.seat] = line
        elif kept.outcomes == line.outcomes:
            repeated.append(line)
        else:
            refused.append(Refusal(line.at, _difference(kept, line)))
            doubted.add(line.seat)
    for seat in doubted:
        refused.append(Refusal(seats.pop(seat).at, f"disagrees with another line of seat {seat}"))
    return Pool(course, dict(sorted(seats.items())), repeated, sorted(refused))


def _difference(kept: Line, line: Line) -> str:
    """The first outcome in which a line differs from another one of the same seat."""
    for (experiment, run, there), (_, _, here) in zip(kept.runs(), line.runs(), strict=True):
        if here != there:
            name = experiment.algorithm.name
            return f"disagrees with line {kept.at} about run {run} of {name}: {here} here, {there} there"
    raise AssertionError


def verify_lines(pooled: Pool, sample: int = 2, seed: int | None = None) -> pd.DataFrame:
    """Make some runs of each seat again, and compare their outcomes.

    Parameters
    ----------
    pooled : Pool
    sample : int
        How many runs of each seat, drawn at random; all if there are no more.
    seed : int, optional
        The seed of the draw; by default every draw differs.

    Returns
    -------
    pandas.DataFrame
        One row for each run that was made again and has the same outcome: seat, algorithm, run, success, number.

    Raises
    ------
    ValueError
        If a run has another outcome than its line says; the error names the line, the seat and the run.
    """
    draw = np.random.default_rng(seed)
    rows = []
    for seat, line in pooled.seats.items():
        runs = list(line.runs())
        for place in sorted(draw.choice(len(runs), min(checks.integer("sample", sample, 1), len(runs)), replace=False)):
            experiment, run, outcome = runs[place]
            made = _made(experiment, run)
            if made != outcome:
                raise ValueError(
                    f"lines must hold what the algorithms make; got line {line.at}, of seat {seat}, where run {run} of "
                    f"{experiment.algorithm.name} is: {outcome}; made again: {made}"
                )
            rows.append((seat, experiment.algorithm.name, run, *outcome))
    return pd.DataFrame(rows, columns=["seat", "algorithm", "run", "success", "number"])


def _made(experiment: Experiment, number: int) -> Outcome:
    seed = experiment.seed_sequence(number)
    return Outcome.of(evolve(experiment.maze, experiment.algorithm, seed, experiment.parameters))


def add_store(results: Mapping[Experiment, pd.DataFrame], store: str | os.PathLike) -> dict[Experiment, pd.DataFrame]:
    """Results of a class together with the runs of the same experiments in a store; runs in both count once.

    Parameters
    ----------
    results : mapping of Experiment to DataFrame
        As in `Pool.results`.
    store : path
        It is only read. To bring many stores together, see `safe.merge`.

    Raises
    ------
    StoreError
        If it is no store or is damaged.
    ValueError
        If both have a run and its outcomes differ.
    """
    added = {}
    with Store.for_reading(store) as opened:
        for experiment, table in results.items():
            known = {run: Outcome(bool(success), int(number)) for run, success, number in table.to_numpy()}
            for entry in opened.experiments(experiment.digest):
                for stored in opened.runs(entry):
                    outcome = Outcome.of(stored.run)
                    if known.setdefault(stored.number, outcome) != outcome:
                        raise ValueError(
                            f"store must agree with the lines; got {opened}, where run {stored.number} of "
                            f"{experiment.algorithm.name} is: {outcome}; in the lines: {known[stored.number]}"
                        )
            rows = [(run, *known[run]) for run in sorted(known)]
            added[experiment] = pd.DataFrame(rows, columns=["run", "success", "number"])
    return added
