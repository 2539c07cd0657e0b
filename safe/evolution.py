"""The generational loop, the same for every algorithm (Algorithms 1 and 2 of the paper).

One generation:

     1. every solution's robot walks the maze from the start to its end point
     2. every solution gets its components: 1 / (distance to the goal), and novelty
     3. its fitness is the best score that an objective function gives it (Algorithm 1)
     4. the best solution so far is kept; if it is within the success distance, the run ends
     5. objective functions, if they evolve, are rated by their genotypic novelty (Algorithm 2)
     6. the next generation is bred, first the solutions, then the objective functions

Algorithms differ in the population of objective functions that step 3 uses, and in whether step 5 and the second half
of step 6 take place (see `safe.algorithms`). Random search has no objective functions, and draws every generation at
random.

Each choice beyond the paper concerns one step: `admission`, of end points to the archive, and `scaling`, of components,
belong to step 2 (`safe.novelty`, `safe.judges`); `rating` to step 5 (`safe.judges`); `judging` to step 6
(`safe.operators`). A solution's fitness and winner, by which coefficients are reported, always follow Algorithm 1, also
if a drawn judge selects the parents.

All randomness of a run comes from one numpy.random.Generator(SFC64(seed)), and only from its method `random()`, in this
order: the genes of the first solutions, one solution after the other; then, if objective functions are drawn, their
genes, likewise; then, generation by generation, the breeding of the solutions and that of the objective functions (for
the draws of a breeding see `safe.operators`). Random search draws the genes of every generation as those of the first.
The draws of a choice follow those that the paper's rules make in the same step: with random admission, step 2 of every
generation, the first and the last included, draws the index of each solution that enters the archive, if the archive
has places and an objective function can weigh novelty; with a drawn judge, so do elites and tournaments in step 6.

The loop exists once. Python steps through it (`generations`), to watch and to teach, or compiled code runs it to its
end (`evolve`). Both call `advance`, and give the same run, bit for bit.
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
from safe.judges import (
    GENOTYPIC_NOVELTY,
    RATINGS,
    RAW,
    SCALINGS,
    SPEARMAN,
    UNRATED,
    Judges,
    best_scores,
    correlations,
    scale,
)
from safe.kernel import kernel, while_compiling
from safe.maze import Maze, MazeArrays
from safe.maze_files import load_maze
from safe.novelty import (
    ADMISSIONS,
    LOWEST_REPLACED,
    ArchiveArrays,
    admit,
    archived,
    empty_archive,
    empty_occupancy,
    score_cells,
    score_points,
)
from safe.operators import JUDGINGS, Breeding, breed, copy_genomes, draw_genomes
from safe.robot import WEIGHTS, WalkSpace, walk_all, walk_space

RULES = 1  # version of the rules, raised with every change that alters any run

Seed = int | Sequence[int] | np.random.SeedSequence


@dataclass(frozen=True)
class Run:
    """The outcome of a run. Stores and tables of results take their columns from these fields, in this order.

    `controller` and `coefficients` belong to the best solution, the first with the smallest distance. In a successful
    run it is the one that succeeded.
    """

    success: bool
    generation: int  # the last one, counted from 0; in a successful run, the generations to success
    distance: int  # of the best solution's end point to the goal, taxicab, in cells
    controller: tuple[float, ...]  # p_1..p_16
    coefficients: tuple[float, ...]  # (a, b) of the objective function behind its fitness; () in random search
    evaluations: int  # solutions evaluated


@dataclass(frozen=True, eq=False)
class Generation(Run):
    """The run so far, and its latest generation after evaluation, before the next is bred. All arrays are copies."""

    genomes: np.ndarray  # float, (population, 16): p_1..p_16 of each solution
    endpoints: np.ndarray  # int, (population, 2): row and column
    distances: np.ndarray  # int, (population,): end point to goal, taxicab, in cells
    components: np.ndarray  # float, (components, population), raw; novelty is 0 if no objective function can weigh it
    scaled: np.ndarray | None  # float, likewise: what is weighed, or 0 if it cannot be; None if it is the components
    novelty: np.ndarray | None  # float, (population,); None if no objective function can weigh it
    fitness: np.ndarray | None  # float, (population,): the best scores, even with drawn judges; None in random search
    objectives: np.ndarray  # float, (objective functions, components): the coefficients of each
    objective_fitness: np.ndarray | None  # float, (objective functions,); None if they do not evolve
    winners: np.ndarray | None  # int, (population,): the objective function behind each solution's fitness
    archive: tuple[np.ndarray, np.ndarray]  # points (n, 2) and scores (n,), the oldest first
    objective_archive: tuple[np.ndarray, np.ndarray]  # points (n, components) and scores (n,)

    @property
    def run(self) -> Run:
        """The run so far, without the arrays of its generation."""
        return Run(*(getattr(self, field.name) for field in fields(Run)))


def evolve(maze: Maze | str, algorithm: Algorithm | str, seed: Seed, parameters: Parameters = Parameters()) -> Run:
    """Evolve one run to its end, in compiled code.

    Parameters
    ----------
    maze : Maze or str
        The maze, or its name.
    algorithm : Algorithm or str
        The algorithm, or its name in `safe.ALGORITHMS`.
    seed : int, sequence of int, or numpy.random.SeedSequence
        The seed of the run's random numbers. The same seed gives the same run, on every machine.
    parameters : Parameters
        Sizes and rates; the paper's by default.

    Raises
    ------
    ValueError
        If a name is unknown or the seed is not valid.

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
    """As `evolve`, but return None as soon as another thread sets the single value of `stop` to True."""
    compile_kernels()
    state, settings, rng = start_run(maze, algorithm, seed, parameters)
    return run_so_far(state, settings) if run_to_end(state, settings, rng, stop) else None


