"""What was asked of the experiments beyond the paper, before the runs that decide it, and the answers.

Questions come from runs with one seed (`designs.EXPLORED`), and are decided by runs with another (`designs.CONFIRMED`),
by the rules of the ledger (`safe.companion.verdicts`):

- a direction ("more often than"): by Fisher's exact test, or for a share of runs ("in most runs") by the binomial test
  against one half, with Holm's correction for all questions of the same design;
- a likeness ("as often as"): by two one-sided tests against an effect of `statistics.MARGIN`, unless a difference is
  detected, by Fisher's test with the same correction.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, fields

import pandas as pd
from scipy import stats

from safe.companion import evidence
from safe.companion.claims import Claim
from safe.companion.designs import EXPLORED, RUNS, Design, Level
from safe.companion.questions import Levels, Mechanism, Question, all_questions
from safe.companion.verdicts import NOT_REPRODUCED, REPRODUCED, verdict
from safe.experiments.experiment import Experiment
from safe.maze import Maze
from safe.results import formats
from safe.results.statistics import compare_rates, holm, success_interval

BEYOND = "beyond the paper"  # the family of its claims, with the name of the design
CONFIRMED, NOT_CONFIRMED = "confirmed", "not confirmed"
_WORDS = {REPRODUCED: CONFIRMED, NOT_REPRODUCED: NOT_CONFIRMED}

Results = Mapping[Experiment, pd.DataFrame]


def explored(
    make_design: Callable[[Sequence[Maze], int, int], Design], mazes: Sequence[Maze]
) -> tuple[Design, Results]:
    """The cells of a design that were explored on these mazes, and their recorded runs."""
    design = make_design(mazes, RUNS[EXPLORED], EXPLORED)
    results = evidence.runs(design.cells.values())
    return Design(design.factors, {key: e for key, e in design.cells.items() if e in results}), results


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
    name: str,
    explored: tuple[Design, Results],
    confirmed: tuple[Design, Results],
    traces: Results,
) -> pd.DataFrame:
    """The answers to the questions of a design, as rows of the ledger.

    Parameters
    ----------
    name : str
        Of the design, and of its questions (see `safe.companion.questions`).
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
    for question in all_questions()[name]:
        try:
            if isinstance(question, Question):
                rows.append(_compared(question, explored, confirmed))
            else:
                rows.append(_counted(question, confirmed[0], traces))
        except LookupError:
            continue
    columns = [field.name for field in fields(Claim)] + ["explored"]
    table = pd.DataFrame(rows, columns=columns).set_index("claim").assign(family=f"{BEYOND}: {name}")
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
    try:
        seen = " against ".join(
            formats.count(*successes(*explored, levels)) for levels in (question.first, question.second)
        )
    except LookupError:
        seen = formats.DASH
    return {
        "claim": question.statement,
        "statement": question.statement,
        "here": " against ".join(formats.count(*counted) for counted in counts),
        "explored": seen,
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
