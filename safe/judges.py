"""How objective functions judge solutions, and how they are rated by what solutions come of it.

An objective function is a weighted sum of components (Equation 1 of the paper):

    O_j(S_i) = a_j * (1 / distance of S_i's end point to the goal) + b_j * (novelty of S_i)

The paper weighs components as they are ("raw"). Two other scalings make them comparable within a generation:

    maximum     each component is divided by the generation's largest; it is 0 if the largest is 0
    rank        each component is replaced by its rank among the generation's n, from 0 to n - 1, divided by n - 1;
                equal values get the average of their ranks

The paper rates objective functions by their genotypic novelty (Algorithm 2), which asks nothing of the solutions. Two
other ratings, for variants in which both sides profit, ask whether an objective function prefers what is nearer to the
goal: the correlation, over the generation, of the scores that it gives with minus the distance. It is Pearson's, of the
values, or Spearman's, of their ranks; 0 if scores or distances do not vary.

Floating-point operations are done in one order, so that every twin of these functions gives the same bits. A score is
0 + a_j * c_1 + b_j * c_2, from the left. The ranks from 0, of a value in a generation, are half of (values below it +
values not above it - 1). A correlation takes both sides as ranks, or as values minus the first value, so that equal
values give exactly 0; adds them up in the order of solutions, divides by n, subtracts this mean from each; adds up the
squares of these deviations, and the products of the two sides, in the same order; and divides the sum of products by
(root of the scores' squares * root of the distances' squares), or is 0 if one of these roots is.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from safe.kernel import kernel

SCALINGS = ("raw", "maximum", "rank")  # of components
RAW, MAXIMUM, RANK = range(len(SCALINGS))
RATINGS = ("none", "genotypic novelty", "pearson", "spearman")  # of objective functions; with "none" they never change
UNRATED, GENOTYPIC_NOVELTY, PEARSON, SPEARMAN = range(len(RATINGS))


class Judges(NamedTuple):
    """Objective functions, and what they weigh."""

    objectives: np.ndarray  # float64, (objective functions, components): the coefficients of each
    components: np.ndarray  # float64, (components, solutions), scaled


# Compiled functions


@kernel
def scale(values: np.ndarray, scaling: int, scaled: np.ndarray) -> None:
    """Scale one component of all solutions, which is never negative, by a scaling other than "raw"."""
    if scaling == MAXIMUM:
        largest = 0.0
        for i in range(len(values)):
            largest = max(largest, values[i])
        for i in range(len(values)):
            scaled[i] = values[i] / largest if largest > 0 else 0.0
    else:
        rank(values, scaled)
        for i in range(len(values)):
            scaled[i] /= len(values) - 1


@kernel
def rank(values: np.ndarray, ranks: np.ndarray) -> None:
    """The rank of each value, from 0; equal values share the average. For a few hundred, no sorting is faster."""
    for i in range(len(values)):
        value = values[i]
        twice = -1
        for j in range(len(values)):
            twice += values[j] < value
            twice += values[j] <= value
        ranks[i] = twice / 2


@kernel
def score_all(judges: Judges, j: int, scores: np.ndarray) -> None:
    """The scores that the j-th objective function gives all solutions, O_j(S_1), O_j(S_2), ... (Equation 1)."""
    objectives, components = judges
    for i in range(len(scores)):
        scores[i] = 0.0
    for c in range(len(components)):
        for i in range(len(scores)):
            scores[i] += objectives[j, c] * components[c, i]


@kernel
def best_scores(judges: Judges, fitness: np.ndarray, winners: np.ndarray) -> None:
    """Algorithm 1: the fitness of S_i is max_j O_j(S_i), and the first such O_j is its winner.

    Components are never negative, so an objective function whose coefficients are all at most those of an earlier one
    cannot win. Leaving such dominated ones out leaves few of a random population.
    """
    objectives = judges.objectives
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
        score_all(judges, j, scores)
        for i in range(n):  # selects, not branches, so that the processor handles several solutions at once
            is_better = scores[i] > fitness[i]
            fitness[i] = scores[i] if is_better else fitness[i]
            winners[i] = j if is_better else winners[i]


@kernel
def _is_dominated(objectives: np.ndarray, j: int, contenders: np.ndarray, m: int) -> bool:
    """Does one of the first m contenders have coefficients that are all at least those of the j-th one?"""
    for e in range(m):
        exceeds = False
        for c in range(objectives.shape[1]):
            exceeds |= objectives[j, c] > objectives[contenders[e], c]
        if not exceeds:
            return True
    return False


@kernel
def correlations(judges: Judges, distances: np.ndarray, of_ranks: bool, fitness: np.ndarray) -> None:
    """The correlation of each objective function's scores, or of their ranks, with minus the distance to the goal."""
    n = len(distances)
    scores = np.empty(n)
    apart, nearness = np.empty(n), np.empty(n)  # deviations from the mean
    for i in range(n):
        scores[i] = -distances[i]
    spread_of_nearness = _deviations(scores, of_ranks, nearness)
    for j in range(len(fitness)):
        score_all(judges, j, scores)
        spread = _deviations(scores, of_ranks, apart)
        product = 0.0
        for i in range(n):
            product += apart[i] * nearness[i]
        varies = spread > 0 and spread_of_nearness > 0
        fitness[j] = product / (spread * spread_of_nearness) if varies else 0.0


@kernel
def _deviations(values: np.ndarray, of_ranks: bool, deviations: np.ndarray) -> float:
    """The deviations of the values, or of their ranks, from the mean; returns the root of the sum of their squares."""
    n = len(values)
    if of_ranks:
        rank(values, deviations)
    else:
        for i in range(n):
            deviations[i] = values[i] - values[0]  # exactly 0 if all are equal; the mean of equal values may be rounded
    total = 0.0
    for i in range(n):
        total += deviations[i]
    mean = total / n
    squares = 0.0
    for i in range(n):
        deviations[i] -= mean
        squares += deviations[i] * deviations[i]
    return math.sqrt(squares)
