"""The time to a first result: in a new Python process, without a cache of compiled functions and with one.

Choices beyond the paper are compiled when a run first needs them: here after a run without them.
"""

import os
import subprocess
import sys
import time

import pytest

FIRST_RUN = "import safe; safe.evolve('maze1', 'safe', 1, safe.Parameters(generations=2))"
FIRST_CHOICES = FIRST_RUN.replace("generations=2", "generations=2, admission='random'")
COMMANDS = {
    "without compiled cache": FIRST_RUN,
    "with compiled cache": FIRST_RUN,
    "choices, not compiled": FIRST_CHOICES,
    "choices, compiled": FIRST_CHOICES,
    "import safe": "import safe",
}


@pytest.fixture(scope="module")
def cache_folder(tmp_path_factory):
    return tmp_path_factory.mktemp("cache")


@pytest.mark.benchmark(timer=time.perf_counter)
@pytest.mark.parametrize("stage", COMMANDS)
def test_first_use(benchmark, measure, cache_folder, stage):
    # if benchmarks are only checked, the usual cache will do
    environment = os.environ | ({"NUMBA_CACHE_DIR": str(cache_folder)} if benchmark.enabled else {})
    command = [sys.executable, "-c", COMMANDS[stage]]
    once = stage in ("without compiled cache", "choices, not compiled")
    measure("first use", lambda: subprocess.run(command, env=environment, check=True), once=once, stage=stage)
