"""How objective functions judge solutions, and how they are rated by what solutions come of it.

An objective function is a weighted sum of components (Equation 1 of the paper):

    O_j(S_i) = a_j * (1 / distance of S_i's end point to the goal) + b_j * (novelty of S_i)

The paper weighs components as they are ("raw"). Two other scalings make them comparable within a generation:

    maximum     each component is divided by the generation's largest; it is 0 if the largest is 0
    rank        each component is replaced by its rank among the generation's n, from 0 to n - 1, divided by n - 1;
                equal values get the average of their ranks

Beside closeness and novelty there are two more components to weigh: the rarity of a robot's path (see `safe.paths`),
and 1 / the shortest way from its end point to the maze's goal, which no robot can know. At the goal, this is 2 as well.

Instead of weighing, an objective function may be a *goal* of its own: a place in the maze. Its genome [a, b] in the
unit square names the cell in row a * height and column b * width, rounded down; its score is minus the taxicab distance
from there to a solution's end point. If objective functions are "mixed", the first half weighs; the others are goals.

The paper rates objective functions by their genotypic novelty (Algorithm 2), which asks nothing of the solutions. Other
ratings ask something of them:

    pearson, spearman   whether an objective function prefers what is nearer to the maze's goal: the correlation, over
                        the generation, of the scores that it gives with minus the distance, of values or of ranks; 0
                        if scores or distances do not vary
    mutualism           the highest score that it gives in the generation: both sides profit
    competition         minus that
    discovery           how many cells, new to the run, are on the paths of the solutions whose parent it chose, and 0.9
                        times its own parent's rating
    shuffled            the same, shuffled among the objective functions: a control
    patience            of goals: the highest score that it has given since it was drawn. A goal is drawn again if it
                        has been reached, within 1 cell, or if that score has not risen for some generations
    redrawn             all are drawn again in every generation, and none is rated

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

from safe.kernel import index, kernel

KINDS = ("weights", "goal", "mixed")  # of objective functions
SCALINGS = ("raw", "maximum", "rank")  # of components
RAW, MAXIMUM, RANK = range(len(SCALINGS))
RATINGS = (  # of objective functions; with "none" they never change
    "none",
    "genotypic novelty",
    "pearson",
    "spearman",
    "mutualism",
    "competition",
    "discovery",
    "shuffled",
    "patience",
    "redrawn",
)
(
    UNRATED,
    GENOTYPIC_NOVELTY,
    PEARSON,
    SPEARMAN,
    MUTUALISM,
    COMPETITION,
    DISCOVERY,
    SHUFFLED,
    PATIENCE,
    REDRAWN,
) = range(len(RATINGS))
REACHED = 1  # cells from a goal, at which it has been reached
DECAY = 0.9  # of what an objective function was rated for in the generation before, with "discovery"


class Judges(NamedTuple):
    """Objective functions, and what they weigh."""

    objectives: np.ndarray  # float64, (objective functions, genes): coefficients, or a place
    components: np.ndarray  # float64, (components, solutions), scaled
    first_goal: int = 2**31  # objective functions from this one on are goals
    endpoints: np.ndarray = np.empty((0, 2), dtype=np.int64)  # (solutions, 2), row and column: what goals judge
    shape: tuple[int, int] = (0, 0)  # of the maze in which goals are places


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
    objectives, components, endpoints = judges.objectives, judges.components, judges.endpoints
    if j >= judges.first_goal:
        row, column = place_of(judges, j)
        for i in range(len(scores)):
            scores[i] = -(abs(endpoints[i, 0] - row) + abs(endpoints[i, 1] - column))
        return
    weight = objectives[j, 0]
    for i in range(len(scores)):
        scores[i] = 0.0 + weight * components[0, i]
    for c in range(1, len(components)):
        weight = objectives[j, c]
        for i in range(len(scores)):
            scores[i] += weight * components[c, i]


@kernel
def score_one(judges: Judges, j: int, i: int) -> float:
    """The score that the j-th objective function gives the i-th solution, O_j(S_i)."""
    if j >= judges.first_goal:
        row, column = place_of(judges, j)
        return -float(abs(judges.endpoints[i, 0] - row) + abs(judges.endpoints[i, 1] - column))
    score = 0.0
    for c in range(len(judges.components)):
        score += judges.objectives[j, c] * judges.components[c, i]
    return score


@kernel
def place_of(judges: Judges, j: int) -> tuple[int, int]:
    """The cell, row and column, that a goal's genome [a, b] in the unit square names."""
    height, width = judges.shape
    row, column = int(judges.objectives[j, 0] * height), int(judges.objectives[j, 1] * width)
    return min(row, height - 1), min(column, width - 1)


