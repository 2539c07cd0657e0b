"""Figures of mazes: walls, paths, what a robot senses, neighbours in a grid."""

from __future__ import annotations

import string
from collections.abc import Sequence

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from safe.maze import Maze, ways_to_goal
from safe.results.figures.style import FAINT, GOAL, PATH, START, WALL, legend_below, plain
from safe.results.labels import maze_labels

_DIRECTIONS = {"right": (0, 1), "left": (0, -1), "down": (1, 0), "up": (-1, 0)}  # rows down, columns right


def draw_maze(axes: Axes, maze: Maze) -> None:
    """Draw walls, start (a disc) and goal (a star); rows are counted downwards, and a cell is one unit wide."""
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
    axes.set(xticks=[], yticks=[], aspect="equal")
    for spine in axes.spines.values():
        spine.set_visible(False)


def draw_path(axes: Axes, path: np.ndarray) -> None:
    """Draw a path, array of int of shape (steps + 1, 2), as a line that ends in a square."""
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
    """The mazes side by side, in axes of shape (1, number of mazes)."""
    return plot_paths([[(maze, None, label) for maze, label in zip(mazes, maze_labels(mazes), strict=True)]])


def plot_landscape(maze: Maze) -> tuple[Figure, np.ndarray]:
    """What closeness rewards beside what is needed: cells to the goal through walls, and steps on the shortest way."""
    rows, columns = np.indices(maze.shape)
    apart = np.abs(rows - maze.goal[0]) + np.abs(columns - maze.goal[1])
    ways = ways_to_goal(maze)
    figure, grid = plt.subplots(1, 2, figsize=(8.4, 4.8))
    for axes, values, title in (
        (grid[0], apart, "distance to the goal, cells"),
        (grid[1], ways, "steps to walk to the goal"),
    ):
        draw_maze(axes, maze)
        shown = axes.imshow(np.ma.masked_where(ways < 0, values), cmap="cividis_r", zorder=1)
        axes.set_title(title)
        figure.colorbar(shown, ax=axes, orientation="horizontal", shrink=0.8)
    legend_below(figure)
    return figure, grid


def plot_crowd(
    maze: Maze, points: np.ndarray, nearest: Sequence[tuple[tuple[int, int], np.ndarray, str]]
) -> tuple[Figure, Axes]:
    """End points over the maze, and lines from some of them to their nearest neighbours.

    Parameters
    ----------
    maze : Maze
    points : array of int, shape (n, 2)
        All that may be neighbours.
    nearest : sequence of (point, array of shape (k, 2), label)
        A point, its neighbours, and what is written about it.
    """
    figure, axes = plt.subplots(figsize=(5.6, 5.8))
    draw_maze(axes, maze)
    axes.plot(points[:, 1], points[:, 0], ".", color=FAINT, markersize=4, label="end points and archive", zorder=2)
    for number, (point, neighbours, label) in enumerate(nearest):
        for neighbour in neighbours:
            axes.plot([point[1], neighbour[1]], [point[0], neighbour[0]], color=f"C{number}", linewidth=0.8, zorder=3)
        style = {"color": f"C{number}", "markersize": 8, "linestyle": "none", "zorder": 5}
        axes.plot(point[1], point[0], "D", markeredgecolor="white", label=plain(label), **style)
    legend_below(figure)
    return figure, axes


def plot_sheet(mazes: Sequence[Maze], columns: int = 6) -> tuple[Figure, Axes]:
    """Many mazes on one sheet, row by row, each with its number above, from 1; the axes have an image of each."""
    side, gap = max(max(maze.shape) for maze in mazes), 22
    lines = -(-len(mazes) // columns)
    figure, axes = plt.subplots(figsize=(5.6, 5.6 * lines / columns + 0.4))
    for number, maze in enumerate(mazes):
        top, left = ((side + gap) * place for place in divmod(number, columns))
        height, width = maze.shape
        extent = left - 0.5, left + width - 0.5, top + height - 0.5, top - 0.5
        axes.imshow(
            maze.walls, cmap=ListedColormap(["white", WALL]), vmin=0, vmax=1, interpolation="none", extent=extent
        )
        axes.text(left + width / 2, top - 2, str(number + 1), ha="center", va="bottom")
        for (row, column), marker, size, colour, label in (
            (maze.start, "o", 4, START, "start"),
            (maze.goal, "*", 7, GOAL, "goal"),
        ):
            style = {"markersize": size, "color": colour, "markeredgewidth": 0, "linestyle": "none", "label": label}
            axes.plot(left + column, top + row, marker, **style)
    across = (side + gap) * min(columns, len(mazes)) - gap
    axes.set(xlim=(-0.5, across - 0.5), ylim=((side + gap) * lines - gap - 0.5, -gap))
    axes.set_axis_off()
    legend_below(figure)
    return figure, axes


def plot_paths(rows: Sequence[Sequence[tuple[Maze, np.ndarray | None, str]]]) -> tuple[Figure, np.ndarray]:
    """Rows of mazes, each with a path (or None) and a title; the axes have the shape (rows, mazes in the longest)."""
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
            axes.set_title(plain(title))
    legend_below(figure)
    return figure, grid


def plot_sensors(maze: Maze, cell: tuple[int, int], margin: int = 4) -> tuple[Figure, Axes]:
    """What a robot in an open cell (row, column) senses: arrows to the first walls, and to the side of the goal.

    The figure shows the part of the maze that the arrows reach, and `margin` cells around it.
    """
    readings = maze.readings(cell)
    row, column = cell
    figure, axes = plt.subplots(figsize=(5.6, 4.4))
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
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5},
            zorder=6,
        )
    rows, columns = np.array(reach).T
    axes.set_xlim(columns.min() - margin, columns.max() + margin)
    axes.set_ylim(rows.max() + margin, rows.min() - margin)
    axes.set_title(plain(f"{maze.name}, the robot in row {row}, column {column}"))
    return figure, axes


def plot_neighbours(points: np.ndarray, neighbours: Sequence[Sequence[int]]) -> tuple[Figure, Axes]:
    """Points (row, column), shape (n, 2), lettered from A, each joined along rows and columns with its neighbours.

    Parameters
    ----------
    points : array of int, shape (n, 2)
        Rows and columns.
    neighbours : sequence of sequences of int
        For each point the indices of its neighbours.
    """
    points = np.asarray(points)
    figure, axes = plt.subplots(figsize=(5, 4))
    for (row, column), near in zip(points, neighbours, strict=True):
        for other_row, other_column in points[list(near)]:
            axes.plot([column, other_column, other_column], [row, row, other_row], color=FAINT, linewidth=1, zorder=1)
    axes.plot(points[:, 1], points[:, 0], "o", markersize=16, color=PATH, zorder=2)
    for letter, (row, column) in zip(string.ascii_uppercase, points, strict=False):
        axes.text(column, row, letter, color="white", ha="center", va="center", fontsize="small", zorder=3)
    low, high = points.min(axis=0) - 1, points.max(axis=0) + 1
    axes.set(xlim=(low[1], high[1]), ylim=(high[0], low[0]), aspect="equal", xlabel="column", ylabel="row")
    axes.grid(alpha=0.3)
    return figure, axes
