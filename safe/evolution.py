"""The generational loop, the same for every algorithm (Algorithms 1 and 2 of the paper).

One generation:

     1. every solution walks the maze from the start; its end point is what counts
     2. its components: 1 / (distance to the goal), and novelty
     3. its fitness: the best score that an objective function gives it (Algorithm 1)
     4. the best solution so far is kept; within the success distance, the run ends
     5. objective functions are rated by their genotypic novelty, where they evolve (Algorithm 2)
     6. the next generation is bred, first of the solutions, then of the objective functions

Algorithms differ in the population of objective functions that step 3 uses, and in whether step 5 and the second half
of step 6 take place (see `safe.algorithms`). Random search has no objective functions: it draws every generation anew.

All randomness of a run comes from one numpy.random.Generator(SFC64(seed)), by `random()` alone, in this order: the
genes of the first solutions, one solution after the other; those of the first objective functions, likewise, where they
are drawn; then, generation by generation, the breeding of the solutions and that of the objective functions (for the
draws of a breeding see `safe.operators`). Random search draws the genes of every generation as those of the first.

The loop is stepped from Python (`generations`) to watch and to teach, or driven to its end in compiled code (`evolve`).
Both call `advance`, and give the same run, bit for bit.
"""

from __future__ import annotations

import functools
import threading
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from safe import checks
from safe.algorithms import COMPONENTS, Algorithm, Parameters, get_algorithm
from safe.kernel import kernel, while_compiling
from safe.maze import Maze, MazeArrays
from safe.maze_files import load_maze
from safe.novelty import ArchiveArrays, archived, empty_archive, empty_occupancy, score_cells, score_points
from safe.operators import Breeding, breed, copy_genomes, draw_genomes
from safe.robot import WEIGHTS, WalkSpace, walk_all, walk_space

RULES = 1  # raised whenever a change alters what any run gives

Seed = int | Sequence[int] | np.random.SeedSequence


@dataclass(frozen=True)
class Run:
    """The outcome of a run. Stores and tables of results take their columns from these fields, in this order.

    `controller` and `coefficients` belong to the best solution: the first with the smallest distance.
    In a successful run that is the successful one.
    """

    success: bool
    generation: int  # the last one, counted from 0: in a successful run, the generations to success
    distance: int  # of the best solution's end point to the goal, taxicab, in cells
    controller: tuple[float, ...]  # p_1..p_16
    coefficients: tuple[float, ...]  # (a, b) of the objective function that gave it its fitness; () in random search
    evaluations: int  # solutions evaluated


@dataclass(frozen=True, eq=False)
class Generation(Run):
    """A run up to one generation, and that generation, evaluated, before the next is bred. All arrays are copies."""

    genomes: np.ndarray  # float, (population, 16): p_1..p_16 of each solution
    endpoints: np.ndarray  # int, (population, 2): row and column
    distances: np.ndarray  # int, (population,): end point to goal, taxicab, in cells
    components: np.ndarray  # float, (components, population): what objective functions weigh; 0 what none can weigh
    novelty: np.ndarray | None  # float, (population,); None where no objective function can weigh it
    fitness: np.ndarray | None  # float, (population,); None in random search
    objectives: np.ndarray  # float, (objective functions, components): the weights of each
    objective_fitness: np.ndarray | None  # float, (objective functions,); None where they do not evolve
    winners: np.ndarray | None  # int, (population,): which objective function gave a solution its fitness
    archive: tuple[np.ndarray, np.ndarray]  # points (n, 2) and scores (n,), the oldest first
    objective_archive: tuple[np.ndarray, np.ndarray]  # points (n, components) and scores (n,)

    @property
    def run(self) -> Run:
        """The run so far, without the generation."""
        return Run(*(getattr(self, field.name) for field in fields(Run)))


def evolve(maze: Maze | str, algorithm: Algorithm | str, seed: Seed, parameters: Parameters = Parameters()) -> Run:
    """One run, from its first generation to its end, in compiled code.

    Parameters
    ----------
    maze : Maze or str
        The maze, or its name.
    algorithm : Algorithm or str
        The algorithm, or its name in `safe.ALGORITHMS`.
    seed : int, sequence of int, or numpy.random.SeedSequence
        Where the run's randomness starts from. The same seed gives the same run, everywhere.
    parameters : Parameters
        Sizes and rates; the paper's by default.

    Raises
    ------
    ValueError
        Where a name is unknown or the seed is none.

    Examples
    --------
    >>> run = evolve("maze1", "safe", seed=1, parameters=Parameters(generations=3))
    >>> run.success, run.generation, run.evaluations
    (False, 2, 600)
    """
    return evolve_until_stopped(np.zeros(1, dtype=bool), maze, algorithm, seed, parameters)


