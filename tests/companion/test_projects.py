"""The plain loop of the projects compared with the package's, and what can be replaced in it."""

import numpy as np
import pytest

import safe
from safe.companion import projects

SMALL = safe.Parameters(population=20, objectives=12, generations=12, archive=50, k=4, steps=60)


def rated_by_novelty():
    archive = safe.NoveltyArchive(SMALL.archive, SMALL.k, "euclidean")
    return lambda objectives, components, distances: archive.score(objectives)


OWN = {
    "novelty": lambda: {},
    "standard": lambda: {"objectives": [(1, 0)]},
    "fixed": lambda: {"objectives": [(0.5, 0.5)]},
    "safe": lambda: {"objectives": None, "rate": rated_by_novelty()},
}


@pytest.mark.parametrize("maze", ["maze1", safe.Maze.from_drawing("S....#..\n.##..#..\n...#...G")])
@pytest.mark.parametrize("algorithm", OWN)
def test_by_the_papers_rules_runs_are_those_of_the_package(algorithm, maze):
    for seed in range(4):
        expected = safe.evolve(maze, algorithm, seed, SMALL)
        assert projects.search(maze, seed, SMALL, **OWN[algorithm]()) == expected


def test_every_part_can_be_replaced():
    maze = safe.Maze.from_drawing("S" + "." * 20 + "G")
    seen = []

    class Archive:
        def score(self, points):
            return points[:, 1].astype(float)

    def walk(maze, genomes, steps):
        assert steps == SMALL.steps
        return np.column_stack([np.zeros(len(genomes), int), np.abs(genomes[:, 0] * 21).astype(int)])

    def components(maze, genomes, ends, closeness, novelty):
        assert (novelty == ends[:, 1]).all()
        assert (closeness == 1 / np.maximum(21 - ends[:, 1], 0.5)).all()
        return [novelty, closeness, np.ones(len(ends))]

    def rate(objectives, components, distances):
        assert (distances == 21 - components[0]).all()
        seen.append(objectives.mean(axis=0))
        return objectives[:, 2]

    parameters = safe.Parameters(**SMALL.departures | {"success_distance": 0, "generations": 30})
    run = projects.search(
        maze, 1, parameters, genes=3, walk=walk, archive=Archive(), components=components, objectives=None, rate=rate
    )
    assert len(run.controller) == len(run.coefficients) == 3
    assert run.distance == 21 - int(abs(run.controller[0] * 21))
    assert seen[-1][2] > seen[0][2] + 0.1  # objective functions are bred by their rating


def test_a_comparison_is_with_the_baseline():
    table = projects.compare({"a": [True] * 30, "base": [False, True] * 15, "c": [False] * 30}, "base")
    assert table.difference.tolist()[::2] == [0.5, -0.5]
    assert table.loc["base", ["difference", "p_value"]].isna().all()
    assert (table.low <= table.rate).all()
    assert (table.rate <= table.high).all()
    assert (table.p_value.dropna() < 0.001).all()
    assert projects.readable(table).loc["base"].tolist() == ["15 of 30", "33 to 67 %", "–", "–"]


@pytest.mark.parametrize(("runs", "few"), [(1, 2), (59, 2), (60, 3), (500, 25)])
def test_a_project_begins_with_a_twentieth_of_the_runs(runs, few):
    assert projects.few(runs) == few
