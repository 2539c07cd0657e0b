"""Novelty search and SAFE as a user of DEAP would write them, in DEAP's own style.

Selection, crossover and elitism are DEAP's, and so are individuals, lists that carry a fitness. They are cloned by
deepcopy, DEAP's default, which takes about a fifth of the time and which an expert would replace. The robots walk
in compiled code, a generation in one call of `safe.endpoints`, and novelty is brute force in numpy: both are more than
DEAP itself offers.
The algorithm is that of `safe.evolve`; random draws are Python's, so that the runs are others.
"""

from __future__ import annotations

import random
from collections.abc import Sequence

import numpy as np
from deap import base, creator, tools
from scipy.spatial.distance import cdist

import safe

creator.create("Maximum", base.Fitness, weights=(1.0,))
creator.create("Individual", list, fitness=creator.Maximum)


class Archive:
    """Points, the scores that they entered with, and novelty by all distances.

    Those from a generation to all of itself and to all of the archive are computed at once; a point that enters brings
    along a column of them. So the rule is kept to (scored in order, each offered to the archive right away), and only
    the selection of the k smallest is done point by point.
    """

    def __init__(self, capacity: int, k: int, metric: str) -> None:
        self.k, self.metric = k, metric
        self.points = np.full((capacity, 2), np.inf)
        self.scores = np.full(capacity, -np.inf)
        self.entry = np.arange(capacity) - capacity  # empty places are the first to be taken, in order
        self.entered = 0

    def score(self, points: np.ndarray) -> np.ndarray:
        n = len(points)
        distances = cdist(points, np.concatenate([points, self.points]), self.metric)
        np.fill_diagonal(distances, np.inf)
        scores = np.empty(n)
        for i in range(n):
            nearest = np.partition(distances[i], self.k - 1)[: self.k]
            scores[i] = nearest[nearest < np.inf].sum() / self.k
            lowest = np.flatnonzero(self.scores == self.scores.min())
            place = lowest[self.entry[lowest].argmin()]
            if scores[i] > self.scores[place]:
                self.points[place], self.scores[place], self.entry[place] = points[i], scores[i], self.entered
                distances[:, n + place] = distances[:, i]
                distances[i, n + place] = 0.0
                self.entered += 1
        return scores


def mutate(individual: list[float], low: float, high: float) -> tuple[list[float]]:
    """One gene, drawn uniformly, gets a new uniform value."""
    individual[random.randrange(len(individual))] = random.uniform(low, high)
    return (individual,)


def make_toolbox(genes: int, low: float, high: float, parameters: safe.Parameters) -> base.Toolbox:
    toolbox = base.Toolbox()
    toolbox.register("gene", random.uniform, low, high)
    toolbox.register("individual", tools.initRepeat, creator.Individual, toolbox.gene, genes)
    toolbox.register("population", tools.initRepeat, list, toolbox.individual)
    toolbox.register("select", tools.selTournament, tournsize=parameters.tournament)
    toolbox.register("mate", tools.cxOnePoint)
    toolbox.register("mutate", mutate, low=low, high=high)
    return toolbox


def rate(population: list, fitness: Sequence[float]) -> None:
    for individual, value in zip(population, fitness, strict=True):
        individual.fitness.values = (value,)


def next_generation(toolbox: base.Toolbox, population: list, parameters: safe.Parameters) -> list:
    elites = [toolbox.clone(individual) for individual in tools.selBest(population, parameters.elites)]
    selected = toolbox.select(population, len(population) - parameters.elites)
    offspring = [toolbox.clone(individual) for individual in selected]
    for first, second in zip(offspring[::2], offspring[1::2], strict=True):
        if random.random() < parameters.crossover:
            toolbox.mate(first, second)
        for individual in (first, second):
            if random.random() < parameters.mutation:
                toolbox.mutate(individual)
    return elites + offspring


def evolve(maze: safe.Maze, algorithm: str, seed: int, parameters: safe.Parameters) -> tuple[int, int]:
    """How many generations a run took, and the smallest distance to the goal. Arguments as those of `safe.evolve`."""
    random.seed(seed)
    algorithm = safe.ALGORITHMS[algorithm]
    toolbox = make_toolbox(16, -1, 1, parameters)
    objective_toolbox = make_toolbox(2, 0, 1, parameters)
    archive = Archive(parameters.archive, parameters.k, "cityblock")
    objective_archive = Archive(parameters.archive, parameters.k, "euclidean")

    solutions = toolbox.population(parameters.population)
    objectives = algorithm.objectives or objective_toolbox.population(parameters.objectives)
    closest = np.inf
    for generation in range(1, parameters.generations + 1):  # noqa: B007
        endpoints = safe.endpoints(maze, solutions, parameters.steps)
        distances = maze.distance(endpoints)
        components = np.stack([1 / np.maximum(distances, 0.5), archive.score(endpoints)])
        rate(solutions, (np.array(objectives) @ components).max(axis=0))
        closest = min(closest, int(distances.min()))
        if closest <= parameters.success_distance:
            break
        if algorithm.rating != "none":
            rate(objectives, objective_archive.score(np.array(objectives)))
            objectives = next_generation(objective_toolbox, objectives, parameters)
        solutions = next_generation(toolbox, solutions, parameters)
    return generation, closest
