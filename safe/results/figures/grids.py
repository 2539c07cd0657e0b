"""Figures of designs: rates of success by levels of factors, and what happened inside runs, window by window."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from safe.results.figures.style import legend_below, plain

MARKERS = "osD^vP*"


def plot_rates(rates: pd.DataFrame, panel: str, place: str, colour: str, columns: int = 2) -> tuple[Figure, np.ndarray]:
    """Rates of success with 95 % intervals, as points beside each other.

    Parameters
    ----------
    rates : DataFrame, one row for each cell
        With the columns rate, low and high, in [0, 1], and those of the factors.
    panel, place, colour : str
        The factors whose levels have a panel, a line of points, and a colour and marker each.
    columns : int
        How many panels stand side by side.
    """
    panels, places, colours = (list(dict.fromkeys(rates[factor])) for factor in (panel, place, colour))
    lines = -(-len(panels) // columns)
    size = (4.2 * columns, lines * (0.9 + 0.42 * len(places)))
    figure, grid = plt.subplots(lines, columns, figsize=size, squeeze=False, sharex=True, sharey=True)
    for axes in grid.flat[len(panels) :]:
        axes.set_axis_off()
    for axes, level in zip(grid.flat, panels, strict=False):
        for number, of_colour in enumerate(colours):
            found = rates[(rates[panel] == level) & (rates[colour] == of_colour)]
            lift = 0.6 * ((number + 0.5) / len(colours) - 0.5)
            at = [places.index(name) + lift for name in found[place]]
            error = 100 * np.array([found.rate - found.low, found.high - found.rate]).clip(0)
            style = {"fmt": MARKERS[number % len(MARKERS)], "color": f"C{number}", "capsize": 3, "markersize": 5}
            axes.errorbar(100 * found.rate, at, xerr=error, label=plain(str(of_colour)), **style)
        axes.set(title=plain(str(level)), xlim=(-3, 103))
        axes.set_yticks(range(len(places)), [plain(str(name)) for name in places])
        axes.set_ylim(len(places) - 0.5, -0.5)
        axes.grid(axis="x", alpha=0.3)
    for axes in grid[-1]:
        axes.set_xlabel("runs that succeed, %")
    legend_below(figure)
    return figure, grid


def plot_levels(
    rates: pd.DataFrame, panel: str, level: str, colour: str, columns: int = 2, xlabel: str = ""
) -> tuple[Figure, np.ndarray]:
    """Rates of success with 95 % intervals, as lines along the levels of a factor, evenly spaced.

    For the parameters see `plot_rates`; `level` is the factor along the horizontal axis.
    """
    panels, levels, colours = (list(dict.fromkeys(rates[factor])) for factor in (panel, level, colour))
    lines = -(-len(panels) // columns)
    figure, grid = plt.subplots(
        lines, columns, figsize=(4.2 * columns, 0.4 + 2.8 * lines), squeeze=False, sharex=True, sharey=True
    )
    for axes in grid.flat[len(panels) :]:
        axes.set_axis_off()
    for axes, of_panel in zip(grid.flat, panels, strict=False):
        for number, of_colour in enumerate(colours):
            found = rates[(rates[panel] == of_panel) & (rates[colour] == of_colour)]
            if len(found):
                at = [levels.index(name) for name in found[level]]
                error = 100 * np.array([found.rate - found.low, found.high - found.rate]).clip(0)
                style = {"fmt": f"{MARKERS[number % len(MARKERS)]}-", "color": f"C{number}", "capsize": 3}
                axes.errorbar(at, 100 * found.rate, yerr=error, markersize=5, label=plain(str(of_colour)), **style)
        axes.set(title=plain(str(of_panel)), ylim=(-3, 103))
        axes.set_xticks(range(len(levels)), [plain(_written(name)) for name in levels])
        axes.grid(axis="y", alpha=0.3)
    for axes in grid[:, 0]:
        axes.set_ylabel("runs that succeed, %")
    for axes in grid[-1]:
        axes.set_xlabel(xlabel or level)
    legend_below(figure)
    return figure, grid


def plot_windows(
    traces: Mapping[str, pd.DataFrame], panels: Mapping[str, Sequence[str]], columns: int = 2
) -> tuple[Figure, np.ndarray]:
    """What happened inside runs: medians over runs and, as bands, the middle half, by generation.

    Parameters
    ----------
    traces : mapping of str to DataFrame
        By their labels, the measures of traced runs, with the columns run and window, the window's first generation.
    panels : mapping of str to sequence of str
        By the label of the vertical axis, the measures in a panel, which all traces share; the second is dashed.
    columns : int
        How many panels stand side by side.
    """
    lines = -(-len(panels) // columns)
    figure, grid = plt.subplots(lines, columns, figsize=(4.2 * columns, 0.4 + 2.7 * lines), squeeze=False, sharex=True)
    for axes in grid.flat[len(panels) :]:
        axes.set_axis_off()
    for axes, (label, measures) in zip(grid.flat, panels.items(), strict=False):
        for number, (name, table) in enumerate(traces.items()):
            for style, measure in zip(("-", "--"), measures, strict=False):
                found = table.groupby("window")[measure].describe()
                at = found.index + 1  # so that generation 0 has a place on a logarithmic axis
                shown = {"label": plain(name)} if measure == measures[0] else {}
                axes.plot(at, found["50%"], style, color=f"C{number}", **shown)
                axes.fill_between(at, found["25%"], found["75%"], facecolor=f"C{number}", alpha=0.15)
        axes.set(ylabel=label, xscale="log")
        starts = [
            start for start in (0, 1, 3, 10, 30, 100, 300) if start <= max(t.window.max() for t in traces.values())
        ]
        axes.set_xticks([start + 1 for start in starts], [str(start) for start in starts])
        axes.minorticks_off()
        axes.grid(alpha=0.2)
    for axes in grid[-1]:
        axes.set_xlabel("generation")
    legend_below(figure)
    return figure, grid


def _written(level: object) -> str:
    return f"{level:,}" if isinstance(level, int) else str(level)
