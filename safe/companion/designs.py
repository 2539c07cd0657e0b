"""The experiments beyond the paper, chapter by chapter: what was varied, on which seeds, with how many runs.

A design is a grid of cells. Each cell is an experiment, known by a level of every factor. Every design was first
explored, on one seed, to find out what to ask. Then the questions and the rules of their decision were written down
(`safe.companion.findings`), and the same cells were run with a seed that nobody had seen.

`runs` is the number of runs of the cells that matter most. Other cells have a fixed share of it (SHARES), and at least
one run.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

from safe import checks
from safe.algorithms import Algorithm, Parameters
from safe.companion.paper import MAZES
from safe.experiments.experiment import Experiment
from safe.maze import Maze
from safe.maze_files import load_mazes
from safe.results.labels import maze_labels

EXPLORING, DECIDING = 100, 200  # seeds: of what was explored, and of what the questions are decided by
RUNS = {EXPLORING: 100, DECIDING: 500}  # that are recorded, by seed
TRACED = 20  # recorded runs of a cell inside which the mechanism is recorded, too
SHARES = {
    "no archive": 0.6,
    "no archive, mutation alone": 0.2,
    "capacities": 0.4,
    "mutualism": 0.2,
    "sizes": 0.12,
    "factorial": 0.05,
}

# Levels of factors

NOVELTY, STANDARD = {"objectives": [(0, 1)]}, {"objectives": [(1, 0)]}
JUDGES = {
    "SAFE": {"objectives": None, "rating": "genotypic novelty"},
    "SAFE, frozen": {"objectives": None},
    "one fixed sum": {"objectives": [(0.5, 0.5)]},
    "a drawn judge": {"objectives": None, "judging": "drawn judge"},
}
SEARCHES = {"novelty search": NOVELTY, "SAFE": JUDGES["SAFE"]}
WEIGHED = {"raw": "raw", "shares of the largest": "maximum", "ranks": "rank"}  # and the scaling that does it
MUTATION_ALONE = {"crossover": 0.0, "mutation": 1.0}
VARIATION = {"crossover and mutation": {}, "mutation alone": MUTATION_ALONE}
CONDITIONS = {
    "the paper's archive": {},
    "no archive": {"archive": 0},
    "no archive, mutation alone": {"archive": 0} | MUTATION_ALONE,
}
ARCHIVES = {
    "the paper's": {},
    "none": {"archive": 0},
    "random": {"admission": "random"},
    "threshold": {"admission": "threshold"},
    "the paper's, after scoring": {"admission": "after scoring"},
    "the paper's, distinct cells": {"admission": "distinct"},
    "the paper's, rescored": {"admission": "rescored"},
}
PLACES = {
    "the paper's": (0, 100, 300, 1000, 3000, 10_000),
    "random": (1000, 10_000),
    "threshold": (1000, 10_000),
}
K = {
    "novelty search": (1, 5, 15, 50, 200),
    "SAFE": (1, 5, 15, 50),
}  # with 200, a generation of SAFE takes 7 times as long
TOURNAMENTS = (2, 5, 20)
POPULATIONS = (50, 100, 200, 500, 1000)
ELITES = (0, 2, 20)
RATINGS = {"Pearson": "pearson", "Spearman": "spearman", "genotypic novelty": "genotypic novelty"}

Level = str | int


@dataclass(frozen=True)
class Design:
    """Experiments, each known by a level of every factor, the maze's label first."""

    factors: tuple[str, ...]
    cells: Mapping[tuple[Level, ...], Experiment]
    traced: Sequence[Experiment] = ()  # those of the cells inside whose runs the mechanism is looked into


@dataclass(frozen=True)
class Recorded:
    """An experiment that is recorded.

    Parameters
    ----------
    experiment : Experiment
        With its number of runs.
    traced : int
        Of how many of the runs, from the first on, the mechanism is recorded, too.

    Raises
    ------
    ValueError
        If `traced` is no integer from 0 to the number of runs.
    """

    experiment: Experiment
    traced: int = 0

    def __post_init__(self) -> None:
        object.__setattr__(self, "traced", checks.integer("traced", self.traced, 0, self.experiment.runs))


def everything() -> list[Recorded]:
    """All that is recorded, in the order of the record, each experiment once."""
    mazes, found = load_mazes(list(MAZES)), {}
    for design, (seed, runs) in product((selection, archives, mutualism, capacities, factorial, sizes), RUNS.items()):
        made = design(mazes, runs, seed)
        for experiment in made.cells.values():
            traced = TRACED if seed == DECIDING and experiment in made.traced else 0
            known = found.get(experiment.digest, Recorded(experiment))  # it may be in an earlier design
            most = max(known.experiment, experiment, key=lambda cell: cell.runs)
            found[experiment.digest] = Recorded(most, max(traced, known.traced))
    return list(found.values())


# Designs


