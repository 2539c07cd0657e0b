"""What was asked of the experiments beyond the paper, before the runs that decide it, and the answers.

Questions come from runs with one seed (`designs.EXPLORED`), and are decided by runs with another (`designs.CONFIRMED`),
by the rules of the ledger (`safe.companion.verdicts`):

- a direction ("more often than"): by Fisher's exact test, or for a share of runs ("in most runs") by the binomial test
  against one half, with Holm's correction for all questions of the same chapter;
- a likeness ("as often as"): by two one-sided tests against an effect of `statistics.MARGIN`, unless a difference is
  detected, by Fisher's test with the same correction.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from itertools import product

import pandas as pd
from scipy import stats

from safe.companion.claims import Claim
from safe.companion.designs import Design, Level
from safe.companion.paper import MAZES
from safe.companion.verdicts import NOT_REPRODUCED, REPRODUCED, verdict
from safe.experiments.experiment import Experiment
from safe.results import formats
from safe.results.statistics import compare_rates, holm, success_interval

CONFIRMED, NOT_CONFIRMED = "confirmed", "not confirmed"
_WORDS = {REPRODUCED: CONFIRMED, NOT_REPRODUCED: NOT_CONFIRMED}

Levels = Mapping[str, Level]  # of some factors of a design, by which cells are chosen
Results = Mapping[Experiment, pd.DataFrame]


@dataclass(frozen=True)
class Question:
    """Which of two groups of cells succeeds more often, or do they succeed equally often?"""

    statement: str
    first: Levels
    second: Levels
    direction: int = 0  # +1: the first more often; 0: equally often


@dataclass(frozen=True)
class Mechanism:
    """Is something so in most of the traced runs of a cell that last for some generations?"""

    statement: str
    cell: Levels
    holds: Callable[[pd.DataFrame], bool]  # in a run, given the measures of its windows
    lasting: int = 0  # the first generation of a window that runs must have reached


def cells_at(design: Design, levels: Levels) -> list[Experiment]:
    """The experiments of a design at these levels.

    Raises
    ------
    LookupError
        If there are none.
    """
    wanted = {design.factors.index(factor): level for factor, level in levels.items()}
    found = [e for key, e in design.cells.items() if all(key[place] == level for place, level in wanted.items())]
    if not found:
        raise LookupError(f"levels must be those of a cell; got {dict(levels)}")
    return found


def successes(design: Design, results: Results, levels: Levels) -> tuple[int, int]:
    """Successes and runs at these levels, cells taken together."""
    counts = [_counted_successes(results, experiment) for experiment in cells_at(design, levels)]
    return sum(count for count, _ in counts), sum(n for _, n in counts)


def rates(design: Design, results: Results) -> pd.DataFrame:
    """Rates of success of a design's cells.

    Returns
    -------
    pandas.DataFrame, one row for each cell, with the columns of its factors
        successes, runs; rate, low and high: the share of runs that succeed, and the ends of its 95 % interval (Wilson);
        evaluations: how many all runs took; per_success: evaluations over successes, which is what a success costs on
        average if one starts anew after every failure; infinite without a success.
    """
    rows = []
    for key, experiment in design.cells.items():
        runs = results[experiment]
        count, n, evaluations = int(runs.success.sum()), len(runs), int(runs.evaluations.sum())
        low, high = success_interval(count, n)
        measured = {"successes": count, "runs": n, "rate": count / n, "low": low, "high": high}
        measured |= {"evaluations": evaluations, "per_success": evaluations / count if count else math.inf}
        rows.append(dict(zip(design.factors, key, strict=True)) | measured)
    return pd.DataFrame(rows)


def readable_rates(
    confirmed: tuple[Design, Results], explored: tuple[Design, Results]
) -> tuple[pd.DataFrame, list[list[Experiment]]]:
    """Successes to read, mazes side by side, and for each row the experiments behind it.

    In parentheses stands the 95 % interval of the rate, in percent; the runs by which the questions were found are
    counted apart.
    """
    design, results = confirmed
    seen = {key: formats.count(*_counted_successes(explored[1], e)) for key, e in explored[0].cells.items()}
    rows: dict[tuple[Level, ...], dict[str, str]] = {}
    behind: dict[tuple[Level, ...], list[Experiment]] = {}
    for key, experiment in design.cells.items():
        maze, *levels = key
        count, n = _counted_successes(results, experiment)
        low, high = success_interval(count, n)
        row = rows.setdefault(tuple(levels), {})
        row[f"{maze}"] = f"{formats.count(count, n)} ({100 * low:.0f} to {100 * high:.0f} %)"
        row[f"{maze}, explored"] = seen.get(key, formats.DASH)
        behind.setdefault(tuple(levels), []).append(experiment)
    index = pd.MultiIndex.from_tuples(rows, names=design.factors[1:])
    return pd.DataFrame(list(rows.values()), index), list(behind.values())


def _counted_successes(results: Results, experiment: Experiment) -> tuple[int, int]:
    runs = results[experiment]
    return int(runs.success.sum()), len(runs)


def exported(rates: pd.DataFrame, factors: Sequence[str]) -> pd.DataFrame:
    """Successes and runs of a table of `rates`, indexed by levels as they stand in names: maze1_no_archive_raw_safe."""
    names = [
        "_".join(re.findall(r"[\w½]+", " ".join(map(str, row)).lower())) for row in rates[list(factors)].to_numpy()
    ]
    return rates[["successes", "runs"]].set_axis(names)


def summary(table: pd.DataFrame) -> str:
    """How many of the questions of a table of `answers` got which answer, as a sentence; which are not confirmed."""
    counts = table.verdict.value_counts()
    found = ", ".join(f"{count} {verdict}" for verdict, count in counts.items())
    others = table.index[table.verdict != CONFIRMED]
    listed = "".join(f"\n- {table.verdict[statement]}: {statement}" for statement in others)
    return f"Of {len(table)} questions: {found}." + (f" Not confirmed are:\n{listed}" if listed else "")


def answers(
    chapter: str,
    questions: Sequence[Question | Mechanism],
    explored: tuple[Design, Results],
    confirmed: tuple[Design, Results],
    traces: Results,
) -> pd.DataFrame:
    """The answers to the questions of a chapter, as rows of the ledger.

    Parameters
    ----------
    explored, confirmed : design, and the runs of its cells
        With the seed by which the questions were found, and with the one by which they are decided.
    traces : mapping of Experiment to DataFrame
        The recorded mechanism of confirmed cells, see `safe.companion.evidence.traces`.

    Returns
    -------
    pandas.DataFrame, one row for each question, indexed by it
        The columns of `safe.companion.ledger.ledger`, and `explored`: what had been seen when it was asked. Questions
        on cells of which there is nothing, such as those of another maze, are left out.
    """
    rows = []
    for question in questions:
        try:
            if isinstance(question, Question):
                rows.append(_compared(question, explored, confirmed))
            else:
                rows.append(_counted(question, confirmed[0], traces))
        except LookupError:
            continue
    columns = [field.name for field in fields(Claim)] + ["explored"]
    table = pd.DataFrame(rows, columns=columns).set_index("claim").assign(family=f"beyond the paper: {chapter}")
    table["p_adjusted"] = holm(table.p_value)
    table["verdict"] = [_WORDS[verdict(row)] for _, row in table.iterrows()]
    return table


def readable_answers(table: pd.DataFrame) -> pd.DataFrame:
    """A table of `answers` to read; differences are in percentage points."""
    differences = table[["difference", "low", "high"]].to_numpy()
    return pd.DataFrame(
        {
            "answer": table.verdict,
            "here": table.here,
            "difference (95 % interval)": [formats.difference_of_rates(*row) for row in differences],
            "p (Holm)": table.p_adjusted.map(formats.p_value),
            "p (equivalence)": table.p_equivalence.map(formats.p_value),
            "explored": table.explored,
        },
        index=table.index.rename("question"),
    )


def _compared(question: Question, explored: tuple[Design, Results], confirmed: tuple[Design, Results]) -> dict:
    """The row of a question that two rates of success decide."""
    counts = [successes(*confirmed, levels) for levels in (question.first, question.second)]
    seen = [successes(*explored, levels) for levels in (question.first, question.second)]
    return {
        "claim": question.statement,
        "statement": question.statement,
        "here": " against ".join(formats.count(*counted) for counted in counts),
        "explored": " against ".join(formats.count(*counted) for counted in seen),
        "test": "Fisher, Newcombe",
        "direction": question.direction,
        **asdict(compare_rates(*counts[0], *counts[1])),
    }


def _counted(mechanism: Mechanism, design: Design, traces: Results) -> dict:
    """The row of a question that a share of runs decides."""
    of_cells = [traces[experiment] for experiment in cells_at(design, mechanism.cell)]
    runs = [of_run for of_cell in of_cells for _, of_run in of_cell.groupby("run")]
    held = [mechanism.holds(of_run) for of_run in runs if of_run.window.max() >= mechanism.lasting]
    if not held:
        raise LookupError(f"runs must have reached generation {mechanism.lasting}; got none")
    count, n = sum(held), len(held)
    low, high = success_interval(count, n)
    return {
        "claim": mechanism.statement,
        "statement": mechanism.statement,
        "here": formats.count(count, n),
        "explored": formats.DASH,
        "test": "binomial, Wilson",
        "direction": 1,
        "difference": count / n - 0.5,
        "low": low - 0.5,
        "high": high - 0.5,
        "p_value": float(stats.binomtest(count, n).pvalue),
    }


# The questions, by chapter

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
    }


def _selection() -> Iterator[Question | Mechanism]:
    def cell(maze: str, condition: str, weighed: str, judge: str) -> Levels:
        return {"maze": maze, "condition": condition, "weighed": weighed, "judge": judge}

    for maze, condition in product(MAZES, (PAPERS, NONE)):
        where, safe = f"on {maze} with {condition}", cell(maze, condition, RAW, "SAFE")
        for other in ("novelty search", "SAFE, frozen", "one fixed sum", "a drawn judge"):
            yield Question(f"SAFE succeeds as often as {_who(other)} {where}", safe, cell(maze, condition, RAW, other))
        for weighed in (SHARES, RANKS):
            yield Question(
                f"SAFE succeeds more often if it weighs raw components than {weighed} {where}",
                safe,
                cell(maze, condition, weighed, "SAFE"),
                1,
            )
    for maze in MAZES:
        where = f"on {maze} with no archive"
        for weighed, other in product((SHARES, RANKS), ("SAFE", "one fixed sum")):
            yield Question(
                f"A drawn judge of {weighed} succeeds more often than {_who(other)} of {weighed} {where}",
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
        "A drawn judge of shares of the largest succeeds more often than novelty search on maze2, "
        "both with no archive and mutation alone",
        cell("maze2", ALONE, SHARES, "a drawn judge"),
        cell("maze2", ALONE, RAW, "novelty search"),
        1,
    )
    for maze in MAZES:
        raw, shares, ranks = (cell(maze, PAPERS, weighed, "SAFE") for weighed in (RAW, SHARES, RANKS))
        yield Mechanism(
            f"In most runs of SAFE on {maze}, at least 99 % of tournaments are won by a solution that none of the "
            "others surpasses in novelty",
            raw,
            lambda windows: windows.by_novelty.mean() >= 0.99,
        )
        yield Mechanism(
            f"In most runs of SAFE on {maze}, from generation {LATER} on, one objective function gives at least "
            "90 % of the fitnesses of a generation, on average",
            raw,
            lambda windows: _later(windows).share.mean() >= 0.9,
        )
        yield Mechanism(
            f"In most runs of SAFE on {maze}, selection for novelty is at least 5 times as strong as for closeness",
            raw,
            lambda windows: windows.differential_novelty.mean() >= 5 * windows.differential_closeness.mean(),
        )
        yield Mechanism(
            f"In most runs of SAFE of shares of the largest on {maze}, selection is stronger for closeness than for "
            f"novelty from generation {LATER} on",
            shares,
            lambda windows: _later(windows).differential_closeness.mean() > _later(windows).differential_novelty.mean(),
        )
        yield Mechanism(
            f"In most runs of SAFE of ranks on {maze}, from generation {LATER} on, the objective function that gives "
            "most fitnesses has both coefficients above 0.8, on average",
            ranks,
            lambda windows: min(_later(windows).a.mean(), _later(windows).b.mean()) > 0.8,
        )


def _archives() -> Iterator[Question | Mechanism]:
    def cell(maze: str, search: str, archive: str) -> Levels:
        return {"maze": maze, "algorithm": search, "archive": archive}

    for maze, search in product(MAZES, ("novelty search", "SAFE")):
        papers, who = cell(maze, search, "the paper's"), f"{_capital(search)} on {maze} succeeds"
        for archive, words in (
            ("none", "without an archive"),
            ("random", "with random admission"),
            ("threshold", "with Lehman and Stanley's threshold"),
            ("the paper's, distinct cells", "with the paper's archive if it holds no cell twice"),
            ("the paper's, rescored", "with the paper's archive if its scores are computed anew"),
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
        papers, who = cell(maze, "novelty search", "the paper's"), f"In most runs of novelty search on {maze}"
        yield Mechanism(
            f"{who}, the paper's archive is full after {LATER} generations",
            papers,
            lambda windows: windows[windows.window >= LATER].archive_size.min() >= 1000,
            LATER,
        )
        yield Mechanism(
            f"{who} that last {LONG} generations, its lowest score is above the mean novelty of the population at "
            "the end",
            papers,
            lambda windows: _last(windows).archive_lowest > _last(windows).novelty,
            LONG,
        )
        yield Mechanism(
            f"{who} that last {LONG} generations, fewer than 10 of 200 solutions enter it in a generation at the end",
            papers,
            lambda windows: _last(windows).entered < 10,
            LONG,
        )
        yield Mechanism(
            f"{who} that last {LONG} generations, its points lie in fewer cells than two thirds of their number at "
            "the end",
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
                f"{_capital(search)} on {maze} succeeds more often with {places:,} places in the paper's archive than "
                "with 1,000",
                papers | {"places": places},
                papers | {"places": 1000},
                1,
            )


def _mutualism() -> Iterator[Question | Mechanism]:
    def cell(maze: str, condition: str, weighed: str, rating: str) -> Levels:
        return {"maze": maze, "condition": condition, "weighed": weighed, "rating": rating}

    for maze, condition, rating in product(MAZES, (PAPERS, NONE), ("Pearson", "Spearman")):
        where, raw = f"on {maze} with {condition}", cell(maze, condition, RAW, rating)
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
        in_most = f"In most runs on {maze}, with objective functions rated by {rating}'s correlation"
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


def _who(judge: str) -> str:
    return {"SAFE, frozen": "SAFE with frozen objective functions"}.get(judge, judge)


def _capital(text: str) -> str:
    return text[0].upper() + text[1:]


def _later(windows: pd.DataFrame) -> pd.DataFrame:
    """The windows from LATER on; all of a run that has ended before."""
    later = windows[windows.window >= LATER]
    return later if len(later) else windows


def _last(windows: pd.DataFrame) -> pd.Series:
    """The last window of a run."""
    return windows.iloc[-1]
