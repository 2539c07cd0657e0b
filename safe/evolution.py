"""The generational loop, the same for every algorithm (Algorithms 1 and 2 of the paper).

One generation:

     1. every solution's robot walks the maze from the start to its end point
     2. every solution gets its components: 1 / (distance to the goal), and novelty
     3. its fitness is the best score that an objective function gives it (Algorithm 1)
     4. the best solution so far is kept; if it is within the success distance, the run ends
     5. objective functions, if they evolve, are rated by their genotypic novelty (Algorithm 2)
     6. the next generation is bred, first the solutions, then the objective functions

The paper's algorithms differ in the population of objective functions that step 3 uses, and in whether step 5 and the
second half of step 6 take place (see `safe.algorithms`). Random search has no objective functions, and draws every
generation at random.

Each choice beyond the paper concerns one step: `admission`, of end points to the archive, and `components` and their
`scaling` belong to step 2 (`safe.novelty`, `safe.paths`, `safe.judges`); `kind`, of objective functions, to step 3;
`rating` to step 5 (`safe.judges`); `judging` and `pool` to step 6 (`safe.operators`, `safe.repertoire`). A solution's
fitness and winner, by which coefficients are reported, always follow Algorithm 1, however parents are selected. The
repertoire takes in the solutions of a generation after step 4, in order.

All randomness of a run comes from one numpy.random.Generator(SFC64(seed)), and only from its method `random()`, in this
order: the genes of the first solutions, one solution after the other; then, if objective functions are drawn, their
genes, likewise; then, generation by generation, the breeding of the solutions and that of the objective functions (for
the draws of a breeding see `safe.operators`). Random search draws the genes of every generation as those of the first.
The draws of a choice follow those that the paper's rules make in the same step. With random admission, step 2 of every
generation, the first and the last included, draws the index of each solution that enters the archive, if the archive
has places and an objective function can weigh novelty. With the rating "shuffled", step 5 of every generation draws its
permutation. In step 6, objective functions choose by draws of their own; then, with the rating "redrawn", all their
genes are drawn, as at first; with "patience" only those of the goals that are given up, in order.

The loop exists once. Python steps through it (`generations`), to watch and to teach, or compiled code runs it to its
end (`evolve`). Both call `advance`, and give the same run, bit for bit.

What only choices beyond the paper need is passed as `choices`, which is None in runs by the paper's rules. numba leaves
out what a condition on it excludes, so a first run by the paper's rules does not wait for the choices to be compiled.
"""

from __future__ import annotations

import functools
import threading
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from safe import checks
from safe.algorithms import CLOSENESS, NOVELTY, PATH_RARITY, WAY, WEIGHABLE, Algorithm, Parameters, get_algorithm
from safe.judges import (
    COMPETITION,
    DISCOVERY,
    GENOTYPIC_NOVELTY,
    MUTUALISM,
    PATIENCE,
    RATINGS,
    RAW,
    REDRAWN,
    SCALINGS,
    SHUFFLED,
    SPEARMAN,
    UNRATED,
    Judges,
    best_scores,
    correlations,
    credit,
    give_up,
    highest_scores,
    scale,
    shuffle,
    wait,
)
from safe.kernel import kernel, while_compiling
from safe.maze import Maze, MazeArrays, ways_to_goal
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
from safe.operators import (
    BEST_SCORE,
    JUDGINGS,
    Breeding,
    Offspring,
    breed,
    copy_genomes,
    draw_genomes,
    empty_offspring,
    inherit,
)
from safe.paths import Paths, empty_paths, score_paths
from safe.repertoire import GENERATION, POOLS, REPERTOIRE, Repertoire, empty_repertoire, keep_latest, known
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
    coefficients: tuple[float, ...]  # (a, b, ...) of the objective function behind its fitness; () if there is none
    evaluations: int  # solutions evaluated


