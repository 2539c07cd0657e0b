"""The time to a first result: in a new Python process, without a cache of compiled functions and with one."""

import os
import subprocess
import sys
import time

import pytest

FIRST_RUN = "import safe; safe.evolve('maze1', 'safe', 1, safe.Parameters(generations=2))"


@pytest.fixture(scope="module")
def cache_folder(tmp_path_factory):
    return tmp_path_factory.mktemp("cache")


@pytest.mark.benchmark(timer=time.perf_counter)
@pytest.mark.parametrize("stage", ["without compiled cache", "with compiled cache", "import safe"])
def test_first_use(benchmark, measure, cache_folder, stage):
    # if benchmarks are only checked, the usual cache will do
    environment = os.environ | ({"NUMBA_CACHE_DIR": str(cache_folder)} if benchmark.enabled else {})
    command = [sys.executable, "-c", "import safe" if stage == "import safe" else FIRST_RUN]
    once = stage == "without compiled cache"
    measure("first use", lambda: subprocess.run(command, env=environment, check=True), once=once, stage=stage)
