"""From tables of runs to tables of results, beside the paper's."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd
from scipy import stats

from safe import checks
from safe.algorithms import ALGORITHMS, Parameters
from safe.experiment import Experiment
from safe.maze import load_maze, maze_names

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


def success_table(results: Mapping[Experiment, pd.DataFrame]) -> pd.DataFrame:
    """Successes and generations to success, beside the paper's where an experiment is one of the paper's.

    Parameters
    ----------
    results : mapping of Experiment to DataFrame
        The runs of each experiment, as `safe.run` gives them.

    Returns
    -------
    pandas.DataFrame, one row for each experiment, indexed by the names of maze and algorithm
        successes, runs; low and high, the ends of the 95 % interval of the rate; mean and sd (ddof = 0) of the
        generations to success; paper_successes, paper_runs, paper_mean and paper_sd; p_value, of Fisher's exact
        test that both rates are the same. Not a number where there is none.
    """
    rows = {}
    for experiment, runs in results.items():
        # random search goes on after a success, so it has no generations to success
        counted = runs.success & (not experiment.algorithm.is_random_search)
        generations = runs.generation[counted]
        successes = int(runs.success.sum())
        low, high = success_interval(successes, len(runs))
        paper, paper_time = (
            _published_for(experiment, "successes"),
            _published_for(experiment, "generations to success"),
        )
        p_value = np.nan
        if not np.isnan(paper["n"]):
            both = [(successes, len(runs) - successes), (paper["mean"], paper["n"] - paper["mean"])]
            p_value = stats.fisher_exact(np.array(both, dtype=int)).pvalue
        rows[experiment.maze.name, experiment.algorithm.name] = {
            "successes": successes,
            "runs": len(runs),
            "low": low,
            "high": high,
            "mean": generations.mean(),
            "sd": generations.std(ddof=0),
            "paper_successes": paper["mean"],
            "paper_runs": paper["n"],
            "paper_mean": paper_time["mean"],
            "paper_sd": paper_time["sd"],
            "p_value": p_value,
        }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis(["maze", "algorithm"])


def _published_for(experiment: Experiment, quantity: str) -> pd.Series:
    """Mean, sd and n of a quantity in the paper; not a number where the paper has no such experiment or quantity.

    What an experiment is called does not make it the paper's: its maze, algorithm and parameters do.
    """
    maze, algorithm = experiment.maze, experiment.algorithm
    is_the_papers = (
        maze.name in maze_names()
        and maze == load_maze(maze.name)
        and algorithm == ALGORITHMS.get(algorithm.name)
        and experiment.parameters == Parameters()
    )
    paper = published()
    found = paper[(paper.maze == maze.name) & (paper["item"] == algorithm.name) & (paper.quantity == quantity)]
    if not is_the_papers or found.empty:
        return pd.Series({"mean": np.nan, "sd": np.nan, "n": np.nan})
    return found[["mean", "sd", "n"]].iloc[0]


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