@dataclass(frozen=True, eq=False)
class Generation(Run):
    """The run so far, and its latest generation after evaluation, before the next is bred. All arrays are copies."""

    genomes: np.ndarray  # float, (population, 16): p_1..p_16 of each solution
    endpoints: np.ndarray  # int, (population, 2): row and column
    distances: np.ndarray  # int, (population,): end point to goal, taxicab, in cells
    components: np.ndarray  # float, (components, population), raw; what no objective function can weigh is 0
    scaled: np.ndarray | None  # float, likewise: what is weighed, or 0 if it cannot be; None if it is the components
    novelty: np.ndarray | None  # float, (population,); None if no objective function can weigh it
    fitness: np.ndarray | None  # float, (population,): the best scores, even with drawn judges; None if nobody judges
    objectives: np.ndarray  # float, (objective functions, genes): the coefficients of each, or its place
    objective_fitness: np.ndarray | None  # float, (objective functions,); None if they are not rated
    winners: np.ndarray | None  # int, (population,): the objective function behind each solution's fitness
    archive: tuple[np.ndarray, np.ndarray]  # points (n, 2) and scores (n,), the oldest first
    objective_archive: tuple[np.ndarray, np.ndarray]  # points (n, genes) and scores (n,)
    parents: np.ndarray  # int, (population,): of which each solution was a copy, in the pool before; -1 at first
    chosen_by: np.ndarray  # int, (population,): the objective function, of those before, that chose it; -1 if none did
    repertoire: tuple[np.ndarray, np.ndarray] | None  # genomes (n, 16) and end points (n, 2), in the order of discovery

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
    state, settings, choices, rng = start_run(maze, algorithm, seed, parameters)
    compile_kernels(choices is not None)
    is_stopped = advance(state, settings, choices, rng, parameters.generations, stop)
    return None if is_stopped else run_so_far(state, settings)


def compile_kernels(with_choices: bool = False) -> None:
    """Compile all that a run needs, or load it from the disk, so that no run's time includes compiling.

    A run with choices beyond the paper (see `has_choices`) needs kernels of its own.
    """
    with _compiling:  # one thread compiles, and the others wait
        _compile_kernels(with_choices)


_compiling = threading.Lock()


@functools.cache
def _compile_kernels(with_choices: bool) -> None:
    admission = "random" if with_choices else "lowest replaced"
    parameters = Parameters(population=4, objectives=4, generations=2, archive=2, admission=admission)
    with while_compiling():
        advance(*start_run(Maze.from_drawing("S.G"), "safe", 0, parameters), 2, NEVER)


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
    start = start_run(maze, algorithm, seed, parameters)  # checks the arguments now, not at the first step
    compile_kernels(start[2] is not None)
    return step_through(*start)


def has_choices(algorithm: Algorithm, parameters: Parameters) -> bool:
    """Does a run have choices beyond the paper, for which it needs more than the paper's rules do?"""
    papers_ratings = RATINGS[UNRATED], RATINGS[GENOTYPIC_NOVELTY]
    is_papers = algorithm.content.keys() <= {"objectives", "rating"} and algorithm.rating in papers_ratings
    return not (is_papers and parameters.admission == ADMISSIONS[LOWEST_REPLACED])


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
    patience: int  # generations
    first_goal: int  # objective functions from this one on are goals
    components: np.ndarray  # int64, (components,): which of WEIGHABLE they are
    weighed: np.ndarray  # bool, (components,): can any objective function ever weigh it?
    searches_at_random: bool
    breeding: Breeding  # of solutions
    objective_breeding: Breeding


class State(NamedTuple):
    """The variables of a run; its arrays are changed in place."""

    genomes: np.ndarray  # float64, (population, 16)
    endpoints: np.ndarray  # int64, (population, 2)
    distances: np.ndarray  # int64, (population,)
    components: np.ndarray  # float64, (components, population)
    judges: Judges  # the same objectives and end points; its components are scaled, the same if that is as they are
    fitness: np.ndarray  # float64, (population,)
    winners: np.ndarray  # int64, (population,)
    archive: ArchiveArrays
    occupancy: np.ndarray  # int32: points of the archive in each cell, see `empty_occupancy`
    objectives: np.ndarray  # float64, (objective functions, genes)
    objective_fitness: np.ndarray  # float64, (objective functions,)
    objective_archive: ArchiveArrays
    best_controller: np.ndarray  # float64, (16,)
    best_coefficients: np.ndarray  # float64, (genes,)
    number: np.ndarray  # int64, (1,): of the generation, -1 before the first
    best_distance: np.ndarray  # int64, (1,)
    offspring: Offspring  # how the present solutions were bred; its genomes are working memory
    objective_offspring: Offspring
    known: np.ndarray  # int64, (population, 2): end points of copies, -1 of others
    walk_space: WalkSpace  # working memory


