"""Figures of mazes, paths and results. They draw what they are given, and never run an experiment."""

from __future__ import annotations

import base64
import hashlib
import html
import io
import json
import string
from collections.abc import Mapping, Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from safe.evolution import Generation
from safe.maze import Maze

STYLE = Path(__file__).with_name("figures.mplstyle")
WALL, START, GOAL, PATH, FAINT = "#404040", "#009E73", "#D55E00", "#0072B2", "#999999"
TINTS = {"solutions": "#CFE5F2", "objectives": "#F9DEC8", "plain": "#F0F0F0", "won": "#BFE3D5"}

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
    axes.set(xticks=[], yticks=[], aspect="equal")
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


def _plain(name: str) -> str:
    """A name as matplotlib takes it for plain text: it reads `$` as mathematics, and leaves `_x` out of legends."""
    return (" " + name if name.startswith("_") else name).replace("$", r"\$")


def _legend_below(figure: Figure, axes: Axes) -> None:
    """One legend for all panels, that of the first."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))


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
            axes.set_title(_plain(title))
    _legend_below(figure, grid[0, 0])
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
    axes.set_title(_plain(f"{maze.name}, the robot in row {row}, column {column}"))
    return figure, axes


def plot_success(table: pd.DataFrame) -> tuple[Figure, np.ndarray]:
    """Rates of success with their 95 % intervals, beside the paper's; a table of `tables.success_table`.

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
        axes.set(title=_plain(maze), xlabel="runs that succeed, %")
        axes.set_yticks(places, [_plain(algorithm) for algorithm in rows.index])
        axes.set_ylim(-0.6, len(rows) - 0.4)
        axes.set_xlim(left=min(0, axes.get_xlim()[0]))
        axes.grid(axis="x", alpha=0.3)
    _legend_below(figure, grid[0, 0])
    return figure, grid[0]


def plot_arrivals(curves: Mapping[tuple[str, str], pd.DataFrame], generations: int) -> tuple[Figure, np.ndarray]:
    """The share of runs that have succeeded, generation by generation, with 95 % bands.

    Parameters
    ----------
    curves : mapping of (maze, algorithm) to DataFrame
        Curves of `statistics.arrivals`.
    generations : int
        How many a run has at the most.

    Returns the figure and its axes, an array with one for each maze.
    """
    mazes = list(dict.fromkeys(maze for maze, _ in curves))
    figure, grid = plt.subplots(1, len(mazes), figsize=(4.4 * len(mazes), 3.6), squeeze=False)
    for axes, maze in zip(grid[0], mazes, strict=True):
        for (of_maze, algorithm), curve in curves.items():
            if of_maze == maze:
                steps = [0, *curve.generation, generations]
                share, low, high = ([0, *curve[name], [0, *curve[name]][-1]] for name in ("share", "low", "high"))
                axes.step(steps, 100 * np.array(share), where="post", label=_plain(algorithm))
                axes.fill_between(steps, 100 * np.array(low), 100 * np.array(high), step="post", alpha=0.2)
        axes.set(title=_plain(maze), xlabel="generation", ylabel="runs that have succeeded, %", ylim=(0, None))
        axes.set_xlim(0, generations)
    _legend_below(figure, grid[0, 0])
    return figure, grid[0]


def plot_coefficients(samples: Mapping[str, pd.DataFrame], table: pd.DataFrame) -> tuple[Figure, np.ndarray]:
    """The objective functions of successful runs, as points (a, b), and the paper's mean and standard deviation.

    Parameters
    ----------
    samples : mapping of a maze's name to DataFrame
        Successful runs, with columns a and b.
    table : DataFrame
        Of `tables.evolved_table`, with the items a and b.

    Returns the figure and its axes, an array with one for each maze.
    """
    figure, grid = plt.subplots(1, len(samples), figsize=(4.2 * len(samples), 4.4), squeeze=False)
    for axes, (maze, runs) in zip(grid[0], samples.items(), strict=True):
        axes.plot(runs.a, runs.b, ".", alpha=0.6, label="a successful run")
        paper = table.loc[maze].droplevel("weighs")[["paper_mean", "paper_sd"]]
        (a, a_sd), (b, b_sd) = paper.loc[["a", "b"]].to_numpy()
        axes.errorbar(a, b, xerr=a_sd, yerr=b_sd, fmt="x", capsize=4, color=GOAL, label="in the paper, mean and sd")
        axes.set(title=_plain(maze), xlabel="a (closeness)", ylabel="b (novelty)", xlim=(-0.02, 1.05))
    _legend_below(figure, grid[0, 0])
    return figure, grid[0]


