"""What the notebooks of the book ask of Jupyter: the looks of figures, tables to take along, numbers for the prose."""

from __future__ import annotations

import json
from concurrent.futures import Executor

import numpy as np
import pandas as pd
from IPython import get_ipython
from IPython.display import display

from safe import checks, figures


def prepare() -> None:
    """Give figures the style of the book, and let every table carry itself along as CSV, for the book to offer.

    Names in tables are not read as mathematics.
    """
    figures.use_style()
    pd.set_option("display.html.use_mathjax", False)
    shell = get_ipython()
    if shell is not None:
        formatter = shell.display_formatter.mimebundle_formatter
        formatter.for_type(pd.DataFrame, lambda table, **_: {"text/csv": table.to_csv()})


def hand_on(table: pd.DataFrame) -> None:
    """Hand the numbers of a table on to the prose of the book, as `column_index`: successes_maze1_safe."""
    numbers = {
        "_".join([column, *map(str, index if isinstance(index, tuple) else [index])]): value
        for column, values in json.loads(table.reset_index(drop=True).to_json()).items()
        for index, value in zip(table.index, values.values(), strict=True)
    }
    display({"application/json": numbers, "text/plain": f"{len(numbers)} numbers"}, raw=True)


def executor_at(scheduler: str, patience: float = 10) -> Executor | None:
    """What computes runs: the workers of a Dask scheduler; None, which stands for the cores of this machine, for "".

    Parameters
    ----------
    scheduler : str
        Its address, such as "tcp://host:8786".
    patience : float
        Seconds to wait for it.

    Raises
    ------
    ValueError
        Where no scheduler answers there, or Dask is not installed.
    """
    if scheduler == "":
        return None
    try:
        from distributed import Client  # not in every environment, and slow to import

        return Client(checks.text("scheduler", scheduler), timeout=patience).get_executor()
    except (ImportError, OSError, ValueError) as error:
        raise ValueError(
            "scheduler must be the address of a running Dask scheduler, or empty; "
            f"was {checks.shown(scheduler)} ({checks.reason(error)})"
        ) from None


def show_page(page: str, instead: str) -> None:
    """Show HTML, and a text where there is none, as in print."""
    display({"text/html": page, "text/plain": instead}, raw=True)


def read_points(text: str) -> np.ndarray:
    """Points written as `row,column`, separated by blanks.

    Returns
    -------
    array of int, shape (n, 2)

    Raises
    ------
    ValueError
        Where there are fewer than two, or one is not two integers of at most a million, either side of 0.

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
        raise ValueError(f"points must be two or more of row,column, separated by blanks; was {checks.shown(text)}")
    return np.array(points)
