"""The same work done by others: the robot, the novelty of a generation, and whole runs.

The peers are libraries and techniques that could be used instead; plain Python is the tests' oracle, written to be
obvious rather than fast. If a peer does less or more than the same work, its docstring says so. In each group the
seconds of a round divided by `points` * `generations` are those of one point.
"""

import copy
from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
import pytest
from scipy.spatial import cKDTree
from scipy.spatial.distance import cdist

import safe
from benchmarks import straightforward, with_deap
from benchmarks.workloads import SEED, record, workload
from safe import NoveltyArchive, Parameters
from tests.helpers import oracle

K, CAPACITY = Parameters().k, Parameters().archive


# The robot


def robots(maze, generations):
    return [safe.endpoints(maze, controllers) for controllers in generations]


def robots_in_python(maze, generations):
    drawing = maze.drawing().split("\n")
    return [[oracle.path(drawing, controller, 300)[-1] for controller in controllers] for controllers in generations]


@pytest.mark.parametrize(
    ("method", "walk", "every", "points"),
    [
        ("safe", None, 1, 200),
        ("safe, endpoints", robots, 4, 200),
        ("plain Python", robots_in_python, 100, 20),  # few, since one robot takes as long as 30,000 others
    ],
    ids=["safe", "safe, endpoints", "plain Python"],
)
def test_robot(measure, sized, method, walk, every, points):
    """All generations from the 100th to the 500th of novelty search, or some, spread over them."""
    first, last = sized(100, check=1), sized(500, check=3)
    parameters = Parameters(generations=last)
    maze = safe.load_maze("maze1")
    if walk is None:
        walk, arguments, generations = workload("robot", maze, "novelty", parameters, first)
    else:
        controllers = [
            genomes[: sized(points, check=2)] for genomes in record(maze, "novelty", parameters).genomes[first::every]
        ]
        arguments, generations = lambda: (maze, controllers), len(controllers)
    about = {"method": method, "points": points, "generations": generations}
    ends = measure("peers: robot", walk, arguments, once=method == "plain Python", **about)
    if ends is not None:
        np.testing.assert_array_equal(ends, robots(maze, controllers))


# Novelty


class Kind(NamedTuple):
    """End points or objective functions: their source, and the distance between two of them."""

    algorithm: str
    part: str  # of the workloads
    metric: str
    in_scipy: str
    power: int  # of the Minkowski distance
    in_oracle: Callable
    scored: Callable  # points and novelty of a generation, and the archive after it


KINDS = {
    "novelty": Kind(
        "novelty", "novelty", "taxicab", "cityblock", 1, oracle.taxicab, lambda g: (g.endpoints, g.novelty, g.archive)
    ),
    "objective functions": Kind(
        "safe",
        "objective functions",
        "euclidean",
        "euclidean",
        2,
        oracle.euclidean,
        lambda g: (g.objectives, g.objective_fitness, g.objective_archive),
    ),
}


class Scored(NamedTuple):
    """A generation, its novelty, and the archive that it met, the oldest first."""

    points: np.ndarray
    novelty: np.ndarray
    archive: np.ndarray
    archive_scores: np.ndarray


@cache
def history(name, parameters):
    """All generations of a run."""
    run = [KINDS[name].scored(g) for g in safe.generations("maze1", KINDS[name].algorithm, SEED, parameters)]
    archives = [(np.empty((0, 2)), np.empty(0)), *(archive for *_, archive in run)]
    return [Scored(points, novelty, *archive) for (points, novelty, _), archive in zip(run, archives, strict=False)]


def in_order(make_archive):
    """By the rule: an archive that scores point after point and lets it in or not."""

    def prepare(kind, before, timed):
        archive = make_archive(kind)
        for generation in before:
            archive.score(generation.points)
        return lambda archive: [archive.score(g.points) for g in timed], lambda: (copy.deepcopy(archive),)

    return prepare


def at_once(score):
    """All points of a generation against the archive before it: the peer need not follow the rule of admission."""
    return lambda kind, before, timed: (lambda: [score(kind, g) for g in timed], tuple)


def by_tree(kind, generation):
    tree = cKDTree(np.concatenate([generation.points, generation.archive]))
    distances, _ = tree.query(generation.points, K + 1, p=kind.power)  # a point's nearest is itself, or its double
    return distances.sum(axis=1) / K


def by_brute_force(kind, generation):
    distances = cdist(generation.points, np.concatenate([generation.points, generation.archive]), kind.in_scipy)
    return np.partition(distances, K)[:, : K + 1].sum(axis=1) / K


def in_python(kind, generation):
    """By the rule, too."""
    archive = oracle.Archive(CAPACITY)
    scores, points = generation.archive_scores.tolist(), generation.archive.tolist()
    archive.members = list(zip(scores, range(len(scores)), points, strict=True))
    archive.entered = len(scores)
    return oracle.novelty(generation.points.tolist(), archive, K, kind.in_oracle)


