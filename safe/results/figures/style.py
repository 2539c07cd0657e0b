"""The style that all figures share: colours, names as plain text, one legend for all panels."""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.figure import Figure

STYLE = Path(__file__).with_name("figures.mplstyle")
WALL, START, GOAL, PATH, FAINT = "#404040", "#009E73", "#D55E00", "#0072B2", "#999999"


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


def plain(name: str) -> str:
    """A name as matplotlib takes it for plain text: it reads `$` as mathematics, and leaves `_x` out of legends."""
    return (" " + name if name.startswith("_") else name).replace("$", r"\$")


def legend_below(figure: Figure) -> None:
    """One legend for all panels, each label once, in as many lines as the width of the figure asks for."""
    handles: dict = {}
    for axes in figure.axes:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            handles.setdefault(label, handle)
    for columns in range(len(handles), 0, -1):
        legend = figure.legend(handles.values(), handles, loc="outside lower center", ncols=columns)
        if columns == 1 or legend.get_window_extent().width <= figure.bbox.width:
            return
        legend.remove()
