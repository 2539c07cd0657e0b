"""Figures of mazes, paths, runs and results, which draw what they are given, and never run an experiment.

Functions named `plot_...` return the figure and its axes: a single one, or an array of the panels, from left to right
or, if there are several rows of them, row by row. `results` and `paper` are those of `safe.results.tables`.
"""

from safe.results.figures.contest import plot_ladder, plot_mean_curves, plot_pairs
from safe.results.figures.grids import plot_interactions, plot_levels, plot_main_effects, plot_rates, plot_windows
from safe.results.figures.mazes import (
    draw_maze,
    draw_path,
    plot_crowd,
    plot_landscape,
    plot_mazes,
    plot_neighbours,
    plot_paths,
    plot_sensors,
    plot_sheet,
)
from safe.results.figures.panels import fractions, image_box, layout
from safe.results.figures.runs import (
    animate,
    plot_components,
    plot_generation,
    plot_judging,
    plot_objectives,
    plot_progress,
)
from safe.results.figures.samples import plot_coefficients, plot_success, plot_success_curves, plot_weights
from safe.results.figures.style import STYLE, use_style

__all__ = [
    "STYLE",
    "animate",
    "draw_maze",
    "draw_path",
    "fractions",
    "image_box",
    "layout",
    "plot_coefficients",
    "plot_components",
    "plot_crowd",
    "plot_generation",
    "plot_interactions",
    "plot_judging",
    "plot_ladder",
    "plot_landscape",
    "plot_levels",
    "plot_main_effects",
    "plot_mazes",
    "plot_mean_curves",
    "plot_neighbours",
    "plot_objectives",
    "plot_pairs",
    "plot_paths",
    "plot_progress",
    "plot_rates",
    "plot_sensors",
    "plot_sheet",
    "plot_success",
    "plot_success_curves",
    "plot_weights",
    "plot_windows",
    "use_style",
]
