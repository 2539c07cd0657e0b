"""The files of the project that its notebooks use, from wherever a notebook is opened."""

from __future__ import annotations

from pathlib import Path

STORE = "results.sqlite"  # all finished runs
MEASUREMENTS = "benchmarks/results.json"
PARTS = ("notebooks", "safe/companion")  # folders by which the project is known


def folder() -> Path | None:
    """The folder of this project: the nearest one from the working directory upwards, or else the package's.

    None if there is neither, which is so where the package alone was installed.
    """
    here, package = Path.cwd(), Path(__file__).parents[2]
    folders = (here, *here.parents, package)
    return next((folder for folder in folders if all((folder / part).is_dir() for part in PARTS)), None)