class Choices(NamedTuple):
    """What only choices beyond the paper need; its arrays are changed in place, except `ways`."""

    ways: np.ndarray  # int64, (height, width): the shortest way from each cell to the goal; (0, 0) if nobody asks
    threshold: np.ndarray  # float64, (2,): of admission by threshold, see `admit`
    idle: np.ndarray  # int64, (objective functions,): generations since anybody got nearer to a goal
    paths: Paths
    repertoire: Repertoire


NEVER = np.zeros(1, dtype=bool)  # no thread stops these runs


def start_run(
    maze: Maze | str, algorithm: Algorithm | str, seed: Seed, parameters: Parameters
) -> tuple[State, Settings, Choices | None, np.random.Generator]:
    """The state before the first generation, the settings, what choices beyond the paper need, the random generator."""
    maze, algorithm = load_maze(maze), get_algorithm(algorithm)
    if not isinstance(parameters, Parameters):
        raise ValueError(f"parameters must be a Parameters; got {checks.shown(parameters)}")
    rng = np.random.Generator(np.random.SFC64(seed_sequence(seed)))

    genomes = -1 + 2 * rng.random((parameters.population, WEIGHTS))  # as `draw_genomes`, but without compiling it
    if algorithm.objectives is None:
        objectives = rng.random((parameters.objectives, algorithm.genes))
    else:
        objectives = np.array(algorithm.objectives, dtype=np.float64).reshape(-1, algorithm.genes)
    evolving = algorithm.rating != "none"
    if evolving and parameters.elites >= len(objectives):
        raise ValueError(
            f"elites must be fewer than the {len(objectives)} objective functions; got {parameters.elites}"
        )
    components = np.array([WEIGHABLE.index(name) for name in algorithm.components])
    n, m = len(genomes), len(objectives)
    first_goal = algorithm.first_goal(m)
    weighed = np.array(
        [bool(first_goal and (evolving or objectives[:first_goal, c].any())) for c in range(len(components))]
    )
    is_weighed = [which in components[weighed] for which in range(len(WEIGHABLE))]
    follows_paths = is_weighed[PATH_RARITY] or algorithm.rating in ("discovery", "shuffled")
    has_repertoire = algorithm.pool == "repertoire"
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
        patience=parameters.patience,
        first_goal=first_goal,
        components=components,
        weighed=weighed,
        searches_at_random=algorithm.is_random_search,
        breeding=Breeding(
            parameters.tournament,
            0 if has_repertoire else parameters.elites,  # the repertoire has kept them
            parameters.crossover,
            parameters.mutation,
            low=-1.0,
            high=1.0,
            judging=JUDGINGS.index(algorithm.judging),
            pool=POOLS.index(algorithm.pool),
        ),
        objective_breeding=Breeding(*rates, low=0.0, high=1.0),
    )
    values, ends = np.zeros((len(components), n)), np.zeros((n, 2), dtype=np.int64)
    scaled = values if settings.scaling == RAW else np.zeros_like(values)
    state = State(
        genomes=genomes,
        endpoints=ends,
        distances=np.zeros(n, dtype=np.int64),
        components=values,
        judges=Judges(objectives, scaled, first_goal, ends, maze.shape),
        fitness=np.zeros(n),
        winners=np.zeros(n, dtype=np.int64),
        archive=empty_archive(parameters.archive, 2),
        occupancy=empty_occupancy(maze.shape),
        objectives=objectives,
        objective_fitness=np.full(m, -np.inf if algorithm.rating == "patience" else 0.0),
        objective_archive=empty_archive(parameters.archive, algorithm.genes),
        best_controller=np.zeros(WEIGHTS),
        best_coefficients=np.zeros(algorithm.genes),
        number=np.array([-1]),
        best_distance=np.array([np.iinfo(np.int64).max]),
        offspring=empty_offspring(n, WEIGHTS),
        objective_offspring=empty_offspring(m, algorithm.genes)._replace(parents=np.arange(m)),
        known=np.full((n, 2), -1),
        walk_space=walk_space(maze.shape, parameters.steps),
    )
    if not has_choices(algorithm, parameters):
        return state, settings, None, rng
    choices = Choices(
        ways=_ways(maze) if is_weighed[WAY] else np.zeros((0, 0), dtype=np.int64),
        threshold=np.array([parameters.threshold, 0.0]),
        idle=np.zeros(m, dtype=np.int64),
        paths=empty_paths(n if follows_paths else 0, maze.shape, parameters.steps),
        repertoire=empty_repertoire(maze.shape if has_repertoire else (0, 0), WEIGHTS),
    )
    return state, settings, choices, rng


