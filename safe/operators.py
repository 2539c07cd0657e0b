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
scores highest wins, the first drawn on a tie. Then no score is common to all, so each elite is the favourite of an
objective function of its own. Their indices are the first draws of a breeding, one for each elite in turn, which is
the individual that scores highest and is no elite yet, the first on a tie.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from safe.judges import Judges, score_all
from safe.kernel import kernel

JUDGINGS = ("best score", "drawn judge")  # of solutions, when some of them are selected
BEST_SCORE, DRAWN_JUDGE = range(len(JUDGINGS))


class Breeding(NamedTuple):
    """The rates and sizes by which a population is bred, and the range of its genes."""

    tournament: int
    elites: int
    crossover: float
    mutation: float
    low: float
    high: float
    judging: int = BEST_SCORE


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
        if fitness[rival] > fitness[winner]:
            winner = rival
    return winner


@kernel
def judged_tournament(judges: Judges, n: int, size: int, rng: np.random.Generator) -> int:
    """As `tournament` among n individuals, by the scores that one drawn objective function gives."""
    drawn = np.empty(size, dtype=np.int64)
    for place in range(size):
        drawn[place] = draw_index(rng, n)
    judge = draw_index(rng, len(judges.objectives))
    winner, best = -1, -np.inf
    for rival in drawn:
        score = 0.0
        for c in range(len(judges.components)):  # Equation 1
            score += judges.objectives[judge, c] * judges.components[c, rival]
        if score > best:
            winner, best = rival, score
    return winner


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
    judges: Judges,
    rates: Breeding,
    rng: np.random.Generator,
    offspring: np.ndarray,
) -> None:
    """Write the next generation into `offspring`: first the elites, the fittest in front, then the pairs.

    Only a drawn judge needs the `judges`.
    """
    is_elite = np.zeros(len(genomes), dtype=np.bool_)
    scores = np.empty(len(genomes)) if rates.judging == DRAWN_JUDGE else fitness
    for place in range(rates.elites):
        if rates.judging == DRAWN_JUDGE:
            score_all(judges, draw_index(rng, len(judges.objectives)), scores)
        fittest = -1
        for i in range(len(genomes)):
            if not is_elite[i] and (fittest < 0 or scores[i] > scores[fittest]):
                fittest = i
        is_elite[fittest] = True
        _copy(genomes, fittest, offspring, place)
    for place in range(rates.elites, len(genomes), 2):
        for child in range(place, place + 2):
            if rates.judging == DRAWN_JUDGE:
                parent = judged_tournament(judges, len(genomes), rates.tournament, rng)
            else:
                parent = tournament(fitness, rates.tournament, rng)
            _copy(genomes, parent, offspring, child)
        if rng.random() < rates.crossover:
            crossover(offspring[place], offspring[place + 1], rng)
        for child in range(place, place + 2):
            if rng.random() < rates.mutation:
                mutate(offspring[child], rates.low, rates.high, rng)


@kernel
def copy_genomes(genomes: np.ndarray, into: np.ndarray) -> None:
    """Copy all genomes into another population of the same shape."""
    for i in range(len(genomes)):
        _copy(genomes, i, into, i)


@kernel
def _copy(genomes: np.ndarray, i: int, into: np.ndarray, place: int) -> None:
    """Copy one genome gene by gene: numba takes seconds longer to compile the copying of whole rows."""
    for gene in range(genomes.shape[1]):
        into[place, gene] = genomes[i, gene]
