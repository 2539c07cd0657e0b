"""What the contest found: rates over mazes, the answers to its contrasts, and evaluations to success.

Mazes are the sample: what holds on these should hold on others that are drawn alike. So each maze counts once, by its
rates of success (see `safe.results.statistics` and `safe.results.mixed`).
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import numpy as np
import pandas as pd

from safe.companion import contest, evidence, held_out
from safe.companion.contest import LEVELS, Contrast
from safe.companion.designs import DECIDING, VARIATION, Design
from safe.companion.findings import BEYOND, CONFIRMED, NOT_CONFIRMED, UNDECIDED
from safe.experiments.experiment import Experiment
from safe.results import formats
from safe.results.mixed import mixed_model
from safe.results.statistics import compare_pairs, holm, mean_over_mazes

Results = Mapping[Experiment, pd.DataFrame]
Counts = pd.DataFrame  # successes and runs, indexed by contestant, operators and maze


def counts(design: Design, results: Results) -> Counts:
    """Successes and runs of each cell of a contest.

    Returns
    -------
    pandas.DataFrame, indexed by contestant, operators and maze
        successes, runs, and evaluations, the sum over the runs.
    """
    rows = {
        (contestant, operators, maze): {
            "successes": int(results[experiment].success.sum()),
            "runs": len(results[experiment]),
            "evaluations": int(results[experiment].evaluations.sum()),
        }
        for (maze, contestant, operators), experiment in design.cells.items()
        if experiment in results
    }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis(["contestant", "operators", "maze"])


def telling(counts: Counts) -> list[str]:
    """The mazes on which not all runs of all contestants succeed, and not none; the others tell nobody apart."""
    pooled = counts.groupby(level="maze", sort=False)[["successes", "runs"]].sum()
    return pooled.index[(pooled.successes > 0) & (pooled.successes < pooled.runs)].tolist()


def ladder(counts: Counts) -> pd.DataFrame:
    """Mean rates of success over mazes, the highest first.

    Returns
    -------
    pandas.DataFrame, indexed by contestant and operators
        mazes, runs (of each maze), rate, low and high: the mean over mazes and the ends of its 95 % interval, by the
        bootstrap over mazes; solved: mazes on which some run succeeds; per_success: evaluations of all runs, over
        successes.
    """
    rows = {}
    for key, of_one in counts.groupby(level=["contestant", "operators"], sort=False):
        mean, low, high = mean_over_mazes((of_one.successes / of_one.runs).to_numpy())
        total = of_one.successes.sum()
        rows[key] = {
            "mazes": len(of_one),
            "runs": int(of_one.runs.iloc[0]),
            "rate": float(mean),
            "low": float(low),
            "high": float(high),
            "solved": int((of_one.successes > 0).sum()),
            "per_success": of_one.evaluations.sum() / total if total else np.inf,
        }
    table = pd.DataFrame.from_dict(rows, orient="index").rename_axis(["contestant", "operators"])
    return table.sort_values("rate", ascending=False, kind="stable")


def answers(contrasts: list[Contrast], counts: Counts) -> pd.DataFrame:
    """The contrasts, decided by their rule (see `safe.companion.contest.contrasts`).

    Returns
    -------
    pandas.DataFrame, one row for each contrast
        question, first, second, operators, mazes (how many count), runs (on each); first_rate and second_rate, the
        means over mazes; difference, low and high: of these means, and the ends of its 95 % interval; better and
        worse: mazes on which the first has the higher rate, and the lower; p_value (Wilcoxon), p_holm; effect, error
        and p_model: of the binomial mixed model, in log odds; answer: "confirmed" if the first has the higher mean and
        p_holm is below the level of the question, "not confirmed" if it has the lower one and p_holm is, otherwise
        "undecided".

    Raises
    ------
    KeyError
        If a contestant did not take part.
    """
    counts = counts.sort_index()
    ends = {(name, one.operators) for one in contrasts for name in (one.first, one.second)}
    taking_part = counts[counts.index.droplevel("maze").isin(ends)]
    mazes = telling(taking_part) or taking_part.index.unique("maze").tolist()  # if none tells anybody apart, p is 1
    rows = []
    for one in contrasts:
        first, second = (counts.loc[(name, one.operators)].loc[mazes] for name in (one.first, one.second))
        rates = [(of_one.successes / of_one.runs).to_numpy() for of_one in (first, second)]
        pair = compare_pairs(*rates)
        model = mixed_model(first.successes, first.runs, second.successes, second.runs)
        rows.append(
            {
                "question": one.question,
                "first": one.first,
                "second": one.second,
                "operators": one.operators,
                "mazes": len(mazes),
                "runs": int(first.runs.iloc[0]),
                "first_rate": rates[0].mean(),
                "second_rate": rates[1].mean(),
                "difference": pair.difference,
                "low": pair.low,
                "high": pair.high,
                "better": pair.better,
                "worse": pair.worse,
                "p_value": pair.p_value,
                "effect": model.effect,
                "error": model.error,
                "p_model": model.p_value,
            }
        )
    table = pd.DataFrame(rows)
    table.insert(table.columns.get_loc("p_value") + 1, "p_holm", holm(table.p_value))
    is_detected = table.p_holm < table.question.map(LEVELS)
    table["answer"] = np.select(
        [is_detected & (table.difference > 0), is_detected & (table.difference < 0)],
        [CONFIRMED, NOT_CONFIRMED],
        UNDECIDED,
    )
    return table


def as_findings(answers: pd.DataFrame, seen: Counts, seed: int) -> pd.DataFrame:
    """A table of `answers` as rows of the ledger, with the columns of `safe.companion.findings.answers`.

    Parameters
    ----------
    answers : DataFrame
    seen : DataFrame
        Counts of the runs by which the contrasts were found.
    seed : int
        Of the runs that decide.
    """
    seen = seen.sort_index()
    before = seen.index.droplevel("maze").unique()
    rows = []
    for row in answers.itertuples():
        keys = [(name, row.operators) for name in (row.first, row.second)]
        explored = _rates(*(_mean_rate(seen.loc[key]) for key in keys)) if {*keys} <= {*before} else formats.DASH
        statement = f"{row.first} succeeds more often than {row.second} ({row.operators})"
        rows.append(
            {
                "claim": f"unseen mazes: {statement}",
                "source": "here",
                "statement": statement,
                "family": f"{BEYOND}: contest",
                "paper": formats.DASH,
                "here": _rates(row.first_rate, row.second_rate),
                "evidence": f"{row.mazes} mazes, {row.runs} runs on each, seed {seed}",
                "test": "Wilcoxon, bootstrap",
                "direction": 1,
                "difference": row.difference,
                "low": row.low,
                "high": row.high,
                "p_value": row.p_value,
                "effect": row.effect,
                "p_equivalence": np.nan,
                "maze": "unseen mazes",
                "explored": explored,
                "p_adjusted": row.p_holm,
                "verdict": row.answer,
            }
        )
    return pd.DataFrame(rows).set_index("claim")


def on_unseen_mazes(runs: int) -> pd.DataFrame:
    """The contest's answers by recorded runs alone, as rows of the ledger; `runs` is that of `contest.decided`."""
    design = contest.decided(held_out.test_set(), min(runs, contest.RUNS), DECIDING)
    decided = answers(contest.contrasts(), counts(design, evidence.runs(design.cells.values())))
    return as_findings(decided, tried(), DECIDING)


