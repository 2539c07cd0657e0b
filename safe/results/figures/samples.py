"""Figures of many runs: rates of success, generations to success, and what evolved, beside what a paper reports."""

from __future__ import annotations

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from safe.algorithms import COEFFICIENTS
from safe.experiments.experiment import Experiment
from safe.results.figures.style import FAINT, GOAL, legend_below, plain
from safe.results.labels import labels, row_labels
from safe.results.statistics import success_curve
from safe.results.tables import Paper, no_paper


def plot_success(table: pd.DataFrame) -> tuple[Figure, np.ndarray]:
    """Rates of success with their 95 % intervals, beside the paper's, from a table of `tables.success_table`."""
    mazes, algorithms = table.index.unique("maze"), table.index.unique("algorithm")
    figure, grid = plt.subplots(1, len(mazes), figsize=(4.2 * len(mazes), 3.2), squeeze=False, sharey=True)
    for axes, maze in zip(grid[0], mazes, strict=True):
        rows = table.loc[maze].reindex(algorithms)[::-1]
        rate = rows.successes / rows.runs
        places = np.arange(len(rows))
        error = np.array([rate - rows.low, rows.high - rate]).clip(0)  # rounding may put an end beyond the rate
        axes.errorbar(100 * rate, places, xerr=100 * error, fmt="o", capsize=4, label="here, with 95 % interval")
        axes.plot(100 * rows.paper_successes / rows.paper_runs, places, "x", markersize=9, label="in the paper")
        axes.set(title=plain(maze), xlabel="runs that succeed, %")
        axes.set_yticks(places, [plain(algorithm) for algorithm in rows.index])
        axes.set_ylim(-0.6, len(rows) - 0.4)
        axes.set_xlim(left=min(0, axes.get_xlim()[0]))
        axes.grid(axis="x", alpha=0.3)
    legend_below(figure)
    return figure, grid[0]


def plot_success_curves(results: Mapping[Experiment, pd.DataFrame]) -> tuple[Figure, np.ndarray]:
    """The share of runs that have succeeded, generation by generation, with 95 % bands (`statistics.success_curve`)."""
    labelled = list(zip(labels(results), results.items(), strict=True))
    mazes, algorithms = (list(dict.fromkeys(names)) for names in zip(*labels(results), strict=True))
    figure, grid = plt.subplots(1, len(mazes), figsize=(4.4 * len(mazes), 3.6), squeeze=False)
    for axes, maze in zip(grid[0], mazes, strict=True):
        for (of_maze, algorithm), (experiment, runs) in labelled:
            if of_maze == maze:
                curve = success_curve(runs)
                steps = [0, *curve.generation, experiment.parameters.generations]
                share, low, high = ([0, *curve[name], [0, *curve[name]][-1]] for name in ("share", "low", "high"))
                colour = f"C{algorithms.index(algorithm)}"
                axes.step(steps, 100 * np.array(share), where="post", color=colour, label=plain(algorithm))
                axes.fill_between(
                    steps, 100 * np.array(low), 100 * np.array(high), step="post", facecolor=colour, alpha=0.2
                )
        axes.set(title=plain(maze), xlabel="generation", ylabel="runs that have succeeded, %", ylim=(0, None))
        axes.set_xlim(0, max(experiment.parameters.generations for experiment in results))
    legend_below(figure)
    return figure, grid[0]


def plot_coefficients(results: Mapping[Experiment, pd.DataFrame], paper: Paper = no_paper) -> tuple[Figure, np.ndarray]:
    """The objective functions of successful runs, as points (a, b), and the paper's mean and standard deviation."""
    figure, grid = plt.subplots(1, len(results), figsize=(4.2 * len(results), 4.4), squeeze=False)
    for axes, label, (experiment, runs) in zip(grid[0], row_labels(results), results.items(), strict=True):
        successful = runs[runs.success]
        axes.plot(successful.a, successful.b, ".", alpha=0.6, label="a successful run")
        (a, a_sd), (b, b_sd) = paper(experiment).reindex(COEFFICIENTS)[["mean", "sd"]].to_numpy()
        axes.errorbar(a, b, xerr=a_sd, yerr=b_sd, fmt="x", capsize=4, color=GOAL, label="in the paper, mean and sd")
        axes.set(title=plain(label), xlabel="a (closeness)", ylabel="b (novelty)", aspect="equal")
        axes.set(xlim=(-0.02, 1.05), ylim=(-0.02, 1.05))
    legend_below(figure)
    return figure, grid[0]


def plot_weights(table: pd.DataFrame) -> tuple[Figure, np.ndarray]:
    """Means and standard deviations of evolved weights, beside the paper's, from a table of `tables.evolved_table`."""
    experiments = table.index.unique("maze")
    figure, grid = plt.subplots(1, len(experiments), figsize=(4.4 * len(experiments), 6), squeeze=False, sharey=True)
    for axes, experiment in zip(grid[0], experiments, strict=True):
        rows = table.loc[experiment][::-1]
        places = np.arange(len(rows))
        for mean, sd, marker, lift, label in (
            (rows["mean"], rows.sd, "o", 0.15, "here, mean and sd"),
            (rows.paper_mean, rows.paper_sd, "x", -0.15, "in the paper"),
        ):
            axes.errorbar(mean, places + lift, xerr=sd, fmt=marker, capsize=2, linewidth=1, label=label)
        axes.axvline(0, color=FAINT, linewidth=0.8, zorder=0)
        names = [f"{item}: {weighs}" for item, weighs in rows.index]
        axes.set(title=plain(experiment), xlabel="weight", yticks=places, yticklabels=names, xlim=(-1.3, 1.3))
    legend_below(figure)
    return figure, grid[0]
