"""What the paper's experiments cost: core-seconds of each, and the peak memory of all.

    python benchmarks/paper.py [RUNS]        with RUNS runs of each experiment (default 50), scaled to 500

The first run of each algorithm, which may compile, is not counted.
"""

import resource
import sys
import time

import safe

PAPER_RUNS = 500


def core_seconds(experiment: safe.Experiment) -> float:
    """The processor time of all threads together."""
    started = time.process_time()
    safe.run(experiment, progress=False)
    return time.process_time() - started


def main() -> None:
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 50
    total = 0.0
    for maze in ("maze1", "maze2"):
        for algorithm in safe.ALGORITHMS:
            safe.evolve(maze, algorithm, seed=0, parameters=safe.Parameters(generations=1))
            cost = core_seconds(safe.Experiment(algorithm, maze, runs)) * PAPER_RUNS / runs
            total += cost
            print(f"{maze} {algorithm:10}{cost:8.1f} core-seconds", flush=True)
    kilobytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (1024 if sys.platform == "darwin" else 1)
    print(f"all            {total:8.1f} core-seconds; peak memory {kilobytes / 1024:.0f} MB")


if __name__ == "__main__":
    main()
