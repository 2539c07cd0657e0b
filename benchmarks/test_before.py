"""This tree beside an earlier one, BEFORE, in turn and in new processes: what has become faster for those who wait.

`ratio` is the median, over pairs, of the processor time of this tree over that of the earlier one. The earlier tree
comes from the history of the repository; another commit is named by BEFORE in the environment.
"""

import os
import statistics
import subprocess
import sys
import tarfile
from io import BytesIO
from pathlib import Path

import pytest

BEFORE = os.environ.get("BEFORE", "5c1b653")  # the first tree that could compare mazes and kinds of coevolution
ROOT = Path(__file__).parent.parent
PAIRS, COLD_PAIRS = 7, 3
COLD = "first run, not compiled"
WARM = "import time, safe; from safe import Experiment, Parameters, evolve, run; evolve('maze1', 'safe', 1)\n"
EXPERIMENTS = """
began = time.process_time()
for maze in "maze1", "maze2":
    for algorithm in "standard", "novelty", "safe", "fixed", "random":
        run(Experiment(algorithm, maze, RUNS), progress=False)
print(time.process_time() - began)
"""
FEW_RUNS = """
began = time.process_time()
for seed in range(RUNS):
    evolve("maze2", ALGORITHM, seed, Parameters(success_distance=0))
print(time.process_time() - began)
"""
FROM_START = "\nimport time; print(time.process_time())"
STAGES = {
    "import safe": "import safe" + FROM_START,
    "import safe, and load a maze": "import safe; safe.load_maze('maze1')" + FROM_START,
    COLD: "import safe; safe.evolve('maze1', 'safe', 1, safe.Parameters(generations=2))" + FROM_START,
    "ten runs of novelty search on maze2": WARM + FEW_RUNS.replace("ALGORITHM", "'novelty'"),
    "ten runs of SAFE on maze2": WARM + FEW_RUNS.replace("ALGORITHM", "'safe'"),
    "ten runs of each of the paper's experiments": WARM + EXPERIMENTS,
}


@pytest.fixture(scope="module")
def before(tmp_path_factory):
    """The folder of the earlier tree."""
    archive = subprocess.run(["git", "archive", BEFORE, "safe"], cwd=ROOT, check=True, capture_output=True).stdout
    folder = tmp_path_factory.mktemp("before")
    with tarfile.open(fileobj=BytesIO(archive)) as files:
        files.extractall(folder, filter="data")
    return folder


@pytest.mark.parametrize("stage", STAGES)
def test_before(request, benchmark, measure, sized, tmp_path_factory, stage):
    program = STAGES[stage].replace("RUNS", str(sized(10, check=1)))

    def seconds(tree):
        settings = {"PYTHONPATH": str(tree)}
        if stage == COLD and benchmark.enabled:
            settings["NUMBA_CACHE_DIR"] = str(tmp_path_factory.mktemp("cache"))
        command = [sys.executable, "-P", "-c", program]
        return float(subprocess.run(command, env=os.environ | settings, check=True, capture_output=True).stdout)

    if not benchmark.enabled:  # if benchmarks are only checked, the history may be missing
        assert measure("before", lambda: seconds(ROOT)) > 0
        return
    trees = request.getfixturevalue("before"), ROOT
    for tree in trees:
        seconds(tree)  # which compiles what is kept
    number = COLD_PAIRS if stage == COLD else PAIRS
    pairs = measure("before", lambda: [[*map(seconds, trees)] for _ in range(number)], once=True, stage=stage)
    earlier, now = map(statistics.median, zip(*pairs, strict=True))
    ratio = statistics.median(mine / theirs for theirs, mine in pairs)
    benchmark.extra_info.update(before=earlier, now=now, ratio=ratio)
