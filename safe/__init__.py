"""SAFE, solution and fitness evolution: a robot in a deceptive maze, and the algorithms that evolve it.

A companion to M. Sipper, J. H. Moore and R. J. Urbanowicz, "Solution and Fitness Evolution (SAFE): Coevolving Solutions
and Their Objective Functions", EuroGP 2019, doi 10.1007/978-3-030-16670-0_10.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from safe.version import __version__

if TYPE_CHECKING:  # what `__getattr__` imports
    from safe.algorithms import ALGORITHMS, Algorithm, Parameters
    from safe.evolution import Generation, Run, evolve, generations
    from safe.experiments.exchange import merge, verify
    from safe.experiments.experiment import Experiment, run, run_all
    from safe.experiments.store import StoreError
    from safe.maze import Maze
    from safe.maze_files import load_maze, parse_maze
    from safe.novelty import NoveltyArchive
    from safe.playground.widget import Playground as Playground
    from safe.robot import endpoints, path

# without Playground, which needs anywidget: `from safe import *` works without it, too
__all__ = [
    "ALGORITHMS",
    "Algorithm",
    "Experiment",
    "Generation",
    "Maze",
    "NoveltyArchive",
    "Parameters",
    "Run",
    "StoreError",
    "__version__",
    "endpoints",
    "evolve",
    "generations",
    "load_maze",
    "merge",
    "parse_maze",
    "path",
    "run",
    "run_all",
    "verify",
]

_NAMES = {
    "safe.algorithms": ("ALGORITHMS", "Algorithm", "Parameters"),
    "safe.evolution": ("Generation", "Run", "evolve", "generations"),
    "safe.experiments.exchange": ("merge", "verify"),
    "safe.experiments.experiment": ("Experiment", "run", "run_all"),
    "safe.experiments.store": ("StoreError",),
    "safe.maze": ("Maze",),
    "safe.maze_files": ("load_maze", "parse_maze"),
    "safe.novelty": ("NoveltyArchive",),
    "safe.playground.widget": ("Playground",),
    "safe.robot": ("endpoints", "path"),
}
_MODULES = {name: module for module, names in _NAMES.items() for name in names}


def __getattr__(name: str) -> object:
    """Import a name on first use, since numba, scipy and pandas take most of the time of a short program."""
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    try:
        value = getattr(import_module(_MODULES[name]), name)
    except ImportError as error:  # tools that look at all attributes expect an AttributeError
        if name != "Playground":
            raise
        raise AttributeError(str(error), name=name, obj=None) from error  # without obj, no other name is suggested
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_MODULES})
