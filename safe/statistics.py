"""From tables of runs to tables of results, beside the paper's."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd
from scipy import stats

from safe import checks
from safe.algorithms import ALGORITHMS, COEFFICIENTS, COMPONENTS, Parameters
from safe.experiment import WEIGHT_COLUMNS, Experiment
from safe.maze import SENSORS, load_maze, maze_names

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
        published_here = _published_for(experiment).reindex(["successes", "generations to success"])
        (_, paper), (_, paper_time) = published_here.iterrows()
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


def readable_success_table(table: pd.DataFrame) -> pd.DataFrame:
    """A table of `success_table` to read: intervals as counts out of the runs, a dash for what is not there."""
    rows = {}
    for index, row in table.iterrows():
        rate = row.paper_successes / row.paper_runs
        rows[index] = {
            "successes": f"{row.successes:.0f} of {row.runs:.0f}",
            "95 % interval": f"{row.low * row.runs:.3g} to {row.high * row.runs:.3g}",
            "in the paper": _show("{:.0f} of {:.0f}", row.paper_successes, row.paper_runs),
            "paper within": "–" if np.isnan(rate) else "yes" if row.low <= rate <= row.high else "no",
            "p": _show("{:.2f}", row.p_value),
            "generations to success, mean (sd)": _show("{:.0f} ({:.0f})", row["mean"], row.sd),
            "mean (sd) in the paper": _show("{:.0f} ({:.0f})", row.paper_mean, row.paper_sd),
        }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis(table.index.names)


def evolved_table(results: Mapping[Experiment, pd.DataFrame]) -> pd.DataFrame:
    """What successful runs of SAFE evolved, beside the paper's: coefficients and parameters of the controllers.

    Parameters
    ----------
    results : mapping of Experiment to DataFrame
        The runs of each experiment, as `safe.run` gives them.

    Returns
    -------
    pandas.DataFrame, one row for each maze and item: a, b, p1..p16
        mean, sd (ddof = 0) and n, the successful runs; paper_mean, paper_sd and paper_n; difference, of the means;
        allowed, the most that the difference is in 95 of 100 pairs of samples of these sizes from one population.
        Not a number where there is none; nothing can be said of what is allowed from a single run.
    """
    rows = {}
    for experiment, runs in results.items():
        successful = runs[runs.success]
        for item, paper in _published_for(experiment).reindex([*COEFFICIENTS, *WEIGHT_COLUMNS]).iterrows():
            sample = successful[item]
            mean, sd, n = sample.mean(), sample.std(ddof=0), len(sample)
            error = np.sqrt(sd**2 / n + paper["sd"] ** 2 / paper["n"]) if n > 1 else np.nan
            rows[experiment.maze.name, item] = {
                "mean": mean,
                "sd": sd,
                "n": n,
                "paper_mean": paper["mean"],
                "paper_sd": paper["sd"],
                "paper_n": paper["n"],
                "difference": mean - paper["mean"],
                "allowed": stats.norm.ppf((1 + CONFIDENCE) / 2) * error,
            }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis(["maze", "item"])


def readable_evolved_table(table: pd.DataFrame) -> pd.DataFrame:
    """A table of `evolved_table` to read: the mazes side by side, a dash for what is not there."""
    columns = {}
    for maze, rows in table.groupby(level="maze", sort=False):
        by_item = rows.droplevel("maze")
        columns |= {
            (maze, "mean (sd)"): [_show("{:.2f} ({:.2f})", *v) for v in by_item[["mean", "sd"]].to_numpy()],
            (maze, "paper"): [_show("{:.2f} ({:.2f})", *v) for v in by_item[["paper_mean", "paper_sd"]].to_numpy()],
            (maze, "difference"): [
                _show("{:+.2f} (±{:.2f})", *v) for v in by_item[["difference", "allowed"]].to_numpy()
            ],
        }
    weighed = [*COMPONENTS, *(f"{sensor} in {total}" for total in "hv" for sensor in SENSORS)]
    index = pd.MultiIndex.from_arrays([table.index.unique("item"), weighed], names=["", "weighs"])
    return pd.DataFrame(columns, index=index)


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


def _show(template: str, *values: float) -> str:
    return "–" if np.isnan(values).any() else template.format(*values)


def _published_for(experiment: Experiment) -> pd.DataFrame:
    """What the paper reports of an experiment: mean, sd and n; nothing where the experiment is not the paper's.

    Indexed by quantity ("successes", "generations to success") and, for SAFE, by what was evolved (a, b, p1..p16).
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
    paper = paper[(paper.maze == maze.name) & is_the_papers]
    counted = paper[paper["item"] == algorithm.name].set_index("quantity")
    evolved = paper[~paper["item"].isin(ALGORITHMS) & (algorithm.name == "safe")].set_index("item")
    return pd.concat([counted, evolved])[["mean", "sd", "n"]]