def evolve_until_stopped(
    stop: np.ndarray, maze: Maze | str, algorithm: Algorithm | str, seed: Seed, parameters: Parameters
) -> Run | None:
    """`evolve`, for as long as the single value of `stop` is False; None where another thread made it True before."""
    compile_kernels()
    state, settings, rng = start_run(maze, algorithm, seed, parameters)
    return run_so_far(state, settings) if run_to_end(state, settings, rng, stop) else None


def compile_kernels() -> None:
    """Compile what a run takes, or load what is compiled: then no run waits for it, and none counts it as its time."""
    with _compiling:  # of several threads one compiles, and the others wait
        _compile_kernels()


_compiling = threading.Lock()


@functools.cache
def _compile_kernels() -> None:
    parameters = Parameters(population=4, objectives=4, generations=2, archive=2)
    with while_compiling():
        run_to_end(*start_run(Maze.from_drawing("S.G"), "safe", 0, parameters), np.zeros(1, dtype=bool))


def generations(
    maze: Maze | str, algorithm: Algorithm | str, seed: Seed, parameters: Parameters = Parameters()
) -> Iterator[Generation]:
    """The same run as `evolve`, one generation at a time. Arguments and errors are those of `evolve`.

    Examples
    --------
    >>> for generation in generations("maze1", "novelty", seed=1, parameters=Parameters(generations=3)):
    ...     print(generation.generation, len(generation.archive[0]))
    0 200
    1 400
    2 600
    """
    compile_kernels()
    begun = start_run(maze, algorithm, seed, parameters)  # arguments are checked now, not at the first step
    return step_through(*begun)


class Settings(NamedTuple):
    """What stays the same in a run."""

    maze: MazeArrays
    steps: int
    success_distance: int
    generations: int
    k: int
    evolving: bool  # are objective functions rated and bred?
    weigh_novelty: bool  # can any objective function ever weigh novelty?
    breeding: Breeding  # of solutions
    objective_breeding: Breeding


class State(NamedTuple):
    """Everything that changes in a run; the arrays are changed in place."""

    genomes: np.ndarray  # float64, (population, 16)
    endpoints: np.ndarray  # int64, (population, 2)
    distances: np.ndarray  # int64, (population,)
    components: np.ndarray  # float64, (components, population)
    fitness: np.ndarray  # float64, (population,)
    winners: np.ndarray  # int64, (population,)
    archive: ArchiveArrays
    occupancy: np.ndarray  # int32: points of the archive in each cell, see `empty_occupancy`
    objectives: np.ndarray  # float64, (objective functions, components)
    objective_fitness: np.ndarray  # float64, (objective functions,)
    objective_archive: ArchiveArrays
    best_controller: np.ndarray  # float64, (16,)
    best_coefficients: np.ndarray  # float64, (components,)
    number: np.ndarray  # int64, (1,): of the generation, -1 before the first
    best_distance: np.ndarray  # int64, (1,)
    # worked in, of no meaning between generations:
    offspring: np.ndarray
    objective_offspring: np.ndarray
    walk_space: WalkSpace


