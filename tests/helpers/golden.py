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
from safe.judges import RATINGS
from safe.novelty import ADMISSIONS

FILE = Path(__file__).parents[1] / "data" / "golden_runs.json"
SEEDS = {"maze1": (1, 2), "maze2": (3,)}


def golden_runs():
    for algorithm in safe.ALGORITHMS:
        for maze, seeds in SEEDS.items():
            for seed in seeds:
                yield {"algorithm": algorithm, "maze": maze, "seed": seed}


def golden_choices():
    """Runs with choices beyond the paper; ratings with drawn judges, since best scores hardly depend on the rating."""
    drawn = {"judging": "drawn judge"}
    algorithms = [{"scaling": "maximum"}, {"scaling": "rank"}, drawn, *({"rating": r} | drawn for r in RATINGS[2:4])]
    for algorithm, parameters in (
        *(
            ("novelty", parameters)
            for parameters in (*({"admission": admission} for admission in ADMISSIONS[1:]), {"archive": 0})
        ),
        *(({"name": "mine", "rating": "genotypic novelty"} | choice, {}) for choice in algorithms),
        (
            {"name": "all", "rating": "spearman", "scaling": "rank", "judging": "drawn judge"},
            {"admission": "random", "admitted": 20, "archive": 100},
        ),
        *(({"name": "mine"} | choice, {}) for choice in GOALS_AND_PATHS),
    ):
        yield {"algorithm": algorithm, "maze": "maze2", "seed": 8, "parameters": {"generations": 100} | parameters}


THREE = {"components": ["1 / distance", "novelty", "path rarity"], "scaling": "rank", "judging": "drawn judge"}
GOALS = {"kind": "goal", "judging": "favourite"}
KNOWN = {"pool": "repertoire"}
GOALS_AND_PATHS = (
    {"objectives": [[1]], "components": ["path rarity"]},
    {"objectives": [[1]], "components": ["1 / way"]},
    THREE,
    *(THREE | {"rating": rating} for rating in ("discovery", "shuffled", "redrawn")),
    *(GOALS | {"rating": rating} for rating in ("none", "genotypic novelty", "mutualism", "competition", "patience")),
    {"kind": "goal"},
    {"objectives": []} | KNOWN,
    GOALS | KNOWN,
    GOALS | KNOWN | {"rating": "patience", "judging": "drawn judge"},
    THREE | KNOWN | {"kind": "mixed", "rating": "redrawn", "judging": "favourite"},
)


def algorithm_of(algorithm):
    """An algorithm's name, or an algorithm from its fields."""
    return safe.Algorithm(**algorithm) if isinstance(algorithm, dict) else algorithm


def outcome(algorithm, maze, seed, parameters=None):
    """A run as it returns from JSON."""
    run = safe.evolve(maze, algorithm_of(algorithm), seed, safe.Parameters(**(parameters or {})))
    return json.loads(json.dumps(asdict(run)))


if __name__ == "__main__":
    versions = {"python": platform.python_version(), "numpy": np.__version__, "numba": numba.__version__}
    runs, choices = (
        [{**which, "outcome": outcome(**which)} for which in some()] for some in (golden_runs, golden_choices)
    )
    golden = {"rules": RULES, "made with": versions, "runs": runs, "choices": choices}
    FILE.write_text(json.dumps(golden, indent=1) + "\n")
