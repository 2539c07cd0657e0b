"""The paper's numbers, and the experiments that they belong to."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pandas as pd

from safe.algorithms import Parameters, get_algorithm
from safe.experiments.experiment import Experiment
from safe.maze_files import is_packaged

MAZES = ("maze1", "maze2")
ALGORITHMS = ("standard", "novelty", "safe", "fixed", "random")  # by their names in `safe.ALGORITHMS`


def published() -> pd.DataFrame:
    """Every number of the paper: table, maze, item, quantity, mean (or the number itself), sd, n."""
    return pd.read_csv(Path(__file__).with_name("published.csv"))


def is_the_papers(experiment: Experiment) -> bool:
    """Is this an experiment of the paper? Its maze, algorithm and parameters decide; a name alone does not."""
    algorithm = experiment.algorithm
    return (
        experiment.maze.name in MAZES
        and is_packaged(experiment.maze)
        and algorithm.name in ALGORITHMS
        and algorithm == get_algorithm(algorithm.name)
        and experiment.parameters == Parameters()
    )


def reported(experiment: Experiment) -> pd.DataFrame:
    """What the paper reports of an experiment, for tables to show beside ours; no row if it is not the paper's.

    Returns
    -------
    pandas.DataFrame, one row for each quantity
        mean, sd and n, indexed by "successes", "generations to success" and, for SAFE, a, b, p1..p16.

    Examples
    --------
    >>> reported(Experiment("safe", "maze1")).loc["successes", ["mean", "n"]].tolist()
    [328.0, 500.0]
    >>> reported(Experiment("safe", "maze1", parameters=Parameters(k=3))).empty
    True
    """
    is_reported = is_the_papers(experiment)
    return _reported(experiment.maze.name if is_reported else "", experiment.algorithm.name).copy()


@cache  # a ledger asks often
def _reported(maze: str, algorithm: str) -> pd.DataFrame:
    numbers = published()
    numbers = numbers[numbers.maze == maze]
    counted = numbers[numbers["item"] == algorithm].set_index("quantity")
    evolved = numbers[~numbers["item"].isin(ALGORITHMS) & (algorithm == "safe")].set_index("item")
    return pd.concat([counted, evolved])[["mean", "sd", "n"]]


def parameter_table(parameters: Parameters = Parameters()) -> pd.DataFrame:
    """The parameters of the paper's Table 1, beside its values.

    Returns
    -------
    pandas.DataFrame, one row for each parameter
        meaning, value, in the paper.
    """
    table1 = published().query("table == '1'").set_index("item")
    return pd.DataFrame(
        {
            "meaning": table1.quantity,
            "value": [f"{getattr(parameters, name):g}" for name in table1.index],
            "in the paper": [f"{value:g}" for value in table1["mean"]],
        },
        index=table1.index.rename("parameter"),
    )