def start_run(
    maze: Maze | str, algorithm: Algorithm | str, seed: Seed, parameters: Parameters
) -> tuple[State, Settings, np.random.Generator]:
    """The state before the first generation, the settings, and the source of randomness."""
    maze, algorithm = load_maze(maze), get_algorithm(algorithm)
    if not isinstance(parameters, Parameters):
        raise ValueError(f"parameters must be a Parameters; got {checks.shown(parameters)}")
    rng = np.random.Generator(np.random.SFC64(seed_sequence(seed)))

    genomes = np.empty((parameters.population, WEIGHTS))
    draw_genomes(rng, -1.0, 1.0, genomes)
    if algorithm.objectives is None:
        objectives = np.empty((parameters.objectives, len(COMPONENTS)))
        draw_genomes(rng, 0.0, 1.0, objectives)
    else:
        objectives = np.array(algorithm.objectives, dtype=np.float64).reshape(-1, len(COMPONENTS))
    evolving = algorithm.rating == "genotypic novelty"
    if evolving and parameters.elites >= len(objectives):
        raise ValueError(
            f"elites must be fewer than the {len(objectives)} objective functions; got {parameters.elites}"
        )
    rates = parameters.tournament, parameters.elites, parameters.crossover, parameters.mutation
    settings = Settings(
        maze=maze.arrays,
        steps=parameters.steps,
        success_distance=parameters.success_distance,
        generations=parameters.generations,
        k=parameters.k,
        evolving=evolving,
        weigh_novelty=bool(evolving or objectives[:, NOVELTY].any()),
        breeding=Breeding(*rates, low=-1.0, high=1.0),
        objective_breeding=Breeding(*rates, low=0.0, high=1.0),
    )
    n, m = len(genomes), len(objectives)
    state = State(
        genomes=genomes,
        endpoints=np.zeros((n, 2), dtype=np.int64),
        distances=np.zeros(n, dtype=np.int64),
        components=np.zeros((len(COMPONENTS), n)),
        fitness=np.zeros(n),
        winners=np.zeros(n, dtype=np.int64),
        archive=empty_archive(parameters.archive, 2),
        occupancy=empty_occupancy(maze.shape),
        objectives=objectives,
        objective_fitness=np.zeros(m),
        objective_archive=empty_archive(parameters.archive, len(COMPONENTS)),
        best_controller=np.zeros(WEIGHTS),
        best_coefficients=np.zeros(len(COMPONENTS)),
        number=np.array([-1]),
        best_distance=np.array([np.iinfo(np.int64).max]),
        offspring=np.empty_like(genomes),
        objective_offspring=np.empty_like(objectives),
        walk_space=walk_space(maze.shape, parameters.steps),
    )
    return state, settings, rng


def seed_sequence(seed: Seed) -> np.random.SeedSequence:
    if isinstance(seed, np.random.SeedSequence):
        return seed
    try:
        words = [checks.integer("seed", word, 0) for word in (seed if isinstance(seed, Sequence) else [seed])]
    except ValueError:
        words = []
    if not words:
        raise ValueError(
            f"seed must be a non-negative integer, a sequence of them, or a SeedSequence; got {checks.shown(seed)}"
        )
    return np.random.SeedSequence(words if isinstance(seed, Sequence) else words[0])


def run_so_far(state: State, settings: Settings) -> Run:
    number = int(state.number[0])
    return Run(
        success=bool(state.best_distance[0] <= settings.success_distance),
        generation=number,
        distance=int(state.best_distance[0]),
        controller=tuple(state.best_controller.tolist()),
        coefficients=tuple(state.best_coefficients.tolist()) if len(state.objectives) else (),
        evaluations=(number + 1) * len(state.genomes),
    )


def step_through(state: State, settings: Settings, rng: np.random.Generator) -> Iterator[Generation]:
    judged = len(state.objectives) > 0
    more = True
    while more:
        more = advance(state, settings, rng)
        yield Generation(
            **vars(run_so_far(state, settings)),
            genomes=state.genomes.copy(),
            endpoints=state.endpoints.copy(),
            distances=state.distances.copy(),
            components=state.components.copy(),
            novelty=state.components[NOVELTY].copy() if settings.weigh_novelty else None,
            fitness=state.fitness.copy() if judged else None,
            objectives=state.objectives.copy(),
            objective_fitness=state.objective_fitness.copy() if settings.evolving else None,
            winners=state.winners.copy() if judged else None,
            archive=archived(state.archive),
            objective_archive=archived(state.objective_archive),
        )


GOAL, NOVELTY = COMPONENTS.index("1 / distance"), COMPONENTS.index("novelty")


# Compiled functions


@kernel
def run_to_end(state: State, settings: Settings, rng: np.random.Generator, stop: np.ndarray) -> bool:
    """Run to the end, or until another thread sets `stop`. Has the end been reached?"""
    while advance(state, settings, rng):
        if stop[0]:
            return False
    return True


