import itertools
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import safe
from safe import Algorithm, Parameters, evolve, generations
from safe.algorithms import get_algorithm
from safe.companion import paper
from safe.evolution import RULES, has_choices, start_run
from safe.judges import SCALINGS
from safe.novelty import ADMISSIONS
from tests.helpers import oracle
from tests.helpers.golden import FILE, golden_choices, golden_runs, outcome
from tests.helpers.strategies import algorithms, mazes

SMALL = Parameters(population=20, objectives=10, generations=12, archive=60, k=4, steps=40)
EVOLVING = [algorithm for algorithm in safe.ALGORITHMS.values() if not algorithm.is_random_search]
ADMITTING = st.builds(
    replace,
    st.just(SMALL),
    archive=st.sampled_from([0, 7, 60]),
    admission=st.sampled_from(ADMISSIONS),
    admitted=st.integers(1, 5),
    threshold=st.floats(0, 3),
    patience=st.integers(1, 5),
)


@pytest.mark.parametrize(("kind", "which"), [("runs", golden_runs), ("choices", golden_choices)])
def test_golden_runs(kind, which):
    golden = json.loads(FILE.read_text())
    assert golden["rules"] == RULES
    outcomes = [run.pop("outcome") for run in golden[kind]]
    assert golden[kind] == list(which())
    for run, expected in zip(golden[kind], outcomes, strict=True):
        assert outcome(**run) == expected, run


@settings(max_examples=25)
@given(mazes(), st.sampled_from(EVOLVING), st.just(SMALL), st.integers(0, 2**64))
def test_a_run_is_that_of_the_oracle_generation_by_generation(maze, algorithm, parameters, seed):
    assert_run_of_the_oracle(maze, algorithm, parameters, seed)


@settings(max_examples=150)
@given(mazes(), algorithms(), ADMITTING, st.integers(0, 2**64))
def test_a_run_with_choices_is_that_of_the_oracle(maze, algorithm, parameters, seed):
    assert_run_of_the_oracle(maze, algorithm, parameters, seed)


def assert_run_of_the_oracle(maze, algorithm, parameters, seed):
    rng = np.random.Generator(np.random.SFC64(seed))
    expected = oracle.evolve(maze.drawing().split("\n"), algorithm, parameters, rng)
    for got, wanted in itertools.zip_longest(generations(maze, algorithm, seed, parameters), expected):
        assert got.genomes.tolist() == wanted.genomes
        assert got.endpoints.tolist() == [list(end) for end in wanted.endpoints]
        assert ([] if got.fitness is None else got.fitness.tolist()) == wanted.fitness
        assert got.objectives.tolist() == [list(map(float, objective)) for objective in wanted.objectives]
        distance, genome, objective = wanted.best
        assert (got.distance, got.controller) == (distance, tuple(genome))
        assert got.coefficients == tuple(map(float, objective))
        assert got.archive[0].tolist() == [list(point) for _, _, point in wanted.archive.members]
        if algorithm.rating != "genotypic novelty":  # of which the last digit may differ
            assert getattr(got.objective_fitness, "tolist", lambda: None)() == wanted.objective_fitness
        origins = [tuple(-1 if one is None else one for one in origin) for origin in wanted.origins]
        assert list(zip(got.parents.tolist(), got.chosen_by.tolist(), strict=True)) == origins
        if algorithm.pool == "generation":
            assert got.repertoire is None
        else:
            genomes, endpoints = got.repertoire
            assert genomes.tolist() == list(wanted.repertoire.values())
            assert endpoints.tolist() == [list(end) for end in wanted.repertoire]


@pytest.mark.parametrize("maze", ["maze1", "maze2"])
@pytest.mark.parametrize("algorithm", safe.ALGORITHMS)
def test_stepped_and_driven_give_the_same_run(algorithm, maze):
    for seed in range(3):
        parameters = Parameters(generations=40)
        *_, last = generations(maze, algorithm, seed, parameters)
        assert last.run == evolve(maze, algorithm, seed, parameters)


@pytest.mark.parametrize("algorithm", safe.ALGORITHMS)
def test_a_seed_gives_its_run_and_another_seed_another(algorithm):
    parameters = Parameters(generations=5)
    first, again, other = (evolve("maze1", algorithm, seed, parameters) for seed in (1, 1, 2))
    assert first == again
    assert first.controller != other.controller


def test_the_forms_of_a_seed():
    parameters = Parameters(generations=2)
    by_number = evolve("maze1", "safe", 5, parameters)
    assert by_number == evolve("maze1", "safe", [5], parameters)
    assert by_number == evolve("maze1", "safe", np.random.SeedSequence(5), parameters)
    assert by_number != evolve("maze1", "safe", [5, 1], parameters)


