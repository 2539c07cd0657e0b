"""How the cost grows with the sizes that a user can set: populations, archives, paths, mazes, k, experiments.

`kernel` names what is timed, as in the group "part", or a function of the package. The group "stored runs" is about
stores of up to a million runs: `bytes` is the size of one, `memory` how much more memory its tables took at most, over
the memory of the tables.
"""

import subprocess
import sys
from functools import cache

import numpy as np
import pytest

import safe
from benchmarks.workloads import SEED, workload
from safe import Experiment, Maze, Parameters, Run
from safe.experiments.provenance import origin
from safe.experiments.store import Store

TINY = Parameters(population=10, objectives=10, generations=2, archive=10)
EXPERIMENTS = 10  # that share a store
SAMPLE = 10
MEMORY = """
import re, resource, sys
from pathlib import Path
import safe
from benchmarks.test_growth import experiments_of
path, size = sys.argv[1], int(sys.argv[2])
def peak():  # in bytes; on Linux `resource` would begin with that of the process which started this one
    status = Path("/proc/self/status")
    if status.exists():
        return 1024 * int(re.search("VmHWM:[^0-9]*([0-9]+)", status.read_text()).group(1))
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
safe.run(experiments_of(EXPERIMENTS)[0], path, progress=False)
before = peak()
tables = [safe.run(experiment, path, progress=False) for experiment in experiments_of(size)]
print((peak() - before) / sum(table.memory_usage().sum() for table in tables))
""".replace("EXPERIMENTS", str(EXPERIMENTS))