def plot_weights(table: pd.DataFrame) -> tuple[Figure, np.ndarray]:
    """The evolved weights of controllers, mean and standard deviation, beside the paper's.

    The table is one of `tables.evolved_table`. Returns the figure and its axes, an array with one for each maze.
    """
    mazes = table.index.unique("maze")
    figure, grid = plt.subplots(1, len(mazes), figsize=(4.4 * len(mazes), 6), squeeze=False, sharey=True)
    for axes, maze in zip(grid[0], mazes, strict=True):
        rows = table.loc[maze][::-1]
        places = np.arange(len(rows))
        for mean, sd, marker, lift, label in (
            (rows["mean"], rows.sd, "o", 0.15, "here, mean and sd"),
            (rows.paper_mean, rows.paper_sd, "x", -0.15, "in the paper"),
        ):
            axes.errorbar(mean, places + lift, xerr=sd, fmt=marker, capsize=2, linewidth=1, label=label)
        axes.axvline(0, color=FAINT, linewidth=0.8, zorder=0)
        labels = [f"{item}: {weighs}" for item, weighs in rows.index]
        axes.set(title=_plain(maze), xlabel="weight", yticks=places, yticklabels=labels, xlim=(-1.3, 1.3))
    _legend_below(figure, grid[0, 0])
    return figure, grid[0]


def plot_parts(table: pd.DataFrame) -> tuple[Figure, np.ndarray]:
    """What the parts of a generation cost (see `speed.parts_table`): one panel a maze, one bar an algorithm."""
    mazes = table.index.unique("maze")
    parts = table.drop(columns="all")
    figure, grid = plt.subplots(1, len(mazes), figsize=(4 * len(mazes), 2.9), squeeze=False, sharex=True)
    for axes, maze in zip(grid[0], mazes, strict=True):
        rows = parts.loc[maze].iloc[::-1].fillna(0)
        left = np.zeros(len(rows))
        for part in rows:
            axes.barh([_plain(name) for name in rows.index], rows[part], left=left, label=part, height=0.6)
            left += rows[part].to_numpy()
        axes.set(title=_plain(maze), xlabel="microseconds a generation")
    _legend_below(figure, grid[0, 0])
    return figure, grid[0]


VARIED = {  # what grows, in words
    "population": "solutions, and as many objective functions",
    "archive": "places in an archive",
    "k": "k, nearest neighbours",
    "steps": "steps of a robot",
    "maze": "cells along a side of the maze",
    "runs": "runs of an experiment",
}