def compile_kernels() -> None:
    """Compile all that a run needs, or load it from the disk, so that no run's time includes compiling."""
    with _compiling:  # one thread compiles, and the others wait
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
    """The run of `evolve`, one generation at a time. Arguments and errors are those of `evolve`.

    Examples
    --------
    >>> for generation in generations("maze1", "novelty", seed=1, parameters=Parameters(generations=3)):
    ...     print(generation.generation, len(generation.archive[0]))
    0 200
    1 400
    2 600
    """
    compile_kernels()
    start = start_run(maze, algorithm, seed, parameters)  # checks the arguments now, not at the first step
    return step_through(*start)


class Settings(NamedTuple):
    """The constants of a run."""

    maze: MazeArrays
    steps: int
    success_distance: int
    generations: int
    k: int
    admission: int  # to the archive of end points
    admitted: int
    scaling: int  # of components
    rating: int  # of objective functions
    weighed: tuple[bool, ...]  # of each component, can any objective function ever weigh it?
    breeding: Breeding  # of solutions
    objective_breeding: Breeding


class State(NamedTuple):
    """The variables of a run; its arrays are changed in place."""

    genomes: np.ndarray  # float64, (population, 16)
    endpoints: np.ndarray  # int64, (population, 2)
    distances: np.ndarray  # int64, (population,)
    components: np.ndarray  # float64, (components, population)
    scaled: np.ndarray  # the components as they are weighed; the same array if that is as they are
    fitness: np.ndarray  # float64, (population,)
    winners: np.ndarray  # int64, (population,)
    archive: ArchiveArrays
    occupancy: np.ndarray  # int32: points of the archive in each cell, see `empty_occupancy`
    threshold: np.ndarray  # float64, (2,): of admission by threshold, see `admit`
    objectives: np.ndarray  # float64, (objective functions, components)
    objective_fitness: np.ndarray  # float64, (objective functions,)
    objective_archive: ArchiveArrays
    best_controller: np.ndarray  # float64, (16,)
    best_coefficients: np.ndarray  # float64, (components,)
    number: np.ndarray  # int64, (1,): of the generation, -1 before the first
    best_distance: np.ndarray  # int64, (1,)
    # working memory, whose contents mean nothing between generations:
    offspring: np.ndarray
    objective_offspring: np.ndarray
    walk_space: WalkSpace


