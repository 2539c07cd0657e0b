"""Labels of experiments in tables, figures and links: names and, if names coincide, what tells the experiments apart.

The name of a maze or an algorithm is whatever its author chose, so two of them may share one. Results are therefore
kept by experiment, and become labels only here. If no two names coincide, names are all that a label shows.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from itertools import compress

from safe.experiments.experiment import Experiment
from safe.experiments.store import sha256
from safe.maze import Maze

Label = tuple[str, str]  # of the maze, of the algorithm


def labels(experiments: Iterable[Experiment]) -> list[Label]:
    """A label for each experiment, in order, different for each: (maze, algorithm).

    If an algorithm occurs more than once on a maze, the seeds or parameters that differ stand behind its name (the
    numbers of runs, if nothing else differs). If mazes or algorithms that differ share a name, the first letters of a
    digest stand behind it.

    Examples
    --------
    >>> labels([Experiment("safe", "maze1"), Experiment("novelty", "maze1")])
    [('maze1', 'safe'), ('maze1', 'novelty')]
    >>> labels([Experiment("safe", "maze1"), Experiment("safe", "maze1", seed=1)])
    [('maze1', 'safe (seed 0)'), ('maze1', 'safe (seed 1)')]
    """
    traits = _traits(list(experiments))
    found = [(maze, algorithm) for maze, algorithm, *_ in traits]
    for name in {algorithm for _, algorithm in found}:
        alike = [index for index, (_, algorithm) in enumerate(found) if algorithm == name]
        mazes = [found[index][0] for index in alike]
        if len(set(mazes)) < len(mazes):
            differences = _differences([traits[index][2:] for index in alike])
            for index, maze, difference in zip(alike, mazes, differences, strict=True):
                found[index] = maze, f"{name} ({difference})"
    return found


def row_labels(experiments: Iterable[Experiment]) -> list[str]:
    """A label for each experiment, in order, different for each: the maze's, with the algorithm's if that is needed.

    Examples
    --------
    >>> row_labels([Experiment("safe", "maze1"), Experiment("safe", "maze2")])
    ['maze1', 'maze2']
    >>> row_labels([Experiment("safe", "maze1"), Experiment("novelty", "maze1")])
    ['maze1: safe', 'maze1: novelty']
    """
    found = labels(experiments)
    mazes = [maze for maze, _ in found]
    return [f"{maze}: {algorithm}" if mazes.count(maze) > 1 else maze for maze, algorithm in found]


def maze_labels(mazes: Iterable[Maze]) -> list[str]:
    """A label for each maze, in order: its name, with a digest behind it if other mazes share the name.

    Examples
    --------
    >>> maze_labels([Maze.from_drawing("S.G", "mine"), Maze.from_drawing("SG", "mine")])
    ['mine (digest 45d430)', 'mine (digest 1453e2)']
    """
    return _with_digests([(maze.name, maze.drawing()) for maze in mazes])


def differences(experiments: Iterable[Experiment]) -> list[str]:
    """What tells experiments apart, in words, for each in order; nothing for a single one.

    Examples
    --------
    >>> differences([Experiment("safe", "maze1"), Experiment("novelty", "maze1", seed=7)])
    ['safe, seed 0', 'novelty, seed 7']
    """
    return _differences(_traits(list(experiments)))


def _traits(experiments: Sequence[Experiment]) -> list[tuple[str, ...]]:
    """All that may tell experiments apart: maze, algorithm, parameters, seed and, if these are the same, runs."""
    mazes = maze_labels(experiment.maze for experiment in experiments)
    algorithms = _with_digests([(e.algorithm.name, e.content["algorithm"]) for e in experiments])
    traits = [
        (
            *names,
            *(f"{name} = {value}" for name, value in vars(experiment.parameters).items()),
            f"seed {experiment.seed}",
        )
        for *names, experiment in zip(mazes, algorithms, experiments, strict=True)
    ]
    if len(set(traits)) < len(traits):
        traits = [(*of_one, f"{e.runs} runs") for of_one, e in zip(traits, experiments, strict=True)]
    return traits


def _differences(traits: Sequence[Sequence[str]]) -> list[str]:
    differs = [len(set(of_all)) > 1 for of_all in zip(*traits, strict=True)]
    return [", ".join(compress(of_one, differs)) for of_one in traits]


def _with_digests(named: Sequence[tuple[str, object]]) -> list[str]:
    """Names, with a digest of the content behind each that stands for several contents."""
    digests = [sha256(json.dumps(content))[:6] for _, content in named]
    names = [name for name, _ in set(zip((name for name, _ in named), digests, strict=True))]
    return [
        f"{name} (digest {digest})" if names.count(name) > 1 else name
        for (name, _), digest in zip(named, digests, strict=True)
    ]
