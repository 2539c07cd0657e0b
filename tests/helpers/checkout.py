"""A checkout of the repository for tests, in which they execute notebooks and build the book."""

import os
import shutil
import sqlite3
import subprocess
import sys
from contextlib import closing, contextmanager
from pathlib import Path

ROOT = Path(__file__).parents[2]
RUNS = "4"  # of each experiment
PARTS = ["_config.yml", "benchmarks", "book", "notebooks", "safe"]


@contextmanager
def locked(folder):
    """Keep all other processes that ask for it out of a folder, which need not exist yet."""
    with closing(sqlite3.connect(folder.with_suffix(".lock"), timeout=3600)) as lock:  # locks files on every system
        lock.execute("BEGIN EXCLUSIVE")
        yield


def make(folder):
    """Copy the checkout into a new folder, execute all its notebooks and build the book."""
    folder.mkdir()
    for part in PARTS:
        if (ROOT / part).is_dir():
            # with __pycache__, for the compiled kernels: copies keep the times by which numba recognises them
            shutil.copytree(ROOT / part, folder / part)
        else:
            shutil.copy(ROOT / part, folder)
    for made in (execute(folder), _call(folder, sys.executable, "book/verify.py"), build(folder)):
        assert made.returncode == 0, output_of(made)


def execute(folder, *arguments, **options):
    """Run book/execute.py in a checkout."""
    return _call(folder, sys.executable, "book/execute.py", *arguments, **options)


def build(folder, *arguments, **options):
    """Run book/build.py in a checkout."""
    return _call(folder, sys.executable, "book/build.py", *arguments, **options)


def build_for_students(folder):
    """Run book/student.py in a checkout."""
    return _call(folder, sys.executable, "book/student.py")


def _call(folder, *command, runs=RUNS, **settings):
    environment = {**os.environ, **settings, "RUNS": runs, "NO_COLOR": "1"}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)


def output_of(process):
    return process.stdout + process.stderr
