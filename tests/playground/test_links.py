import pandas as pd
import pytest

import safe
from safe.playground import links
from safe.playground.address import run_address
from tests.helpers.results import mazes_of_one_name, runs, seeds, values_of_k

SMALL = safe.Parameters(population=4, elites=0, generations=1)


def results_of(*experiments):
    """Made-up runs: each experiment comes with the success of its runs."""
    return {
        safe.Experiment(algorithm, maze, len(success), seed, SMALL): pd.DataFrame(
            {"run": range(len(success)), "success": success}
        )
        for algorithm, maze, seed, success in experiments
    }


def test_a_replay_is_of_the_first_run_that_succeeded_or_else_of_the_first():
    results = results_of(("safe", "maze1", 0, [False, False, True, True]), ("random", "maze1", 0, [False, False]))
    solved, unsolved = results
    assert links.replays(results) == [
        ("safe: run 2", run_address(solved, 2)),
        ("random: run 0", run_address(unsolved, 0)),
    ]
    assert links.replays({}) == []


@pytest.mark.parametrize(
    ("others", "texts"),
    [
        ([], ["run 0"]),
        ([("safe", "maze2", 0, [True])], ["maze1: run 0", "maze2: run 0"]),
        ([("safe", "maze1", 7, [False, True])], ["seed 0: run 0", "seed 7: run 1"]),
        ([("novelty", "maze2", 0, [True])], ["maze1, safe: run 0", "maze2, novelty: run 0"]),
    ],
)
def test_the_text_of_a_replay_says_what_experiments_differ_in(others, texts):
    results = results_of(("safe", "maze1", 0, [True]), *others)
    assert [text for text, _ in links.replays(results)] == texts


def test_each_row_leads_to_its_own_experiments():
    results = results_of(*((a, m, 0, [False, True]) for m in ("maze1", "maze2") for a in ("novelty", "safe")))
    novelty1, safe1, _, safe2 = results
    assert links.replays_of_rows([[safe2], [novelty1, safe1], []], results) == [
        [("run 1", run_address(safe2, 1))],
        [("novelty: run 1", run_address(novelty1, 1)), ("safe: run 1", run_address(safe1, 1))],
        [],
    ]


@pytest.mark.parametrize("make", [mazes_of_one_name, values_of_k, seeds])
def test_each_row_leads_to_its_own_experiment_if_names_coincide(make):
    """Regression: a row led to all experiments of its names."""
    experiments, _, _ = make()
    results = {e: runs(1, number, [0]).sort_index(ascending=False) for number, e in enumerate(experiments, start=1)}
    rows = links.replays_of_rows([[e] for e in results], results)
    assert rows == [[("run 0", run_address(e, 0))] for e in experiments]
    together = links.replays(results)
    assert [address for _, address in together] == [run_address(e, 0) for e in experiments]
    assert len({text for text, _ in together}) == len(experiments)