def start_run(
    maze: Maze | str, algorithm: Algorithm | str, seed: Seed, parameters: Parameters
) -> tuple[State, Settings, np.random.Generator]:
    """The state before the first generation, the settings, and the random generator."""
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
    evolving = algorithm.rating != "none"
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
        admission=ADMISSIONS.index(parameters.admission),
        admitted=parameters.admitted,
        scaling=SCALINGS.index(algorithm.scaling),
        rating=RATINGS.index(algorithm.rating),
        weighed=tuple(bool(evolving or coefficients.any()) for coefficients in objectives.T),
        breeding=Breeding(*rates, low=-1.0, high=1.0, judging=JUDGINGS.index(algorithm.judging)),
        objective_breeding=Breeding(*rates, low=0.0, high=1.0),
    )
    n, m = len(genomes), len(objectives)
    components = np.zeros((len(COMPONENTS), n))
    state = State(
        genomes=genomes,
        endpoints=np.zeros((n, 2), dtype=np.int64),
        distances=np.zeros(n, dtype=np.int64),
        components=components,
        scaled=components if settings.scaling == RAW else np.zeros_like(components),
        fitness=np.zeros(n),
        winners=np.zeros(n, dtype=np.int64),
        archive=empty_archive(parameters.archive, 2),
        occupancy=empty_occupancy(maze.shape),
        threshold=np.array([parameters.threshold, 0.0]),
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
            scaled=state.scaled.copy() if settings.scaling != RAW else None,
            novelty=state.components[NOVELTY].copy() if settings.weighed[NOVELTY] else None,
            fitness=state.fitness.copy() if judged else None,
            objectives=state.objectives.copy(),
            objective_fitness=state.objective_fitness.copy() if settings.rating != UNRATED else None,
            winners=state.winners.copy() if judged else None,
            archive=archived(state.archive),
            objective_archive=archived(state.objective_archive),
        )


GOAL, NOVELTY = COMPONENTS.index("1 / distance"), COMPONENTS.index("novelty")


# Compiled functions


@kernel
def run_to_end(state: State, settings: Settings, rng: np.random.Generator, stop: np.ndarray) -> bool:
    """Run to the end, or until another thread sets `stop`; returns whether the end was reached."""
    while advance(state, settings, rng):
        if stop[0]:
            return False
    return True


@kernel
def advance(state: State, settings: Settings, rng: np.random.Generator) -> bool:
    """Breed and evaluate the next generation (the first is only evaluated); returns whether another follows."""
    if state.number[0] >= 0:
        breed_both(state, settings, rng)
    state.number[0] += 1
    evaluate(state, settings, rng)
    keep_best(state)
    if settings.rating == GENOTYPIC_NOVELTY:
        # Algorithm 2: the fitness of an objective function is the novelty of its genome
        score_points(state.objectives, state.objective_archive, settings.k, False, state.objective_fitness)
    elif settings.rating != UNRATED:
        judges = Judges(state.objectives, state.scaled)
        correlations(judges, state.distances, settings.rating == SPEARMAN, state.objective_fitness)
    is_last = state.number[0] + 1 >= settings.generations
    # random search does not stop at a success: its result is the best of all solutions that it may draw
    has_succeeded = len(state.objectives) > 0 and state.best_distance[0] <= settings.success_distance
    return not (is_last or has_succeeded)


@kernel
def evaluate(state: State, settings: Settings, rng: np.random.Generator) -> None:
    """Steps 1 to 3: end points, components, fitness."""
    walk_all(settings.maze, state.genomes, settings.steps, state.walk_space, state.endpoints)
    goal_row, goal_column = settings.maze.goal
    for i in range(len(state.genomes)):
        distance = abs(state.endpoints[i, 0] - goal_row) + abs(state.endpoints[i, 1] - goal_column)
        state.distances[i] = distance
        # at the goal itself 1 / distance is undefined: it counts as at distance 1/2
        state.components[GOAL, i] = 1.0 / distance if distance > 0 else 2.0
    if settings.weighed[NOVELTY]:
        novelty, rule = state.components[NOVELTY], settings.admission
        score_cells(state.endpoints, state.archive, state.occupancy, settings.k, rule, novelty)
        if rule != LOWEST_REPLACED:
            admitted = settings.admitted
            admit(state.endpoints, novelty, state.archive, state.occupancy, rule, admitted, state.threshold, rng)
    if settings.scaling != RAW:
        for c in range(len(state.components)):
            if settings.weighed[c]:
                scale(state.components[c], settings.scaling, state.scaled[c])
    if len(state.objectives) > 0:
        best_scores(Judges(state.objectives, state.scaled), state.fitness, state.winners)


@kernel
def keep_best(state: State) -> None:
    """Step 4: keep the first solution that is nearer to the goal than all before it."""
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
    """Step 6: the next generation of solutions and, if they evolve, of objective functions."""
    if len(state.objectives) == 0:
        draw_genomes(rng, settings.breeding.low, settings.breeding.high, state.genomes)
        return
    judges = Judges(state.objectives, state.scaled)
    breed(state.genomes, state.fitness, judges, settings.breeding, rng, state.offspring)
    copy_genomes(state.offspring, state.genomes)
    if settings.rating != UNRATED:
        rates, offspring = settings.objective_breeding, state.objective_offspring
        breed(state.objectives, state.objective_fitness, judges, rates, rng, offspring)
        copy_genomes(state.objective_offspring, state.objectives)
