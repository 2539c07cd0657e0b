"""From tables of runs to tables of results, beside the paper's."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd
from scipy import stats

from safe import checks

CONFIDENCE = 0.95


def published() -> pd.DataFrame:
    """Every number in the paper's results: table, maze, item, quantity, mean (or the number itself), sd, n."""
    return pd.read_csv(Path(__file__).with_name("published.csv"))


def success_interval(successes: int, runs: int) -> tuple[float, float]:
    """Wilson's 95 % interval for the rate of success, its two ends in [0, 1].

    Examples
    --------
    >>> low, high = success_interval(322, 500)
    >>> round(low, 3), round(high, 3)
    (0.601, 0.685)
    """
    interval = stats.binomtest(successes, runs).proportion_ci(CONFIDENCE, method="wilson")
    return float(interval.low), float(interval.high)


def success_table(results: Mapping[tuple[str, str], pd.DataFrame]) -> pd.DataFrame:
    """Successes and generations to success, beside the paper's.

    Parameters
    ----------
    results : mapping of (maze, algorithm) to DataFrame
        The runs of each experiment, as `safe.run` gives them.

    Returns
    -------
    pandas.DataFrame, one row for each experiment, indexed by maze and algorithm
        successes, runs; low and high, the ends of the 95 % interval of the rate; mean and sd (ddof = 0) of the
        generations to success; paper_successes, paper_runs, paper_mean and paper_sd; p_value, of Fisher's exact
        test that both rates are the same. Not a number where there is none.
    """
    paper = published().set_index(["maze", "item", "quantity"])[["mean", "sd", "n"]]
    nothing = pd.Series({"mean": np.nan, "sd": np.nan, "n": np.nan})
    rows = {}
    for (maze, algorithm), runs in results.items():
        generations = runs.generation[runs.success]
        successes = len(generations)
        low, high = success_interval(successes, len(runs))
        counted, timed = (
            paper.loc[key] if (key := (maze, algorithm, quantity)) in paper.index else nothing
            for quantity in ("successes", "generations to success")
        )
        p_value = np.nan
        if not np.isnan(counted["n"]):
            both = [(successes, len(runs) - successes), (counted["mean"], counted["n"] - counted["mean"])]
            p_value = stats.fisher_exact(np.array(both, dtype=int)).pvalue
        rows[maze, algorithm] = {
            "successes": successes,
            "runs": len(runs),
            "low": low,
            "high": high,
            "mean": generations.mean(),
            "sd": generations.std(ddof=0),
            "paper_successes": counted["mean"],
            "paper_runs": counted["n"],
            "paper_mean": timed["mean"],
            "paper_sd": timed["sd"],
            "p_value": p_value,
        }
    table = pd.DataFrame.from_dict(rows, orient="index")
    return table.rename_axis(["maze", "algorithm"])


def readable_success_table(table: pd.DataFrame) -> pd.DataFrame:
    """A table of `success_table` to read: intervals as counts out of the runs, a dash for what is not there."""

    def show(template: str, *values: float) -> str:
        return "–" if np.isnan(values).any() else template.format(*values)

    rows = {}
    for index, row in table.iterrows():
        rate = row.paper_successes / row.paper_runs
        rows[index] = {
            "successes": f"{row.successes:.0f} of {row.runs:.0f}",
            "95 % interval": f"{row.low * row.runs:.0f} to {row.high * row.runs:.0f}",
            "in the paper": show("{:.0f} of {:.0f}", row.paper_successes, row.paper_runs),
            "paper within": "–" if np.isnan(rate) else "yes" if row.low <= rate <= row.high else "no",
            "p": show("{:.2f}", row.p_value),
            "generations to success, mean (sd)": show("{:.0f} ({:.0f})", row["mean"], row.sd),
            "mean (sd) in the paper": show("{:.0f} ({:.0f})", row.paper_mean, row.paper_sd),
        }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis(table.index.names)


def first_solutions(results: pd.DataFrame, n: int) -> pd.DataFrame:
    """The first n successful runs of an experiment; where there are fewer, then those that came closest to the goal.

    Raises
    ------
    ValueError
        Where n is less than 1.
    """
    n = checks.integer("n", n, 1)
    miss = results.distance.where(~results.success, 0)
    return results.assign(miss=miss).sort_values(["miss", "run"]).drop(columns="miss").head(n)
