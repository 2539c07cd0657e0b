"""Figures of goals, which are places that judge: where they lie, whom they favour, and whether they come back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from safe.algorithms import Algorithm
from safe.evolution import Generation
from safe.maze import Maze
from safe.results.exploration import places_of
from safe.results.figures.mazes import draw_maze
from safe.results.figures.style import FAINT, PATH, WALL, legend_below, plain

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


def draw_choices(axes: Axes, maze: Maze, algorithm: Algorithm, before: Generation, after: Generation) -> None:
    """Draw who chose whom: the parents of a generation, where they ended, and the goals that chose them.

    Parameters
    ----------
    axes : Axes
    maze : Maze
    algorithm : Algorithm
        One by which goals choose parents.
    before, after : Generation
        Of a run, one after the other; the parents are those of the second.
    """
    first_goal = algorithm.first_goal(len(before.objectives))
    by_goal, by_weights = after.chosen_by >= first_goal, (after.chosen_by >= 0) & (after.chosen_by < first_goal)
    known = before.endpoints if before.repertoire is None else before.repertoire[1]
    goals = places_of(maze, before.objectives[after.chosen_by[by_goal]])
    chosen, weighed = known[after.parents[by_goal]], before.endpoints[after.parents[by_weights]]
    draw_maze(axes, maze)
    lines = np.stack([goals, chosen], axis=1)[:, :, ::-1]
    axes.add_collection(LineCollection(lines, colors=FAINT, linewidths=0.5, zorder=2), autolim=False)
    for points, marker, size, colour, label in (
        (known, ".", 2, FAINT, "where robots have ended"),
        (goals, "x", 4, PLACE, "places that chose"),
        (chosen, ".", 5, PATH, "whom they chose"),
        (weighed, "+", 6, WALL, "whom weights chose"),
    ):
        style = {"markersize": size, "color": colour, "linestyle": "none", "label": label, "zorder": 3}
        if len(points):
            axes.plot(points[:, 1], points[:, 0], marker, **style)
    axes.set_title(f"generation {before.generation}")


def plot_choices(
    maze: Maze, algorithm: Algorithm, pairs: Sequence[tuple[Generation, Generation]]
) -> tuple[Figure, np.ndarray]:
    """Who chose whom at some times of a run, a panel for each pair of generations (see `draw_choices`)."""
    side = 3.4 if len(pairs) > 1 else 5.4
    figure, grid = plt.subplots(1, len(pairs), figsize=(side * len(pairs), side + 0.5), squeeze=False)
    for axes, pair in zip(grid[0], pairs, strict=True):
        draw_choices(axes, maze, algorithm, *pair)
    legend_below(figure)
    return figure, grid[0]


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
