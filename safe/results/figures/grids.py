"""Figures of designs: rates of success by levels of factors, and what happened inside runs, window by window."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from safe.results.figures.style import legend_below, plain
from safe.results.statistics import success_interval

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
    panels, places, colours = (_levels(rates[factor]) for factor in (panel, place, colour))
    height = 0.9 + 0.42 * len(places)
    figure, grid = _panels(len(panels), columns, height, xlabel="runs that succeed, %", sharey=True)
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
    legend_below(figure)
    return figure, grid


def plot_levels(
    rates: pd.DataFrame, panel: str, level: str, colour: str, columns: int = 2, xlabel: str = ""
) -> tuple[Figure, np.ndarray]:
    """Rates of success with 95 % intervals, as lines along the levels of a factor, evenly spaced.

    For the parameters see `plot_rates`; `level` is the factor along the horizontal axis.
    """
    panels, levels, colours = (_levels(rates[factor]) for factor in (panel, level, colour))
    figure, grid = _panels(len(panels), columns, 2.8, legend=0.4, xlabel=xlabel or level, sharey=True)
    for axes, of_panel in zip(grid.flat, panels, strict=False):
        for number, of_colour in enumerate(colours):
            found = rates[(rates[panel] == of_panel) & (rates[colour] == of_colour)]
            found = found.sort_values(level, key=lambda names: names.map(levels.index))
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
    legend_below(figure)
    return figure, grid


def plot_main_effects(rates: pd.DataFrame, factors: Sequence[str], colour: str) -> tuple[Figure, np.ndarray]:
    """Rates of success with 95 % intervals by the levels of each factor, all cells of a level taken together.

    Parameters
    ----------
    rates : DataFrame, one row for each cell
        With the columns successes and runs, and those of the factors.
    factors : sequence of str
        A panel each, side by side.
    colour : str
        The factor whose levels have a line each.
    """
    figure, grid = plt.subplots(1, len(factors), figsize=(2.9 * len(factors), 3.6), squeeze=False, sharey=True)
    for axes, factor in zip(grid[0], factors, strict=True):
        levels = _levels(rates[factor])
        for number, (name, cells) in enumerate(rates.groupby(colour, sort=False)):
            counts = cells.groupby(factor)[["successes", "runs"]].sum().reindex(levels).dropna()
            rate = counts.successes / counts.runs
            ends = np.array([success_interval(int(row.successes), int(row.runs)) for row in counts.itertuples()]).T
            error = 100 * np.abs(ends - rate.to_numpy())
            style = {"fmt": f"{MARKERS[number % len(MARKERS)]}-", "color": f"C{number}", "capsize": 3, "markersize": 5}
            at = [levels.index(level) for level in counts.index]
            axes.errorbar(at, 100 * rate, yerr=error, label=plain(str(name)), **style)
        axes.set_xticks(range(len(levels)), [plain(_written(level)).replace(" ", "\n") for level in levels])
        axes.set(title=factor, ylim=(-3, 103), xlim=(-0.4, len(levels) - 0.6))
        axes.grid(axis="y", alpha=0.3)
    grid[0, 0].set_ylabel("runs that succeed, %")
    legend_below(figure)
    return figure, grid[0]


def plot_interactions(rates: pd.DataFrame, pairs: Sequence[tuple[str, str]]) -> tuple[Figure, np.ndarray]:
    """Rates of success by the levels of two factors, as tables coloured by the rate, a panel for each pair."""
    figure, grid = plt.subplots(1, len(pairs), figsize=(3.9 * len(pairs), 3.4), squeeze=False)
    for axes, (across, down) in zip(grid[0], pairs, strict=True):
        columns, rows = (_levels(rates[factor]) for factor in (across, down))
        counts = rates.groupby([down, across])[["successes", "runs"]].sum()
        share = 100 * (counts.successes / counts.runs).unstack().reindex(index=rows, columns=columns)  # noqa: PD010
        axes.imshow(share, cmap="viridis", vmin=0, vmax=100, aspect="auto")
        for (row, column), value in np.ndenumerate(share.to_numpy()):
            text = "" if np.isnan(value) else f"{value:.0f} %"
            axes.text(column, row, text, ha="center", va="center", color="white" if value < 60 else "black")
        axes.set_xticks(range(len(columns)), [plain(_written(level)).replace(" ", "\n") for level in columns])
        axes.set_yticks(range(len(rows)), [plain(_written(level)) for level in rows])
        axes.set(xlabel=across, ylabel=down)
    return figure, grid[0]


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
    figure, grid = _panels(len(panels), columns, 2.7, legend=0.4, xlabel="generation")
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
    legend_below(figure)
    return figure, grid


def _panels(
    number: int, columns: int, height: float, xlabel: str, legend: float = 0, sharey: bool = False
) -> tuple[Figure, np.ndarray]:
    """So many panels, line by line, each with the numbers and the label of the horizontal axis that all share.

    `height` is that of a line of panels, and `legend` that of the room below them, in inches.
    """
    lines = -(-number // columns)
    size = (4.2 * columns, legend + height * lines + 0.4 * (lines - 1))
    figure, grid = plt.subplots(lines, columns, figsize=size, squeeze=False, sharex=True, sharey=sharey)
    for axes in grid.flat[number:]:
        axes.set_axis_off()
    for axes in grid.flat[:number]:
        axes.tick_params(labelbottom=True)
        axes.set_xlabel(xlabel)
    return figure, grid


def _levels(values: pd.Series) -> list:
    """The levels of a factor: numbers in ascending order, words in that of the table."""
    return sorted(set(values)) if pd.api.types.is_numeric_dtype(values) else list(dict.fromkeys(values))


def _written(level: object) -> str:
    return f"{level:,}" if isinstance(level, int | np.integer) else str(level)