def test_threads_do_not_disturb_each_other():
    parameters = Parameters(generations=20)
    one_by_one = [evolve("maze1", "safe", seed, parameters) for seed in range(8)]
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(lambda seed: evolve("maze1", "safe", seed, parameters), range(8))) == one_by_one


@pytest.mark.parametrize(("name", "coefficients"), [("standard", (1, 0)), ("novelty", (0, 1)), ("fixed", (0.5, 0.5))])
def test_a_frozen_objective_function_is_the_algorithm(name, coefficients):
    # a population of equal objective functions judges as one of them does, whatever its size
    frozen = Algorithm("frozen", objectives=[coefficients] * 7)
    for seed in range(3):
        parameters = Parameters(generations=30)
        assert evolve("maze1", frozen, seed, parameters) == evolve("maze1", name, seed, parameters)


def test_novelty_is_not_computed_where_it_cannot_matter_and_nothing_changes():
    # with a coefficient too small to matter novelty is computed, and the run of the standard EA stays the same
    parameters = Parameters(generations=30)
    *_, without = generations("maze2", "standard", 4, parameters)
    *_, weighed = generations("maze2", Algorithm("weighed", [(1, 5e-324)]), 4, parameters)
    assert without.novelty is None
    assert len(without.archive[0]) == 0
    assert weighed.novelty.max() > 0
    assert without.controller == weighed.controller


def test_what_a_generation_tells():
    maze = safe.load_maze("maze1")
    before = None
    for generation in generations(maze, "safe", 3, Parameters(generations=8)):
        n, m = 200, 200
        assert generation.generation == (0 if before is None else before.generation + 1)
        assert generation.genomes.shape == (n, 16)
        assert (generation.endpoints == safe.endpoints(maze, generation.genomes)).all()
        assert (generation.distances == maze.distance(generation.endpoints)).all()
        components = np.stack([1 / np.maximum(generation.distances, 0.5), generation.novelty], axis=1)
        winners = generation.objectives[generation.winners]
        np.testing.assert_array_equal((winners * components).sum(axis=1), generation.fitness)
        scores = components @ generation.objectives.T
        np.testing.assert_allclose(scores.max(axis=1), generation.fitness, rtol=1e-12)
        assert generation.objectives.shape == (m, 2)
        assert generation.objective_fitness.shape == (m,)
        assert len(generation.archive[0]) == len(generation.archive[1]) == min(1000, n * (generation.generation + 1))
        assert generation.evaluations == n * (generation.generation + 1)
        if before is not None:  # the elite is handed on
            elite = before.genomes[np.argsort(-before.fitness, kind="stable")[:2]]
            assert (generation.genomes[:2] == elite).all()
            assert generation.distance <= before.distance
        before = generation


def test_random_search_draws_every_generation_anew_and_keeps_the_best():
    parameters = Parameters(generations=6)
    rng = np.random.Generator(np.random.SFC64(9))
    drawn = -1 + 2 * rng.random((parameters.evaluations, 16))
    distances = safe.load_maze("maze1").distance(safe.endpoints("maze1", drawn))
    run = evolve("maze1", "random", 9, parameters)
    assert run.distance == distances.min()
    assert run.controller == tuple(drawn[distances.argmin()])
    assert run.coefficients == ()
    assert (run.generation, run.evaluations) == (5, 1200)


def test_random_search_goes_on_after_a_success():
    maze = safe.Maze.from_drawing("S..G")
    run = evolve(maze, "random", 0, Parameters(population=4, objectives=4, generations=9, steps=3))
    assert run.success
    assert run.evaluations == 36


def test_a_run_stops_with_the_generation_that_succeeds():
    maze = safe.load_maze("maze1")
    runs = [list(generations(maze, "novelty", seed, Parameters(generations=200))) for seed in range(4)]
    succeeded = [run for run in runs if run[-1].success]
    assert succeeded
    for run in runs:
        assert [generation.distances.min() <= 2 for generation in run[:-1]] == [False] * (len(run) - 1)
        last = run[-1]
        assert last.success == (last.distances.min() <= 2)
        assert last.success or last.generation == 199
    last = succeeded[0][-1]
    assert last.controller == tuple(last.genomes[last.distances.argmin()])
    assert (safe.path(maze, last.controller)[-1] == last.endpoints[last.distances.argmin()]).all()


