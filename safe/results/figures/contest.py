"""Figures of contests: algorithms compared on many mazes, each of which counts once."""

from __future__ import annotations

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from safe.results.figures.style import FAINT, legend_below, plain
from safe.results.statistics import mean_over_mazes, mean_success_curve


def plot_ladder(rates: pd.DataFrame) -> tuple[Figure, Axes]:
    """Mean rates of success with 95 % intervals over mazes, the best on top, and faint dots for the mazes.

    Parameters
    ----------
    rates : DataFrame, one row for each maze and algorithm
        With the columns algorithm and rate, in [0, 1].
    """
    of_algorithm = {name: rows.rate.to_numpy() for name, rows in rates.groupby("algorithm", sort=False)}
    names = sorted(of_algorithm, key=lambda name: of_algorithm[name].mean(), reverse=True)
    figure, axes = plt.subplots(figsize=(5.6, 1.2 + 0.42 * len(names)))
    for place, name in enumerate(names):
        of_mazes = of_algorithm[name]
        lift = 0.3 * np.sin(12.9898 * np.arange(len(of_mazes)))  # apart, without chance
        label = {"label": "a maze"} if place == 0 else {}
        axes.plot(100 * of_mazes, place + lift, ".", color=FAINT, alpha=0.5, markersize=4, **label)
        mean, low, high = (100 * value for value in mean_over_mazes(of_mazes))
        label = {"label": "mean, with 95 % interval over mazes"} if place == 0 else {}
        error = np.array([[mean - low], [high - mean]]).clip(0)
        axes.errorbar(mean, place, xerr=error, fmt="o", color="C0", capsize=4, **label)
    axes.set(xlabel="runs that succeed, %", xlim=(-3, 103), ylim=(len(names) - 0.5, -0.5))
    axes.set_yticks(range(len(names)), [plain(str(name)) for name in names])
    axes.grid(axis="x", alpha=0.3)
    legend_below(figure)
    return figure, axes


def plot_pairs(rates: pd.DataFrame, first: str, second: str) -> tuple[Figure, Axes]:
    """The rates of success of two algorithms, a dot for each maze; dots are as large as the mazes are many.

    Parameters
    ----------
    rates : DataFrame, one row for each maze and algorithm
        With the columns maze, algorithm and rate, in [0, 1].
    first, second : str
        The algorithms along the horizontal and the vertical axis.
    """
    by_maze = rates.pivot_table(index="maze", columns="algorithm", values="rate")[[first, second]].dropna()
    counts = (100 * by_maze).round(6).value_counts()
    figure, axes = plt.subplots(figsize=(4.6, 4.6))
    axes.plot([0, 100], [0, 100], color=FAINT, linewidth=0.8, zorder=0)
    x, y = (counts.index.get_level_values(name) for name in (first, second))
    axes.scatter(x, y, s=24 * counts.to_numpy(), alpha=0.6, linewidths=0)
    better, worse = ((by_maze[first] > by_maze[second]).sum(), (by_maze[first] < by_maze[second]).sum())
    axes.text(2, 98, f"better on {worse}", va="top")
    axes.text(98, 2, f"better on {better}", ha="right")
    axes.set(xlim=(-4, 104), ylim=(-4, 104), aspect="equal")
    axes.set(xlabel=f"{plain(first)}:\nruns that succeed, %", ylabel=f"{plain(second)}:\nruns that succeed, %")
    return figure, axes


def plot_mean_curves(runs: Mapping[str, pd.DataFrame]) -> tuple[Figure, Axes]:
    """The share of runs that have succeeded, by evaluations, with 95 % bands (`statistics.mean_success_curve`).

    Parameters
    ----------
    runs : mapping of str to DataFrame
        By the name of the algorithm, its runs on all mazes, with the columns maze, success and evaluations.
    """
    figure, axes = plt.subplots(figsize=(5.6, 4.2 + 0.15 * len(runs)))
    for number, (name, of_algorithm) in enumerate(runs.items()):
        curve, last = mean_success_curve(of_algorithm), of_algorithm.evaluations.max()
        steps = [0, *curve.evaluations, last]
        share, low, high = (
            100 * np.array([0, *curve[column], [0, *curve[column]][-1]]) for column in ("share", "low", "high")
        )
        style = {"color": f"C{number % 7}", "linestyle": "-" if number < 7 else "--"}  # there are seven colours
        axes.step(steps, share, where="post", label=plain(name), **style)
        axes.fill_between(steps, low, high, step="post", facecolor=style["color"], alpha=0.15)
    axes.set(xlabel="evaluations", ylabel="runs that have succeeded, %", ylim=(0, 100))
    axes.set_xlim(0, max(of_algorithm.evaluations.max() for of_algorithm in runs.values()))
    axes.xaxis.set_major_formatter("{x:,.0f}")
    legend_below(figure)
    return figure, axes
