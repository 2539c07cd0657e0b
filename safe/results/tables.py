"""Tables of results, a row for each experiment, and the same tables to read, beside what a paper reports.

Every table takes `results`, the runs of each experiment as `safe.run` gives them. Its rows are in the same order, and
its index consists of labels (see `safe.results.labels`). Algorithms to compare are given by their names.

`paper` is a function that returns, for an experiment, what a paper reports of it: a row for each quantity ("successes",
"generations to success", and a, b, p1..p16 for evolved values), with columns mean (or the count), sd and n. For the
paper on SAFE it is `safe.companion.paper.reported`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, fields

import numpy as np
import pandas as pd

from safe import checks
from safe.algorithms import COEFFICIENTS, COMPONENTS
from safe.experiments.experiment import WEIGHT_COLUMNS, Experiment
from safe.maze import SENSORS
from safe.results import formats
from safe.results.labels import labels, row_labels
from safe.results.statistics import Comparison, compare_means, compare_rates, compare_times, holm, success_interval

Results = Mapping[Experiment, pd.DataFrame]  # the runs of each experiment, as `safe.run` gives them
Paper = Callable[[Experiment], pd.DataFrame]  # mean, sd and n, by quantity

COMPARED = [field.name for field in fields(Comparison)]
# what each coefficient and each weight multiplies
_WEIGHED = dict(zip(COEFFICIENTS, COMPONENTS, strict=True)) | dict(
    zip(WEIGHT_COLUMNS, (f"{sensor} in {total}" for total in "hv" for sensor in SENSORS), strict=True)
)


def no_paper(experiment: Experiment) -> pd.DataFrame:
    """The default `paper`, which reports nothing."""
    return pd.DataFrame(columns=["mean", "sd", "n"], dtype=float)


def pairs(results: Iterable[Experiment], names: Sequence[tuple[str, str]]) -> list[tuple[Experiment, Experiment]]:
    """Pairs of experiments on the same maze, by the names of their algorithms: maze by maze, in the order of names.

    If several experiments on one maze share a name, each of them is paired.

    Examples
    --------
    >>> experiments = [Experiment(algorithm, "maze1") for algorithm in ("safe", "novelty")]
    >>> [(first.algorithm.name, second.algorithm.name) for first, second in pairs(experiments, [("novelty", "safe")])]
    [('novelty', 'safe')]
    """
    by_maze: dict = {}
    for experiment in results:
        by_maze.setdefault(experiment.maze, []).append(experiment)
    return [
        (first, second)
        for on_maze in by_maze.values()
        for name, other in names
        for first in on_maze
        if first.algorithm.name == name
        for second in on_maze
        if second.algorithm.name == other
    ]


def success_table(results: Results, paper: Paper = no_paper) -> pd.DataFrame:
    """Successes, beside what a paper reports.

    Returns
    -------
    pandas.DataFrame, one row for each experiment, indexed by maze and algorithm
        successes, runs; low and high, the ends of the 95 % interval of the rate; paper_successes and paper_runs; and
        how the two rates compare (`compare_rates`): difference, difference_low and difference_high, p_value, effect,
        p_equivalence. These are not a number if the paper reports nothing.
    """
    rows = []
    for experiment, runs in results.items():
        successes = int(runs.success.sum())
        low, high = success_interval(successes, len(runs))
        reported = paper(experiment).reindex(["successes"]).iloc[0]
        compared = dict.fromkeys(COMPARED)
        if not np.isnan(reported["n"]):
            compared = asdict(compare_rates(successes, len(runs), int(reported["mean"]), int(reported["n"])))
        rows.append(
            {
                "successes": successes,
                "runs": len(runs),
                "low": low,
                "high": high,
                "paper_successes": reported["mean"],
                "paper_runs": reported["n"],
                "difference": compared.pop("difference"),
                "difference_low": compared.pop("low"),
                "difference_high": compared.pop("high"),
            }
            | compared
        )
    return pd.DataFrame(rows, _index(labels(results), "maze", "algorithm"), dtype=float)


def readable_success_table(table: pd.DataFrame) -> pd.DataFrame:
    """A table of `success_table` to read: intervals as counts out of the runs, a dash if there is no number."""
    rows = [
        {
            "successes": formats.count(row.successes, row.runs),
            "95 % interval": f"{row.low * row.runs:.3g} to {row.high * row.runs:.3g}",
            "in the paper": formats.count(row.paper_successes, row.paper_runs),
            "difference, percentage points": formats.difference_of_rates(
                row.difference, row.difference_low, row.difference_high
            ),
            "p": formats.p_value(row.p_value),
        }
        for row in table.itertuples()
    ]
    return pd.DataFrame(rows, table.index)


def difference_table(results: Results, first: str, second: str) -> pd.DataFrame:
    """How often two algorithms succeed, and how the rates differ; to read.

    Returns
    -------
    pandas.DataFrame, one row for each pair of `pairs`, indexed by maze
        Successes of both, the difference of their rates with its 95 % interval in percentage points, p of Fisher's
        exact test, p of the equivalence test.
    """
    rows, index = [], []
    label_of = dict(zip(results, labels(results), strict=True))
    found = pairs(results, [(first, second)])
    for pair in found:
        (maze, ours), (_, other) = (label_of[experiment] for experiment in pair)
        is_alone = [experiment.maze for experiment, _ in found].count(pair[0].maze) == 1
        index.append(maze if is_alone else f"{maze}: {ours}, {other}")
        counts = [(int(results[experiment].success.sum()), len(results[experiment])) for experiment in pair]
        compared = compare_rates(*counts[0], *counts[1])
        rows.append(
            {
                first: formats.count(*counts[0]),
                second: formats.count(*counts[1]),
                "difference, percentage points": formats.difference_of_rates(
                    compared.difference, compared.low, compared.high
                ),
                "p": formats.p_value(compared.p_value),
                "p (equivalence)": formats.p_value(compared.p_equivalence),
            }
        )
    return pd.DataFrame(rows, pd.Index(index, name="maze"))


def times_table(results: Results, names: Sequence[tuple[str, str]]) -> pd.DataFrame:
    """Pairs of algorithms compared by their generations to success; to read.

    Returns
    -------
    pandas.DataFrame, one row for each pair of `pairs`, indexed by maze, first and second
        A12; p of the log-rank test; p corrected by Holm's method for all rows.
    """
    label_of = dict(zip(results, labels(results), strict=True))
    found = pairs(results, names)
    index = [(*label_of[first], label_of[second][1]) for first, second in found]
    table = pd.DataFrame(
        [compare_times(results[first], results[second]) for first, second in found],
        _index(index, "maze", "first", "second"),
        columns=["A12", "p"],
    )
    return pd.DataFrame(
        {
            "A12": [formats.DASH if np.isnan(value) else f"{value:.2f}" for value in table.A12],
            "p": table.p.map(formats.p_value),
            "p (Holm)": holm(table.p).map(formats.p_value),
        },
        table.index,
    )


def generations_table(results: Results, paper: Paper = no_paper) -> pd.DataFrame:
    """Generations to success, averaged over the successful runs, beside what a paper reports.

    Random search goes on after a success, so it has no row (see `with_generations`).

    Returns
    -------
    pandas.DataFrame, one row for each experiment, indexed by maze and algorithm
        mean, sd (ddof = 0) and n; paper_mean, paper_sd and paper_n; and how the two means compare (`compare_means`):
        difference, low, high, p_value, effect, p_equivalence. A value that cannot be computed is not a number.
    """
    timed = with_generations(results)
    rows = [(e, "generations to success", runs.generation[runs.success]) for e, runs in timed.items()]
    index = [label for experiment, label in zip(results, labels(results), strict=True) if experiment in timed]
    return _means(rows, paper, _index(index, "maze", "algorithm"))


def with_generations(results: Results) -> Results:
    """The results that have generations to success: all except those of random search."""
    return {experiment: runs for experiment, runs in results.items() if not experiment.algorithm.is_random_search}


def evolved_table(results: Results, items: Sequence[str], paper: Paper = no_paper) -> pd.DataFrame:
    """What successful runs evolved, on average, beside what a paper reports.

    Parameters
    ----------
    items : sequence of str
        Coefficients a, b and weights p1..p16.

    Returns
    -------
    pandas.DataFrame, one row for each item of each experiment, indexed by maze, item and weighs
        Columns as in `generations_table`.
    """
    rows = [(e, item, runs[runs.success][item]) for e, runs in results.items() for item in items]
    index = [(label, item, _WEIGHED[item]) for label in row_labels(results) for item in items]
    return _means(rows, paper, _index(index, "maze", "item", "weighs"))


def readable_means_table(table: pd.DataFrame, digits: int = 2) -> pd.DataFrame:
    """A table of `generations_table` or `evolved_table` to read, a dash if there is no number."""
    compared = table[["difference", "low", "high"]].to_numpy()
    return pd.DataFrame(
        {
            "runs": table.n,
            "mean (sd)": [formats.mean_and_sd(*row, digits) for row in table[["mean", "sd"]].to_numpy()],
            "in the paper": [formats.mean_and_sd(*row, digits) for row in table[["paper_mean", "paper_sd"]].to_numpy()],
            "difference (95 % interval)": [formats.difference_of_means(*row, digits) for row in compared],
            "p": table.p_value.map(formats.p_value),
        }
    )


def first_solutions(runs: pd.DataFrame, n: int) -> pd.DataFrame:
    """The first n successful runs of an experiment; if there are fewer, then those that came closest to the goal.

    Raises
    ------
    ValueError
        If n is less than 1.
    """
    n = checks.integer("n", n, 1)
    miss = runs.distance.where(~runs.success, 0)
    return runs.assign(miss=miss).sort_values(["miss", "run"]).drop(columns="miss").head(n)


def _index(rows: Sequence[tuple[str, ...]], *names: str) -> pd.MultiIndex:
    return pd.MultiIndex.from_frame(pd.DataFrame(rows, columns=names))  # `from_tuples` refuses an empty list


def _means(samples: Sequence[tuple[Experiment, str, pd.Series]], paper: Paper, index: pd.MultiIndex) -> pd.DataFrame:
    """Averages of samples, each of a quantity of an experiment, beside what a paper reports."""
    reported = {experiment: paper(experiment) for experiment, _, _ in samples}
    rows = []
    for experiment, quantity, sample in samples:
        theirs = reported[experiment].reindex([quantity]).iloc[0]
        values = sample.mean(), sample.std(ddof=0), len(sample), theirs["mean"], theirs["sd"], theirs["n"]
        rows.append((*values, *asdict(compare_means(*values)).values()))
    return pd.DataFrame(rows, index, columns=["mean", "sd", "n", "paper_mean", "paper_sd", "paper_n", *COMPARED])
