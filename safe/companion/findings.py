"""What was asked of the experiments beyond the paper, before the runs that decide it, and the answers.

Questions come from runs with one seed (`designs.EXPLORING`), and are decided by runs with another (`designs.DECIDING`),
by the rules of the ledger (`safe.companion.verdicts`):

- a direction ("more often than"): by Fisher's exact test, or for a share of runs ("in most runs") by the binomial test
  against one half, with Holm's correction for all questions of the same design;
- a likeness ("as often as"): by two one-sided tests against an effect of `statistics.MARGIN`, unless a difference is
  detected, by Fisher's test with the same correction.

A question is confirmed where the ledger would say that a claim is reproduced, and undecided where no difference is
detectable.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, fields
from pathlib import Path

import pandas as pd
from scipy import stats

from safe.companion import designs, evidence, verdicts
from safe.companion.claims import Claim
from safe.companion.designs import DECIDING, EXPLORING, RUNS, Design, Level
from safe.companion.questions import LATER, Levels, Mechanism, Question, all_questions
from safe.experiments.experiment import Experiment
from safe.maze import Maze
from safe.results import formats
from safe.results.mechanism import SINCE_START
from safe.results.statistics import compare_rates, holm, success_interval

RECORD = Path(__file__).with_name("findings.csv")
BEYOND = "beyond the paper"  # the family of its claims, with the name of the design
CONFIRMED, NOT_CONFIRMED, UNDECIDED = "confirmed", "not confirmed", "undecided"
_WORDS = {
    verdicts.REPRODUCED: CONFIRMED,
    verdicts.NOT_REPRODUCED: NOT_CONFIRMED,
    verdicts.UNDECIDED: UNDECIDED,
}

Results = Mapping[Experiment, pd.DataFrame]


class NothingThereError(LookupError):
    """A question that these runs do not bear on: their design has no such cell, or nobody looked into its runs."""


def beyond_the_paper(mazes: Sequence[Maze], runs: int) -> pd.DataFrame:
    """The answers to all questions on these mazes, of recorded runs alone, as a ledger.

    Parameters
    ----------
    mazes : sequence of Maze
    runs : int
        As in the designs; no more than are recorded.
    """
    tables = []
    for name in all_questions():
        make_design = getattr(designs, name)
        design = make_design(mazes, min(runs, RUNS[DECIDING]), DECIDING)
        results = evidence.runs(design.cells.values())
        design = Design(design.factors, {key: e for key, e in design.cells.items() if e in results})
        traces = evidence.traces(list(results), designs.TRACED)
        tables.append(answers(name, explored(make_design, mazes), (design, results), traces))
    return pd.concat(tables)


def explored(
    make_design: Callable[[Sequence[Maze], int, int], Design], mazes: Sequence[Maze]
) -> tuple[Design, Results]:
    """The cells of a design that were explored on these mazes, and their recorded runs."""
    design = make_design(mazes, RUNS[EXPLORING], EXPLORING)
    results = evidence.runs(design.cells.values())
    return Design(design.factors, {key: e for key, e in design.cells.items() if e in results}), results


def cells_at(design: Design, levels: Levels) -> list[Experiment]:
    """The experiments of a design at these levels.

    Raises
    ------
    NothingThereError
        If there are none.
    """
    wanted = {design.factors.index(factor): level for factor, level in levels.items()}
    found = [e for key, e in design.cells.items() if all(key[place] == level for place, level in wanted.items())]
    if not found:
        raise NothingThereError(f"levels must be those of a cell; got {dict(levels)}")
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
        average if one starts again after every failure; infinite without a success.
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
    for (key, experiment), found in zip(design.cells.items(), rates(design, results).itertuples(), strict=True):
        maze, *levels = key
        row = rows.setdefault(tuple(levels), {})
        row[f"{maze}"] = (
            f"{formats.count(found.successes, found.runs)} ({100 * found.low:.0f} to {100 * found.high:.0f} %)"
        )
        row[f"{maze}, explored"] = seen.get(key, formats.DASH)
        behind.setdefault(tuple(levels), []).append(experiment)
    index = pd.MultiIndex.from_tuples(rows, names=design.factors[1:])
    return pd.DataFrame(list(rows.values()), index), list(behind.values())


def _counted_successes(results: Results, experiment: Experiment) -> tuple[int, int]:
    runs = results[experiment]
    return int(runs.success.sum()), len(runs)


def readable_mechanism(design: Design, traces: Results, levels: Levels, measures: Mapping[str, str]) -> pd.DataFrame:
    """What happens inside the runs of some cells, to read.

    Means over windows from generation LATER on, and then over the runs that lasted so long; of measures since the start
    of a run what it reached.

    Parameters
    ----------
    levels : mapping of str to str or int
        Those by which cells are chosen; the table's index has the other factors.
    measures : mapping of str to str
        Measures of `safe.results.mechanism`, and the headings of their columns.
    """
    places = [place for place, factor in enumerate(design.factors) if factor not in levels]
    chosen = set(cells_at(design, levels))
    rows = {}
    for key, experiment in design.cells.items():
        if experiment in chosen and experiment in traces:
            runs = [
                of_run.loc[of_run.window >= LATER, list(measures)] for _, of_run in traces[experiment].groupby("run")
            ]
            of_runs = pd.DataFrame([of_run.mean() for of_run in runs])
            counted = [measure for measure in measures if measure in SINCE_START]
            of_runs[counted] = pd.DataFrame([of_run[counted].max() for of_run in runs])
            shown = [formats.DASH if math.isnan(value) else f"{value:.3g}" for value in of_runs.mean()]
            rows[tuple(key[place] for place in places)] = shown
    names = [design.factors[place] for place in places]
    return pd.DataFrame(list(rows.values()), pd.MultiIndex.from_tuples(rows, names=names), list(measures.values()))


def exported(rates: pd.DataFrame, factors: Sequence[str]) -> pd.DataFrame:
    """Successes and runs of a table of `rates`, indexed by levels as they stand in names: maze1_no_archive_raw_safe."""
    names = [
        "_".join(re.findall(r"[\w½]+", " ".join(map(str, row)).lower())) for row in rates[list(factors)].to_numpy()
    ]
    return rates[["successes", "runs"]].set_axis(names)


def summary(table: pd.DataFrame) -> str:
    """How many of the questions of a table of `answers` got which answer, as a sentence; which are not confirmed."""
    if not len(table):
        return "No question was asked of these mazes."
    counts = table.verdict.value_counts()
    said = f"{len(table)} questions were asked: {counts.get(CONFIRMED, 0)} are confirmed"
    said += f", {counts.get(NOT_CONFIRMED, 0)} are not, and {counts.get(UNDECIDED, 0)} are undecided."
    others = table[table.verdict != CONFIRMED]
    listed = "".join(f"\n- {row.statement} ({row.maze}: {row.verdict}, {row.here})" for row in others.itertuples())
    return said + (f" Not confirmed are:\n{listed}" if listed else "")


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
        The columns of `safe.companion.ledger.ledger`, maze, and explored: the same of the runs of the exploration.
        Questions on cells of which there is nothing, such as those of another maze, are left out.
    """
    rows = []
    for question in all_questions()[name]:
        try:
            if isinstance(question, Question):
                found = _compared(question, explored, confirmed)
            else:
                found = _counted(question, confirmed[0], traces)
        except NothingThereError:
            continue
        about = {
            "claim": f"{question.maze}: {question.statement}",
            "statement": question.statement,
            "maze": question.maze,
        }
        rows.append(about | {"source": "here", "paper": formats.DASH} | found)
    columns = [*(field.name for field in fields(Claim)), "maze", "explored"]
    table = pd.DataFrame(rows, columns=columns).set_index("claim").assign(family=f"{BEYOND}: {name}")
    table["p_adjusted"] = holm(table.p_value)
    table["verdict"] = [_WORDS[verdicts.verdict(row)] for _, row in table.iterrows()]
    return table


