"""The paper's rules and the choices beyond it once more, in plain Python, as slow and as obvious as possible.

Nothing here imports the package. A maze is a list of strings (`#` wall), a controller a list of 16 numbers.
"""

import math
from fractions import Fraction
from typing import NamedTuple


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
        self.enter(point, score)

    def enter(self, point, score):
        self.members.append((score, self.entered, point))
        self.entered += 1

    def rescore(self, points, k, distance):
        """Give every member the novelty that it has now, among the points of a generation and the other members."""
        members = [member for _, _, member in self.members]
        scores = []
        for i, point in enumerate(members):
            others = [*points, *members[:i], *members[i + 1 :]]
            scores.append(sum(sorted(distance(point, other) for other in others)[:k]) / k)
        self.members = [(score, *member[1:]) for score, member in zip(scores, self.members, strict=True)]

    def enter_for_the_oldest(self, point, score):
        if self.capacity:
            self.enter(point, score)
            self.members = self.members[-self.capacity :]


class Threshold:
    def __init__(self, first):
        self.value = first
        self.idle = 0

    def admit(self, points, scores, archive):
        entering = [(p, score) for p, score in zip(points, scores, strict=True) if score > self.value]
        if not archive.capacity:
            return
        for point, score in entering:
            archive.enter_for_the_oldest(point, score)
        if entering:
            self.idle = 0
        else:
            self.idle += len(points)
        if len(entering) > 4:
            self.value *= 1.2
        if self.idle >= 2500:
            self.value *= 0.95
            self.idle = 0


def admit_drawn(points, scores, archive, admitted, rng):
    if archive.capacity:
        for i in [index(rng, len(points)) for _ in range(admitted)]:
            archive.enter_for_the_oldest(points[i], scores[i])


def admit_after_scoring(points, scores, archive, are_distinct):
    for point, score in zip(points, scores, strict=True):
        if not (are_distinct and point in [member for _, _, member in archive.members]):
            archive.offer(point, score)


def novelty(points, archive, k, distance, offering=True):
    scores = []
    for i, point in enumerate(points):
        others = [other for j, other in enumerate(points) if j != i]
        others += [member for _, _, member in archive.members]
        total = 0.0
        for d in sorted(distance(point, other) for other in others)[:k]:
            total += d
        scores.append(total / k)
        if offering:
            archive.offer(point, scores[-1])
    return scores


def ranks(values):
    ascending = sorted(values)
    first = {value: ascending.index(value) for value in values}
    return [first[value] + (values.count(value) - 1) / 2 for value in values]


def scale(values, scaling):
    if scaling == "raw":
        return values
    if scaling == "maximum":
        return [value / max(values) if max(values) else 0.0 for value in values]
    return [rank / (len(values) - 1) for rank in ranks(values)]


def correlation(xs, ys):
    n = len(xs)
    sides = []
    for values in (xs, ys):
        total = 0.0
        for value in values:
            total += value
        deviations = [value - total / n for value in values]
        squares = 0.0
        for deviation in deviations:
            squares += deviation * deviation
        sides.append((deviations, math.sqrt(squares)))
    (xs, x), (ys, y) = sides
    product = 0.0
    for dx, dy in zip(xs, ys, strict=True):
        product += dx * dy
    return product / (x * y) if x and y else 0.0


def pearson(scores, nearness):
    return correlation([s - scores[0] for s in scores], [s - nearness[0] for s in nearness])


def spearman(scores, nearness):
    return correlation(ranks(scores), ranks(nearness))


def score(objective, components):
    total = 0.0
    for coefficient, component in zip(objective, components, strict=True):
        total += coefficient * component
    return total


def index(rng, n):
    return int(rng.random() * n)


def uniform(rng, low, high):
    return low + (high - low) * rng.random()


def select(fitness, size, rng):
    drawn = [index(rng, len(fitness)) for _ in range(size)]
    best = max(fitness[i] for i in drawn)
    return next(i for i in drawn if fitness[i] == best)


def place(goal, height, width):
    """The cell that a goal names."""
    return min(int(goal[0] * height), height - 1), min(int(goal[1] * width), width - 1)


def select_by_one(panel, size, rng):
    """The winner of a tournament, and its judge."""
    drawn = [index(rng, len(panel[0])) for _ in range(size)]
    judge = index(rng, len(panel))
    return max(drawn, key=lambda i: panel[judge][i]), judge


def favourites(panel, count, rng):
    """The elites if judges are drawn."""
    found = []
    for _ in range(count):
        scores = panel[index(rng, len(panel))]
        others = [i for i in range(len(scores)) if i not in found]
        found.append(max(others, key=lambda i: scores[i]))
    return found


