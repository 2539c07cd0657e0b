"""That the benchmarks do not rot: each is called once, at a small size, and nothing is timed."""

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

MISSING = [package for package in ("pytest_benchmark", "deap", "ribs") if find_spec(package) is None]


@pytest.mark.skipif(bool(MISSING), reason=f"only `make bench` installs {', '.join(MISSING)}")
def test_every_benchmark_works():
    outcome = subprocess.run(
        [sys.executable, "-m", "pytest", "benchmarks", "--benchmark-disable", "--quiet", "-p", "no:cacheprovider"],
        cwd=Path(__file__).parent.parent,
        env=os.environ | {"RUNS": "1"},
        capture_output=True,
        text=True,
    )
    assert outcome.returncode == 0, outcome.stdout + outcome.stderr
