"""What the operators must conserve, and their rates. Rates are held to 5 standard errors, from stated seeds."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from safe.algorithms import Parameters
from safe.judges import Judges
from safe.operators import (
    DRAWN_JUDGE,
    Breeding,
    breed,
    crossover,
    draw_genomes,
    empty_offspring,
    inherit,
    judged_tournament,
    mutate,
    tournament,
)
from safe.repertoire import empty_repertoire
from tests.helpers import oracle

MANY = 20_000
NOBODY = Judges(np.empty((0, 2)), np.empty((2, 0)))
NOTHING_KNOWN = empty_repertoire((0, 0), 0)


def generator(seed):
    return np.random.Generator(np.random.SFC64(seed))


def bred(*arguments, **more):
    return offspring_of(*arguments, **more).genomes


def offspring_of(genomes, fitness, seed, judges=None, **rates):
    offspring = empty_offspring(*genomes.shape)
    rates = {"tournament": 5, "elites": 2, "crossover": 0.8, "mutation": 0.4, "low": -1.0, "high": 1.0, **rates}
    fitness = np.asarray(fitness, dtype=np.float64)
    repertoire = None if judges is None else NOTHING_KNOWN
    breed(genomes, fitness, judges, repertoire, Breeding(**rates), generator(seed), offspring)
    return offspring


def assert_rate(count, n, probability):
    error = np.sqrt(n * probability * (1 - probability))
    assert abs(count - n * probability) <= 5 * error


@given(st.integers(0, 2**32), st.integers(1, 10), st.integers(1, 6), st.integers(0, 3), st.sampled_from([2, 3, 16]))
def test_breeding_is_that_of_the_oracle(seed, half, size, elite_pairs, length):
    n = 2 * (half + elite_pairs)
    parameters = Parameters(population=n, objectives=n, tournament=size, elites=2 * elite_pairs)
    genomes = generator(seed).random((n, length))
    fitness = generator(seed + 1).integers(0, 4, n).astype(float)  # with ties
    expected, _ = oracle.breed(genomes.tolist(), fitness, parameters, -1, 1, generator(seed))
    for judges in (None, NOBODY):
        offspring = bred(genomes, fitness, seed, judges, tournament=size, elites=2 * elite_pairs)
        assert offspring.tolist() == expected


@given(st.integers(0, 2**32), st.integers(1, 10), st.integers(1, 6), st.integers(0, 3), st.integers(1, 8))
def test_breeding_by_drawn_judges_is_that_of_the_oracle(seed, half, size, elite_pairs, m):
    n = 2 * (half + elite_pairs)
    parameters = Parameters(population=n, objectives=n, tournament=size, elites=2 * elite_pairs)
    genomes, coefficients = generator(seed).random((n, 3)), generator(seed + 1).integers(0, 3, (m, 2)) / 2
    components = generator(seed + 2).integers(0, 4, (2, n)).astype(float)  # with ties
    rates = {"tournament": size, "elites": 2 * elite_pairs, "judging": DRAWN_JUDGE}
    offspring = bred(genomes, np.full(n, np.nan), seed, Judges(coefficients, components), **rates)
    panel = [(genomes.tolist(), scores) for scores in (coefficients @ components).tolist()]
    expected, _ = oracle.breed(genomes.tolist(), None, parameters, -1, 1, generator(seed), panel)
    assert offspring.tolist() == expected


def test_a_single_judge_selects_as_fitness_does():
    fitness = generator(1).integers(0, 4, 30).astype(float)
    judge = Judges(np.array([[1.0]]), fitness[np.newaxis])
    for seed in range(100):
        winner, by = judged_tournament(judge, 30, 5, generator(seed))
        assert (winner, by) == (tournament(fitness, 5, generator(seed)), 0)


def test_the_elite_passes_on_unchanged_and_first():
    genomes = generator(1).random((10, 16))
    fitness = [0, 3, 1, 7, 2, 7, 0, 5, 4, 6]
    offspring = bred(genomes, fitness, seed=2)
    assert (offspring[0] == genomes[3]).all()  # of the two fittest the first
    assert (offspring[1] == genomes[5]).all()


def test_breeding_leaves_the_parents_as_they_are():
    genomes = generator(1).random((10, 16))
    before = genomes.copy()
    bred(genomes, range(10), seed=2)
    assert (genomes == before).all()


def test_without_variation_offspring_are_copies():
    genomes = generator(1).random((10, 16))
    offspring = bred(genomes, range(10), seed=2, crossover=0.0, mutation=0.0)
    assert {tuple(child) for child in offspring} <= {tuple(parent) for parent in genomes}


@given(st.integers(0, 2**32), st.sampled_from([None, NOBODY]), st.sampled_from([0.0, 0.8]))
def test_a_copy_is_known_as_one_and_inherits_its_end_point(seed, judges, rate):
    genomes = np.repeat(np.arange(10.0)[:, np.newaxis], 16, axis=1)  # a crossover of different parents changes both
    offspring = offspring_of(genomes, np.arange(10) % 3, seed, judges, crossover=rate)
    is_copy = (offspring.genomes == genomes[offspring.parents]).all(axis=1)
    assert offspring.is_copy.tolist() == is_copy.tolist()
    endpoints, known = generator(seed).integers(0, 9, (10, 2)), np.zeros((10, 2), dtype=np.int64)
    inherit(offspring, endpoints, known)
    assert (known == np.where(is_copy[:, np.newaxis], endpoints[offspring.parents], -1)).all()


def test_crossover_conserves_the_genes_at_each_place_and_cuts_uniformly():
    cuts = np.zeros(16, dtype=int)
    rng = generator(3)
    for _ in range(MANY):
        first, second = np.zeros(16), np.ones(16)
        crossover(first, second, rng)
        assert (first + second == 1).all()
        cut = int((first == 0).sum())
        assert (first == np.r_[np.zeros(cut), np.ones(16 - cut)]).all()
        cuts[cut] += 1
    assert cuts[0] == 0
    for count in cuts[1:]:
        assert_rate(count, MANY, 1 / 15)


def test_two_genes_are_always_cut_between():
    first, second = np.array([1.0, 2.0]), np.array([3.0, 4.0])
    crossover(first, second, generator(0))
    assert first.tolist() == [1.0, 4.0]
    assert second.tolist() == [3.0, 2.0]


def test_mutation_gives_one_uniform_gene_a_uniform_value():
    genes, values = np.zeros(16, dtype=int), []
    rng = generator(4)
    for _ in range(MANY):
        genome = np.full(16, 9.0)
        mutate(genome, -1.0, 1.0, rng)
        (changed,) = np.flatnonzero(genome != 9.0)
        genes[changed] += 1
        values.append(genome[changed])
    for count in genes:
        assert_rate(count, MANY, 1 / 16)
    assert min(values) >= -1
    assert max(values) < 1
    for count in np.histogram(values, bins=10, range=(-1, 1))[0]:
        assert_rate(count, MANY, 1 / 10)


def test_a_tournament_selects_by_rank():
    # the best of 5 drawn from 10 has rank r (0 the worst) with probability ((r+1)^5 - r^5) / 10^5
    fitness = np.arange(10.0)
    rng = generator(5)
    wins = np.bincount([tournament(fitness, 5, rng) for _ in range(MANY)], minlength=10)
    for rank, count in enumerate(wins):
        assert_rate(count, MANY, ((rank + 1) ** 5 - rank**5) / 10**5)


def test_among_equals_a_tournament_selects_the_first_drawn():
    rng = generator(6)
    wins = np.bincount([tournament(np.zeros(4), 5, rng) for _ in range(MANY)], minlength=4)
    for count in wins:
        assert_rate(count, MANY, 1 / 4)
    rng, twin = generator(7), generator(7)
    for _ in range(100):
        drawn = [int(twin.random() * 4) for _ in range(5)]
        assert tournament(np.zeros(4), 5, rng) == drawn[0]


@pytest.mark.parametrize("probability", [0.0, 0.4, 1.0])
def test_the_rate_of_mutation(probability):
    genomes = np.full((MANY + 2, 16), 9.0)
    changed = (bred(genomes, np.zeros(len(genomes)), seed=8, mutation=probability) != 9.0).any(axis=1).sum()
    assert_rate(changed, MANY, probability)


@pytest.mark.parametrize("probability", [0.0, 0.8, 1.0])
def test_the_rate_of_crossover(probability):
    # genome i is i everywhere: offspring that hold two values come from a crossover of different parents
    n = MANY + 2
    genomes = np.repeat(np.arange(float(n))[:, np.newaxis], 16, axis=1)
    offspring = bred(genomes, np.zeros(n), seed=9, crossover=probability, mutation=0.0)[2:]
    crossed = (offspring != offspring[:, :1]).any(axis=1).reshape(-1, 2)
    assert (crossed[:, 0] == crossed[:, 1]).all()
    assert_rate(crossed[:, 0].sum(), MANY // 2, probability * (1 - 1 / n))


def test_first_genomes_are_uniform():
    genomes = np.empty((MANY // 10, 10))
    draw_genomes(generator(10), 0.0, 1.0, genomes)
    assert genomes.ravel().tolist() == generator(10).random(MANY).tolist()
    draw_genomes(generator(10), -1.0, 1.0, genomes)
    assert genomes.min() >= -1
    assert genomes.max() < 1
    for count in np.histogram(genomes, bins=10, range=(-1, 1))[0]:
        assert_rate(count, MANY, 1 / 10)