@kernel
def advance(state: State, settings: Settings, rng: np.random.Generator) -> bool:
    """Breed the next generation and evaluate it (the first is only evaluated). Is there another after it?"""
    if state.number[0] >= 0:
        breed_both(state, settings, rng)
    state.number[0] += 1
    evaluate(state, settings)
    keep_best(state)
    if settings.evolving:
        # Algorithm 2: the fitness of an objective function is the novelty of its genome
        score_points(state.objectives, state.objective_archive, settings.k, False, state.objective_fitness)
    is_last = state.number[0] + 1 >= settings.generations
    # random search has no first success to stop at: it looks for the best of all that it may draw
    has_succeeded = len(state.objectives) > 0 and state.best_distance[0] <= settings.success_distance
    return not (is_last or has_succeeded)


@kernel
def evaluate(state: State, settings: Settings) -> None:
    """End points, components, fitness."""
    walk_all(settings.maze, state.genomes, settings.steps, state.walk_space, state.endpoints)
    goal_row, goal_column = settings.maze.goal
    for i in range(len(state.genomes)):
        distance = abs(state.endpoints[i, 0] - goal_row) + abs(state.endpoints[i, 1] - goal_column)
        state.distances[i] = distance
        # at the goal itself 1 / distance has no value: it counts as at distance 1/2
        state.components[GOAL, i] = 1.0 / distance if distance > 0 else 2.0
    if settings.weigh_novelty:
        score_cells(state.endpoints, state.archive, state.occupancy, settings.k, state.components[NOVELTY])
    if len(state.objectives) > 0:
        best_scores(state.components, state.objectives, state.fitness, state.winners)


@kernel
def best_scores(components: np.ndarray, objectives: np.ndarray, fitness: np.ndarray, winners: np.ndarray) -> None:
    """Algorithm 1: the fitness of S_i is max_j O_j(S_i), and the first such O_j is its winner.

    Components are never negative, so an objective function that weighs none of them more than an earlier one does
    cannot win. It is left out, which leaves few of a random population.
    """
    contenders = np.empty(len(objectives), dtype=np.int64)
    m = 0
    for j in range(len(objectives)):
        if not _is_dominated(objectives, j, contenders, m):
            contenders[m] = j
            m += 1
    n = len(fitness)
    scores = np.empty(n)
    for i in range(n):
        fitness[i] = -np.inf
    for e in range(m):
        j = contenders[e]
        for i in range(n):
            scores[i] = 0.0
        for c in range(len(components)):  # O_j(S_i), Equation 1
            for i in range(n):
                scores[i] += objectives[j, c] * components[c, i]
        for i in range(n):  # selects, not branches: the processor does several at once
            is_better = scores[i] > fitness[i]
            fitness[i] = scores[i] if is_better else fitness[i]
            winners[i] = j if is_better else winners[i]


@kernel
def _is_dominated(objectives: np.ndarray, j: int, contenders: np.ndarray, m: int) -> bool:
    """Does one of the first m contenders weigh every component at least as much as the j-th objective function does?"""
    for e in range(m):
        weighs_more = False
        for c in range(objectives.shape[1]):
            weighs_more |= objectives[j, c] > objectives[contenders[e], c]
        if not weighs_more:
            return True
    return False


@kernel
def keep_best(state: State) -> None:
    """Keep the first solution that is nearer to the goal than all before it."""
    for i in range(len(state.distances)):
        if state.distances[i] < state.best_distance[0]:
            state.best_distance[0] = state.distances[i]
            for gene in range(WEIGHTS):
                state.best_controller[gene] = state.genomes[i, gene]
            if len(state.objectives) > 0:
                for c in range(len(state.best_coefficients)):
                    state.best_coefficients[c] = state.objectives[state.winners[i], c]


@kernel
def breed_both(state: State, settings: Settings, rng: np.random.Generator) -> None:
    """The next generation of solutions and, where they evolve, of objective functions."""
    if len(state.objectives) == 0:
        draw_genomes(rng, settings.breeding.low, settings.breeding.high, state.genomes)
        return
    breed(state.genomes, state.fitness, settings.breeding, rng, state.offspring)
    copy_genomes(state.offspring, state.genomes)
    if settings.evolving:
        breed(state.objectives, state.objective_fitness, settings.objective_breeding, rng, state.objective_offspring)
        copy_genomes(state.objective_offspring, state.objectives)
