"""Figures of mazes, paths and results. They draw what they are given, and never run an experiment."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from safe.maze import Maze

STYLE = Path(__file__).with_name("figures.mplstyle")
WALL, START, GOAL, PATH = "#404040", "#009E73", "#D55E00", "#0072B2"

_DIRECTIONS = {"right": (0, 1), "left": (0, -1), "down": (1, 0), "up": (-1, 0)}  # rows down, columns right


def use_style() -> None:
    """Make every figure look like those of the book; in a notebook as SVG for pages and PDF for print."""
    plt.style.use(STYLE)
    try:
        from IPython import get_ipython
        from matplotlib_inline.backend_inline import set_matplotlib_formats
    except ImportError:
        return
    if get_ipython() is not None:
        set_matplotlib_formats("svg", "pdf")


def draw_maze(axes: Axes, maze: Maze) -> None:
    """Walls, start (a disc) and goal (a star), rows counted downwards, one unit a cell."""
    axes.imshow(maze.walls, cmap=ListedColormap(["white", WALL]), vmin=0, vmax=1, interpolation="none")
    for (row, column), marker, size, colour, label in (
        (maze.start, "o", 9, START, "start"),
        (maze.goal, "*", 15, GOAL, "goal"),
    ):
        axes.plot(
            column,
            row,
            marker,
            markersize=size,
            color=colour,
            markeredgecolor="white",
            zorder=4,
            label=label,
            linestyle="none",
        )
    axes.set(title=maze.name, xticks=[], yticks=[], aspect="equal")
    for spine in axes.spines.values():
        spine.set_visible(False)


def draw_path(axes: Axes, path: np.ndarray) -> None:
    """The cells of a path, array of int of shape (steps + 1, 2), as a line, its end a square."""
    axes.plot(path[:, 1], path[:, 0], color=PATH, label="path", zorder=2)
    axes.plot(
        path[-1, 1],
        path[-1, 0],
        "s",
        markersize=7,
        color=PATH,
        markeredgecolor="white",
        zorder=5,
        label="end of the path",
        linestyle="none",
    )


def plot_mazes(mazes: Sequence[Maze]) -> tuple[Figure, np.ndarray]:
    """The mazes side by side. Returns the figure and its axes, an array of shape (1, number of mazes)."""
    return plot_paths([[(maze, None, maze.name) for maze in mazes]])


def plot_paths(rows: Sequence[Sequence[tuple[Maze, np.ndarray | None, str]]]) -> tuple[Figure, np.ndarray]:
    """Rows of mazes, each with a path (or None) and a title. Returns the figure and its axes, one for each maze."""
    columns = max(len(row) for row in rows)
    side = 4.2 if columns < 3 else 3.1
    figure, grid = plt.subplots(
        len(rows), columns, figsize=(side * columns, (side + 0.2) * len(rows) + 0.3), squeeze=False
    )
    for axes in grid.flat:
        axes.set_axis_off()
    for row, axes_row in zip(rows, grid, strict=True):
        for (maze, path, title), axes in zip(row, axes_row, strict=False):
            axes.set_axis_on()
            draw_maze(axes, maze)
            if path is not None:
                draw_path(axes, path)
            axes.set_title(title)
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    return figure, grid


def plot_sensors(maze: Maze, cell: tuple[int, int], margin: int = 4) -> tuple[Figure, Axes]:
    """What a robot in an open cell (row, column) senses: arrows to the first walls, and to the side of the goal.

    The part of the maze that the arrows reach is shown, and `margin` cells around. Returns the figure and its axes.
    """
    readings = maze.readings(cell)
    row, column = cell
    figure, axes = plt.subplots(figsize=(7, 5))
    draw_maze(axes, maze)
    axes.plot(column, row, "D", markersize=11, color=PATH, markeredgecolor="white", zorder=5, linestyle="none")
    reach = [(row, column)]
    for direction, (down, right) in _DIRECTIONS.items():
        cells = readings[f"dist_{direction}"]
        end = row + down * cells, column + right * cells
        reach.append(end)
        axes.annotate("", end[::-1], (column, row), arrowprops={"arrowstyle": "-|>", "color": PATH, "lw": 1.8})
        text = f"dist_{direction} = {cells:.0f}"
        if readings[f"goal_{direction}"]:
            text += f"\ngoal_{direction} = {readings[f'goal_{direction}']:.0f}"
        axes.text(
            (column + end[1]) / 2,
            (row + end[0]) / 2,
            text,
            color=GOAL if readings[f"goal_{direction}"] else PATH,
            ha="center",
            va="center",
            fontsize="small",
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5},
            zorder=6,
        )
    rows, columns = np.array(reach).T
    axes.set_xlim(columns.min() - margin, columns.max() + margin)
    axes.set_ylim(rows.max() + margin, rows.min() - margin)
    axes.set_title(f"{maze.name}, the robot in row {row}, column {column}")
    return figure, axes


def plot_success(table: pd.DataFrame) -> tuple[Figure, np.ndarray]:
    """Rates of success with their 95 % intervals, beside the paper's; a table of `statistics.success_table`.

    Returns the figure and its axes, an array with one for each maze.
    """
    mazes = table.index.unique("maze")
    figure, grid = plt.subplots(1, len(mazes), figsize=(4.2 * len(mazes), 3.2), squeeze=False, sharey=True)
    for axes, maze in zip(grid[0], mazes, strict=True):
        rows = table.loc[maze][::-1]
        rate = rows.successes / rows.runs
        places = np.arange(len(rows))
        error = np.array([rate - rows.low, rows.high - rate]).clip(0)  # an end may pass the rate by a rounding
        axes.errorbar(100 * rate, places, xerr=100 * error, fmt="o", capsize=4, label="here, with 95 % interval")
        axes.plot(100 * rows.paper_successes / rows.paper_runs, places, "x", markersize=9, label="in the paper")
        axes.set(title=maze, xlabel="runs that succeed, %", yticks=places, yticklabels=rows.index)
        axes.set_ylim(-0.6, len(rows) - 0.4)
        axes.set_xlim(left=min(0, axes.get_xlim()[0]))
        axes.grid(axis="x", alpha=0.3)
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    return figure, grid[0]
