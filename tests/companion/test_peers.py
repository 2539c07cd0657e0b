"""NSGA-II compared with its definition in plain Python and with DEAP's; the repertoire with pyribs' grid of elites."""

from dataclasses import replace

import numpy as np
import pytest
from deap import base, tools
from hypothesis import given
from hypothesis import strategies as st
from ribs.archives import GridArchive

import safe
from safe.companion import contest, peers
from tests.helpers import oracle

DRAWING = "S....#..\n.##..#..\n...#...G\n.#...#..\n.#.#...."
MAZE = safe.Maze.from_drawing(DRAWING)
SMALL = safe.Parameters(
    population=10, generations=16, success_distance=0, tournament=2, elites=0, k=3, steps=12, archive=6, admitted=2
)


def dominates(one, other):
    return one != other and all(a >= b for a, b in zip(one, other, strict=True))


def fronts_of(points):
    """The number of each point's front, by removing front after front."""
    fronts, left, number = {}, set(range(len(points))), 0
    while left:
        front = {i for i in left if not any(dominates(points[j], points[i]) for j in left)}
        fronts |= dict.fromkeys(front, number)
        left -= front
        number += 1
    return [fronts[i] for i in range(len(points))]


def crowding_of(points, fronts):
    distances = [0.0] * len(points)
    for number in set(fronts):
        for axis in range(2):
            front = sorted((i for i in range(len(points)) if fronts[i] == number), key=lambda i: points[i][axis])
            values = [points[i][axis] for i in front]
            for place, i in enumerate(front):
                if place in (0, len(front) - 1):
                    distances[i] += np.inf
                elif values[-1] > values[0]:
                    distances[i] += (values[place + 1] - values[place - 1]) / (values[-1] - values[0])
    return distances


def keys_of(points):
    """What NSGA-II sorts by: the front, then minus the crowding distance, rounded."""
    fronts = fronts_of(points)
    return list(zip(fronts, [-round(distance, 9) for distance in crowding_of(points, fronts)], strict=True))


def keys_of_latest_first(ends, points):
    copies = [ends[i + 1 :].count(end) for i, end in enumerate(ends)]
    latest = {end: i for i, end in enumerate(ends)}
    cells = sorted(latest)
    of_cell = dict(zip(cells, keys_of([points[latest[cell]] for cell in cells]), strict=True))
    return [(copy, *of_cell[end]) for copy, end in zip(copies, ends, strict=True)]


def run_in_python(parameters, copies, rng):
    """The genomes of every generation after selection, and the smallest distance so far."""
    drawing = DRAWING.split("\n")
    archive = oracle.Archive(parameters.archive)
    offspring = [[oracle.uniform(rng, -1, 1) for _ in range(16)] for _ in range(parameters.population)]
    genomes, best = [], None
    for generation in range(parameters.generations):
        ends = [oracle.path(drawing, genome, parameters.steps)[-1] for genome in genomes + offspring]
        distances = [oracle.taxicab(end, MAZE.goal) for end in ends]
        for genome, distance in zip(offspring, distances[-len(offspring) :], strict=True):
            if best is None or distance < best[0]:
                best = distance, genome
        if best[0] <= parameters.success_distance:
            break
        offering = parameters.admission == "lowest replaced"
        novelty = oracle.novelty(ends, archive, parameters.k, oracle.taxicab, offering)
        if not offering:
            new = len(offspring)
            oracle.admit_drawn(ends[-new:], novelty[-new:], archive, parameters.admitted, rng)
        points = [(1 / distance, score) for distance, score in zip(distances, novelty, strict=True)]
        keys = keys_of(points) if copies == "equal" else keys_of_latest_first(ends, points)
        chosen = sorted(sorted(range(len(keys)), key=keys.__getitem__)[: parameters.population])
        genomes = [(genomes + offspring)[i] for i in chosen]
        ranks = {key: -place for place, key in enumerate(sorted(set(keys)))}
        if generation + 1 < parameters.generations:
            offspring, _ = oracle.breed(genomes, [ranks[keys[i]] for i in chosen], parameters, -1, 1, rng)
    return generation, best


@pytest.mark.parametrize("copies", peers.COPIES)
@pytest.mark.parametrize("admission", ["lowest replaced", "random"])
@pytest.mark.parametrize("variation", [{}, {"crossover": 0, "mutation": 1}])
def test_runs_are_those_of_plain_python(copies, admission, variation):
    parameters = replace(SMALL, admission=admission, **variation)
    outcomes = set()
    for seed in range(8):
        run = peers.nsga2(MAZE, seed, parameters, copies)
        generation, (distance, genome) = run_in_python(parameters, copies, np.random.Generator(np.random.SFC64(seed)))
        assert (run.generation, run.distance, run.controller) == (generation, distance, tuple(genome))
        assert run.success == (distance == 0)
        assert run.evaluations == 10 * (generation + 1)
        outcomes.add(run.success)
    assert outcomes == {True, False}, "both ends of a run are tried"


