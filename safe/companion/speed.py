"""The measurements of `make bench`, as tables and figures.

The file of measurements holds, for each benchmark, its group, the seconds of one round, and what a round does: most
often so many `generations`, and in each so many `points`. Times are processor times if a round waits for nothing.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from safe import checks
from safe.companion import project
from safe.results.figures.style import FAINT, legend_below, plain

PARTS = (
    "robot",
    "novelty",
    "fitness",
    "breeding",
    "objective functions",
    "breeding of objective functions",
    "all",
)
PEERS = {  # group: the unit that is timed
    "peers: robot": "end point",
    "peers: novelty": "novelty, end point",
    "peers: objective functions": "novelty, objective function",
    "peers: run": "generation, ",
    "twin": "generation in the playground, ",
}
VARIED = {  # sizes that are varied, in words
    "population": "solutions, and as many objective functions",
    "archive": "places in an archive",
    "k": "k, nearest neighbours",
    "steps": "steps of a robot",
    "maze": "cells along a side of the maze",
    "runs": "runs of an experiment",
}


def read_measured(path: str | os.PathLike) -> tuple[pd.DataFrame, dict[str, str]]:
    """All measurements, one row each, and a description of the machine that they were made on.

    Parameters
    ----------
    path : path
        The file of measurements; empty: that of the project.

    Raises
    ------
    ValueError
        If the file holds no measurements, or is that of a project that is not here.
    """
    if path == "":
        folder = project.folder()
        if folder is None:
            raise ValueError(
                "measured must be the path of measurements; "
                f"got '', for {project.MEASUREMENTS} of the project, but there is none"
            )
        path = folder / project.MEASUREMENTS
    try:
        found = json.loads(Path(path).read_text(encoding="utf-8"))
        rows = [
            {"group": row["group"], "seconds": row["stats"]["median"], **row["extra_info"]}
            for row in found["benchmarks"]
        ]
        machine = {
            "processor": f"{found['machine_info']['cpu']['brand_raw']}, {found['machine_info']['cpu']['count']} cores",
            "system": f"{found['machine_info']['system']}, Python {found['machine_info']['python_version']}",
            "packages": ", ".join(f"{name} {version}" for name, version in found["versions"].items()),
            "measured": found["datetime"][:10],
        }
    except (OSError, TypeError, ValueError, KeyError) as error:
        reason = getattr(error, "strerror", None) or "it holds no measurements of `make bench`"
        raise ValueError(
            f"measured must be the path of measurements; got {checks.shown(str(path))} ({reason})"
        ) from None
    return pd.DataFrame(rows), machine


def _of(measured: pd.DataFrame, group: str) -> pd.DataFrame:
    """The measurements of a group, without the columns that are empty in it."""
    return measured[measured["group"] == group].dropna(axis="columns", how="all")


def parts_table(measured: pd.DataFrame) -> pd.DataFrame:
    """Microseconds that a generation takes, by part: one row for each maze and algorithm.

    Examples
    --------
    >>> row = {"group": "part", "maze": "maze1", "algorithm": "novelty", "part": "robot"}
    >>> parts_table(pd.DataFrame([{**row, "seconds": 0.1, "generations": 500}])).iloc[0].to_dict()
    {'robot': 200.0}
    """
    parts = _of(measured, "part")
    parts = parts.assign(microseconds=1e6 * parts.seconds / parts.generations)
    table = parts.pivot_table(index=["maze", "algorithm"], columns="part", values="microseconds", sort=False)
    return table[[part for part in PARTS if part in table]].rename_axis(columns=None)


def peers_table(measured: pd.DataFrame) -> pd.DataFrame:
    """How long each method takes for the same task, and how many times as long as this package.

    Examples
    --------
    >>> row = {"group": "peers: novelty", "points": 2, "generations": 5}
    >>> rows = [{**row, "method": "safe", "seconds": 1e-3}, {**row, "method": "abacus", "seconds": 1.0}]
    >>> peers_table(pd.DataFrame(rows)).times_as_long.tolist()
    [1.0, 1000.0]
    """
    rows = []
    for group, what in PEERS.items():
        peers = _of(measured, group)
        if peers.empty:
            continue
        each = 1e6 * peers.seconds / peers.generations / peers.get("points", 1)
        whats = what + peers.get("algorithm", pd.Series("", peers.index))
        for name, ours in each[peers.method == "safe"].groupby(whats):
            for method, microseconds in each[whats == name].groupby(peers.method, sort=False):
                row = {"what": name, "method": method, "microseconds": microseconds.iloc[0]}
                rows.append({**row, "times_as_long": microseconds.iloc[0] / ours.iloc[0]})
    return pd.DataFrame(rows).set_index(["what", "method"])


def paper_table(measured: pd.DataFrame) -> pd.DataFrame:
    """The cost of each of the paper's experiments, and how many times as much the straightforward version takes."""
    paper = _of(measured, "paper").set_index(["maze", "algorithm"])
    plain = _of(measured, "paper: straightforward").set_index(["maze", "algorithm"])
    return pd.DataFrame(
        {
            "runs": paper.runs.astype(int),
            "core_seconds": paper.core_seconds,
            "milliseconds_a_run": 1000 * paper.core_seconds / paper.runs,
            "straightforward_times": plain.core_seconds / plain.safe_core_seconds,
        }
    )


