"""The contest: search algorithms on mazes for which none of them was made; and three kinds of coevolution.

All contestants are compared on the design set, with one seed, to find out what to ask. Then the questions and the rule
of their decision were written down (`safe.companion.contest_questions`), and the test set was run once, with another
seed (see `safe.companion.held_out` for the mazes). Each contestant has the paper's operators, and mutation alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, product

from safe.algorithms import Algorithm, Parameters
from safe.companion import held_out
from safe.companion.designs import ARCHIVES, DECIDING, EXPLORING, VARIATION, Design, Level
from safe.companion.paper import MAZES
from safe.experiments.experiment import Experiment
from safe.maze import Maze
from safe.maze_files import load_mazes
from safe.results.labels import maze_labels

EXPLORED = 5  # runs of each contestant on each maze of the design set
RUNS = 50  # on each maze of the test set, of those on which the questions bear
OTHERS = 5  # of all others
CLASS = 500  # runs of each of the three kinds
TRACED = 1  # run on each maze of the design set, of some contestants, inside which is looked

# Contestants

NOVELTY, SAFE = {"objectives": [(0, 1)]}, {"objectives": None, "rating": "genotypic novelty"}
RANDOM_ARCHIVE = ARCHIVES["random"]
THREE = {"components": ("1 / distance", "novelty", "path rarity"), "scaling": "rank"}
DRAWN = THREE | {"judging": "drawn judge"}
GOALS = {"kind": "goal", "judging": "favourite"}
BOTH = THREE | {"kind": "mixed", "judging": "favourite"}
RATED = {
    "frozen": "none",
    "redrawn": "redrawn",
    "bred by genotypic novelty": "genotypic novelty",
    "bred by discovery": "discovery",
    "bred by discovery, shuffled": "shuffled",
    "by patience": "patience",
}
POOLS = {"among the generation": "generation", "from the repertoire": "repertoire"}


@dataclass(frozen=True)
class Contestant:
    """A search algorithm of the contest."""

    name: str
    family: str
    fields: Mapping[str, object]  # of its Algorithm
    rules: Mapping[str, object]  # of its Parameters


def contestants() -> list[Contestant]:
    """All contestants, family by family."""
    return [*_searches(), *_baselines(), *_weighing(), *_goals(), *_both()]


def _searches() -> Iterator[Contestant]:
    family = "novelty search and SAFE"
    for archive, size in product(("the paper's", "none", "random", "threshold"), (5, 20)):
        rules = ARCHIVES[archive] | {"tournament": size}
        yield Contestant(f"novelty search, archive {archive}, tournaments of {size}", family, NOVELTY, rules)
    for archive in ("the paper's", "random"):
        yield Contestant(f"SAFE, archive {archive}", family, SAFE, ARCHIVES[archive])


def _baselines() -> Iterator[Contestant]:
    family = "baselines"
    yield Contestant("MAP-Elites", family, {"objectives": [], "pool": "repertoire"}, {})
    for size in (5, 20):
        fields = {"objectives": [(1,)], "components": ("1 / way",)}
        yield Contestant(f"the true way, tournaments of {size}", family, fields, {"tournament": size})


def _weighing() -> Iterator[Contestant]:
    family = "weighing"
    rarity = {"objectives": [(1,)], "components": ("path rarity",)}
    for size in (5, 20):
        yield Contestant(f"path rarity alone, tournaments of {size}", family, rarity, {"tournament": size})
    for pair in combinations(THREE["components"], 2):
        fields = DRAWN | {"components": pair}
        yield Contestant(f"{' and '.join(pair)}, drawn judges", family, fields, RANDOM_ARCHIVE)
    for name, fields in {
        "one fixed sum": THREE | {"objectives": [(1, 1, 1)]},
        "the best score": THREE,
        "favourites": THREE | {"judging": "favourite"},
    }.items():
        yield Contestant(f"three components, {name}", family, fields, RANDOM_ARCHIVE)
    for rated, rating in RATED.items():
        if rating != "patience":
            fields = DRAWN | {"rating": rating}
            yield Contestant(f"three components, drawn judges, {rated}", family, fields, RANDOM_ARCHIVE)
    rules = RANDOM_ARCHIVE | {"tournament": 20}
    yield Contestant("three components, drawn judges, frozen, tournaments of 20", family, DRAWN, rules)


def _goals() -> Iterator[Contestant]:
    for (where, pool), (rated, rating) in product(POOLS.items(), RATED.items()):
        if rating not in ("discovery", "shuffled"):
            fields = GOALS | {"rating": rating, "pool": pool}
            yield Contestant(f"goals {where}, {rated}", "goals", fields, {})
    for where, pool in POOLS.items():
        fields = GOALS | {"rating": "patience", "pool": pool}
        yield Contestant(f"goals {where}, by patience, 20 of them", "goals", fields, {"objectives": 20})


def _both() -> Iterator[Contestant]:
    for (where, pool), rated in product(POOLS.items(), ("frozen", "redrawn")):
        fields = BOTH | {"rating": RATED[rated], "pool": pool}
        yield Contestant(f"three components and goals {where}, {rated}", "both", fields, RANDOM_ARCHIVE)


# Designs


def contest(mazes: Sequence[Maze], runs: Mapping[str, int], seed: int) -> Design:
    """The contestants in `runs`, each with so many runs on each maze, with the paper's operators and mutation alone."""

    def cells() -> Iterator[tuple[tuple[Level, ...], Experiment]]:
        for maze, label in zip(mazes, maze_labels(mazes), strict=True):
            for one, (operators, rates) in product(contestants(), VARIATION.items()):
                if one.name in runs:
                    algorithm, parameters = Algorithm(one.name, **one.fields), Parameters(**one.rules | rates)
                    experiment = Experiment(algorithm, maze, runs[one.name], seed, parameters)
                    yield (label, one.name, operators), experiment

    return Design(("maze", "contestant", "operators"), dict(cells()))


def explored() -> Design:
    """All contestants on the design set."""
    return contest(held_out.design_set(), {one.name: EXPLORED for one in contestants()}, EXPLORING)


def decided() -> Design:
    """All contestants on the test set, those of the questions with more runs."""
    return contest(held_out.test_set(), runs, DECIDING)


def known() -> Design:
    """All contestants on mazes that their designer knew."""
    return contest(load_mazes([*MAZES, "medium"]), {one.name: RUNS for one in contestants()}, DECIDING)
