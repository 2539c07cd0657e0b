"""Draw book/_static/robot-path, the picture of the README and of the first page, as SVG and PDF: make picture."""

from pathlib import Path

import matplotlib.pyplot as plt

import safe
from safe.results import figures

SEED = 1

if __name__ == "__main__":
    figures.use_style()
    maze = safe.load_maze("maze1")
    run = safe.evolve(maze, "safe", SEED)
    if not run.success:
        raise SystemExit(f"SEED must be that of a run that succeeds; got {SEED}")
    figure, _ = figures.plot_paths([[(maze, safe.path(maze, run.controller), "")]])
    for kind, metadata in (("svg", {"Date": None}), ("pdf", {"CreationDate": None})):
        figure.savefig(Path(__file__).parent / "_static" / f"robot-path.{kind}", metadata=metadata)
    plt.close(figure)