def selection(mazes: Sequence[Maze], runs: int, seed: int) -> Design:
    """What SAFE selects: who judges, and what is weighed; novelty search beside it."""

    def cells() -> Iterator[tuple]:
        for maze, (condition, rules) in product(mazes, CONDITIONS.items()):
            judges = {("raw", "novelty search"): NOVELTY} | {
                (weighed, judge): fields | {"scaling": scaling}
                for (weighed, scaling), (judge, fields) in product(WEIGHED.items(), JUDGES.items())
            }
            for (weighed, judge), fields in judges.items():
                yield (maze, condition, weighed, judge), fields, rules, condition

    def is_traced(condition: str, *_: Level) -> bool:
        return condition != "no archive, mutation alone"

    return _design(("maze", "condition", "weighed", "judge"), mazes, cells(), runs, seed, is_traced)


def archives(mazes: Sequence[Maze], runs: int, seed: int) -> Design:
    """What the archive costs: rules of admission, and parts of the paper's rule changed."""
    cells = (
        ((maze, search, archive), fields, rules, "archives")
        for maze, (search, fields), (archive, rules) in product(mazes, SEARCHES.items(), ARCHIVES.items())
    )

    def is_traced(search: str, *_: Level) -> bool:
        return search == "novelty search"

    return _design(("maze", "algorithm", "archive"), mazes, cells, runs, seed, is_traced)


def capacities(mazes: Sequence[Maze], runs: int, seed: int) -> Design:
    """Archives with more or fewer places."""
    cells = (
        ((maze, search, archive, places), fields, ARCHIVES[archive] | {"archive": places}, "capacities")
        for maze, (search, fields), (archive, sizes) in product(mazes, SEARCHES.items(), PLACES.items())
        for places in sizes
    )
    return _design(("maze", "algorithm", "archive", "places"), mazes, cells, runs, seed)


def factorial(mazes: Sequence[Maze], runs: int, seed: int) -> Design:
    """All combinations of k, tournament size, variation and archive; the standard EA has neither k nor archive."""

    def cells() -> Iterator[tuple]:
        for maze, size, (variation, rates) in product(mazes, TOURNAMENTS, VARIATION.items()):
            rules = {"tournament": size} | rates
            yield (maze, "standard EA", 15, size, variation, "none"), STANDARD, rules, "factorial"
            for (search, fields), archive in product(SEARCHES.items(), ("the paper's", "none", "random")):
                for k in K[search]:
                    own = rules | {"k": k} | ARCHIVES[archive]
                    yield (maze, search, k, size, variation, archive), fields, own, "factorial"

    return _design(("maze", "algorithm", "k", "tournament", "variation", "archive"), mazes, cells(), runs, seed)


def sizes(mazes: Sequence[Maze], runs: int, seed: int) -> Design:
    """Population against generations, at 100,000 evaluations, and elites."""
    searched = [(search, fields, archive) for search, fields in SEARCHES.items() for archive in ("the paper's", "none")]

    def cells() -> Iterator[tuple]:
        for maze, (search, fields, archive) in product(mazes, [("standard EA", STANDARD, "none"), *searched]):
            own = ARCHIVES[archive] if search in SEARCHES else {}
            for population in POPULATIONS:
                rules = {"population": population, "generations": Parameters().evaluations // population}
                yield (maze, search, archive, population, 2), fields, rules | own, "sizes"
            for elites in ELITES:
                yield (maze, search, archive, 200, elites), fields, {"elites": elites} | own, "sizes"

    return _design(("maze", "algorithm", "archive", "population", "elites"), mazes, cells(), runs, seed)


def mutualism(mazes: Sequence[Maze], runs: int, seed: int) -> Design:
    """Objective functions rated by the correlation of their scores with closeness, beside the paper's rating."""

    def cells() -> Iterator[tuple]:
        for maze, condition in product(mazes, ("the paper's archive", "no archive")):
            for (weighed, scaling), (rating, rule) in product(WEIGHED.items(), RATINGS.items()):
                fields, kind = {"rating": rule, "scaling": scaling}, condition if weighed == "raw" else "mutualism"
                yield (maze, condition, weighed, rating), fields, CONDITIONS[condition], kind

    return _design(("maze", "condition", "weighed", "rating"), mazes, cells(), runs, seed, lambda *_: True)


def _design(
    factors: tuple[str, ...],
    mazes: Sequence[Maze],
    cells: Iterable[tuple],
    runs: int,
    seed: int,
    is_traced: Callable[..., bool] = lambda *_: False,
) -> Design:
    """A design from its cells: levels of the factors, fields of the algorithm, parameters, and a key of SHARES.

    `is_traced` says of the levels behind the maze whether the mechanism is looked into.
    """
    runs = checks.integer("runs", runs, 1, checks.MOST)
    labels = dict(zip(mazes, maze_labels(mazes), strict=True))  # two mazes may have one name
    experiments = {}
    named_after = next(factor for factor in ("judge", "rating", "algorithm") if factor in factors)
    for (maze, *levels), fields, rules, kind in cells:
        algorithm = Algorithm(dict(zip(factors[1:], levels, strict=True))[named_after], **fields)
        share = max(1, round(runs * SHARES.get(kind, 1)))
        experiments[(labels[maze], *levels)] = Experiment(algorithm, maze, share, seed, Parameters(**rules))
    return Design(factors, experiments, [e for (_, *levels), e in experiments.items() if is_traced(*levels)])
