"""The cost of the paper's ten experiments, with RUNS runs of each (500), and of their first runs in the
straightforward version.
"""

import os
import sys
import time

import pytest

import safe
from benchmarks import straightforward
from safe import Experiment, Parameters
from safe.companion import paper

RUNS = int(os.environ.get("RUNS", 500))
STRAIGHTFORWARD_RUNS = 2  # one takes some seconds

experiments = pytest.mark.parametrize(
    ("algorithm", "maze"), [(algorithm, maze) for maze in ("maze1", "maze2") for algorithm in paper.ALGORITHMS]
)


@experiments
@pytest.mark.benchmark(timer=time.perf_counter)
def test_paper(benchmark, measure, sized, algorithm, maze):
    experiment = Experiment(algorithm, maze, RUNS, parameters=Parameters(generations=sized(500, check=3)))
    safe.evolve(maze, algorithm, seed=0, parameters=Parameters(generations=2))  # compiles
    started = time.process_time()  # of all threads together
    measure(
        "paper",
        safe.run,
        lambda: (experiment, None, None, False),
        once=True,
        algorithm=algorithm,
        maze=maze,
        runs=RUNS,
    )
    benchmark.extra_info["core_seconds"] = time.process_time() - started
    benchmark.extra_info["peak_megabytes"] = peak_megabytes()


def peak_megabytes():
    """The most memory that this process has used so far."""
    if sys.platform == "win32":
        import psutil  # comes with ipykernel

        return psutil.Process().memory_info().peak_wset / 2**20
    import resource  # Unix alone has it

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (2**20 if sys.platform == "darwin" else 2**10)


@experiments
def test_paper_straightforward(benchmark, measure, sized, algorithm, maze):
    experiment = Experiment(algorithm, maze, parameters=Parameters(generations=sized(500, check=3)))

    def runs(evolve):
        started = time.process_time()
        seeds = map(experiment.seed_sequence, range(min(RUNS, STRAIGHTFORWARD_RUNS)))
        return [evolve(maze, algorithm, seed, experiment.parameters) for seed in seeds], time.process_time() - started

    for evolve in (safe.evolve, straightforward.evolve):
        evolve(maze, algorithm, seed=0, parameters=Parameters(generations=2))  # compiles
    expected, safe_core_seconds = runs(safe.evolve)
    got, core_seconds = measure(
        "paper: straightforward",
        runs,
        lambda: (straightforward.evolve,),
        once=True,
        algorithm=algorithm,
        maze=maze,
        runs=len(expected),
        safe_core_seconds=safe_core_seconds,
    )
    assert got == expected  # the same runs, to the last bit
    benchmark.extra_info["core_seconds"] = core_seconds
