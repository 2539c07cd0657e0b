"""Runs of every kind, drawn at random: mazes, algorithms, seeds and parameters."""

import functools
import itertools
from dataclasses import replace

import numpy as np

import safe
from safe import Algorithm, Experiment, Maze, Parameters, load_maze
from safe.algorithms import COMPONENTS
from safe.judges import KINDS, RATINGS, SCALINGS
from safe.novelty import ADMISSIONS
from safe.operators import JUDGINGS
from safe.repertoire import POOLS

RUNS = 200


def drawn_maze(rng):
    """A maze with walls at random."""
    while True:
        height, width = rng.integers(2, 40, 2)
        cells = [tuple(map(int, rng.integers((height, width)))) for _ in range(2)]
        try:
            return Maze(rng.random((height, width)) < 0.3, *cells)
        except ValueError:  # the start or the goal is in a wall, or cannot be reached
            continue


def drawn_algorithm(rng):
    """An algorithm by its name, or one as a user might write it."""
    given = rng.uniform(-0.2, 1, (2 * int(rng.integers(2, 9)), 2)).tolist()
    return [
        *safe.ALGORITHMS,
        Algorithm("a quarter", [(0.25, 0.75)]),
        Algorithm("several", given[: rng.integers(1, len(given))]),
        Algorithm("drawn", None),
        Algorithm("given", given, "genotypic novelty"),
    ][rng.integers(9)]


def drawn_parameters(rng):
    return Parameters(
        population=2 * int(rng.integers(2, 25)),
        objectives=2 * int(rng.integers(2, 25)),
        generations=int(rng.integers(1, 40)),
        tournament=int(rng.integers(1, 8)),
        elites=int(rng.choice([0, 2, 2])),
        crossover=rng.choice([0.0, 0.8, 1.0]),
        mutation=rng.choice([0.0, 0.4, 1.0]),
        k=int(rng.choice([1, 4, 15, 200, 1_000_000])),
        archive=int(rng.choice([0, 1, 30, 200, 1000])),
        steps=int(rng.choice([1, 50, 300, 1001])),
        success_distance=int(rng.choice([0, 0, 2, 5])),
    )


def drawn_seed(rng):
    """A seed in one of its forms."""
    words = [int(word) for word in rng.integers(2**63, size=5)]
    return [
        words[0] % 1000,
        words[0],
        (words[0] << 200) + words[1],
        words,
        np.random.SeedSequence(words[0], spawn_key=words[3:4]).spawn(2)[1],
        Experiment("safe", "maze1", seed=words[0]).seed_sequence(17),
    ][rng.integers(6)]


@functools.cache
def runs_of_every_kind():
    """The arguments of 200 runs."""
    rng = np.random.default_rng(2019)
    papers = [load_maze("maze1"), load_maze("maze2")]
    runs = [
        (
            drawn_maze(rng) if rng.random() < 0.5 else papers[rng.integers(2)],
            drawn_algorithm(rng),
            drawn_seed(rng),
            drawn_parameters(rng),
        )
        for _ in range(RUNS - 5)
    ]
    large, far_apart = np.zeros((300, 260), dtype=bool), Parameters(40, 40, generations=8, steps=5000, archive=50)
    smallest = Parameters(2, 2, elites=0, generations=30)
    return [
        *runs,
        (Maze(large, (150, 130), (0, 0)), "novelty", 0, far_apart),
        (Maze(large, (150, 130), (0, 0)), "safe", 2**64, far_apart),
        (papers[0], "safe", 0, smallest),
        (papers[1], "novelty", [0, 0], smallest),
        (Maze.from_drawing("SG"), "fixed", [2**40], Parameters(generations=3)),
    ]


FACTORS = {
    "kind": KINDS,
    "rating": RATINGS,
    "judging": JUDGINGS,
    "pool": POOLS,
    "scaling": SCALINGS,
    "components": [
        COMPONENTS,
        ("novelty", "1 / distance"),
        ("path rarity",),
        ("1 / way", "novelty"),
        ("1 / distance", "novelty", "path rarity"),
        ("path rarity", "1 / way", "1 / distance", "novelty"),
    ],
    "admission": ADMISSIONS,
}
WHO_CHOOSES_WHOM = 4  # the first of the factors, of which all combinations occur


def combinations():
    """All combinations of choices that the package takes, each as a tuple with a value for each of FACTORS."""
    for *choices, components in itertools.product(*itertools.islice(FACTORS.values(), 6)):
        try:
            Algorithm("mine", None, **dict(zip(FACTORS, (*choices, components), strict=False)))
        except ValueError:
            continue
        for admission in ADMISSIONS:
            yield *choices, components, admission


@functools.cache
def covering_combinations():
    """Few combinations among which are all pairs of choices, and all combinations of who chooses whom."""

    def parts(combination):
        return {combination[:WHO_CHOOSES_WHOM], *itertools.combinations(enumerate(combination), 2)}

    combined = list(combinations())
    shuffled = [combined[i] for i in np.random.default_rng(2021).permutation(len(combined))]
    taken, covered = [], set()
    for least in (16, 8, 4, 1):  # first those that cover many parts
        for combination in shuffled:
            if len(parts(combination) - covered) >= least:
                taken.append(combination)
                covered |= parts(combination)
    return taken


def drawn_objectives(rng, kind, genes):
    """Objective functions as a user might write them."""
    if kind == "weights":
        return [(1.0,) * genes, *rng.uniform(-0.2, 1, (3, genes)).tolist()]
    return [(1.0,) * genes, (0.0,) * genes, *rng.random((4, genes)).tolist()]


@functools.cache
def runs_with_choices():
    """The arguments of runs with choices, most of them beyond the paper."""
    rng = np.random.default_rng(2020)
    papers = [load_maze("maze1"), load_maze("maze2")]
    nobody = [("weights", "none", "best score", "repertoire", "raw", COMPONENTS, admission) for admission in ADMISSIONS]
    runs = []
    for combination in [*covering_combinations(), *nobody[:3]]:
        *choices, admission = combination
        choices = dict(zip(FACTORS, choices, strict=False))
        parameters = drawn_parameters(rng)
        parameters = replace(
            parameters,
            generations=min(parameters.generations, 10),
            admission=admission,
            admitted=int(rng.integers(1, 30)),
            threshold=float(rng.choice([0.0, 0.5, 6.0, 20.0])),
            patience=int(rng.integers(1, 5)),
        )
        algorithm = Algorithm("mine", [] if combination in nobody else None, **choices)
        if algorithm.objectives is None and rng.random() < 0.4:
            algorithm = replace(algorithm, objectives=drawn_objectives(rng, algorithm.kind, algorithm.genes))
        maze = drawn_maze(rng) if rng.random() < 0.4 else papers[rng.integers(2)]
        runs.append((maze, algorithm, drawn_seed(rng), parameters))
    return runs
