"""What the notebooks of the book ask of Jupyter: the looks of figures, tables to take along, numbers for the prose."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor

import numpy as np
import pandas as pd
from IPython import get_ipython
from IPython.display import display

from safe import checks
from safe.experiments.experiment import Experiment
from safe.playground.address import run_address
from safe.results import figures

Link = tuple[str, str]  # its text, and an address in the playground


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


def show_table(table: pd.DataFrame, links: Sequence[Sequence[Link]], heading: str = "replay") -> None:
    """Show a table whose rows have links to the playground, which stand in the book and nowhere else.

    Parameters
    ----------
    table : DataFrame
        As it is shown in Jupyter, in print, and for download.
    links : sequence of sequences of (text, address), one for each row
        The links of each row. They travel beside the CSV, as metadata of the output.
    heading : str
        Over the column that the links are in. Where the table has such a column, its texts become the links.

    Raises
    ------
    ValueError
        Where there are not as many rows of links as the table has.
    """
    if len(links) != len(table):
        raise ValueError(f"links must be as many as the {len(table)} rows of the table; got {len(links)}")
    display(
        table, metadata={"text/csv": {"links": [[list(link) for link in row] for row in links], "heading": heading}}
    )


def replays(results: Mapping[Experiment, pd.DataFrame]) -> list[Link]:
    """A link to one run of each experiment: the first that succeeded, or the first of all where none did.

    The text of a link is the number of the run, and whatever experiments differ in: maze, algorithm, seed.

    Parameters
    ----------
    results : mapping of Experiment to DataFrame
        The runs of each experiment, as `safe.run` gives them.

    Examples
    --------
    >>> from safe import run_all
    >>> results = run_all(["novelty", "random"], ["maze1"], runs=2, seed=0)
    >>> [text for text, address in replays(results)]
    ['novelty: run 1', 'random: run 0']
    """
    labels = [(e.maze.name, e.algorithm.name, f"seed {e.seed}") for e in results]
    differing = [len(set(of_all)) > 1 for of_all in zip(*labels, strict=True)]
    links = []
    for (experiment, runs), label in zip(results.items(), labels, strict=True):
        number = int(runs.run[runs.success.idxmax()])
        which = ", ".join(part for part, differs in zip(label, differing, strict=True) if differs)
        links.append((f"{which}: run {number}" if which else f"run {number}", run_address(experiment, number)))
    return links


def replays_of_rows(table: pd.DataFrame, results: Mapping[Experiment, pd.DataFrame]) -> list[list[Link]]:
    """For each row of a table the links (see `replays`) to the experiments that it tells of.

    A row tells of a maze, which it names in its index, as `maze`, and of the algorithms that it names there, as
    `algorithm`, or as `first` and `second`; where it names none, of all of them.
    """
    found = []
    for _, row in table.index.to_frame().iterrows():
        named = row.reindex(["algorithm", "first", "second"]).dropna().tolist()
        of_maze = {e: runs for e, runs in results.items() if e.maze.name == row.maze}
        algorithms = named or dict.fromkeys(e.algorithm.name for e in of_maze)
        found.append(replays({e: of_maze[e] for name in algorithms for e in of_maze if e.algorithm.name == name}))
    return found


def export_numbers(table: pd.DataFrame) -> None:
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
        from distributed.comm import get_address_host_port

        # a client that fails at what is no address stays half alive, and can block another when it is collected
        get_address_host_port(checks.text("scheduler", scheduler))
        return Client(scheduler, timeout=patience, set_as_default=False).get_executor()
    except (ImportError, OSError, TypeError, ValueError) as error:
        raise ValueError(
            "scheduler must be the address of a running Dask scheduler, or empty; "
            f"got {checks.shown(scheduler)} ({checks.reason(error)})"
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
        raise ValueError(f"points must be two or more of row,column, separated by blanks; got {checks.shown(text)}")
    return np.array(points)
