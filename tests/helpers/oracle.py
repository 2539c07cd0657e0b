"""The paper's rules once more, in plain Python, as slow and as obvious as possible.

Nothing here imports the package. A maze is a list of strings (`#` wall), a controller a list of 16 numbers.
"""

import math
from fractions import Fraction


def find(drawing, symbol):
    for row, line in enumerate(drawing):
        for column, character in enumerate(line):
            if character == symbol:
                return row, column


def is_free(drawing, row, column):
    return 0 <= row < len(drawing) and 0 <= column < len(drawing[0]) and drawing[row][column] != "#"


def crosses(first, last, cell):
    """Does the line between the centres of two cells cross the inside of a cell?"""
    begins, ends = Fraction(0), Fraction(1)  # of the part within the cell, as shares of the line
    for start, end, middle in zip(first, last, cell, strict=True):
        if start == end:
            if start != middle:
                return False
        else:
            sides = [(middle + half - start) / Fraction(end - start) for half in (Fraction(-1, 2), Fraction(1, 2))]
            begins, ends = max(begins, min(sides)), min(ends, max(sides))
    return begins < ends or first == last


def look(drawing, row, column, down, right):
    """The number of cells up to and including the first wall or, without a wall, up to the edge."""
    cells = 0
    while True:
        row, column = row + down, column + right
        if not (0 <= row < len(drawing) and 0 <= column < len(drawing[0])):
            return cells
        cells += 1
        if drawing[row][column] == "#":
            return cells


def sense(drawing, row, column):
    height, width = len(drawing), len(drawing[0])
    goal_row, goal_column = find(drawing, "G")
    return {
        "dist_right": look(drawing, row, column, 0, 1),
        "goal_right": width if goal_column > column else 0,
        "dist_left": look(drawing, row, column, 0, -1),
        "goal_left": 0 if goal_column > column else width,
        "dist_down": look(drawing, row, column, 1, 0),
        "goal_down": height if goal_row > row else 0,
        "dist_up": look(drawing, row, column, -1, 0),
        "goal_up": 0 if goal_row > row else height,
    }


def path(drawing, controller, steps):
    row, column = find(drawing, "S")
    cells = [(row, column)]
    for _ in range(steps):
        readings = list(sense(drawing, row, column).values())
        h = v = 0.0
        for i, reading in enumerate(readings):
            h += controller[i] * reading
            v += controller[8 + i] * reading
        next_column = column + (1 if h >= 0 else -1)
        if is_free(drawing, row, next_column):
            column = next_column
        next_row = row + (1 if v >= 0 else -1)
        if is_free(drawing, next_row, column):
            row = next_row
        cells.append((row, column))
    return cells


def taxicab(p, q):
    return sum(abs(a - b) for a, b in zip(p, q, strict=True))


def euclidean(p, q):
    return math.sqrt(sum((a - b) * (a - b) for a, b in zip(p, q, strict=True)))


class Archive:
    def __init__(self, capacity):
        self.capacity = capacity
        self.members = []  # (score, entry, point), the oldest first
        self.entered = 0

    def offer(self, point, score):
        if len(self.members) >= self.capacity:
            if not self.members:
                return
            lowest = min(self.members)  # the lowest score and, on a tie, the earliest entry
            if not score > lowest[0]:
                return
            self.members.remove(lowest)
        self.members.append((score, self.entered, point))
        self.entered += 1


def novelty(points, archive, k, distance):
    scores = []
    for i, point in enumerate(points):
        others = [other for j, other in enumerate(points) if j != i]
        others += [member for _, _, member in archive.members]
        total = 0.0
        for d in sorted(distance(point, other) for other in others)[:k]:
            total += d
        scores.append(total / k)
        archive.offer(point, scores[-1])
    return scores


def index(rng, n):
    return int(rng.random() * n)


def uniform(rng, low, high):
    return low + (high - low) * rng.random()


def select(fitness, size, rng):
    drawn = [index(rng, len(fitness)) for _ in range(size)]
    best = max(fitness[i] for i in drawn)
    return next(i for i in drawn if fitness[i] == best)


def breed(genomes, fitness, parameters, low, high, rng):
    ranked = sorted(range(len(genomes)), key=lambda i: (-fitness[i], i))
    offspring = [list(genomes[i]) for i in ranked[: parameters.elites]]
    while len(offspring) < len(genomes):
        first = list(genomes[select(fitness, parameters.tournament, rng)])
        second = list(genomes[select(fitness, parameters.tournament, rng)])
        if rng.random() < parameters.crossover:
            cut = 1 + index(rng, len(first) - 1)
            first, second = first[:cut] + second[cut:], second[:cut] + first[cut:]
        for child in (first, second):
            if rng.random() < parameters.mutation:
                gene = index(rng, len(child))
                child[gene] = uniform(rng, low, high)
            offspring.append(child)
    return offspring


def evolve(drawing, objectives, rated, parameters, rng):
    """A run of an algorithm with these objective functions (None: drawn), rated by genotypic novelty or not at all.

    Yields, for every generation, its genomes, end points, fitness and objective functions, and the best so far:
    (distance, genome, objective function).
    """
    goal = find(drawing, "G")
    solutions = [[uniform(rng, -1, 1) for _ in range(16)] for _ in range(parameters.population)]
    if objectives is None:
        objectives = [[uniform(rng, 0, 1) for _ in range(2)] for _ in range(parameters.objectives)]
    archive, objective_archive = Archive(parameters.archive), Archive(parameters.archive)
    best = None
    for _ in range(parameters.generations):
        ends = [path(drawing, solution, parameters.steps)[-1] for solution in solutions]
        distances = [taxicab(end, goal) for end in ends]
        novelties = novelty(ends, archive, parameters.k, taxicab)
        fitness, winners = [], []
        for distance, new in zip(distances, novelties, strict=True):
            nearness = 1 / distance if distance else 2.0
            scores = [a * nearness + b * new for a, b in objectives]
            fitness.append(max(scores))
            winners.append(objectives[scores.index(max(scores))])
        for distance, solution, winner in zip(distances, solutions, winners, strict=True):
            if best is None or distance < best[0]:
                best = distance, list(solution), list(winner)
        yield solutions, ends, fitness, objectives, best
        if best[0] <= parameters.success_distance:
            return
        if rated:
            objective_fitness = novelty(objectives, objective_archive, parameters.k, euclidean)
        solutions = breed(solutions, fitness, parameters, -1, 1, rng)
        if rated:
            objectives = breed(objectives, objective_fitness, parameters, 0, 1, rng)
