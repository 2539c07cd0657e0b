"""The runs behind the recorded ledger, kept so that a test notices a changed verdict without making them all again.

    python -m tests.helpers.record    makes tests/data/runs.npz and safe/companion/ledger.csv from results.sqlite,
                                      and safe/companion/findings.csv from the recorded evidence

The record keeps how each run ended, and its evolved values if the ledger uses them. Examine what has changed in the
ledger before you commit it: a verdict that changes is news.
"""

from pathlib import Path

import numpy as np
import pandas as pd

import safe
from safe.algorithms import COEFFICIENTS
from safe.companion import designs, findings, ledger, paper, standings
from safe.experiments.experiment import WEIGHT_COLUMNS
from safe.maze_files import load_mazes

FILE = Path(__file__).parents[1] / "data" / "runs.npz"
COLUMNS = ["generation", "distance", *COEFFICIENTS, *WEIGHT_COLUMNS]
SEEDS_OF_SECOND_LOOK = range(1, 5)


def experiments():
    """Every experiment of the ledger's first look."""
    return [safe.Experiment(algorithm, maze) for maze in paper.MAZES for algorithm in paper.ALGORITHMS]


def repetitions(experiment):
    """The experiments of its second look at one of them."""
    return [
        safe.Experiment(experiment.algorithm, experiment.maze, experiment.runs, seed) for seed in SEEDS_OF_SECOND_LOOK
    ]


def key(experiment):
    return f"{experiment.maze.name} {experiment.algorithm.name} {experiment.seed}"


def stripped(experiment, runs):
    """The part of an experiment's runs that is kept, as one array, a row for each run."""
    kept = runs.reindex(columns=COLUMNS).astype(float)
    if experiment.algorithm.name == "safe":
        kept.loc[~runs.success, [*COEFFICIENTS, *WEIGHT_COLUMNS]] = np.nan
    elif experiment.algorithm.name != "standard":
        kept[[*COEFFICIENTS, *WEIGHT_COLUMNS]] = np.nan
    return kept.to_numpy()


def recorded_runs():
    """The kept runs by key, with the columns of `safe.run` that are kept."""
    with np.load(FILE) as arrays:
        found = {}
        for name, array in arrays.items():
            runs = pd.DataFrame(array, columns=COLUMNS)
            runs = runs.astype({"generation": int, "distance": int})
            runs.insert(0, "success", runs.distance <= safe.Parameters().success_distance)
            found[name] = runs
    return found


def write(table, file):
    """Write a ledger, so that the same one always gives the same bytes."""
    table.to_csv(file, float_format="%.4g", lineterminator="\n")


def answers():
    """The answers to all questions beyond the paper."""
    runs = designs.RUNS[designs.DECIDING]
    of_mazes = findings.beyond_the_paper(load_mazes(list(paper.MAZES)), runs)
    return pd.concat([of_mazes, standings.on_unseen_mazes(runs)])


if __name__ == "__main__":
    results = {experiment: safe.run(experiment, "results.sqlite") for experiment in experiments()}
    repeats = {
        repetition: safe.run(repetition, "results.sqlite")
        for experiment in ledger.deviating_experiments(results)
        for repetition in repetitions(experiment)
    }
    everything = results | repeats
    np.savez_compressed(FILE, **{key(e): stripped(e, runs) for e, runs in everything.items()})
    write(ledger.ledger(results, repeats), ledger.RECORD)
    write(answers(), findings.RECORD)