def test_at_the_goal_the_component_is_two():
    maze = safe.Maze.from_drawing("SG")
    (generation,) = generations(maze, "standard", 0, Parameters(population=4, objectives=4, generations=1, steps=1))
    assert set(generation.distances) == {0, 1}
    assert generation.fitness.tolist() == [2.0 if distance == 0 else 1.0 for distance in generation.distances]


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ({"maze": "maze3"}, "maze must be one of 'hard', 'maze1', 'maze2', 'medium'"),
        (
            {"algorithm": "saef"},
            "algorithm must be one of 'standard', 'novelty', 'safe', 'fixed', 'random', "
            "'weighing-and-goals'; got 'saef'",
        ),
        ({"algorithm": None}, "algorithm must be one of"),
        ({"seed": -1}, "seed must be a non-negative integer, a sequence of them, or a SeedSequence; got -1"),
        ({"seed": 0.5}, "seed must be"),
        ({"seed": None}, "seed must be"),
        ({"seed": []}, "seed must be"),
        ({"seed": [1, -2]}, "seed must be"),
        ({"seed": "1"}, "seed must be"),
        ({"parameters": None}, "parameters must be a Parameters; got None"),
        (
            {"algorithm": Algorithm("two", [(1, 0), (0, 1)], rating="genotypic novelty")},
            "elites must be fewer than the 2 objective functions; got 2",
        ),
    ],
)
@pytest.mark.parametrize("function", [evolve, generations])
def test_bad_arguments(function, arguments, complaint):
    with pytest.raises(ValueError, match=complaint):
        function(**{"maze": "maze1", "algorithm": "safe", "seed": 0, **arguments})


@pytest.mark.parametrize("scaling", SCALINGS)
@pytest.mark.parametrize("name", ["novelty", "safe"])
def test_scaled_components_are_what_is_weighed(name, scaling):
    algorithm = replace(safe.ALGORITHMS[name], scaling=scaling)
    for generation in safe.generations("maze1", algorithm, 3, safe.Parameters(generations=3)):
        assert (generation.scaled is None) == (scaling == "raw")
        weighed = generation.components if generation.scaled is None else generation.scaled
        winners = generation.objectives[generation.winners].T
        assert (0 + winners[0] * weighed[0] + winners[1] * weighed[1] == generation.fitness).all()
        if scaling != "raw":
            assert weighed[1].max() == 1
            assert weighed[0].any() == (name == "safe")  # nobody can weigh it in novelty search
            assert (np.argsort(weighed[1], kind="stable") == np.argsort(generation.novelty, kind="stable")).all()


def test_without_an_archive_its_admission_is_no_choice():
    runs = {evolve("maze1", "novelty", 1, replace(SMALL, archive=0, admission=admission)) for admission in ADMISSIONS}
    assert len(runs) == 1


def test_where_novelty_is_not_weighed_nothing_is_drawn_for_its_archive():
    runs = {evolve("maze1", "standard", 1, replace(SMALL, admission=admission)) for admission in ADMISSIONS}
    assert len(runs) == 1


@pytest.mark.parametrize("algorithm", ["standard", "novelty", "safe", "fixed"])
def test_fitness_is_the_best_weighing_of_the_components(algorithm):
    for generation in safe.generations("maze1", algorithm, 3, safe.Parameters(generations=3)):
        scores = generation.components.T @ generation.objectives.T
        assert scores.max(axis=1) == pytest.approx(generation.fitness, rel=1e-12)
        assert scores[np.arange(len(scores)), generation.winners] == pytest.approx(generation.fitness, rel=1e-12)
        expected = np.zeros(len(scores)) if generation.novelty is None else generation.novelty
        assert (generation.components[1] == expected).all()


@pytest.mark.parametrize(
    ("algorithm", "parameters", "expected"),
    [
        *((algorithm, Parameters(), False) for algorithm in paper.ALGORITHMS),
        ("safe", Parameters(population=10, crossover=0, archive=0), False),
        ("novelty", Parameters(admission="random"), True),
        ("weighing-and-goals", Parameters(), True),
        (Algorithm("mine", rating="pearson"), Parameters(), True),
        (Algorithm("mine", scaling="rank"), Parameters(), True),
    ],
)
def test_choices_beyond_the_paper_are_known(algorithm, parameters, expected):
    assert has_choices(get_algorithm(algorithm), parameters) == expected
    *_, choices, _ = start_run("maze1", algorithm, 1, parameters)
    assert (choices is not None) == expected


def test_starting_a_run_compiles_nothing(tmp_path):
    """All compiling is done by `compile_kernels`, which shows it."""
    code = """
from numba.core import event
from safe.evolution import Parameters, start_run
with event.install_recorder("numba:compile") as compiled:
    start_run("maze1", "safe", 1, Parameters())
assert not compiled.buffer
"""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    subprocess.run([sys.executable, "-c", code], env=environment, check=True)