@given(st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6)), min_size=2, max_size=40))
def test_preferences_follow_fronts_and_then_crowding(points):
    found = peers.preferences(*np.array(points, dtype=float).T)
    keys = keys_of(points)
    for i, j in zip(range(len(points)), range(1, len(points)), strict=False):
        if found[i] != pytest.approx(found[j]):
            assert (found[i] > found[j]) == (keys[i] < keys[j])


def test_survivors_are_those_of_deap():
    class Closest(base.Fitness):
        weights = (1.0, 1.0)

    class Solution(list):
        pass

    points = np.random.default_rng(3).random((400, 2))
    solutions = [Solution([i]) for i in range(400)]
    for solution, point in zip(solutions, points, strict=True):
        solution.fitness = Closest(tuple(point))
    expected = {solution[0] for solution in tools.selNSGA2(solutions, 200, nd="log")}
    survivors = np.argsort(-peers.preferences(*points.T), kind="stable")[:200]
    assert set(survivors.tolist()) == expected


def test_the_latest_of_each_cell_come_before_all_copies():
    ends = np.array([[0, 0], [0, 0], [5, 5], [0, 0], [5, 5], [9, 9]])
    found = peers.latest_first(ends, np.array([3.0, 3, 2, 3, 2, 1]), np.array([1.0, 1, 1, 1, 1, 0]))
    assert np.argsort(-found).tolist() == [3, 4, 5, 1, 2, 0]
    assert np.isfinite(found).all()


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"parameters": 5}, r"^parameters must be a Parameters; got 5$"),
        ({"copies": "none"}, r"^copies must be one of 'equal', 'latest first'; got 'none'$"),
        ({"seed": -1}, r"^seed must be a non-negative integer"),
        ({"maze": "maze9"}, r"^maze must be"),
    ],
)
def test_what_is_wrong_is_said(wrong, message):
    with pytest.raises(ValueError, match=message):
        peers.nsga2(**{"maze": "maze1", "seed": 0} | wrong)


@pytest.mark.parametrize("seed", range(3))
def test_the_repertoire_is_pyribs_grid_of_the_latest(seed):
    """A grid keeps the best solution of each cell: the latest, if the number of its evaluation is the objective."""
    maze = safe.load_maze("maze2")
    elites = safe.Algorithm("map-elites", objectives=[], pool="repertoire")
    parameters = safe.Parameters(generations=30, population=40, objectives=40, crossover=0, success_distance=0)
    ranges = [(-0.5, cells - 0.5) for cells in maze.shape]
    grid = GridArchive(solution_dim=16, dims=maze.shape, ranges=ranges)
    genomes_before = None  # by place in the repertoire
    for generation in safe.generations(maze, elites, seed, parameters):
        if genomes_before is not None:  # without crossover, offspring are elites of the grid, but for one gene
            parents = genomes_before[generation.parents]
            assert ((generation.genomes != parents).sum(axis=1) <= 1).all()
        last = 40 * (generation.generation + 1)
        grid.add(generation.genomes, np.arange(last - 40, last), generation.endpoints)
        held = dict(zip(map(tuple, grid.data("measures").tolist()), grid.data("solution"), strict=True))
        genomes, ends = generation.repertoire
        assert {*map(tuple, ends.tolist())} == held.keys()
        genomes_before = np.array([held[tuple(cell)] for cell in ends.tolist()])
        np.testing.assert_array_equal(genomes, genomes_before)
    assert 40 < len(grid) < 600, "many cells, and many elites that were replaced"


def test_the_record_holds_what_was_tried_and_what_it_makes():
    assert peers.verify(sample=3, seed=5) == 3
    counts = peers.counts()
    assert counts.runs.sum() == len(list(peers.all_tried()))
    one = counts.xs(("NSGA-II, copies equal", "mutation alone"), level=("contestant", "operators"))
    assert set(one.index) > set(contest.KNOWN)
    assert (counts.evaluations <= counts.runs * safe.Parameters().evaluations).all()


def test_another_record_is_refused(tmp_path, monkeypatch):
    lines = peers.RECORD.read_text().splitlines()
    monkeypatch.setattr(peers, "RECORD", tmp_path / "nsga2.csv")
    peers.RECORD.write_text("\n".join(lines[:-1]))
    with pytest.raises(ValueError, match="record must hold the runs that were designed; got others in"):
        peers.verify()
    altered = [f"{line},7" if place else line for place, line in enumerate(line.rsplit(",", 1)[0] for line in lines)]
    peers.RECORD.write_text("\n".join([lines[0], *altered[1:]]))
    with pytest.raises(ValueError, match=r"record must hold what its runs make; got '.*,7' instead of"):
        peers.verify(sample=2, seed=1)
