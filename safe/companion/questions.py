"""What was asked of the experiments beyond the paper, before the runs that decide it.

For how a question is answered see `safe.companion.findings`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import product

import pandas as pd

from safe.companion.designs import Level
from safe.companion.paper import MAZES

Levels = Mapping[str, Level]  # of some factors of a design, by which cells are chosen


@dataclass(frozen=True)
class Question:
    """Which of two groups of cells succeeds more often, or do they succeed equally often?"""

    statement: str
    first: Levels
    second: Levels
    direction: int = 0  # +1: the first more often; 0: equally often

    @property
    def maze(self) -> Level:
        return self.first["maze"]


@dataclass(frozen=True)
class Mechanism:
    """Does something hold in most of the traced runs of a cell that last for some generations?

    Means over windows count each window of a run alike, so the first generations count more than their number.
    """

    statement: str
    cell: Levels
    holds: Callable[[pd.DataFrame], bool]  # in a run, given the measures of its windows
    lasting: int = 0  # the first generation of a window that runs must have reached

    @property
    def maze(self) -> Level:
        return self.cell["maze"]


RAW, SHARES, RANKS = "raw", "shares of the largest", "ranks"
PAPERS, NONE, ALONE = "the paper's archive", "no archive", "no archive, mutation alone"
LATER = 10  # generations, after which a run is beyond its beginning
LONG = 100


def all_questions() -> dict[str, list[Question | Mechanism]]:
    """The questions of each design, by its name."""
    return {
        "selection": [*_selection()],
        "archives": [*_archives()],
        "capacities": [*_capacities()],
        "mutualism": [*_mutualism()],
        "factorial": [*_factorial()],
        "sizes": [*_sizes()],
    }


def _selection() -> Iterator[Question | Mechanism]:
    def cell(maze: str, condition: str, weighed: str, judge: str) -> Levels:
        return {"maze": maze, "condition": condition, "weighed": weighed, "judge": judge}

    for maze, condition in product(MAZES, (PAPERS, NONE)):
        where, safe = f"({condition})", cell(maze, condition, RAW, "SAFE")
        for other, words in (
            ("novelty search", "novelty search"),
            ("SAFE, frozen", "with frozen objective functions"),
            ("one fixed sum", "one fixed sum"),
            ("a drawn judge", "with a drawn judge"),
        ):
            yield Question(f"SAFE succeeds as often as {words} {where}", safe, cell(maze, condition, RAW, other))
        for weighed in (SHARES, RANKS):
            yield Question(
                f"SAFE succeeds more often if it weighs raw components than {weighed} {where}",
                safe,
                cell(maze, condition, weighed, "SAFE"),
                1,
            )
    for maze in MAZES:
        where = "(no archive)"
        for weighed, other in product((SHARES, RANKS), ("SAFE", "one fixed sum")):
            yield Question(
                f"A drawn judge of {weighed} succeeds more often than {other} of {weighed} {where}",
                cell(maze, NONE, weighed, "a drawn judge"),
                cell(maze, NONE, weighed, other),
                1,
            )
        for weighed in (SHARES, RANKS):
            yield Question(
                f"Novelty search succeeds more often than a drawn judge of {weighed} {where}",
                cell(maze, NONE, RAW, "novelty search"),
                cell(maze, NONE, weighed, "a drawn judge"),
                1,
            )
    yield Question(
        "A drawn judge of shares of the largest succeeds more often than novelty search, "
        "both with no archive and mutation alone",
        cell("maze2", ALONE, SHARES, "a drawn judge"),
        cell("maze2", ALONE, RAW, "novelty search"),
        1,
    )
    for maze in MAZES:
        raw, shares, ranks = (cell(maze, PAPERS, weighed, "SAFE") for weighed in (RAW, SHARES, RANKS))
        yield Mechanism(
            "In most runs of SAFE, at least 99 % of tournaments are won by a solution that none of the "
            "others surpasses in novelty",
            raw,
            lambda windows: windows.by_novelty.mean() >= 0.99,
        )
        yield Mechanism(
            f"In most runs of SAFE, from generation {LATER} on, one objective function gives at least "
            "90 % of the fitnesses of a generation, on average",
            raw,
            lambda windows: _later(windows).share.mean() >= 0.9,
        )
        yield Mechanism(
            "In most runs of SAFE, selection for novelty is at least 5 times as strong as for closeness",
            raw,
            lambda windows: windows.differential_novelty.mean() >= 5 * windows.differential_closeness.mean(),
        )
        yield Mechanism(
            f"In most runs of SAFE of shares of the largest, selection is stronger for closeness than for "
            f"novelty from generation {LATER} on",
            shares,
            lambda windows: _later(windows).differential_closeness.mean() > _later(windows).differential_novelty.mean(),
        )
        yield Mechanism(
            f"In most runs of SAFE of ranks, from generation {LATER} on, the objective function that gives "
            "most fitnesses has both coefficients above 0.8, on average",
            ranks,
            lambda windows: min(_later(windows).a.mean(), _later(windows).b.mean()) > 0.8,
        )


def _archives() -> Iterator[Question | Mechanism]:
    def cell(maze: str, search: str, archive: str) -> Levels:
        return {"maze": maze, "algorithm": search, "archive": archive}

    for maze, search in product(MAZES, ("novelty search", "SAFE")):
        papers, who = cell(maze, search, "the paper's"), f"{_capital(search)} succeeds"
        for archive, words in (
            ("none", "without an archive"),
            ("random", "with random admission"),
            ("threshold", "with Lehman and Stanley's threshold"),
            ("the paper's, distinct cells", "with the paper's archive if it holds no cell twice"),
            ("the paper's, rescored", "with the paper's archive if its scores are computed again"),
        ):
            statement = f"{who} more often {words} than with the paper's archive"
            yield Question(statement, cell(maze, search, archive), papers, 1)
        yield Question(
            f"{who} as often with the paper's archive if points enter after all are scored",
            cell(maze, search, "the paper's, after scoring"),
            papers,
        )
        yield Question(
            f"{who} more often with random admission than without an archive",
            cell(maze, search, "random"),
            cell(maze, search, "none"),
            1,
        )
    for maze in MAZES:
        papers, who = cell(maze, "novelty search", "the paper's"), "In most runs of novelty search"
        yield Mechanism(
            f"{who}, the paper's archive is full after {LATER} generations",
            papers,
            lambda windows: windows[windows.window >= LATER].archive_size.min() >= 1000,
            LATER,
        )
        yield Mechanism(
            f"{who} that last {LONG} generations, the lowest score in the paper's archive is above the mean novelty of "
            "the population at the end",
            papers,
            lambda windows: _last(windows).archive_lowest > _last(windows).novelty,
            LONG,
        )
        yield Mechanism(
            f"{who} that last {LONG} generations, fewer than 10 of 200 solutions enter the paper's archive in a "
            "generation at the end",
            papers,
            lambda windows: _last(windows).entered < 10,
            LONG,
        )
        yield Mechanism(
            f"{who} that last {LONG} generations, the points of the paper's archive lie in fewer cells than two "
            "thirds of their number at the end",
            papers,
            lambda windows: _last(windows).archive_cells < 2 / 3 * _last(windows).archive_size,
            LONG,
        )
        for archive, words, is_below in (
            ("the paper's", "the paper's archive", True),
            ("none", "no archive", False),
            ("random", "random admission", False),
        ):
            yield Mechanism(
                f"{who} that last {LONG} generations, with {words}, the standard deviation of novelty is "
                f"{'below' if is_below else 'above'} 40 % of its mean at the end",
                cell(maze, "novelty search", archive),
                lambda windows, is_below=is_below: (
                    (_last(windows).novelty_sd < 0.4 * _last(windows).novelty) == is_below
                ),
                LONG,
            )


def _capacities() -> Iterator[Question]:
    for maze, search in product(MAZES, ("novelty search", "SAFE")):
        papers = {"maze": maze, "algorithm": search, "archive": "the paper's"}
        for places in (100, 10_000):
            yield Question(
                f"{_capital(search)} succeeds more often with {places:,} places in the paper's archive than with 1,000",
                papers | {"places": places},
                papers | {"places": 1000},
                1,
            )


def _mutualism() -> Iterator[Question | Mechanism]:
    def cell(maze: str, condition: str, weighed: str, rating: str) -> Levels:
        return {"maze": maze, "condition": condition, "weighed": weighed, "rating": rating}

    for maze, condition, rating in product(MAZES, (PAPERS, NONE), ("Pearson", "Spearman")):
        where, raw = f"({condition})", cell(maze, condition, RAW, rating)
        yield Question(
            f"SAFE succeeds as often if its objective functions are rated by {rating}'s correlation as by their "
            f"novelty {where}",
            raw,
            cell(maze, condition, RAW, "genotypic novelty"),
        )
        for weighed in (SHARES, RANKS):
            yield Question(
                f"Rated by {rating}'s correlation, objective functions of raw components lead to success more often "
                f"than those of {weighed} {where}",
                raw,
                cell(maze, condition, weighed, rating),
                1,
            )
    for maze, rating in product(MAZES, ("Pearson", "Spearman")):
        raw, shares = (cell(maze, PAPERS, weighed, rating) for weighed in (RAW, SHARES))
        in_most = f"In most runs with objective functions rated by {rating}'s correlation"
        yield Mechanism(
            f"{in_most}, their mean coefficient of novelty is below 0.2 from generation {LATER} on",
            raw,
            lambda windows: _later(windows).mean_b.mean() < 0.2,
        )
        yield Mechanism(
            f"{in_most}, at least 99 % of tournaments are nevertheless won by a solution that none of the "
            "others surpasses in novelty",
            raw,
            lambda windows: windows.by_novelty.mean() >= 0.99,
        )
        yield Mechanism(
            f"{in_most} and weighing shares of the largest, winners of tournaments are unsurpassed in closeness more "
            f"often than in novelty from generation {LATER} on",
            shares,
            lambda windows: _later(windows).by_closeness.mean() > _later(windows).by_novelty.mean(),
        )


def _factorial() -> Iterator[Question]:
    papers = {"k": 15, "tournament": 5, "variation": "crossover and mutation", "archive": "the paper's"}
    best = {"k": 15, "tournament": 20, "variation": "mutation alone", "archive": "random"}
    for maze, search in product(MAZES, ("novelty search", "SAFE")):
        where, who = {"maze": maze, "algorithm": search}, f"{_capital(search)} succeeds"
        for factor, more, less, words in (
            ("k", 15, 1, "with k = 15 than with k = 1"),
            ("tournament", 20, 2, "with tournaments of 20 than with tournaments of 2"),
            (
                "variation",
                "mutation alone",
                "crossover and mutation",
                "with mutation alone than with crossover as well",
            ),
            ("archive", "random", "the paper's", "with random admission than with the paper's archive"),
        ):
            statement = f"{who} more often {words}, over all settings of the others"
            yield Question(statement, where | {factor: more}, where | {factor: less}, 1)
        yield Question(
            f"{who} more often with tournaments of 20, mutation alone and random admission than with "
            "the paper's setting",
            where | best,
            where | papers,
            1,
        )
        yield Question(
            f"{who} more often than the standard EA, both over all settings",
            where,
            {"maze": maze, "algorithm": "standard EA"},
            1,
        )
    for maze in MAZES:
        where = {"maze": maze, "algorithm": "novelty search", "archive": "none"}
        yield Question(
            "Novelty search succeeds more often without an archive with k = 15 than with k = 200",
            where | {"k": 15},
            where | {"k": 200},
            1,
        )


def _sizes() -> Iterator[Question]:
    for maze, search in product(MAZES, ("novelty search", "SAFE")):
        cell = {"maze": maze, "algorithm": search, "archive": "none", "elites": 2}
        yield Question(
            f"{_capital(search)} without an archive succeeds more often with a population of 200 than with "
            "one of 50, at equal cost",
            cell | {"population": 200},
            cell | {"population": 50},
            1,
        )


def _capital(text: str) -> str:
    return text[0].upper() + text[1:]


def _later(windows: pd.DataFrame) -> pd.DataFrame:
    """The windows from LATER on; all of a run that has ended before."""
    later = windows[windows.window >= LATER]
    return later if len(later) else windows


def _last(windows: pd.DataFrame) -> pd.Series:
    """The last window of a run."""
    return windows.iloc[-1]
