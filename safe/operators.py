"""Selection and variation: how the next generation is bred (Section 6 and Table 1 of the paper).

The fittest few pass on unchanged (elitism). Pairs of offspring fill the other places: two parents, each the winner of a
tournament; with some probability, a single-point crossover of the two; and for each offspring, with some probability,
one gene replaced by a new uniform value (mutation).

All draws come from `rng.random()`, a uniform value u in [0, 1): an index among n is int(u n), a value in [low, high) is
low + (high - low) u. For each pair of offspring the order is: the indices of the first parent's tournament; those of
the second's; one draw that decides on crossover and, if it takes place, one for the cut; then, for each of the two
offspring, one draw that decides on mutation and, if it takes place, one for the gene and one for its value.

Fittest are, by the paper's rule, those with the best scores (Algorithm 1). With a "drawn judge", each tournament is
judged by one objective function, whose index is drawn right after those of the tournament: the individual that it
scores highest wins, the first drawn on a tie. With a "favourite" there is no tournament: one objective function is
drawn for each parent, which is the individual that it scores highest, the first on a tie. Then no score is common to
all, so each elite is the favourite of an objective function of its own. Their indices are the first draws of a
breeding, one for each elite in turn, which is the individual that scores highest and is no elite yet, the first on a
tie.

Parents may also come from the repertoire (see `safe.repertoire`), which is passed on as a whole, so there are no
elites. Goals choose from it as from a generation; objective functions that weigh still choose from the generation, in
which components are measured. Without objective functions, one draw gives the parent's index in the repertoire.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from safe.judges import Judges, favourite, score_all, score_one
from safe.kernel import index, kernel
from safe.repertoire import GENERATION, REPERTOIRE, Repertoire

JUDGINGS = ("best score", "drawn judge", "favourite")  # of solutions, when some of them are selected
BEST_SCORE, DRAWN_JUDGE, FAVOURITE = range(len(JUDGINGS))


class Breeding(NamedTuple):
    """The rates and sizes by which a population is bred, and the range of its genes."""

    tournament: int
    elites: int
    crossover: float
    mutation: float
    low: float
    high: float
    judging: int = BEST_SCORE
    pool: int = GENERATION  # from which parents are taken


class Offspring(NamedTuple):
    """What breeding writes."""

    genomes: np.ndarray  # float64, (individuals, genes)
    parents: np.ndarray  # int64, (individuals,): of which each was a copy before crossover and mutation
    chosen_by: np.ndarray  # int64, (individuals,): the objective function that was drawn to choose it, or -1
    is_copy: np.ndarray  # bool, (individuals,): neither crossover nor mutation has changed it


def empty_offspring(individuals: int, genes: int) -> Offspring:
    """Room for offspring; nobody has parents yet."""
    nobody = np.full(individuals, -1)
    return Offspring(np.zeros((individuals, genes)), nobody, nobody.copy(), np.zeros(individuals, dtype=bool))


# Compiled functions


@kernel
def draw_index(rng: np.random.Generator, n: int) -> int:
    """A uniform index in 0..n-1."""
    return int(rng.random() * n)


@kernel
def draw_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """A uniform value in [low, high)."""
    return low + (high - low) * rng.random()


@kernel
def draw_genomes(rng: np.random.Generator, low: float, high: float, genomes: np.ndarray) -> None:
    """Fill all genomes with uniform values, one genome after the other."""
    for i in range(genomes.shape[0]):
        for gene in range(genomes.shape[1]):
            genomes[i, gene] = draw_uniform(rng, low, high)


@kernel
def tournament(fitness: np.ndarray, size: int, rng: np.random.Generator) -> int:
    """The fittest of `size` individuals drawn with replacement, the first drawn on a tie."""
    winner = draw_index(rng, len(fitness))
    for _ in range(size - 1):
        rival = draw_index(rng, len(fitness))
        if fitness[index(rival)] > fitness[index(winner)]:
            winner = rival
    return winner


@kernel(makes_arrays=True)
def judged_tournament(judges: Judges, n: int, size: int, rng: np.random.Generator) -> tuple[int, int]:
    """As `tournament` among n individuals, by the scores that one drawn objective function gives: winner and judge."""
    drawn = np.empty(size, dtype=np.int64)
    for place in range(size):
        drawn[place] = draw_index(rng, n)
    judge = draw_index(rng, len(judges.objectives))
    winner, best = -1, -np.inf
    for rival in drawn:
        score = score_one(judges, judge, rival)
        if score > best:
            winner, best = rival, score
    return winner, judge


@kernel
def choose(
    fitness: np.ndarray, judges: Judges, repertoire: Repertoire, rates: Breeding, rng: np.random.Generator
) -> tuple[int, int, bool]:
    """A parent by any choice: its index, in the generation or in the repertoire; that of the objective function that
    was drawn to choose it, or -1; and whether it is in the repertoire."""
    n, size = len(fitness), repertoire.size[0]
    if rates.judging == BEST_SCORE:
        if rates.pool == GENERATION:
            return tournament(fitness, rates.tournament, rng), -1, False
        return draw_index(rng, size), -1, True  # nobody judges
    known = Judges(judges.objectives, judges.components, judges.first_goal, repertoire.endpoints, judges.shape)
    if rates.judging == DRAWN_JUDGE:
        if rates.pool == REPERTOIRE:
            parent, judge = judged_tournament(known, size, rates.tournament, rng)
            return parent, judge, True
        parent, judge = judged_tournament(judges, n, rates.tournament, rng)
        return parent, judge, False
    judge = draw_index(rng, len(judges.objectives))
    if rates.pool == REPERTOIRE and judge >= judges.first_goal:
        return favourite(known, judge, size), judge, True
    return favourite(judges, judge, n), judge, False


@kernel
def crossover(first: np.ndarray, second: np.ndarray, rng: np.random.Generator) -> None:
    """Swap, in place, the genes behind a cut that is drawn uniformly from 1..length-1."""
    cut = 1 + draw_index(rng, len(first) - 1)
    for gene in range(cut, len(first)):
        first[gene], second[gene] = second[gene], first[gene]


@kernel
def mutate(genome: np.ndarray, low: float, high: float, rng: np.random.Generator) -> None:
    """Give one gene, drawn uniformly, a new uniform value in [low, high), in place."""
    gene = draw_index(rng, len(genome))
    genome[gene] = draw_uniform(rng, low, high)


@kernel
def breed(
    genomes: np.ndarray,
    fitness: np.ndarray,
    judges: Judges | None,
    repertoire: Repertoire | None,
    rates: Breeding,
    rng: np.random.Generator,
    offspring: Offspring,
) -> None:
    """Write the next generation into `offspring`: first the elites, the fittest in front, then the pairs.

    Only choices beyond the paper need the `judges` and the `repertoire`; by the paper's rules they are None.
    """
    _pass_on_elites(genomes, fitness, judges, rates, rng, offspring)
    bred, parents, chosen_by, is_copy = offspring
    for place in range(rates.elites, len(genomes), 2):
        for child in range(place, place + 2):
            source, judge = genomes, -1
            if judges is None:
                parent = tournament(fitness, rates.tournament, rng)
            else:
                parent, judge, is_known = choose(fitness, judges, repertoire, rates, rng)
                if is_known:
                    source = repertoire.genomes
            _copy(source, parent, bred, child)
            parents[child], chosen_by[child], is_copy[child] = parent, judge, True
        if rng.random() < rates.crossover:
            crossover(bred[place], bred[place + 1], rng)
            if parents[place] != parents[place + 1]:
                is_copy[place] = is_copy[place + 1] = False
        for child in range(place, place + 2):
            if rng.random() < rates.mutation:
                mutate(bred[child], rates.low, rates.high, rng)
                is_copy[child] = False


@kernel(makes_arrays=True)
def _pass_on_elites(
    genomes: np.ndarray,
    fitness: np.ndarray,
    judges: Judges | None,
    rates: Breeding,
    rng: np.random.Generator,
    offspring: Offspring,
) -> None:
    """Write the elites into `offspring`. Not part of `breed`, where no references to arrays are counted."""
    bred, parents, chosen_by, is_copy = offspring
    is_elite = np.zeros(len(genomes), dtype=np.int64)  # as elsewhere: numba compiles np.zeros for each type
    scores = np.empty(len(genomes)) if rates.judging != BEST_SCORE else fitness
    for place in range(rates.elites):
        if judges is not None and rates.judging != BEST_SCORE:
            score_all(judges, draw_index(rng, len(judges.objectives)), scores)
        fittest = np.int64(-1)
        for i in range(len(genomes)):
            if not is_elite[i] and (fittest < 0 or scores[i] > scores[fittest]):
                fittest = i
        is_elite[fittest] = 1
        _copy(genomes, fittest, bred, place)
        parents[place], chosen_by[place], is_copy[place] = fittest, -1, True


@kernel
def inherit(offspring: Offspring, endpoints: np.ndarray, known: np.ndarray) -> None:
    """Put the end points of copies, which are those of their parents, into `known`, and -1 for others."""
    for i in range(len(known)):
        for axis in range(2):
            known[i, axis] = endpoints[offspring.parents[i], axis] if offspring.is_copy[i] else -1


@kernel
def copy_genomes(genomes: np.ndarray, into: np.ndarray) -> None:
    """Copy all genomes into another population of the same shape."""
    for i in range(len(genomes)):
        _copy(genomes, i, into, i)


@kernel
def _copy(genomes: np.ndarray, i: int, into: np.ndarray, place: int) -> None:
    """Copy one genome gene by gene: numba takes seconds longer to compile the copying of whole rows."""
    for gene in range(genomes.shape[1]):
        into[index(place), gene] = genomes[index(i), gene]