def tried() -> Counts:
    """The counts of all that was tried on the design set."""
    return _tried().copy()


@cache  # of thousands of experiments
def _tried() -> Counts:
    design = contest.tried(held_out.design_set(), contest.TRIED)
    return counts(design, evidence.runs(design.cells.values()))


def readable_tried(on_design_set: Counts, on_known: Counts) -> pd.DataFrame:
    """What was tried, to read, family by family, in each the best with mutation alone in front.

    Returns
    -------
    pandas.DataFrame, indexed by family and contestant
        For each set of operators the mean rate on the design set in percent, with its 95 % interval; for each known
        maze the successes, with one set of operators after the other.
    """
    families = {one.name: one.family for one in contest.contestants()}
    of_design = ladder(on_design_set).reset_index()
    of_design["family"] = of_design.contestant.map(families).fillna("peers")
    best = of_design[of_design.operators == "mutation alone"].set_index("contestant").rate
    order = [*dict.fromkeys(families.values()), "peers"]
    rows = {}
    for (family, name), found in of_design.groupby(["family", "contestant"]):
        by_operators = found.set_index("operators")
        row = {
            operators: "{:.0f} ({:.0f} to {:.0f})".format(*100 * by_operators.loc[operators, ["rate", "low", "high"]])
            for operators in VARIATION
        }
        for maze in on_known.index.unique("maze"):
            row[maze] = ", ".join(str(on_known.successes[name, operators, maze]) for operators in VARIATION)
        rows[family, name] = row
    keys = sorted(rows, key=lambda key: (order.index(key[0]), -best[key[1]], key[1]))
    return pd.DataFrame([rows[key] for key in keys], pd.MultiIndex.from_tuples(keys, names=["family", "contestant"]))


def _mean_rate(of_one: Counts) -> float:
    return float((of_one.successes / of_one.runs).mean())


def _rates(first: float, second: float) -> str:
    return f"{100 * first:.0f} % against {100 * second:.0f} %"