@functools.lru_cache(maxsize=8)
def _ways(maze: Maze) -> np.ndarray:
    return ways_to_goal(maze)


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


def step_through(
    state: State, settings: Settings, choices: Choices | None, rng: np.random.Generator
) -> Iterator[Generation]:
    judged = len(state.objectives) > 0
    rated = settings.rating not in (UNRATED, REDRAWN)
    novelty = next(iter(np.flatnonzero((settings.components == NOVELTY) & settings.weighed)), None)
    more = True
    while more:
        more = advance(state, settings, choices, rng, 1, NEVER)
        yield Generation(
            **vars(run_so_far(state, settings)),
            genomes=state.genomes.copy(),
            endpoints=state.endpoints.copy(),
            distances=state.distances.copy(),
            components=state.components.copy(),
            scaled=state.judges.components.copy() if settings.scaling != RAW else None,
            novelty=state.components[novelty].copy() if novelty is not None else None,
            fitness=state.fitness.copy() if judged else None,
            objectives=state.objectives.copy(),
            objective_fitness=state.objective_fitness.copy() if rated else None,
            winners=state.winners.copy() if judged else None,
            archive=archived(state.archive),
            objective_archive=archived(state.objective_archive),
            parents=state.offspring.parents.copy(),
            chosen_by=state.offspring.chosen_by.copy(),
            repertoire=known(choices.repertoire) if settings.breeding.pool == REPERTOIRE else None,
        )


# Compiled functions


@kernel
def advance(
    state: State,
    settings: Settings,
    choices: Choices | None,
    rng: np.random.Generator,
    most: int,
    stop: np.ndarray,
) -> bool:
    """Take the steps of the next generations, until the end, at most so many, or until another thread sets `stop`;
    returns whether another follows."""
    follows = True
    for _ in range(most):
        follows = next_generation(state, settings, choices, rng)
        if not follows or stop[0]:
            break
    return follows


@kernel
def next_generation(state: State, settings: Settings, choices: Choices | None, rng: np.random.Generator) -> bool:
    """Breed the next generation (the first is already there) and evaluate it; returns whether another follows.

    Not part of `advance`, since what Python calls counts references.
    """
    if state.number[0] >= 0:
        breed_both(state, settings, choices, rng)
    state.number[0] += 1
    evaluate(state, settings, choices, rng)
    keep_best(state)
    if choices is not None and settings.breeding.pool == REPERTOIRE:
        keep_latest(choices.repertoire, state.genomes, state.endpoints)
    rate(state, settings, choices, rng)
    is_last = state.number[0] + 1 >= settings.generations
    # random search does not stop at a success: its result is the best of all solutions that it may draw
    has_succeeded = state.best_distance[0] <= settings.success_distance and not settings.searches_at_random
    return not (is_last or has_succeeded)


