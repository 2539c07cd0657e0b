"""The contest: search algorithms on mazes for which none of them was made; and three kinds of coevolution.

All contestants were compared on mazes of the design set, with one seed, to find out what to ask. Then the contrasts and
the rule of their decision were written down, and their contestants ran on the test set, once, with another seed (see
`safe.companion.held_out` for the mazes). Each contestant has the paper's operators, or mutation alone. What was tried
is recorded, too: all contestants, with the first seed, on the whole design set and on known mazes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, product

from safe import checks
from safe.algorithms import ALGORITHMS, Algorithm, Parameters
from safe.companion import held_out
from safe.companion.designs import ARCHIVES, DECIDING, EXPLORING, VARIATION, Design, Level, Recorded
from safe.companion.paper import MAZES
from safe.experiments.experiment import Experiment
from safe.maze import Maze
from safe.maze_files import load_mazes
from safe.results.labels import maze_labels

TRIED = 3  # recorded runs of each contestant on each maze of the design set
TRIED_ON_KNOWN = 10  # the same on each known maze
RUNS = 500  # that are recorded of the three kinds; of a contestant, the SHARE of it on each maze
SHARE = 0.1
TRACED = 20  # recorded runs of a kind inside which is looked
LOOKED = 1  # the same of a contestant on each maze
KNOWN = (*MAZES, "medium", "hard")  # mazes that the designer knows: the paper's, and Lehman and Stanley's

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
    yield Contestant("random search", family, {"objectives": []}, {})
    yield Contestant("the standard EA", family, {"objectives": [(1, 0)]}, {})
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
        yield Contestant(f"weighing, {name}", family, fields, RANDOM_ARCHIVE)
    for rated, rating in RATED.items():
        if rating != "patience":
            fields = DRAWN | {"rating": rating}
            yield Contestant(f"weighing, drawn judges, {rated}", family, fields, RANDOM_ARCHIVE)
    rules = RANDOM_ARCHIVE | {"tournament": 20}
    yield Contestant("weighing, drawn judges, frozen, tournaments of 20", family, DRAWN, rules)


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
        yield Contestant(f"weighing and goals {where}, {rated}", "both", fields, RANDOM_ARCHIVE)
    name, best = CHALLENGERS[0], ALGORITHMS["weighing-and-goals"].content
    yield Contestant(f"{name}, the paper's archive", "both", best, {})


# Questions


@dataclass(frozen=True)
class Contrast:
    """Does the first contestant succeed more often than the second, on mazes that none was made for?"""

    question: str  # a key of QUESTIONS
    first: str
    second: str
    operators: str


QUESTIONS = {
    "better than novelty": "Does anything beat the best novelty search with the same operators?",
    "many judges": "Do many judges beat one fixed sum of the same components?",
    "coevolution": "Does evolving judges beat frozen, freshly drawn and shuffled ones?",
}
LEVELS = {"better than novelty": 0.01, "many judges": 0.05, "coevolution": 0.05}  # of p, after Holm's correction
# of novelty searches, the best on the design set
BEST_NOVELTY = {
    "crossover and mutation": "novelty search, archive random, tournaments of 5",
    "mutation alone": "novelty search, archive random, tournaments of 20",
}
CHALLENGERS = (
    "weighing and goals from the repertoire, redrawn",
    "weighing, drawn judges, frozen",
)
FROM_REPERTOIRE = "goals from the repertoire, {}"
BY_DRAWN_JUDGES = "weighing, drawn judges, {}"


def contrasts() -> list[Contrast]:
    """The primary contrasts, to which Holm's correction applies all together.

    A contrast is confirmed if the first contestant's mean rate over the test mazes is the higher one and Wilcoxon's
    signed-rank test of the paired rates has a p below the level of its question (LEVELS). Mazes on which all runs of
    all contestants of the contrasts succeed, or none, are left out, whatever the contrast.
    """
    found = []
    for operators, best in BEST_NOVELTY.items():
        found += [Contrast("better than novelty", one, best, operators) for one in CHALLENGERS]
        for many in ("weighing, drawn judges, frozen", "weighing, the best score"):
            found.append(Contrast("many judges", many, "weighing, one fixed sum", operators))
    for name, evolved, others in (
        (BY_DRAWN_JUDGES, "bred by genotypic novelty", ("frozen", "redrawn")),
        (BY_DRAWN_JUDGES, "bred by discovery", ("frozen", "redrawn", "bred by discovery, shuffled")),
        (FROM_REPERTOIRE, "bred by genotypic novelty", ("frozen", "redrawn")),
        (FROM_REPERTOIRE, "by patience", ("frozen", "redrawn")),
    ):
        for other in others:
            found.append(Contrast("coevolution", name.format(evolved), name.format(other), "mutation alone"))
    return found


# inside whose runs is looked
LOOKED_INTO = [
    (name, "mutation alone")
    for name in (
        BEST_NOVELTY["mutation alone"],
        *CHALLENGERS,
        "weighing, one fixed sum",
        FROM_REPERTOIRE.format("frozen"),
        FROM_REPERTOIRE.format("by patience"),
    )
]


# Designs


def decided(mazes: Sequence[Maze], runs: int, seed: int) -> Design:
    """The contestants of the contrasts, each with a tenth of `runs` on each maze, but at least one."""
    runs = checks.integer("runs", runs, 1, checks.MOST)
    ends = dict.fromkeys((name, one.operators) for one in contrasts() for name in (one.first, one.second))
    return contest(mazes, list(ends), max(1, round(runs * SHARE)), seed)


def tried(mazes: Sequence[Maze], runs: int) -> Design:
    """All contestants, with the seed of what was tried."""
    ends = product([one.name for one in contestants()], VARIATION)
    return contest(mazes, list(ends), runs, EXPLORING)


def contest(mazes: Sequence[Maze], ends: Sequence[tuple[str, str]], runs: int, seed: int) -> Design:
    """Contestants with operators, by their names, with so many runs on each maze."""
    known = {one.name: one for one in contestants()}

    def cells() -> Iterator[tuple[tuple[Level, ...], Experiment]]:
        for maze, (name, operators) in product(mazes, ends):
            parameters = Parameters(**known[name].rules | VARIATION[operators])
            yield (labels[maze], name, operators), Experiment(_algorithm(known[name]), maze, runs, seed, parameters)

    labels = dict(zip(mazes, maze_labels(mazes), strict=True))
    found = dict(cells())
    traced = [e for (_, name, operators), e in found.items() if (name, operators) in LOOKED_INTO]
    return Design(("maze", "contestant", "operators"), found, traced)


def _algorithm(contestant: Contestant) -> Algorithm:
    return Algorithm(contestant.name, **contestant.fields)


# Three kinds of coevolution

KINDS = {
    "mutualism": GOALS | {"rating": "mutualism"},
    "competition": GOALS | {"rating": "competition"},
    "commensalism": GOALS | {"rating": "genotypic novelty"},
    "unchanging": GOALS,
    "redrawn": GOALS | {"rating": "redrawn"},
    "mutualism, best score": {"kind": "goal", "rating": "mutualism"},
}


def kinds(mazes: Sequence[Maze], runs: int, seed: int) -> Design:
    """Places that judge, with the paper's parameters, and everything else equal: what are they bred for?"""
    labels = dict(zip(mazes, maze_labels(mazes), strict=True))
    cells = {
        (labels[maze], kind): Experiment(Algorithm(kind, **fields), maze, runs, seed)
        for maze, (kind, fields) in product(mazes, KINDS.items())
    }
    return Design(("maze", "kind"), cells, list(cells.values()))


# Everything


def everything_tried() -> list[Recorded]:
    """All that is recorded of what was tried, in the order of the record."""
    designs = tried(held_out.design_set(), TRIED), tried(load_mazes(list(KNOWN)), TRIED_ON_KNOWN)
    return [Recorded(experiment) for design in designs for experiment in design.cells.values()]


def everything() -> list[Recorded]:
    """All that is recorded of the three kinds and of the test set, in the order of the record."""
    of_class, of_test = kinds(load_mazes(list(MAZES)), RUNS, DECIDING), decided(held_out.test_set(), RUNS, DECIDING)
    looked = set(of_test.traced)
    return [
        *(Recorded(experiment, TRACED) for experiment in of_class.cells.values()),
        *(Recorded(experiment, LOOKED * (experiment in looked)) for experiment in of_test.cells.values()),
    ]
