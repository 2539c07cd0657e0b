"""From tables of runs to tables of results, beside the paper's."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, fields
from pathlib import Path

import numpy as np
import pandas as pd

from safe import checks
from safe.algorithms import ALGORITHMS, COEFFICIENTS, COMPONENTS, Parameters
from safe.experiments.experiment import WEIGHT_COLUMNS, Experiment
from safe.maze import SENSORS
from safe.maze_files import is_packaged
from safe.results.statistics import Comparison, compare_means, compare_rates, success_interval

_WEIGHED = dict(zip(COEFFICIENTS, COMPONENTS, strict=True)) | dict(
    zip(WEIGHT_COLUMNS, (f"{sensor} in {total}" for total in "hv" for sensor in SENSORS), strict=True)
)


def published() -> pd.DataFrame:
    """Every number of the paper: table, maze, item, quantity, mean (or the number itself), sd, n."""
    return pd.read_csv(Path(__file__).parents[1] / "companion" / "published.csv")


def is_the_papers(experiment: Experiment) -> bool:
    """Is it one of the paper's? What it is called does not make it so: its maze, algorithm and parameters do."""
    algorithm = experiment.algorithm
    return (
        is_packaged(experiment.maze)
        and algorithm == ALGORITHMS.get(algorithm.name)
        and experiment.parameters == Parameters()
    )


def parameter_table(parameters: Parameters = Parameters()) -> pd.DataFrame:
    """Parameters beside the paper's Table 1.

    Returns
    -------
    pandas.DataFrame, one row for each parameter
        meaning, value, in the paper.
    """
    paper = published().query("table == '1'").set_index("item")
    values = asdict(parameters)
    return pd.DataFrame(
        {
            "meaning": paper.quantity.reindex(values),
            "value": [f"{value:g}" for value in values.values()],
            "in the paper": [f"{value:g}" for value in paper["mean"].reindex(values)],
        },
        index=pd.Index(values, name="parameter"),
    )


def success_table(results: Mapping[Experiment, pd.DataFrame]) -> pd.DataFrame:
    """Successes, beside the paper's where an experiment is one of the paper's.

    Parameters
    ----------
    results : mapping of Experiment to DataFrame
        The runs of each experiment, as `safe.run` gives them.

    Returns
    -------
    pandas.DataFrame, one row for each experiment, indexed by the names of maze and algorithm
        successes, runs; low and high, the ends of the 95 % interval of the rate; paper_successes and paper_runs; and
        what `compare_rates` tells of the two: difference, difference_low and difference_high, p_value, effect,
        p_equivalence. Not a number where there is none.
    """
    rows = {}
    for experiment, runs in results.items():
        successes = int(runs.success.sum())
        low, high = success_interval(successes, len(runs))
        paper = _published_for(experiment).reindex(["successes"]).iloc[0]
        compared = dict.fromkeys(field.name for field in fields(Comparison))
        if not np.isnan(paper["n"]):
            compared = asdict(compare_rates(successes, len(runs), int(paper["mean"]), int(paper["n"])))
        rows[experiment.maze.name, experiment.algorithm.name] = {
            "successes": successes,
            "runs": len(runs),
            "low": low,
            "high": high,
            "paper_successes": paper["mean"],
            "paper_runs": paper["n"],
            "difference": compared.pop("difference"),
            "difference_low": compared.pop("low"),
            "difference_high": compared.pop("high"),
        } | compared
    return pd.DataFrame.from_dict(rows, orient="index", dtype=float).rename_axis(["maze", "algorithm"])


def readable_success_table(table: pd.DataFrame) -> pd.DataFrame:
    """A table of `success_table` to read: intervals as counts out of the runs, a dash for what is not there."""
    rows = {}
    for index, row in table.iterrows():
        rows[index] = {
            "successes": f"{row.successes:.0f} of {row.runs:.0f}",
            "95 % interval": f"{row.low * row.runs:.3g} to {row.high * row.runs:.3g}",
            "in the paper": _show("{:.0f} of {:.0f}", row.paper_successes, row.paper_runs),
            "difference, percentage points": _points(row.difference, row.difference_low, row.difference_high),
            "p": _show("{:.2f}", row.p_value),
        }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis(table.index.names)


def difference_table(results: Mapping[Experiment, pd.DataFrame], first: str, second: str) -> pd.DataFrame:
    """Two algorithms set against each other on every maze; to read.

    Parameters
    ----------
    results : mapping of Experiment to DataFrame
        The runs of each experiment, as `safe.run` gives them.
    first, second : str
        Names of the two algorithms.

    Returns
    -------
    pandas.DataFrame, one row for each maze
        Successes of both, the difference of their rates with its 95 % interval in percentage points, p of Fisher's
        exact test, p of the equivalence test.
    """
    counts = {(e.maze.name, e.algorithm.name): (int(runs.success.sum()), len(runs)) for e, runs in results.items()}
    rows = {}
    for maze in dict.fromkeys(maze for maze, _ in counts):
        ours, other = counts[maze, first], counts[maze, second]
        compared = compare_rates(*ours, *other)
        rows[maze] = {
            first: "{} of {}".format(*ours),
            second: "{} of {}".format(*other),
            "difference, percentage points": _points(compared.difference, compared.low, compared.high),
            "p": f"{compared.p_value:.2f}",
            "p (equivalence)": f"{compared.p_equivalence:.3f}",
        }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("maze")


