"""SAFE, solution and fitness evolution: a robot in a deceptive maze, and the algorithms that evolve it.

A companion to M. Sipper, J. H. Moore and R. J. Urbanowicz, "Solution and Fitness Evolution (SAFE): Coevolving Solutions
and Their Objective Functions", EuroGP 2019, doi 10.1007/978-3-030-16670-0_10.
"""

from safe.algorithms import ALGORITHMS, Algorithm, Parameters
from safe.evolution import Generation, Run, evolve, generations
from safe.experiments.exchange import merge, verify
from safe.experiments.experiment import Experiment, run, run_all
from safe.experiments.store import StoreError
from safe.maze import Maze
from safe.maze_files import load_maze, parse_maze
from safe.novelty import NoveltyArchive
from safe.robot import endpoints, path
from safe.version import __version__

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


def __getattr__(name: str) -> object:
    if name == "Playground":  # imported on first use, since only it needs anywidget
        try:
            from safe.playground.widget import Playground
        except ImportError as error:  # tools that look at all attributes expect an AttributeError
            raise AttributeError(str(error), name=name, obj=None) from error  # without obj, no other name is suggested
        return Playground
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), "Playground"])
