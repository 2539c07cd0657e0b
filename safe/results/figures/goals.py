"""Figures of goals, which are places that judge: where they lie, whom they favour, and whether they come back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from safe.evolution import Generation
from safe.maze import Maze
from safe.results.exploration import places_of
from safe.results.figures.mazes import draw_maze
from safe.results.figures.style import FAINT, PATH, legend_below, plain

PLACE = "#CC79A7"


def draw_goals(axes: Axes, maze: Maze, generation: Generation) -> None:
    """Draw the goals of a generation, the end points of its robots, and a line from each goal to its favourite.

    Parameters
    ----------
    axes : Axes
    maze : Maze
    generation : Generation
        Of a run in which all objective functions are goals.
    """
    places, ends = places_of(maze, generation.objectives), generation.endpoints
    favourites = np.abs(places[:, np.newaxis] - ends).sum(axis=2).argmin(axis=1)  # the first on a tie
    draw_maze(axes, maze)
    lines = np.stack([places, ends[favourites]], axis=1)[:, :, ::-1]  # columns lie along the horizontal axis
    axes.add_collection(LineCollection(lines, colors=FAINT, linewidths=0.5, zorder=2), autolim=False)
    for points, marker, colour, label in (
        (ends, ".", PATH, "end points of robots"),
        (places, "x", PLACE, "places that judge"),
    ):
        style = {"markersize": 4, "color": colour, "linestyle": "none", "label": label, "zorder": 3}
        axes.plot(points[:, 1], points[:, 0], marker, **style)


def plot_goals(maze: Maze, rows: Sequence[Sequence[tuple[Generation, str]]]) -> tuple[Figure, np.ndarray]:
    """Rows of generations, each with a title, over the maze; axes have the shape (rows, generations in the longest)."""
    columns = max(len(row) for row in rows)
    side = 3.4 if columns < 4 else 2.8
    size = (side * columns, (side + 0.2) * len(rows) + 0.3)
    figure, grid = plt.subplots(len(rows), columns, figsize=size, squeeze=False)
    for axes in grid.flat:
        axes.set_axis_off()
    for row, axes_row in zip(rows, grid, strict=True):
        for (generation, title), axes in zip(row, axes_row, strict=False):
            axes.set_axis_on()
            draw_goals(axes, maze, generation)
            axes.set_title(plain(title))
    legend_below(figure)
    return figure, grid


def plot_autocorrelations(curves: Mapping[str, Sequence[np.ndarray]]) -> tuple[Figure, np.ndarray]:
    """Autocorrelations by lag, a panel for each label: a faint line for each run, and their mean.

    Parameters
    ----------
    curves : mapping of str to sequence of arrays of float, each of shape (lags,)
        By the label of the panel, the curves of its runs, from lag 0 on; all of the same length.
    """
    figure, grid = plt.subplots(1, len(curves), figsize=(3.6 * len(curves), 3.2), squeeze=False, sharey=True)
    for number, (axes, (name, of_runs)) in enumerate(zip(grid[0], curves.items(), strict=True)):
        for curve in of_runs:
            axes.plot(curve, color=FAINT, linewidth=0.8, alpha=0.6, label="a run")
        if len(of_runs):
            axes.plot(np.mean(of_runs, axis=0), color=f"C{number}", label=f"mean: {plain(name)}")
        axes.axhline(0, color=FAINT, linewidth=0.8, zorder=0)
        axes.set(title=plain(name), xlabel="lag, generations", ylim=(-1.05, 1.05))
    grid[0, 0].set_ylabel("autocorrelation")
    legend_below(figure)
    return figure, grid[0]