@cache
def square_maze(side, walls):
    """A maze with a border, a start in the middle, and as many straight walls at random, a fifth of a side long."""
    rng = np.random.default_rng(SEED)
    cells = np.pad(np.zeros((side - 2, side - 2), dtype=bool), 1, constant_values=True)
    for row, column in rng.integers(side, size=(walls, 2)):
        if rng.random() < 0.5:
            cells[row, column : column + side // 5] = True
        else:
            cells[row : row + side // 5, column] = True
    start, goal = (side // 2, side // 2), (side // 8, side // 8)
    for row, column in (start, goal):
        cells[row - 1 : row + 2, column - 1 : column + 2] = False
    return Maze(cells, start, goal, "empty" if walls == 0 else "walls at random")


@pytest.fixture
def measure_part(measure):
    """Time a part of a generation, of size `size` of `what`."""

    def measure_part(what, size, part, maze, algorithm, parameters, **more):
        function, arguments, generations = workload(part, maze, algorithm, parameters, **more)
        about = {"algorithm": algorithm, "maze": getattr(maze, "name", maze), "generations": generations}
        measure("growth", function, arguments, what=what, size=size, kernel=part, **about)

    return measure_part


@pytest.mark.parametrize("algorithm", ["novelty", "safe"])
@pytest.mark.parametrize("size", [50, 100, 200, 500, 1000, 2000, 5000])
def test_population(measure_part, sized, algorithm, size):
    """Objective functions are as many as solutions, the archives those of the paper."""
    n = sized(size, check=50)
    parameters = Parameters(population=n, objectives=n, generations=sized(20, check=2))
    measure_part("population", size, "all", "maze1", algorithm, parameters)


@pytest.mark.parametrize("part", ["novelty", "objective functions"])
@pytest.mark.parametrize("size", [0, 100, 1000, 10_000, 100_000])
def test_archive(measure_part, sized, part, size):
    """The same generations of one run for all sizes, after all before were offered to an archive of that size."""
    first = sized(500, check=2)
    run = Parameters(generations=first + sized(20, check=2))
    timed_with = Parameters(archive=sized(size, check=100))
    measure_part("archive", size, part, "maze1", "safe", run, first=first, timed_with=timed_with)


@pytest.mark.parametrize("part", ["novelty", "objective functions"])
@pytest.mark.parametrize("size", [1, 5, 15, 50, 100, 200])
def test_k(measure_part, sized, part, size):
    first = sized(100, check=2)
    run = Parameters(generations=first + sized(20, check=2))
    measure_part("k", size, part, "maze1", "safe", run, first=first, timed_with=Parameters(k=size))


@pytest.mark.parametrize("maze", ["maze1", "empty"])
@pytest.mark.parametrize("size", [30, 300, 3000, 30_000])
def test_steps(measure_part, sized, maze, size):
    maze = "maze1" if maze == "maze1" else square_maze(sized(1000, check=50), 0)
    parameters = Parameters(steps=sized(size, check=300), generations=sized(20, check=2))
    measure_part("steps", size, "robot", maze, "novelty", parameters)


@pytest.mark.parametrize("part", ["robot", "novelty"])
@pytest.mark.parametrize("walls", [0, 25])
@pytest.mark.parametrize("size", [20, 50, 100, 200, 500, 1000])
def test_maze(measure_part, sized, part, walls, size):
    """As many steps as in the paper, for its size: three times the side. In an empty maze robots end far apart."""
    maze = square_maze(sized(size, check=50), walls)
    parameters = Parameters(steps=3 * size, generations=sized(20, check=2))
    measure_part("maze", size, part, maze, "novelty", parameters)


@pytest.mark.parametrize("size", [10, 100, 1000, 10_000, 100_000])
def test_runs(measure, sized, size):
    """Runs so short that the time is that of their surroundings: seeds, threads, store, table."""
    experiment = Experiment("safe", "maze1", sized(size, check=10), parameters=TINY)
    safe.evolve("maze1", "safe", seed=0, parameters=TINY)  # compiles
    arguments = experiment, None, None, False
    measure("growth", safe.run, lambda: arguments, once=True, what="runs", size=size, kernel="safe.run", generations=2)


def experiments_of(size):
    """Experiments that together have so many runs."""
    return [Experiment("safe", "maze1", size // EXPERIMENTS, seed, TINY) for seed in range(EXPERIMENTS)]


@pytest.fixture(scope="module")
def stored(tmp_path_factory):
    """Makes stores of so many runs, all made up but those that `safe.verify` draws with the seed SEED."""

    @cache
    def stored(size):
        rng, path = np.random.default_rng(SEED), tmp_path_factory.mktemp("stored") / "s.sqlite"
        drawn = set(np.random.default_rng(SEED).choice(size, min(SAMPLE, size), replace=False).tolist())
        with Store.for_writing(path) as store:
            for place, experiment in enumerate(experiments_of(size)):
                entry, runs = store.entry(experiment.content, "safe", "maze1"), []
                for number in range(experiment.runs):
                    if place * experiment.runs + number in drawn:
                        run = safe.evolve("maze1", "safe", experiment.seed_sequence(number), TINY)
                    else:
                        run = Run(
                            False, 1, 25, tuple(rng.uniform(-1, 1, 16).tolist()), tuple(rng.random(2).tolist()), 20
                        )
                    runs.append((number, run, rng.random()))
                store.add(entry, origin(), runs)
        return path

    return stored


@pytest.mark.parametrize("what", ["table", "tables", "verify"])
@pytest.mark.parametrize("size", [1000, 10_000, 100_000, 1_000_000])
def test_stored_runs(measure, sized, stored, size, what):
    """One experiment's table, those of all ten, and a verified sample."""
    runs = sized(size, check=100)
    path, experiments = stored(runs), experiments_of(runs)

    def tables(number):
        return [safe.run(experiment, path, None, False) for experiment in experiments[:number]]

    function, arguments = {
        "table": (tables, (1,)),
        "tables": (tables, (EXPERIMENTS,)),
        "verify": (safe.verify, (path, SAMPLE, SEED, False)),
    }[what]
    about = {"bytes": path.stat().st_size}
    if what == "tables" and sys.platform != "win32":
        command = [sys.executable, "-c", MEMORY, path, str(runs)]
        about["memory"] = float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    measure("stored runs", function, lambda: arguments, once=size > 10_000, what=what, size=size, **about)