def breed(genomes, fitness, parameters, low, high, rng, panel=None, judging="drawn judge", repertoire=None):
    """The offspring, and where each comes from: its parent's index and the objective function that chose it, or None.

    With a panel, objective functions choose as `judging` says: it holds, for each of them, the genomes from which it
    chooses and the scores that it gives them. Without one but with a repertoire, {end point: genome}, nobody chooses.
    """

    def parent():
        if repertoire is not None and panel is None:
            i = index(rng, len(repertoire))
            return list(list(repertoire.values())[i]), i, None
        if panel is None:
            i, judge = select(fitness, parameters.tournament, rng), None
        elif judging == "drawn judge":
            i, judge = select_by_one([scores for _, scores in panel], parameters.tournament, rng)
        else:
            judge = index(rng, len(panel))
            i = max(range(len(panel[judge][1])), key=lambda i: panel[judge][1][i])
        among = panel[judge][0] if panel else genomes
        return list(among[i]), i, judge

    if repertoire is not None:
        elites = []
    elif panel:
        elites = favourites([scores for _, scores in panel], parameters.elites, rng)
    else:
        elites = sorted(range(len(genomes)), key=lambda i: (-fitness[i], i))[: parameters.elites]
    offspring = [list(genomes[i]) for i in elites]
    origins = [(i, None) for i in elites]
    while len(offspring) < len(genomes):
        (first, *one), (second, *other) = parent(), parent()
        origins += [tuple(one), tuple(other)]
        if rng.random() < parameters.crossover:
            cut = 1 + index(rng, len(first) - 1)
            first, second = first[:cut] + second[cut:], second[:cut] + first[cut:]
        for child in (first, second):
            if rng.random() < parameters.mutation:
                gene = index(rng, len(child))
                child[gene] = uniform(rng, low, high)
            offspring.append(child)
    return offspring, origins


def shortest_ways(drawing):
    """The length of the shortest way to the goal, by cell."""
    goal = find(drawing, "G")
    ways, border = {goal: 0}, [goal]
    while border:
        row, column = border.pop(0)
        for cell in ((row + 1, column), (row - 1, column), (row, column + 1), (row, column - 1)):
            if is_free(drawing, *cell) and cell not in ways:
                ways[cell] = ways[row, column] + 1
                border.append(cell)
    return ways


class Generation(NamedTuple):
    genomes: list
    endpoints: list
    fitness: list  # empty if nobody judges
    objectives: list
    best: tuple  # so far: distance, genome, objective function
    objective_fitness: list | None  # None if they are not rated
    archive: Archive
    origins: list  # the parent's index and that of the objective function that chose it, or None
    repertoire: dict  # end point: genome


