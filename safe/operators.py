"""Selection and variation: how the next generation is bred (Section 6 and Table 1 of the paper).

The fittest few pass on unchanged (elitism). Pairs of offspring fill the other places: two parents, each the winner of a
tournament; with some probability, a single-point crossover of the two; and for each offspring, with some probability,
one gene replaced by a new uniform value (mutation).

All draws come from `rng.random()`, a uniform value u in [0, 1): an index among n is int(u n), a value in [low, high) is
low + (high - low) u. For each pair of offspring the order is: the indices of the first parent's tournament; those of
the second's; one draw that decides on crossover and, if it takes place, one for the cut; then, for each of the two
offspring, one draw that decides on mutation and, if it takes place, one for the gene and one for its value.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from safe.kernel import kernel


class Breeding(NamedTuple):
    """The rates and sizes by which a population is bred, and the range of its genes."""

    tournament: int
    elites: int
    crossover: float
    mutation: float
    low: float
    high: float


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
    genomes: np.ndarray, fitness: np.ndarray, rates: Breeding, rng: np.random.Generator, offspring: np.ndarray
) -> None:
    """Write the next generation into `offspring`: first the elites, the fittest in front, then the pairs."""
    is_elite = np.zeros(len(genomes), dtype=np.bool_)
    for place in range(rates.elites):
        fittest = -1
        for i in range(len(genomes)):
            if not is_elite[i] and (fittest < 0 or fitness[i] > fitness[fittest]):
                fittest = i
        is_elite[fittest] = True
        _copy(genomes, fittest, offspring, place)
    for place in range(rates.elites, len(genomes), 2):
        _copy(genomes, tournament(fitness, rates.tournament, rng), offspring, place)
        _copy(genomes, tournament(fitness, rates.tournament, rng), offspring, place + 1)
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