def add(archive, points):
    """A generation in pyribs: its novelty, then all points are added, and the tree is rebuilt."""
    archive.add(np.zeros((len(points), 1)), None, points)


def by_pyribs(compute):
    """Novelty with respect to a filled archive alone, without the population, whose tree is already built.

    The distance is always Euclidean, which for end points is not the rule.
    """

    def prepare(kind, before, timed):
        from ribs.archives import ProximityArchive  # not above: its memory would count as the paper's

        archives = []
        for generation in timed:
            n = len(generation.archive)
            archives.append(ProximityArchive(solution_dim=1, measure_dim=2, k_neighbors=K, novelty_threshold=0))
            archives[-1].add(np.zeros((n, 1)), None, generation.archive)
            assert len(archives[-1]) == n

        def work(archives):
            return [compute(archive, generation.points) for archive, generation in zip(archives, timed, strict=True)]

        return work, lambda: (copy.deepcopy(archives),)

    return prepare


class Method(NamedTuple):
    prepare: (
        Callable  # (kind, generations before, generations timed) -> function, and a function that makes its arguments
    )
    generations: int
    is_exact: bool = False  # does it give the novelty of the rule?


METHODS = {
    "safe, NoveltyArchive": Method(in_order(lambda kind: NoveltyArchive(CAPACITY, K, kind.metric)), 100, True),
    "numpy brute force, in order": Method(
        in_order(lambda kind: with_deap.Archive(CAPACITY, K, kind.in_scipy)), 50, True
    ),
    "numpy brute force": Method(at_once(by_brute_force), 50),
    "scipy cKDTree": Method(at_once(by_tree), 50),
    "pyribs ProximityArchive, batch": Method(by_pyribs(lambda archive, points: archive.compute_novelty(points)), 50),
    "pyribs ProximityArchive, batch added": Method(by_pyribs(add), 50),
    "pyribs ProximityArchive, one at a time": Method(
        by_pyribs(lambda archive, points: [archive.compute_novelty(point[np.newaxis]) for point in points]), 10
    ),
    "plain Python": Method(at_once(in_python), 2, True),
}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("method", ["safe", *METHODS])
def test_novelty(measure, sized, method, kind):
    first = sized(200, check=6)  # by then the archive is full
    parameters = Parameters(generations=first + sized(100, check=2), success_distance=0)
    if method == "safe":
        function, arguments, generations = workload(KINDS[kind].part, "maze1", KINDS[kind].algorithm, parameters, first)
        is_exact = False  # it gives no scores: that they are right has been looked at
    else:
        prepare, generations, is_exact = METHODS[method]
        run = history(kind, parameters)
        timed = run[first : first + generations]
        function, arguments = prepare(KINDS[kind], run[:first], timed)
        generations = len(timed)
    about = {"method": method, "points": parameters.population, "generations": generations}
    scores = measure(f"peers: {kind}", function, arguments, once=method == "plain Python", **about)
    if is_exact:
        np.testing.assert_allclose(scores, [g.novelty for g in timed], rtol=1e-12)


# Whole runs


def run_in_python(maze, algorithm, seed, parameters):
    """The same run."""
    algorithm = safe.ALGORITHMS[algorithm]
    rng = np.random.Generator(np.random.SFC64(seed))
    drawing = maze.drawing().split("\n")
    *_, last = oracle.evolve(drawing, algorithm, parameters, rng)
    distance, genome, _ = last.best
    return distance, tuple(genome)


def run_by(evolve):
    def run(*arguments):
        found = evolve(*arguments)
        return found.distance, found.controller

    return run


RUNS = {  # plain Python takes seconds for a generation: few, while its archive is small, which is in its favour
    "safe": (run_by(safe.evolve), 50),
    "DEAP": (with_deap.evolve, 50),
    "straightforward": (run_by(straightforward.evolve), 50),
    "plain Python": (run_in_python, 2),
}


@pytest.mark.parametrize("algorithm", ["novelty", "safe"])
@pytest.mark.parametrize("method", RUNS)
def test_run(measure, sized, method, algorithm):
    run, generations = RUNS[method]
    population = sized(200, check=10)
    parameters = Parameters(
        population=population, objectives=population, generations=sized(generations, check=2), success_distance=0
    )
    arguments = safe.load_maze("maze1"), algorithm, SEED, parameters
    about = {"method": method, "algorithm": algorithm, "generations": parameters.generations}
    found = measure("peers: run", run, lambda: arguments, once=method == "plain Python", **about)
    if method == "DEAP":  # whose random numbers are others
        assert found[0] == parameters.generations
    else:
        assert found == RUNS["safe"][0](*arguments)
