"""Whole runs, recorded so that the tests notice a change that alters any of them.

    python -m tests.helpers.golden        records tests/data/golden_runs.json

Record them again only with a higher `safe.evolution.RULES`, so that earlier results are not mixed with new ones.
"""

import json
import platform
from dataclasses import asdict
from pathlib import Path

import numba
import numpy as np

import safe
from safe.evolution import RULES

FILE = Path(__file__).parents[1] / "data" / "golden_runs.json"
SEEDS = {"maze1": (1, 2), "maze2": (3,)}


def golden_runs():
    for algorithm in safe.ALGORITHMS:
        for maze, seeds in SEEDS.items():
            for seed in seeds:
                yield {"algorithm": algorithm, "maze": maze, "seed": seed}


def outcome(algorithm, maze, seed):
    """A run as it returns from JSON."""
    return json.loads(json.dumps(asdict(safe.evolve(maze, algorithm, seed))))


if __name__ == "__main__":
    versions = {"python": platform.python_version(), "numpy": np.__version__, "numba": numba.__version__}
    runs = [{**which, "outcome": outcome(**which)} for which in golden_runs()]
    FILE.write_text(json.dumps({"rules": RULES, "made with": versions, "runs": runs}, indent=1) + "\n")