def readable_answers(table: pd.DataFrame) -> pd.DataFrame:
    """A table of `answers` to read, mazes side by side: the answers, differences in percentage points, and p.

    The difference of a share of runs is from one half. p is Holm's, or of equivalence for what succeeds as often.
    """
    rows: dict[str, dict[str, str]] = {}
    for row in table.itertuples():
        found = rows.setdefault(row.statement, {})
        found[f"{row.maze}"] = row.verdict
        found[f"{row.maze}: difference"] = formats.difference_of_rates(row.difference, row.low, row.high)
        is_likeness = row.direction == 0 and row.verdict != NOT_CONFIRMED
        found[f"{row.maze}: p"] = formats.p_value(row.p_equivalence if is_likeness else row.p_adjusted)
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("question").fillna(formats.DASH)


def readable_ledger(table: pd.DataFrame, name: str) -> pd.DataFrame:
    """The answers to the questions of a design, with all numbers, to read; differences are in percentage points."""
    part = table[table.family == f"{BEYOND}: {name}"]
    differences = part[["difference", "low", "high"]].to_numpy()
    words = {
        "answer": part.verdict,
        "here": part.here,
        "difference (95 % interval)": [formats.difference_of_rates(*row) for row in differences],
        "p (Holm)": part.p_adjusted.map(formats.p_value),
        "p (equivalence)": part.p_equivalence.map(formats.p_value),
        "explored": part.explored,
    }
    return pd.DataFrame(words).rename_axis("question")


