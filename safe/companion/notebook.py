"""Helpers of the book's notebooks: the style of figures, tables with links, numbers for the prose, parameters read.

A notebook runs wherever it is opened. A file that its parameters leave empty is the project's (see
`safe.companion.project`). A relative path that they give is relative to the working directory: the shell's with
papermill, and the notebook's folder in Jupyter.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from concurrent.futures import Executor
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from IPython import get_ipython
from IPython.core.pylabtools import print_figure
from IPython.display import display
from matplotlib.artist import Artist
from matplotlib.figure import Figure

from safe import checks
from safe.companion import project
from safe.results import figures

IMAGES = {"image/svg+xml": "svg", "application/pdf": "pdf"}  # for pages, and for print


def prepare() -> None:
    """Give figures the style of the book, and let tables and figures carry what the book needs besides.

    A table has a copy of itself as CSV, and a figure says where its panels are (see `safe.results.figures.layout`). No
    name in a table is read as mathematics.
    """
    figures.use_style()
    pd.set_option("display.html.use_mathjax", False)
    pd.set_option("display.max_colwidth", None)
    shell = get_ipython()
    if shell is not None:
        bundle = shell.display_formatter.mimebundle_formatter
        bundle.for_type(pd.DataFrame, lambda table, **_: {"text/csv": table.to_csv(lineterminator="\n")})
        bundle.for_type(Figure, lambda figure, **_: _images(figure))
        for kind in IMAGES:
            shell.display_formatter.formatters[kind].pop(Figure)  # they would take precedence
        if "inline" in plt.get_backend():
            plt.uninstall_repl_displayhook()  # which draws each figure before it is shown, for windows on a screen


def _images(figure: Figure) -> tuple[dict[str, str], dict[str, dict]]:
    """A figure in both formats, drawn once for each, since matplotlib need not find out where everything is."""
    image = figures.image_box(figure)
    metadata = {"image/svg+xml": {"layout": figures.layout(figure, image)}}
    return {kind: print_figure(figure, name, image, base64=True) for kind, name in IMAGES.items()}, metadata


def show_table(table: pd.DataFrame, links: Sequence[Sequence[tuple[str, str]]], heading: str = "replay") -> None:
    """Show a table whose rows have links to the playground, which appear on the pages of the book and nowhere else.

    Parameters
    ----------
    table : DataFrame
        As it is shown in Jupyter, in print, and for download.
    links : sequence of sequences of (text, address), one for each row
        The links of each row (see `safe.playground.links`). They travel beside the CSV, as metadata of the output.
    heading : str
        The heading of the column of links. If the table has a column of that name, its texts become the links.

    Raises
    ------
    ValueError
        If there are not as many rows of links as the table has.
    """
    if len(links) != len(table):
        raise ValueError(f"links must be as many as the {len(table)} rows of the table; got {len(links)}")
    display(
        table, metadata={"text/csv": {"links": [[list(link) for link in row] for row in links], "heading": heading}}
    )


def show_figure(figure: Figure, links: Sequence[tuple[Artist, str, str]]) -> None:
    """Show a figure, parts of which lead to the playground on the pages of the book.

    Parameters
    ----------
    figure : Figure
    links : sequence of (artist, text, address)
        What is linked by the rectangle that it fills, what the link says, and an address in the playground.
    """
    image = figures.image_box(figure)
    areas = []
    for artist, text, address in links:
        box = figures.fractions(figure, image, artist.get_window_extent())
        areas.append([text, address, *(round(100 * part, 2) for part in box)])
    display(figure, metadata={"image/svg+xml": {"links": areas}})
    plt.close(figure)


def say(text: str) -> None:
    """Show sentences, in Markdown, that hold numbers from the results."""
    display({"text/markdown": text, "text/plain": text}, raw=True)


def export_numbers(table: pd.DataFrame) -> None:
    """Export the numbers of a table to the prose of the book, named `column_index`: successes_maze1_safe."""
    numbers = {
        "_".join([column, *map(str, index if isinstance(index, tuple) else [index])]): value
        for column, values in json.loads(table.reset_index(drop=True).to_json()).items()
        for index, value in zip(table.index, values.values(), strict=True)
    }
    display({"application/json": numbers, "text/plain": f"{len(numbers)} numbers"}, raw=True)


def resources(store: str, scheduler: str, cores: int) -> dict[str, object]:
    """What the runs of a notebook need, as the keyword arguments of `safe.run_all`.

    Parameters
    ----------
    store : str
        The path of the store; empty: `results.sqlite` of the project, or of the working directory if there is none.
    scheduler : str
        The address of a Dask scheduler; empty: this machine (see `executor_at`).
    cores : int
        How many cores of this machine; 0: all that this process may use.

    Raises
    ------
    ValueError
        If `cores` is no integer of at least 0, or no scheduler answers.
    """
    return {
        "store": (project.folder() or Path.cwd()) / project.STORE if store == "" else store,
        "cores": checks.integer("cores", cores, 0) or None,
        "executor": executor_at(scheduler),
    }


def executor_at(scheduler: str, patience: float = 10) -> Executor | None:
    """An executor on the workers of a Dask scheduler; None, which stands for the cores of this machine, for "".

    Parameters
    ----------
    scheduler : str
        Its address, such as "tcp://host:8786".
    patience : float
        Seconds to wait for it.

    Raises
    ------
    ValueError
        If no scheduler answers there, or Dask is not installed.
    """
    if scheduler == "":
        return None
    try:
        from distributed import Client  # not in every environment, and slow to import
        from distributed.comm import get_address_host_port

        # a client that fails at a malformed address stays half alive, and can block another when it is collected
        get_address_host_port(checks.text("scheduler", scheduler))
        return Client(scheduler, timeout=patience, set_as_default=False).get_executor()
    except (ImportError, OSError, TypeError, ValueError) as error:
        raise ValueError(
            "scheduler must be the address of a running Dask scheduler, or empty; "
            f"got {checks.shown(scheduler)} ({checks.reason(error)})"
        ) from None


def show_page(page: str, instead: str) -> None:
    """Show a page of HTML and, where HTML cannot be shown, as in print, a text instead."""
    display({"text/html": page, "text/plain": instead}, raw=True)


def read_points(text: str) -> np.ndarray:
    """Points written as `row,column`, separated by blanks.

    Returns
    -------
    array of int, shape (n, 2)

    Raises
    ------
    ValueError
        If there are fewer than two, or one is not two integers from minus a million to a million.

    Examples
    --------
    >>> read_points("0,0 2,1").tolist()
    [[0, 0], [2, 1]]
    """
    try:
        points = [(int(row), int(column)) for row, column in (point.split(",") for point in text.split())]
        points = points if np.abs(points).max() <= checks.MOST else []
    except (AttributeError, TypeError, ValueError):
        points = []
    if len(points) < 2:
        raise ValueError(f"points must be two or more of row,column, separated by blanks; got {checks.shown(text)}")
    return np.array(points)
