"""What `make bench` has measured, as tables.

The file of measurements holds, for each benchmark, its group, the seconds of one round, and what the round was: most
often so many `generations`, and in each so many `points`. Times are those of the processor where nothing is waited for.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import pandas as pd

from safe import checks

PARTS = (
    "robot",
    "novelty",
    "fitness",
    "breeding",
    "objective functions",
    "breeding of objective functions",
    "all",
)
PEERS = {  # group: what one of them is
    "peers: robot": "end point",
    "peers: novelty": "novelty, end point",
    "peers: objective functions": "novelty, objective function",
    "peers: run": "generation, ",
    "twin": "generation in the playground, ",
}


def read_measured(path: str | os.PathLike) -> tuple[pd.DataFrame, dict[str, str]]:
    """All measurements, one row each, and what they were made on.

    Raises
    ------
    ValueError
        Where the file holds no measurements.
    """
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
    """The measurements of a group, with those columns that it has."""
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
    """What takes how long by which method, and how many times as long as here.

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
    """What each of the paper's experiments costs, and how many times as much by the straightforward version."""
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


def growth_table(measured: pd.DataFrame) -> pd.DataFrame:
    """Seconds for each size of what is varied, by what was timed: a generation of it, or all runs of an experiment."""
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


def key_figures(measured: pd.DataFrame) -> pd.DataFrame:
    """What texts say of all this, rounded, in one column: the rows are named by what they are."""
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
