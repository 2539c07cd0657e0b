"""Draw the pictures in book/_static that no notebook makes, as SVG and PDF: make picture.

`robot-path` is that of the README and of the first page, and `cycle` the cycle of an evolutionary algorithm.
"""

from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

import safe
from safe.results import figures
from safe.results.figures.style import WALL

SEED = 1
STEPS = (  # of the cycle: centre, what is done, and how
    ((0.5, 0.88), "evaluate", "give each individual its fitness"),
    ((0.83, 0.5), "select", "parents win tournaments"),
    ((0.5, 0.12), "vary", "crossover, then mutation"),
    ((0.17, 0.5), "replace", "offspring and the two best\nare the next generation"),
)
SIZE = (0.3, 0.2)  # of a box


def robot_path() -> Figure:
    maze = safe.load_maze("maze1")
    run = safe.evolve(maze, "safe", SEED)
    if not run.success:
        raise SystemExit(f"SEED must be that of a run that succeeds; got {SEED}")
    return figures.plot_paths([[(maze, safe.path(maze, run.controller), "")]])[0]


def cycle() -> Figure:
    figure, axes = plt.subplots(figsize=(6, 3.6))
    axes.set(xlim=(0, 1), ylim=(0, 1))
    axes.set_axis_off()
    (width, height), number = SIZE, len(STEPS)
    for (x, y), what, how in STEPS:
        corner = x - width / 2, y - height / 2
        box = FancyBboxPatch(corner, width, height, boxstyle="round,pad=0.01", facecolor="#CFE5F2", edgecolor=WALL)
        axes.add_patch(box)
        axes.text(x, y + 0.05, what, ha="center", va="center", fontweight="bold")
        axes.text(x, y - 0.035, how, ha="center", va="center", fontsize=8)
    for place, ((x, y), *_) in enumerate(STEPS):
        (to_x, to_y), *_ = STEPS[(place + 1) % number]
        right, up = (1 if to_x > x else -1), (1 if to_y > y else -1)
        if place % 2:  # from a box at the side, to one in the middle
            start, end = (x, y + up * (height / 2 + 0.02)), (to_x - right * (width / 2 + 0.02), to_y)
        else:
            start, end = (x + right * (width / 2 + 0.02), y), (to_x, to_y - up * (height / 2 + 0.02))
        style = {"arrowstyle": "-|>", "mutation_scale": 14, "color": WALL, "connectionstyle": "arc3,rad=-0.25"}
        axes.add_patch(FancyArrowPatch(start, end, **style))
    words = "500 generations\nof 200 individuals,\nor until one succeeds"
    axes.text(0.5, 0.5, words, ha="center", va="center", fontsize=9)
    return figure


if __name__ == "__main__":
    figures.use_style()
    for name, draw in (("robot-path", robot_path), ("cycle", cycle)):
        figure = draw()
        for kind, metadata in (("svg", {"Date": None}), ("pdf", {"CreationDate": None})):
            figure.savefig(Path(__file__).parent / "_static" / f"{name}.{kind}", metadata=metadata)
        plt.close(figure)
