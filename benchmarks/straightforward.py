"""The runs of `safe.evolve` as a first version in numba would compute them: compiled, but without regard for speed.

Every robot walks all its steps; a point's distances to all others are sorted; every objective function scores every
solution. Random draws come in the same order, so a run is the same to the last bit, and the difference in time is what
the algorithms inside the package are worth, apart from compiling.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from safe import Maze, Parameters, Run
from safe.algorithms import CLOSENESS, NOVELTY, Algorithm
from safe.evolution import Seed, Settings, State, breed_both, keep_best, run_so_far, start_run
from safe.judges import UNRATED
from safe.kernel import kernel
from safe.maze import MazeArrays
from safe.robot import READINGS


def evolve(maze: Maze | str, algorithm: Algorithm | str, seed: Seed, parameters: Parameters = Parameters()) -> Run:
    """As `safe.evolve`."""
    state, settings, _, rng = start_run(maze, algorithm, seed, parameters)
    drive(state, settings, rng, *(empty_archive(parameters.archive) for _ in range(2)))
    return run_so_far(state, settings)


class Archive(NamedTuple):
    """Points in no order."""

    points: np.ndarray  # float64, (capacity, 2)
    scores: np.ndarray  # float64, (capacity,)
    entry: np.ndarray  # int64, (capacity,), 0 for the first point that ever entered
    counts: np.ndarray  # int64, (2,): points in it now, points that ever entered


def empty_archive(capacity: int) -> Archive:
    return Archive(
        np.zeros((capacity, 2)), np.zeros(capacity), np.zeros(capacity, dtype=np.int64), np.zeros(2, dtype=np.int64)
    )


@kernel
def drive(
    state: State, settings: Settings, rng: np.random.Generator, archive: Archive, objective_archive: Archive
) -> None:
    goal_row, goal_column = settings.maze.goal
    judged = len(state.objectives) > 0
    while state.number[0] + 1 < settings.generations:
        if state.number[0] >= 0:
            breed_both(state, settings, None, rng)
        state.number[0] += 1
        for i in range(len(state.genomes)):
            row, column = walk(settings.maze, state.genomes[i], settings.steps)
            distance = abs(row - goal_row) + abs(column - goal_column)
            state.endpoints[i] = row, column
            state.distances[i] = distance
            state.components[CLOSENESS, i] = 1.0 / distance if distance > 0 else 2.0
        if settings.weighed[NOVELTY]:
            rate(state.endpoints, archive, settings.k, True, state.components[NOVELTY])
        if judged:
            judge(state.components, state.objectives, state.fitness, state.winners)
        keep_best(state)
        if settings.rating != UNRATED:
            rate(state.objectives, objective_archive, settings.k, False, state.objective_fitness)
        if judged and state.best_distance[0] <= settings.success_distance:
            return


@kernel
def walk(maze: MazeArrays, controller: np.ndarray, steps: int) -> tuple[int, int]:
    walls, sensors, (row, column), _ = maze
    height, width = walls.shape
    for _ in range(steps):
        h = 0.0
        v = 0.0
        for i in range(READINGS):
            h += controller[i] * sensors[row, column, i]
            v += controller[READINGS + i] * sensors[row, column, i]
        aside = column + (1 if h >= 0 else -1)
        if 0 <= aside < width and not walls[row, aside]:
            column = aside
        ahead = row + (1 if v >= 0 else -1)
        if 0 <= ahead < height and not walls[ahead, column]:
            row = ahead
    return row, column


@kernel(makes_arrays=True)
def rate(points: np.ndarray, archive: Archive, k: int, taxicab: bool, scores: np.ndarray) -> None:
    n = len(points)
    for i in range(n):
        size = archive.counts[0]
        distances = np.empty(n + size)
        for j in range(n):
            distances[j] = distance_between(points[i], points[j], taxicab) if j != i else np.inf
        for j in range(size):
            distances[n + j] = distance_between(points[i], archive.points[j], taxicab)
        distances = np.sort(distances)
        total = 0.0
        for j in range(min(k, n - 1 + size)):
            total += distances[j]
        scores[i] = total / k
        offer(archive, points[i], scores[i])


@kernel
def distance_between(p: np.ndarray, q: np.ndarray, taxicab: bool) -> float:
    down, right = p[0] - q[0], p[1] - q[1]
    return float(abs(down) + abs(right)) if taxicab else np.sqrt(down * down + right * right)


@kernel(makes_arrays=True)  # for a moment, to assign a row
def offer(archive: Archive, point: np.ndarray, score: float) -> None:
    points, scores, entry, counts = archive
    place = counts[0]
    if place < len(scores):
        counts[0] += 1
    else:
        place = -1
        for i in range(len(scores)):
            if place < 0 or scores[i] < scores[place] or (scores[i] == scores[place] and entry[i] < entry[place]):
                place = i
        if place < 0 or score <= scores[place]:
            return
    points[place] = point
    scores[place] = score
    entry[place] = counts[1]
    counts[1] += 1


@kernel
def judge(components: np.ndarray, objectives: np.ndarray, fitness: np.ndarray, winners: np.ndarray) -> None:
    for i in range(len(fitness)):
        fitness[i] = -np.inf
        for j in range(len(objectives)):
            score = objectives[j, 0] * components[0, i] + objectives[j, 1] * components[1, i]
            if score > fitness[i]:
                fitness[i] = score
                winners[i] = j
