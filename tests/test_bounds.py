"""The tests of the kernels once more, with bounds checking: no kernel indexes outside an array."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
KERNEL_TESTS = [
    *(f"tests/test_{name}.py" for name in ("robot", "neighbours", "novelty", "judges", "operators", "evolution")),
    "tests/results/test_mechanism.py",
]


def test_kernels_with_bounds_checking():
    environment = os.environ | {"NUMBA_BOUNDSCHECK": "1", "NUMBA_CACHE_DIR": ".numba-boundscheck"}
    command = [sys.executable, "-m", "pytest", "-q", *KERNEL_TESTS]
    checked = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    assert checked.returncode == 0, checked.stdout + checked.stderr
    assert " passed" in checked.stdout
