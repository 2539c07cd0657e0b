"""The cost of a generation of the contest's contestants, where no run succeeds."""

from dataclasses import replace

import pytest

import safe
from safe.companion import contest
from safe.maze_files import load_mazes


@pytest.mark.parametrize(("contestant", "operators"), contest.LOOKED_INTO)
def test_contestant(measure, sized, contestant, operators):
    design = contest.contest(load_mazes(["hard"]), [(contestant, operators)], runs=1, seed=0)
    (experiment,) = design.cells.values()
    parameters = replace(experiment.parameters, generations=sized(500, check=3))
    found = measure(
        "contest",
        safe.evolve,
        lambda: (experiment.maze, experiment.algorithm, experiment.seed_sequence(1), parameters),
        contestant=contestant,
        generations=parameters.generations,
    )
    assert not found.success
