"""The parts of a generation as workloads: the recorded inputs of each part in real runs, and compiled replays of them.

A part that is timed repeatedly on one generation seems several times too fast, because the processor memorises its few
thousand branches. So a whole run is recorded, and each round of a benchmark takes the part through all generations in
order, from the state (archives, random numbers) of that run.

Apart from `straightforward`, only this module of the benchmarks knows the package's compiled functions.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from safe import Maze, Parameters
from safe.evolution import NEVER, NOVELTY, Settings, State, advance, start_run, step_through
from safe.judges import Judges, best_scores
from safe.kernel import kernel
from safe.novelty import score_cells, score_points
from safe.operators import breed, copy_genomes
from safe.robot import walk_all

SEED = 1


class Recording(NamedTuple):
    """The generations of a run, along the first axis of every array; an array is empty if the run has no such
    values.
    """

    genomes: np.ndarray
    endpoints: np.ndarray
    components: np.ndarray
    fitness: np.ndarray
    objectives: np.ndarray
    objective_fitness: np.ndarray
    known: np.ndarray  # end points of copies, which need no walk; -1 of others


class Workload(NamedTuple):
    """A function to be timed, a function that makes its arguments for each round, and the generations in a round."""

    function: Callable
    arguments: Callable[[], tuple]
    generations: int


def start(maze: Maze | str, algorithm: str, parameters: Parameters) -> tuple[State, Settings, np.random.Generator]:
    """The start of a run by the paper's rules that no success will end."""
    state, settings, _, rng = start_run(maze, algorithm, SEED, parameters)
    return state, settings._replace(success_distance=-1), rng


@lru_cache(maxsize=4)  # 500 generations take some 20 MB
def record(maze: Maze | str, algorithm: str, parameters: Parameters) -> Recording:
    """A whole run."""
    state, settings, rng = start(maze, algorithm, parameters)
    run = list(step_through(state, settings, None, rng))
    recorded = ([getattr(generation, name) for generation in run] for name in Recording._fields[:-1])
    arrays = [np.array(values) if values[0] is not None else np.zeros((0, 0)) for values in recorded]
    known = np.full((len(run), parameters.population, 2), -1)
    for before, generation, ends in zip(run, run[1:], known[1:], strict=False):
        is_copy = (generation.genomes == before.genomes[generation.parents]).all(axis=1)
        ends[is_copy] = generation.endpoints[is_copy]
    return Recording(*arrays, known)


def workload(
    part: str,
    maze: Maze | str,
    algorithm: str,
    parameters: Parameters,
    first: int = 0,
    timed_with: Parameters | None = None,
) -> Workload:
    """A part of the generations of a run, from the `first` on.

    Archives have been offered what came before. With `timed_with`, archives and k are those of other parameters than
    the run was made with.
    """
    run = record(maze, algorithm, parameters)
    before, timed = (Recording(*(array[some] for array in run)) for some in (slice(first), slice(first, None)))
    state, settings, rng = start(maze, algorithm, timed_with or parameters)
    if first > 0:
        PARTS[part](state, settings, rng, before)

    def arguments() -> tuple[State, Settings, np.random.Generator, Recording]:
        fresh_state, fresh_rng = copy.deepcopy((state, rng))
        return fresh_state, settings, fresh_rng, timed

    if timed_with is None and part in OUTCOMES:  # does the replay do the work of the run?
        end, *others = arguments()
        PARTS[part](end, *others)
        np.testing.assert_array_equal(OUTCOMES[part](end), OUTCOMES[part](timed)[-1])
    return Workload(PARTS[part], arguments, len(timed.genomes))


# Compiled functions


@kernel(makes_arrays=True)
def judges_in(run: Recording, g: int, state: State, settings: Settings) -> Judges:
    """The objective functions of a generation."""
    shape = settings.maze.walls.shape
    return Judges(run.objectives[g], run.components[g], settings.first_goal, state.endpoints, shape)


@kernel
def robot(state: State, settings: Settings, rng: np.random.Generator, run: Recording) -> None:
    for g in range(len(run.genomes)):
        walk_all(settings.maze, run.genomes[g], settings.steps, state.walk_space, state.endpoints, None, run.known[g])


@kernel
def novelty(state: State, settings: Settings, rng: np.random.Generator, run: Recording) -> None:
    for g in range(len(run.endpoints)):
        score_cells(
            run.endpoints[g], state.archive, state.occupancy, settings.k, settings.admission, state.components[NOVELTY]
        )


@kernel
def fitness(state: State, settings: Settings, rng: np.random.Generator, run: Recording) -> None:
    for g in range(len(run.fitness)):
        best_scores(judges_in(run, g, state, settings), state.fitness, state.winners)


@kernel
def breeding(state: State, settings: Settings, rng: np.random.Generator, run: Recording) -> None:
    for g in range(len(run.genomes)):
        breed(run.genomes[g], run.fitness[g], None, None, settings.breeding, rng, state.offspring)
        copy_genomes(state.offspring.genomes, state.genomes)


@kernel
def objective_functions(state: State, settings: Settings, rng: np.random.Generator, run: Recording) -> None:
    for g in range(len(run.objectives)):
        score_points(run.objectives[g], state.objective_archive, settings.k, False, state.objective_fitness)


@kernel
def breeding_of_objective_functions(state: State, settings: Settings, rng: np.random.Generator, run: Recording) -> None:
    for g in range(len(run.objectives)):
        rates, offspring = settings.objective_breeding, state.objective_offspring
        breed(run.objectives[g], run.objective_fitness[g], None, None, rates, rng, offspring)
        copy_genomes(offspring.genomes, state.objectives)


@kernel
def whole_generation(state: State, settings: Settings, rng: np.random.Generator, run: Recording) -> None:
    advance(state, settings, None, rng, settings.generations, NEVER)


PARTS = {
    "robot": robot,
    "novelty": novelty,
    "fitness": fitness,
    "breeding": breeding,
    "objective functions": objective_functions,
    "breeding of objective functions": breeding_of_objective_functions,
    "all": whole_generation,
}

OUTCOMES = {  # the result of a part, in a state and in every generation of a recording
    "robot": lambda end: end.endpoints,
    "novelty": lambda end: end.components[..., NOVELTY, :],
    "fitness": lambda end: end.fitness,
    "objective functions": lambda end: end.objective_fitness,
    "all": lambda end: end.genomes,
}