def contest_table(measured: pd.DataFrame) -> pd.DataFrame:
    """What a generation of the contest's contestants costs, in microseconds, and over what the first one's does."""
    contestants = _of(measured, "contest").set_index("contestant")
    microseconds = 1e6 * contestants.seconds / contestants.generations
    return pd.DataFrame({"microseconds": microseconds, "ratio": microseconds / microseconds.iloc[0]})


def growth_table(measured: pd.DataFrame) -> pd.DataFrame:
    """Seconds at each size that is varied, for one generation or, if runs are varied, for a whole experiment."""
    growth = _of(measured, "growth")
    whole = growth.kernel == "all"
    label = growth.kernel.where(~whole, growth.get("algorithm"))
    several = growth.groupby(["what", "kernel"]).maze.transform("nunique") > 1
    return pd.DataFrame(
        {
            "what": growth.what,
            "size": growth["size"].astype(int),
            "of": label.where(~several, label + ", " + growth.maze.fillna("")),
            "seconds": (growth.seconds / growth.generations).where(growth.what != "runs", growth.seconds),
        }
    ).reset_index(drop=True)


def first_use_table(measured: pd.DataFrame) -> pd.DataFrame:
    """Seconds from the start of Python to the first result."""
    first = _of(measured, "first use").set_index("stage")
    return first[["seconds"]]


def stored_table(measured: pd.DataFrame) -> pd.DataFrame:
    """Stores of up to a million runs.

    Returns
    -------
    pandas.DataFrame, indexed by how many runs a store has
        megabytes, its size; table and tables, seconds until one of its experiments is a table, and until all are;
        verify, seconds to make a sample of its runs again; memory, what all tables took at most, over their own.
    """
    stored = _of(measured, "stored runs")
    table = stored.pivot_table(index="size", columns="what", values="seconds")
    of_all = stored[stored.what == "tables"].set_index("size")
    table.insert(0, "megabytes", of_all.bytes / 1e6)
    return table.assign(memory=of_all.memory).rename_axis(index="runs", columns=None)


def before_table(measured: pd.DataFrame) -> pd.DataFrame:
    """An earlier tree and this one, seconds of the processor, and the ratio of the second to the first."""
    stages = _of(measured, "before").set_index("stage")
    return stages[["before", "now", "ratio"]]


def key_figures(measured: pd.DataFrame) -> pd.DataFrame:
    """The figures that the prose quotes, rounded to two digits, in one column.

    Raises
    ------
    ValueError
        If the measurements hold none of the playground in Chromium.
    """
    parts, paper = parts_table(measured)["all"], paper_table(measured)
    twin = _of(measured, "twin")
    page = twin[twin.method.str.startswith("Chromium") & (twin.algorithm == "novelty")] if len(twin) else twin
    if page.empty:
        raise ValueError("measurements must hold those of the playground in Chromium; got none")
    seconds_a_run = paper.core_seconds.sum() / paper.runs.sum()
    figures = {
        "core_seconds": paper.core_seconds.sum(),
        "peak_megabytes": _of(measured, "paper").peak_megabytes.max(),
        "days_of_ten_million_runs": 1e7 * seconds_a_run / 86400,
        "playground_generations_a_second": (page.generations / page.seconds).iloc[0],
        **{f"safe_to_novelty_{maze}": parts[maze, "safe"] / parts[maze, "novelty"] for maze in ("maze1", "maze2")},
    }
    return pd.DataFrame({"speed": {"runs": paper.runs.sum(), **{n: float(f"{v:.2g}") for n, v in figures.items()}}})


def plot_parts(table: pd.DataFrame) -> tuple[Figure, np.ndarray]:
    """The cost of the parts of a generation (see `parts_table`), a bar for each algorithm."""
    mazes = table.index.unique("maze")
    parts = table.drop(columns="all")
    figure, grid = plt.subplots(1, len(mazes), figsize=(4 * len(mazes), 2.9), squeeze=False, sharex=True)
    for axes, maze in zip(grid[0], mazes, strict=True):
        rows = parts.loc[maze].iloc[::-1].fillna(0)
        left = np.zeros(len(rows))
        for part in rows:
            axes.barh([plain(name) for name in rows.index], rows[part], left=left, label=part, height=0.6)
            left += rows[part].to_numpy()
        axes.set(title=plain(maze), xlabel="microseconds a generation")
    legend_below(figure)
    return figure, grid[0]


def plot_growth(table: pd.DataFrame) -> tuple[Figure, np.ndarray]:
    """How the cost grows with each size that is varied (see `growth_table`), on logarithmic axes."""
    whats = table.what.unique()
    figure, grid = plt.subplots(-(-len(whats) // 2), 2, figsize=(8, 2.9 * -(-len(whats) // 2)), squeeze=False)
    for axes, what in zip(grid.flat, whats, strict=False):
        rows = table[table.what == what]
        for label, line in rows.groupby("of", sort=False):
            axes.plot(line["size"], 1000 * line.seconds, "o-", markersize=4, label=plain(label))
        # a logarithmic axis has no place for 0, an archive without places
        axes.set(xscale="symlog" if rows["size"].min() == 0 else "log", yscale="log", xlabel=VARIED.get(what, what))
        sizes = np.array(sorted(rows["size"][rows["size"] > 0]))[[0, -1]]
        axes.plot(sizes, 1000 * rows.seconds.min() * sizes / sizes[0], ":", color=FAINT, label="in proportion")
        axes.set_ylabel("milliseconds")
        axes.legend(fontsize="x-small")
    for axes in grid.flat[len(whats) :]:
        axes.set_axis_off()
    return figure, grid