def evolve(drawing, algorithm, parameters, rng):
    """A run of an algorithm, which has objective functions (None: drawn) and choices.

    Yields every Generation until a success.
    """
    height, width = len(drawing), len(drawing[0])
    goal, ways = find(drawing, "G"), shortest_ways(drawing)
    genes = {"weights": len(algorithm.components), "goal": 2, "mixed": max(2, len(algorithm.components))}[
        algorithm.kind
    ]
    solutions = [[uniform(rng, -1, 1) for _ in range(16)] for _ in range(parameters.population)]
    objectives = algorithm.objectives
    if objectives is None:
        objectives = [[uniform(rng, 0, 1) for _ in range(genes)] for _ in range(parameters.objectives)]
    first_goal = {"weights": len(objectives), "goal": 0, "mixed": len(objectives) // 2}[algorithm.kind]
    archive, objective_archive = Archive(parameters.archive), Archive(parameters.archive)
    threshold = Threshold(parameters.threshold)
    rating = algorithm.rating
    visits, repertoire = {}, {}
    origins = [(None, None)] * len(solutions)
    objective_fitness, objective_origins = [0.0] * len(objectives), [(j, None) for j in range(len(objectives))]
    waits = [(-math.inf, 0)] * len(objectives)  # of each goal: its highest score, and for how long
    best = None

    def scores_of_goal(goal, ends):
        return [-taxicab(place(goal, height, width), end) for end in ends]

    def is_weighed(c):
        return bool(objectives[:first_goal]) and (rating != "none" or any(o[c] for o in objectives[:first_goal]))

    weighed = [is_weighed(c) for c in range(len(algorithm.components))]
    for _ in range(parameters.generations):
        paths = [path(drawing, solution, parameters.steps) for solution in solutions]
        ends = [cells[-1] for cells in paths]
        distances = [taxicab(end, goal) for end in ends]
        found = []
        for cells in paths:
            distinct = list(dict.fromkeys(cells))
            found.append(sum(cell not in visits for cell in distinct))
            for cell in distinct:
                visits[cell] = visits.get(cell, 0) + 1
        components = []
        for name, wanted in zip(algorithm.components, weighed, strict=True):
            if name == "1 / distance":
                values = [1 / distance if distance else 2.0 for distance in distances]
            elif not wanted:
                values = [0.0] * len(ends)
            elif name == "1 / way":
                values = [1 / ways[end] if ways[end] else 2.0 for end in ends]
            elif name == "path rarity":
                values = []
                for cells in paths:
                    total = 0.0
                    for cell in dict.fromkeys(cells):
                        total += 1 / math.sqrt(visits[cell])
                    values.append(total)
            else:
                offering = parameters.admission == "lowest replaced"
                values = novelty(ends, archive, parameters.k, taxicab, offering)
                if parameters.admission == "random":
                    admit_drawn(ends, values, archive, parameters.admitted, rng)
                if parameters.admission == "threshold":
                    threshold.admit(ends, values, archive)
                if parameters.admission == "rescored":
                    archive.rescore(ends, parameters.k, taxicab)
                if parameters.admission in ("after scoring", "distinct", "rescored"):
                    admit_after_scoring(ends, values, archive, parameters.admission == "distinct")
            components.append(values)
        weighing = list(zip(*(scale(values, algorithm.scaling) for values in components), strict=True))

        panel = [[score(o[: len(components)], of_one) for of_one in weighing] for o in objectives[:first_goal]]
        panel += [scores_of_goal(goal, ends) for goal in objectives[first_goal:]]
        fitness = [max(scores) for scores in zip(*panel, strict=True)]
        for i, distance in enumerate(distances):
            if best is None or distance < best[0]:
                winner = next((objectives[j] for j in range(len(panel)) if panel[j][i] == fitness[i]), [])
                best = distance, list(solutions[i]), list(winner)
        for end, solution in zip(ends, solutions, strict=True):
            repertoire[end] = list(solution)
        if rating == "genotypic novelty":
            objective_fitness = novelty(objectives, objective_archive, parameters.k, euclidean)
        elif rating in ("pearson", "spearman"):
            correlate = {"pearson": pearson, "spearman": spearman}[rating]
            objective_fitness = [correlate(scores, [-distance for distance in distances]) for scores in panel]
        elif rating == "mutualism":
            objective_fitness = [max(scores) for scores in panel]
        elif rating == "competition":
            objective_fitness = [-max(scores) for scores in panel]
        elif rating in ("discovery", "shuffled"):
            earned = [sum(f for f, (_, by) in zip(found, origins, strict=True) if by == j) for j in range(len(panel))]
            objective_fitness = [0.9 * objective_fitness[j] + earned[j] for j, _ in objective_origins]
            for last in range(len(panel) - 1, 0, -1) if rating == "shuffled" else ():
                j = index(rng, last + 1)
                f = objective_fitness
                f[last], f[j] = f[j], f[last]
        elif rating == "patience":
            for j, scores in enumerate(panel):
                highest, idle = waits[j]
                waits[j] = (max(scores), 0) if max(scores) > highest else (highest, idle + 1)
            objective_fitness = [highest for highest, _ in waits]
        is_rated = rating not in ("none", "redrawn")
        rated = list(objective_fitness) if is_rated else None
        yield Generation(solutions, ends, fitness, objectives, best, rated, archive, origins, repertoire)
        if best[0] <= parameters.success_distance:
            return
        has_repertoire = algorithm.pool == "repertoire"
        judges = None
        if algorithm.judging != "best score":
            known = list(repertoire.values())
            judges = [
                (known, scores_of_goal(objectives[j], repertoire))
                if has_repertoire and j >= first_goal
                else (solutions, panel[j])
                for j in range(len(panel))
            ]
        kept = repertoire if has_repertoire else None
        winners = [next((j for j in range(len(panel)) if panel[j][i] == f), None) for i, f in enumerate(fitness)]
        solutions, origins = breed(solutions, fitness, parameters, -1, 1, rng, judges, algorithm.judging, kept)
        if algorithm.judging == "best score" and objectives:
            origins = [
                (i, None if n < parameters.elites else winners[i]) for n, (i, _) in enumerate(origins)
            ]  # the winner of the parent's fitness has chosen it
        if rating == "redrawn":
            objectives = [[uniform(rng, 0, 1) for _ in range(genes)] for _ in objectives]
        elif rating == "patience":
            objectives = list(objectives)
            for j, (highest, idle) in enumerate(waits):
                if highest >= -1 or idle >= parameters.patience:
                    objectives[j] = [uniform(rng, 0, 1) for _ in range(2)]
                    waits[j] = -math.inf, 0
        elif is_rated:
            objectives, objective_origins = breed(objectives, objective_fitness, parameters, 0, 1, rng)