@kernel(inline="always")
def evaluate(state: State, settings: Settings, choices: Choices | None, rng: np.random.Generator) -> None:
    """Steps 1 to 3: end points, components, fitness."""
    paths = None if choices is None else choices.paths
    walk_all(settings.maze, state.genomes, settings.steps, state.walk_space, state.endpoints, paths, state.known)
    goal_row, goal_column = settings.maze.goal
    for i in range(len(state.genomes)):
        state.distances[i] = abs(state.endpoints[i, 0] - goal_row) + abs(state.endpoints[i, 1] - goal_column)
    for c in range(len(settings.components)):
        which, values = settings.components[c], state.components[c]
        if which == CLOSENESS:
            for i in range(len(values)):
                values[i] = inverse(state.distances[i])
        elif which == NOVELTY and settings.weighed[c]:
            rule = settings.admission
            score_cells(state.endpoints, state.archive, state.occupancy, settings.k, rule, values)
            if choices is not None and rule != LOWEST_REPLACED:
                admitted, threshold = settings.admitted, choices.threshold
                admit(state.endpoints, values, state.archive, state.occupancy, rule, admitted, threshold, rng)
        elif choices is not None and which == PATH_RARITY and settings.weighed[c]:
            score_paths(choices.paths, values)
        elif choices is not None and which == WAY and settings.weighed[c]:
            for i in range(len(values)):
                values[i] = inverse(choices.ways[state.endpoints[i, 0], state.endpoints[i, 1]])
    if choices is not None and settings.scaling != RAW:
        for c in range(len(state.components)):
            if settings.weighed[c]:
                scale(state.components[c], settings.scaling, state.judges.components[c])
    if len(state.objectives) > 0:
        best_scores(state.judges, state.fitness, state.winners)


@kernel
def inverse(distance: int) -> float:
    """1 / distance; at the goal itself that is undefined, and counts as at distance 1/2."""
    return 1.0 / distance if distance > 0 else 2.0


@kernel(inline="always")
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


@kernel(inline="always")
def rate(state: State, settings: Settings, choices: Choices | None, rng: np.random.Generator) -> None:
    """Step 5: the fitness of objective functions."""
    if settings.rating == GENOTYPIC_NOVELTY:
        # Algorithm 2: the fitness of an objective function is the novelty of its genome
        score_points(state.objectives, state.objective_archive, settings.k, False, state.objective_fitness)
    elif choices is not None:
        rate_by_solutions(state, settings, choices, rng)


@kernel
def rate_by_solutions(state: State, settings: Settings, choices: Choices, rng: np.random.Generator) -> None:
    """The fitness of objective functions by a rating beyond the paper's."""
    rating, judges, fitness = settings.rating, state.judges, state.objective_fitness
    if rating in (UNRATED, REDRAWN):
        return
    if rating in (MUTUALISM, COMPETITION):
        highest_scores(judges, 1 if rating == MUTUALISM else -1, fitness)
    elif rating in (DISCOVERY, SHUFFLED):
        credit(choices.paths.found, state.offspring.chosen_by, state.objective_offspring.parents, fitness)
        if rating == SHUFFLED:
            shuffle(fitness, rng)
    elif rating == PATIENCE:
        wait(judges, choices.idle, fitness)
    else:
        correlations(judges, state.distances, rating == SPEARMAN, fitness)


@kernel(inline="always")
def breed_both(state: State, settings: Settings, choices: Choices | None, rng: np.random.Generator) -> None:
    """Step 6: the next generation of solutions and, if they evolve, of objective functions."""
    if settings.searches_at_random:
        draw_genomes(rng, settings.breeding.low, settings.breeding.high, state.genomes)
        return
    judges = None if choices is None else state.judges
    repertoire = None if choices is None else choices.repertoire
    rates, offspring = settings.breeding, state.offspring
    breed(state.genomes, state.fitness, judges, repertoire, rates, rng, offspring)
    if rates.pool == GENERATION:
        inherit(offspring, state.endpoints, state.known)
    if rates.judging == BEST_SCORE and len(state.objectives) > 0:
        for i in range(rates.elites, len(offspring.parents)):
            offspring.chosen_by[i] = state.winners[offspring.parents[i]]
    copy_genomes(offspring.genomes, state.genomes)
    rating, rates = settings.rating, settings.objective_breeding
    if rating == REDRAWN:
        draw_genomes(rng, rates.low, rates.high, state.objectives)
    elif choices is not None and rating == PATIENCE:
        give_up(state.objectives, choices.idle, state.objective_fitness, settings.patience, rng)
    elif rating != UNRATED:
        offspring = state.objective_offspring
        breed(state.objectives, state.objective_fitness, judges, repertoire, rates, rng, offspring)
        copy_genomes(offspring.genomes, state.objectives)
