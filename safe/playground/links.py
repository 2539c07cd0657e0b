"""Links to runs in the playground, for the rows of tables."""

from __future__ import annotations

from collections.abc import Iterable

from safe.experiments.experiment import Experiment
from safe.playground.address import run_address
from safe.results.labels import differences
from safe.results.tables import Results

Link = tuple[str, str]  # its text, and an address in the playground


def replays(results: Results) -> list[Link]:
    """A link to one run of each experiment: the first that succeeded or, if none did, the first of all.

    The text of a link is the number of the run and, before it, what tells the experiments apart: maze, algorithm,
    parameters, seed.

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
    links = []
    for (experiment, runs), which in zip(results.items(), differences(results), strict=True):
        number = int(runs.run[runs.success.idxmax()])
        links.append((f"{which}: run {number}" if which else f"run {number}", run_address(experiment, number)))
    return links


def replays_of_rows(rows: Iterable[Iterable[Experiment]], results: Results) -> list[list[Link]]:
    """For each row of a table the links (see `replays`) to its experiments, which are given row by row.

    Parameters
    ----------
    rows : iterable of iterables of Experiment
        The experiments of each row.
    results : mapping of Experiment to DataFrame
        The runs of each experiment, as `safe.run` gives them.
    """
    return [replays({experiment: results[experiment] for experiment in row}) for row in rows]