def generations_table(results: Mapping[Experiment, pd.DataFrame]) -> pd.DataFrame:
    """Generations to success, averaged over the successful runs, beside the paper's; rows and columns as `means_table`.

    Random search goes on after a success, so it has none.
    """
    samples = {
        (experiment, "generations to success"): runs.generation[runs.success]
        for experiment, runs in results.items()
        if not experiment.algorithm.is_random_search
    }
    algorithms = [experiment.algorithm.name for experiment, _ in samples]
    return means_table(samples).droplevel("item").set_index(pd.Index(algorithms, name="algorithm"), append=True)


def evolved_table(results: Mapping[Experiment, pd.DataFrame], items: Sequence[str]) -> pd.DataFrame:
    """What successful runs evolved: items of a, b, p1..p16, beside the paper's; rows and columns as `means_table`."""
    samples = {(experiment, item): runs[runs.success][item] for experiment, runs in results.items() for item in items}
    table = means_table(samples)
    return table.set_index(
        pd.Index([_WEIGHED[item] for item in table.index.get_level_values("item")], name="weighs"), append=True
    )


def means_table(samples: Mapping[tuple[Experiment, str], pd.Series]) -> pd.DataFrame:
    """Averages of samples, beside the paper's.

    Parameters
    ----------
    samples : mapping of (Experiment, item) to Series
        The item is what the paper's number is found by: "generations to success", or one of a, b, p1..p16.

    Returns
    -------
    pandas.DataFrame, one row for each sample, indexed by the names of maze and item
        mean, sd (ddof = 0) and n; paper_mean, paper_sd and paper_n; and what `compare_means` tells of the two:
        difference, low, high, p_value, effect, p_equivalence. Not a number where there is none.
    """
    ours, theirs = ("mean", "sd", "n"), ("paper_mean", "paper_sd", "paper_n")
    published_for = {experiment: _published_for(experiment) for experiment, _ in samples}
    rows = []
    for (experiment, item), sample in samples.items():
        paper = published_for[experiment].reindex([item]).iloc[0]
        values = sample.mean(), sample.std(ddof=0), len(sample), paper["mean"], paper["sd"], paper["n"]
        rows.append(dict(zip(ours + theirs, values, strict=True)) | asdict(compare_means(*values)))
    index = pd.MultiIndex.from_arrays(
        [[experiment.maze.name for experiment, _ in samples], [item for _, item in samples]], names=["maze", "item"]
    )
    return pd.DataFrame(rows, index, columns=[*ours, *theirs, *(field.name for field in fields(Comparison))])


def readable_means_table(table: pd.DataFrame, digits: int = 2) -> pd.DataFrame:
    """A table of `means_table` to read, a dash for what is not there; differences of fractions get a digit more."""
    one, signed = f"{{:.{digits}f}} ({{:.{digits}f}})", f"{{:+.{digits + bool(digits)}f}}"
    two = f"{signed} ({signed} to {signed})"
    return pd.DataFrame(
        {
            "runs": table.n,
            "mean (sd)": [_show(one, *row) for row in table[["mean", "sd"]].to_numpy()],
            "in the paper": [_show(one, *row) for row in table[["paper_mean", "paper_sd"]].to_numpy()],
            "difference (95 % interval)": [_show(two, *row) for row in table[["difference", "low", "high"]].to_numpy()],
            "p": [_show("{:.2f}", p) for p in table.p_value],
        }
    )


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


def _points(difference: float, low: float, high: float) -> str:
    """A difference of rates with its interval, in percentage points."""
    return _show("{:+.1f} ({:+.1f} to {:+.1f})", 100 * difference, 100 * low, 100 * high)


def _published_for(experiment: Experiment) -> pd.DataFrame:
    """What the paper reports of an experiment: mean, sd and n; nothing where the experiment is not the paper's.

    Indexed by quantity ("successes", "generations to success") and, for SAFE, by what was evolved (a, b, p1..p16).
    """
    maze, algorithm = experiment.maze, experiment.algorithm
    paper = published()
    paper = paper[(paper.maze == maze.name) & is_the_papers(experiment)]
    counted = paper[paper["item"] == algorithm.name].set_index("quantity")
    evolved = paper[~paper["item"].isin(ALGORITHMS) & (algorithm.name == "safe")].set_index("item")
    return pd.concat([counted, evolved])[["mean", "sd", "n"]]
