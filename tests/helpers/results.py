"""Results of experiments that were never run."""

import numpy as np
import pandas as pd

import safe


def runs(successes, n, generations=(), **columns):
    success = np.arange(n) < successes
    generation = np.full(n, 499)
    generation[: len(generations)] = generations
    return pd.DataFrame({"run": np.arange(n), "success": success, "generation": generation, **columns})


def experiment(maze, algorithm, **options):
    return safe.Experiment(algorithm, maze, **options)


# Experiments whose names coincide, with the labels that tell them apart


def mazes_of_one_name():
    mazes = [safe.Maze.from_drawing(drawing, "maze") for drawing in ("S.G", "G.S")]
    return [experiment(maze, "safe") for maze in mazes], r"maze \(digest ......\)", "safe"


def values_of_k():
    values = [experiment("maze1", "safe", parameters=safe.Parameters(k=k)) for k in (5, 15, 30)]
    return values, "maze1", r"safe \(k = \d+\)"


def seeds():
    return [experiment("maze1", "safe", seed=seed) for seed in (0, 1)], "maze1", r"safe \(seed [01]\)"