@kernel(makes_arrays=True)
def favourite(judges: Judges, j: int, n: int) -> int:
    """Of the first n solutions, the one that the j-th objective function scores highest, the first on a tie."""
    found = 0
    if j < judges.first_goal:
        scores = np.empty(n)
        score_all(judges, j, scores)
        for i in range(1, n):
            if scores[i] > scores[found]:
                found = i
        return found
    endpoints, (row, column) = judges.endpoints, place_of(judges, j)  # whole numbers: the repertoire may be large
    least = np.iinfo(np.int64).max
    for i in range(n):
        distance = abs(endpoints[i, 0] - row) + abs(endpoints[i, 1] - column)
        if distance < least:
            found, least = i, distance
    return found


@kernel(makes_arrays=True)
def best_scores(judges: Judges, fitness: np.ndarray, winners: np.ndarray) -> None:
    """Algorithm 1: the fitness of S_i is max_j O_j(S_i), and the first such O_j is its winner.

    Components are never negative, so a weighted sum whose coefficients are all at most those of an earlier one cannot
    win. Leaving such dominated ones out leaves few of a random population.
    """
    n, (m, genes) = len(fitness), judges.objectives.shape
    weighted_sums = min(m, judges.first_goal)
    coefficients = np.empty((genes, weighted_sums))  # in rows, so that the processor compares several at once
    for j in range(weighted_sums):
        for gene in range(genes):
            coefficients[gene, j] = judges.objectives[j, gene]
    is_dominated, exceeds = np.zeros(m, dtype=np.int64), np.empty(m, dtype=np.int64)
    scores = np.empty(n)
    for i in range(n):
        fitness[i] = -np.inf
    for j in range(m):
        if is_dominated[j]:
            continue
        score_all(judges, j, scores)
        for i in range(n):  # selects, not branches, for the same reason
            is_better = scores[i] > fitness[i]
            fitness[i] = scores[i] if is_better else fitness[i]
            winners[i] = j if is_better else winners[i]
        if j < weighted_sums:
            _mark_dominated(coefficients, j, exceeds, is_dominated)


@kernel
def _mark_dominated(coefficients: np.ndarray, j: int, exceeds: np.ndarray, is_dominated: np.ndarray) -> None:
    """Mark those weighted sums behind the j-th that have no coefficient above its own; `exceeds` is working memory."""
    genes, weighted_sums = coefficients.shape
    start, end = index(j + 1), index(weighted_sums)
    for later in range(start, end):
        exceeds[later] = 0
    for gene in range(genes):
        coefficient = coefficients[gene, j]
        for later in range(start, end):
            exceeds[later] |= coefficients[gene, later] > coefficient
    for later in range(start, end):
        is_dominated[later] |= 1 - exceeds[later]


@kernel(makes_arrays=True)
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


@kernel(makes_arrays=True)
def highest_scores(judges: Judges, sign: int, fitness: np.ndarray) -> None:
    """Of each objective function, the highest score that it gives, times a sign."""
    scores = np.empty(judges.components.shape[1])
    for j in range(len(fitness)):
        score_all(judges, j, scores)
        highest = -np.inf
        for i in range(len(scores)):
            highest = max(highest, scores[i])
        fitness[j] = sign * highest


@kernel(makes_arrays=True)
def credit(found: np.ndarray, chosen_by: np.ndarray, parents: np.ndarray, fitness: np.ndarray) -> None:
    """Rate objective functions by the cells that the solutions they have chosen found, from generation to generation.

    `chosen_by` counts the objective functions of the generation before; `parents` says from which of these each of the
    present ones comes, whose rating it inherits.
    """
    before = fitness.copy()
    new = np.zeros(len(fitness), dtype=np.int64)
    for i in range(len(found)):
        if chosen_by[i] >= 0:
            new[chosen_by[i]] += found[i]
    for j in range(len(fitness)):
        fitness[j] = DECAY * before[parents[j]] + new[parents[j]]


@kernel
def shuffle(values: np.ndarray, rng: np.random.Generator) -> None:
    """Shuffle values, the last place first (Fisher and Yates)."""
    for last in range(len(values) - 1, 0, -1):
        drawn = int(rng.random() * (last + 1))
        values[last], values[drawn] = values[drawn], values[last]


@kernel(makes_arrays=True)
def wait(judges: Judges, idle: np.ndarray, fitness: np.ndarray) -> None:
    """Keep the highest score that each goal has given since it was drawn, and for how many generations it is so."""
    highest = np.empty(len(fitness))
    highest_scores(judges, 1, highest)
    for j in range(len(fitness)):
        idle[j] += 1
        if highest[j] > fitness[j]:
            fitness[j] = highest[j]
            idle[j] = 0


@kernel
def give_up(goals: np.ndarray, idle: np.ndarray, fitness: np.ndarray, patience: int, rng: np.random.Generator) -> None:
    """Draw a new goal in the place of each that has been reached, or to which nothing has come nearer for too long."""
    for j in range(len(goals)):
        if fitness[j] >= -REACHED or idle[j] >= patience:
            for gene in range(goals.shape[1]):
                goals[j, gene] = rng.random()
            fitness[j] = -np.inf
            idle[j] = 0