def plot_growth(table: pd.DataFrame) -> tuple[Figure, np.ndarray]:
    """How the cost grows with each size that is varied (see `speed.growth_table`), on logarithmic axes."""
    whats = table.what.unique()
    figure, grid = plt.subplots(-(-len(whats) // 2), 2, figsize=(8, 2.9 * -(-len(whats) // 2)), squeeze=False)
    for axes, what in zip(grid.flat, whats, strict=False):
        rows = table[table.what == what]
        for label, line in rows.groupby("of", sort=False):
            axes.plot(line["size"], 1000 * line.seconds, "o-", markersize=4, label=_plain(label))
        # as steep as what grows in proportion; 0 has no place on a logarithmic axis but at its edge
        axes.set(xscale="symlog" if rows["size"].min() == 0 else "log", yscale="log", xlabel=VARIED.get(what, what))
        sizes = np.array(sorted(rows["size"][rows["size"] > 0]))[[0, -1]]
        axes.plot(sizes, 1000 * rows.seconds.min() * sizes / sizes[0], ":", color=FAINT, label="in proportion")
        axes.set_ylabel("milliseconds")
        axes.legend(fontsize="x-small")
    for axes in grid.flat[len(whats) :]:
        axes.set_axis_off()
    return figure, grid


def plot_neighbours(points: np.ndarray, neighbours: Sequence[Sequence[int]]) -> tuple[Figure, Axes]:
    """Points (row, column), shape (n, 2), lettered from A, each joined with its neighbours along rows and columns."""
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


def plot_judging(generations: Mapping[str, Generation]) -> tuple[Figure, np.ndarray]:
    """One generation of several algorithms, as tables: who judges whom, what decides, what is bred.

    A row is a solution, a column an objective function, a cell the score that it gives; the best score in a row, the
    fitness, is marked. Meant for a few solutions and objective functions, as all numbers are written out.

    Returns the figure and its axes, an array with one for each algorithm.
    """
    widths = [len(generation.objectives) + 5.5 for generation in generations.values()]
    rows = max(len(generation.genomes) for generation in generations.values())
    figure, grid = plt.subplots(
        1, len(widths), figsize=(0.72 * sum(widths), 0.72 * (rows + 4.8)), width_ratios=widths, squeeze=False
    )
    for axes, width, (title, generation) in zip(grid[0], widths, generations.items(), strict=True):
        _draw_judging(axes, generation)
        axes.set(title=_plain(title), xlim=(-2.7, width - 2.7), ylim=(rows - 0.4, -4.7), aspect="equal")
        axes.set_axis_off()
    return figure, grid[0]


def _draw_judging(axes: Axes, generation: Generation) -> None:
    n, m = len(generation.genomes), len(generation.objectives)
    scores = generation.components.T @ generation.objectives.T
    closeness, novelty = generation.components

    def box(x: float, y: float, text: str, kind: str, width: float = 1, height: float = 1, **style: str) -> None:
        corner = x - width / 2, y - height / 2
        axes.add_patch(Rectangle(corner, width, height, facecolor=TINTS[kind], edgecolor="white", linewidth=2))
        axes.text(x, y, text, ha="center", va="center", fontsize=8, **style)

    def arrow(start: tuple[float, float], end: tuple[float, float]) -> None:
        axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": WALL, "shrinkA": 0, "shrinkB": 0})

    for i in range(n):
        text = f"$S_{{{i + 1}}}$:  1/distance {closeness[i]:.4f}"
        if generation.novelty is not None:
            text += f"\n       novelty {novelty[i]:.2f}"
        box(-1.6, i, text, "solutions", width=2.2)
        for j in range(m):
            won = generation.winners[i] == j
            box(j, i, f"{scores[i, j]:.3g}", "won" if won else "plain", fontweight="bold" if won else "normal")
        arrow((m - 0.45, i), (m - 0.05, i))
        box(m + 0.5, i, f"{generation.fitness[i]:.3g}", "won", fontweight="bold")
        arrow((m + 1.05, i), (m + 1.45, i))
    axes.text(m + 0.5, -1.1, "fitness:\nthe best\nscore", ha="center", va="center", fontsize=8)
    box(m + 2.1, (n - 1) / 2, "selection,\ncrossover,\nmutation:\nnext\nsolutions", "solutions", 1.2, n)
    middle = (m - 1) / 2
    for j, (a, b) in enumerate(generation.objectives):
        box(j, -1.1, f"$O_{{{j + 1}}}$\na={a:.4f}\nb={b:.4f}", "objectives")
        if generation.objective_fitness is not None:
            arrow((j, -1.65), (j, -2.05))
            box(j, -2.6, f"{generation.objective_fitness[j]:.3f}", "objectives", fontweight="bold")
            arrow((j, -3.15), (j, -3.55))
    if generation.objective_fitness is None:
        axes.text(middle, -2.6, "The objective function\nstays as it is.", ha="center", va="center", fontsize=8)
    else:
        axes.text(-0.65, -2.6, "fitness:\nnovelty among\nobjective functions", ha="right", va="center", fontsize=8)
        text = "selection, crossover, mutation:\nnext objective functions"
        box(middle, -4.1, text, "objectives", width=m)


def plot_progress(story: Sequence[Generation]) -> tuple[Figure, np.ndarray]:
    """How a run went: distances to the goal and, where it counts, novelty, by generation.

    Returns the figure and its axes, an array of one or two.
    """
    numbers = [generation.generation for generation in story]
    has_novelty = story[0].novelty is not None
    figure, grid = plt.subplots(1 + has_novelty, 1, figsize=(7, 2.6 * (1 + has_novelty)), sharex=True, squeeze=False)
    distance = grid[0, 0]
    distance.plot(
        numbers, [generation.distances.min() for generation in story], alpha=0.5, label="nearest in generation"
    )
    distance.plot(numbers, [generation.distance for generation in story], label="nearest so far")
    distance.set(ylabel="distance to the goal, cells", ylim=(0, None))
    distance.legend()
    if has_novelty:
        novelty = grid[1, 0]
        novelty.plot(numbers, [generation.novelty.max() for generation in story], alpha=0.5, label="highest")
        novelty.plot(numbers, [generation.novelty.mean() for generation in story], label="mean")
        novelty.set(ylabel="novelty, cells", ylim=(0, None))
        novelty.legend()
    grid[-1, 0].set_xlabel("generation")
    return figure, grid[:, 0]


def plot_generation(maze: Maze, generation: Generation) -> tuple[Figure, np.ndarray]:
    """End points and archive over the maze and, where there are several, the objective functions.

    Returns the figure and its axes, an array of one or two.
    """
    several = len(generation.objectives) > 1
    figure, grid = plt.subplots(1, 1 + several, figsize=(4.6 * (1 + several), 5), squeeze=False)
    draw_maze(grid[0, 0], maze)
    archived, _ = generation.archive
    grid[0, 0].plot(archived[:, 1], archived[:, 0], ".", color=FAINT, markersize=3, label="archive")
    ends = generation.endpoints
    grid[0, 0].plot(ends[:, 1], ends[:, 0], ".", color=PATH, markersize=6, label="end points")
    grid[0, 0].set_title(f"generation {generation.generation}: nearest so far {generation.distance} cells")
    grid[0, 0].legend(loc="upper center", bbox_to_anchor=(0.5, 0), ncols=4, fontsize="small", columnspacing=1)
    if several:
        won = np.bincount(generation.winners, minlength=len(generation.objectives)) > 0
        for chosen, colour, label in ((~won, FAINT, "won nowhere"), (won, GOAL, "gave some solution its fitness")):
            a, b = generation.objectives[chosen].T
            grid[0, 1].plot(a, b, ".", color=colour, markersize=7, label=label)
        grid[0, 1].set(title="objective functions", xlabel="a (closeness)", ylabel="b (novelty)", aspect="equal")
        grid[0, 1].set(xlim=(-0.02, 1.02), ylim=(-0.02, 1.02))
        grid[0, 1].legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2, fontsize="small")
    return figure, grid[0]


def animate(maze: Maze, story: Sequence[Generation], frames: int = 30) -> str:
    """A run as HTML: frames of `plot_generation`, evenly spread, with a button to play and a slider.

    It needs nothing from elsewhere, and no kernel.
    """
    chosen = np.unique(np.linspace(0, len(story) - 1, frames).round().astype(int))
    images, shown = [], None
    for index in chosen:
        figure, _ = plot_generation(maze, story[index])
        if shown is None:  # what the first frame fills, so that all are of one size
            figure.draw_without_rendering()
            shown = figure.get_tightbbox().padded(0.05)
        with io.BytesIO() as file:
            figure.savefig(file, format="png", dpi=75, bbox_inches=shown)
            images.append(base64.b64encode(file.getvalue()).decode())
        plt.close(figure)
    last = story[-1]
    text = f"End points over {maze.name}, from generation 0 to {last.generation}, {last.distance} cells from the goal."
    return string.Template(Path(__file__).with_name("player.html").read_text(encoding="utf-8")).substitute(
        id="player-" + hashlib.sha256("".join(images).encode()).hexdigest()[:12],
        text=html.escape(text, quote=True),
        last=len(images) - 1,
        frames=json.dumps(images),
        labels=json.dumps([story[index].generation for index in chosen]),
    )
