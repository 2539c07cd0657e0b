"""Where the panels of a figure lie in its image, so that a narrow page can show them one below the other."""

from __future__ import annotations

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.transforms import Bbox

POINTS = 72  # an inch


def image_box(figure: Figure) -> Bbox:
    """The part of a figure, in inches, to which its image is cut; what is in it then keeps its place."""
    if engine := figure.get_layout_engine():
        for _ in range(2):  # for panels of a fixed aspect once is not enough
            engine.execute(figure)
        with plt.rc_context({"figure.constrained_layout.use": False}):
            figure.set_layout_engine(None)
    return figure.get_tightbbox().padded(plt.rcParams["savefig.pad_inches"])


def fractions(figure: Figure, image: Bbox, box: Bbox) -> list[float]:
    """Left, top, width and height of a box, given in pixels of the figure, as fractions of its image."""
    box = box.transformed(figure.dpi_scale_trans.inverted())
    left, top = (box.x0 - image.x0) / image.width, (image.y1 - box.y1) / image.height
    return [round(float(part), 4) for part in (left, top, box.width / image.width, box.height / image.height)]


def layout(figure: Figure, image: Bbox) -> dict[str, list]:
    """Where the panels of a figure and the entries of its legend are.

    Parameters
    ----------
    figure : Figure
    image : Bbox
        The part of it that is shown (see `image_box`).

    Returns
    -------
    dict
        `size`: width and height of the image, in points. `panels`: for each panel its boxes from left to right, each as
        left, top, width and height, in fractions of the image. A panel has two boxes if the numbers of its vertical
        axis stand at another one alone, and panels that overlap count as one. `entries`: a box for each entry of the
        legend.
    """
    bars = {bar.ax for axes in figure.axes for bar in _colour_bars(axes)}
    drawn = [axes for axes in figure.axes if axes not in bars and (axes.axison or axes.has_data())]
    panels: list[list[Bbox]] = []
    for axes in drawn:
        panel = _boxes(axes, drawn)
        for other in [other for other in panels if _overlap(other[-1], panel[-1])]:
            panels.remove(other)
            panel = [Bbox.union([*other, *panel])]
        panels.append(panel)
    return {
        "size": [round(float(POINTS * side), 1) for side in (image.width, image.height)],
        "panels": [[fractions(figure, image, box) for box in panel] for panel in panels],
        "entries": [fractions(figure, image, box) for legend in figure.legends for box in _entries(legend)],
    }


def _boxes(axes: Axes, drawn: list[Axes]) -> list[Bbox]:
    """The boxes of a panel with its titles, labels and colour bars, preceded by the numbers that it shares."""
    box = Bbox.union([axes.get_tightbbox(), *(bar.ax.get_tightbbox() for bar in _colour_bars(axes))]).padded(2)
    if axes.yaxis.get_tick_params()["labelleft"]:
        return [box]
    row = axes.get_subplotspec().rowspan.start
    numbered = next(
        other
        for other in axes.get_shared_y_axes().get_siblings(axes)
        if other in drawn and other.get_subplotspec().rowspan.start == row and other.get_subplotspec().is_first_col()
    )
    left, edge = numbered.get_tightbbox().x0 - 2, numbered.get_window_extent().x0 - 1.5  # before its line
    return [Bbox.from_extents(left, box.y0, edge, box.y1), box]


def _colour_bars(axes: Axes) -> list:
    return [mappable.colorbar for mappable in (*axes.images, *axes.collections) if mappable.colorbar]


def _overlap(one: Bbox, other: Bbox) -> bool:
    common = Bbox.intersection(one.padded(-3), other.padded(-3))  # labels may touch
    return common is not None and common.width > 0 and common.height > 0


def _entries(legend: Legend) -> list[Bbox]:
    """The boxes of a legend's entries: each a handle and, to its right, a text."""
    boxes = []
    for text in legend.get_texts():
        box = text.get_window_extent()
        pixels = text.get_fontsize() * text.get_figure().dpi / POINTS
        before = (legend.handlelength + legend.handletextpad) * pixels
        boxes.append(Bbox.from_extents(box.x0 - before, box.y0, box.x1, box.y1).padded(2))
    return boxes
