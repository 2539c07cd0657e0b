"""Figures of one run: who judges whom in a generation, how the run went, and an animation of it."""

from __future__ import annotations

import base64
import hashlib
import html
import io
import json
import string
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from safe.evolution import Generation
from safe.maze import Maze
from safe.results.figures.mazes import draw_maze
from safe.results.figures.style import FAINT, GOAL, PATH, WALL, legend_below, plain

TINTS = {"solutions": "#CFE5F2", "objectives": "#F9DEC8", "plain": "#F0F0F0", "won": "#BFE3D5"}


def plot_judging(generations: Mapping[str, Generation]) -> tuple[Figure, np.ndarray]:
    """One generation of several algorithms, as tables: who judges whom, what decides, what is bred.

    A row is a solution, a column an objective function, a cell the score that it gives; the best score in a row, the
    fitness, is marked. All numbers are written out, so keep solutions and objective functions few.

    Parameters
    ----------
    generations : mapping of str to Generation
        The generations, by their titles.
    """
    widths = [len(generation.objectives) + 4.37 for generation in generations.values()]
    rows = max(len(generation.genomes) for generation in generations.values())
    figure, grid = plt.subplots(
        1, len(widths), figsize=(0.7 * sum(widths), 0.96 * (rows + 4.1)), width_ratios=widths, squeeze=False
    )
    for axes, width, (title, generation) in zip(grid[0], widths, generations.items(), strict=True):
        _draw_judging(axes, generation)
        axes.set(title=plain(title), xlim=(-1.99, width - 1.99), ylim=(rows - 0.45, -4.3))
        axes.set_axis_off()
    return figure, grid[0]


def _draw_judging(axes: Axes, generation: Generation) -> None:
    n, m = len(generation.genomes), len(generation.objectives)
    scores = generation.components.T @ generation.objectives.T
    closeness, novelty = generation.components

    def write(x: float, y: float, text: str, **style: str) -> None:
        axes.text(x, y, text, ha="center", va="center", **style)

    def box(x: float, y: float, text: str, kind: str, width: float = 1, height: float = 1, **style: str) -> None:
        corner = x - width / 2, y - height / 2
        axes.add_patch(Rectangle(corner, width, height, facecolor=TINTS[kind], edgecolor="white", linewidth=2))
        write(x, y, text, **style)

    def arrow(start: tuple[float, float], end: tuple[float, float]) -> None:
        axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": WALL, "shrinkA": 0, "shrinkB": 0})

    for i in range(n):
        text = f"$S_{{{i + 1}}}$\n1/distance\n{closeness[i]:.4f}"
        if generation.novelty is not None:
            text += f"\nnovelty {novelty[i]:.1f}"
        box(-1.25, i, text, "solutions", width=1.46)
        for j in range(m):
            won = generation.winners[i] == j
            box(j, i, f"{scores[i, j]:.3g}", "won" if won else "plain", fontweight="bold" if won else "normal")
        arrow((m - 0.48, i), (m - 0.24, i))
        box(m + 0.28, i, f"{generation.fitness[i]:.3g}", "won", fontweight="bold")
        arrow((m + 0.8, i), (m + 1.04, i))
    write(m + 0.28, -1.05, "fitness:\nthe best\nscore")
    box(m + 1.71, (n - 1) / 2, "selection,\ncrossover,\nmutation:\nnext\nsolutions", "solutions", 1.3, n)
    middle = (m - 1) / 2
    for j, (a, b) in enumerate(generation.objectives):
        box(j, -1.05, f"$O_{{{j + 1}}}$\na {a:.3f}\nb {b:.3f}", "objectives")
        if generation.objective_fitness is not None:
            arrow((j, -1.57), (j, -1.83))
            box(j, -2.35, f"{generation.objective_fitness[j]:.3f}", "objectives", fontweight="bold")
            arrow((j, -2.87), (j, -3.13))
    if generation.objective_fitness is None:
        write(middle, -2.35, "The objective\nfunction stays\nas it is.")
    else:
        write(-1.2, -2.35, "fitness:\nnovelty\namong\nobjective\nfunctions")
        text = "selection, crossover, mutation:\nnext objective functions"
        box(middle, -3.65, text, "objectives", width=m)


