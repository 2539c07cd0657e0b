"""Every benchmark works: each is called once, at a small size, without being timed."""

import os
import subprocess
import sys
from pathlib import Path


def test_every_benchmark_works():
    outcome = subprocess.run(
        [sys.executable, "-m", "pytest", "benchmarks", "--benchmark-disable", "--quiet", "-p", "no:cacheprovider"],
        cwd=Path(__file__).parent.parent,
        env=os.environ | {"RUNS": "1"},
        capture_output=True,
        text=True,
    )
    assert outcome.returncode == 0, outcome.stdout + outcome.stderr