def counted(table: pd.DataFrame) -> pd.DataFrame:
    """How many questions of each design got which answer."""
    designs_of = table.family.str.removeprefix(f"{BEYOND}: ")
    counts = pd.crosstab(designs_of, table.verdict)
    counts = counts.reindex(index=designs_of.unique(), columns=list(_WORDS.values()), fill_value=0)
    counts.loc["all"] = counts.sum()
    return counts.rename_axis(index="questions", columns=None)


def _compared(question: Question, explored: tuple[Design, Results], confirmed: tuple[Design, Results]) -> dict:
    """The row of a question that two rates of success decide."""
    counts = [successes(*confirmed, levels) for levels in (question.first, question.second)]
    try:
        seen = " against ".join(
            formats.count(*successes(*explored, levels)) for levels in (question.first, question.second)
        )
    except NothingThereError:
        seen = formats.DASH
    return {
        "here": " against ".join(formats.count(*counted) for counted in counts),
        "evidence": _evidence(confirmed[0], question.first, question.second),
        "explored": seen,
        "test": "Fisher, Newcombe",
        "direction": question.direction,
        **asdict(compare_rates(*counts[0], *counts[1])),
    }


def _counted(mechanism: Mechanism, design: Design, traces: Results) -> dict:
    """The row of a question that a share of runs decides."""
    (cell,) = cells_at(design, mechanism.cell)
    if cell not in traces:
        raise NothingThereError(f"cell must have traced runs; got {dict(mechanism.cell)}")
    runs = [of_run for _, of_run in traces[cell].groupby("run")]
    held = [mechanism.holds(of_run) for of_run in runs if of_run.window.max() >= mechanism.lasting]
    count, n = sum(held), len(held)
    low, high = success_interval(count, n) if n else (math.nan, math.nan)
    return {
        "here": formats.count(count, n) if n else "no run lasted",
        "evidence": f"{n} runs, seed {cell.seed}",
        "explored": formats.DASH,
        "test": "binomial, Wilson",
        "direction": 1,
        "difference": count / n - 0.5 if n else math.nan,
        "low": low - 0.5,
        "high": high - 0.5,
        "p_value": float(stats.binomtest(count, n).pvalue) if n else 1.0,
    }


def _evidence(design: Design, *levels: Levels) -> str:
    """The cells behind an answer, in words."""
    groups = [cells_at(design, of_group) for of_group in levels]
    seeds = ", ".join(dict.fromkeys(str(cell.seed) for group in groups for cell in group))
    sizes = " against ".join(f"{sum(cell.runs for cell in group)} runs of {len(group)} cells" for group in groups)
    return f"{sizes}, seed {seeds}".replace(" of 1 cells", "")