def plot_progress(story: Sequence[Generation]) -> tuple[Figure, np.ndarray]:
    """How a run went: distances to the goal and, if it was computed, novelty, by generation."""
    numbers = [generation.generation for generation in story]
    has_novelty = story[0].novelty is not None
    figure, grid = plt.subplots(1 + has_novelty, 1, figsize=(5.6, 2.6 * (1 + has_novelty)), sharex=True, squeeze=False)
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


def plot_components(story: Sequence[Generation]) -> tuple[Figure, Axes]:
    """How large closeness and novelty are over a run, on a logarithmic scale: the largest and the mean value."""
    figure, axes = plt.subplots(figsize=(5.6, 3.3))
    numbers = [generation.generation for generation in story]
    for row, (name, colour) in enumerate((("1/distance", GOAL), ("novelty, cells", PATH))):
        values = np.array([generation.components[row] for generation in story])
        axes.plot(numbers, values.max(axis=1), color=colour, label=f"{name}: largest")
        axes.plot(numbers, values.mean(axis=1), color=colour, linestyle="--", linewidth=1.2, label=f"{name}: mean")
    axes.set(xlabel="generation", ylabel="component", yscale="log")
    axes.yaxis.set_major_formatter("{x:g}")
    legend_below(figure)
    return figure, axes


def plot_objectives(story: Sequence[Generation]) -> tuple[Figure, np.ndarray]:
    """The objective functions of some generations, a panel for each; those behind a solution's fitness stand out."""
    figure, grid = plt.subplots(1, len(story), figsize=(2.9 * len(story), 3.6), squeeze=False, sharey=True)
    for axes, generation in zip(grid[0], story, strict=True):
        won = np.bincount(generation.winners, minlength=len(generation.objectives))
        a, b = generation.objectives.T
        axes.plot(a[won == 0], b[won == 0], ".", color=FAINT, markersize=4, label="decides nowhere")
        axes.plot(a[won > 0], b[won > 0], "o", color=GOAL, markersize=8, label="gives some solution its fitness")
        axes.set(title=f"generation {generation.generation}", xlabel="$a$ (closeness)", aspect="equal")
        axes.set(xlim=(-0.04, 1.04), ylim=(-0.04, 1.04), xticks=[0, 0.5, 1], yticks=[0, 0.5, 1])
    grid[0, 0].set_ylabel("$b$ (novelty)")
    legend_below(figure)
    return figure, grid[0]


def plot_generation(maze: Maze, generation: Generation) -> tuple[Figure, np.ndarray]:
    """End points and archive over the maze and, if there are several, the objective functions."""
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


def animate(
    maze: Maze,
    story: Sequence[Generation],
    frames: int = 30,
    plot: Callable[[int], tuple[Figure, object]] | None = None,
) -> str:
    """A run as HTML: frames, evenly spread, with a button to play and a slider.

    The page loads nothing, and plays without a kernel.

    Parameters
    ----------
    maze : Maze
    story : sequence of Generation
    frames : int
        How many, if the run has so many generations.
    plot : function, optional
        Draws a frame, given the place of its generation in the story; `plot_generation` by default.
    """
    draw = plot or (lambda index: plot_generation(maze, story[index]))
    chosen = np.unique(np.linspace(0, len(story) - 1, frames).round().astype(int))
    images, shown, places = [], None, []
    for index in chosen:
        figure, _ = draw(index)
        if shown is None:  # the first frame's layout is that of all, and all are cut to what it fills
            figure.draw_without_rendering()
            shown = figure.get_tightbbox().padded(0.05)
            places = [axes.get_position() for axes in figure.axes]
        figure.set_layout_engine("none")
        for axes, place in zip(figure.axes, places, strict=True):
            axes.set_position(place)
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
