"""The environment in which notebooks are executed and the book is built."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

BOOK = Path(__file__).parents[2] / "book"
STARTS_ANOTHER = """
import subprocess, sys
sys.path.insert(0, sys.argv[1])
from isolated import isolated
with isolated():
    subprocess.run([sys.executable, "-c", sys.argv[2]])
"""
WAITS = """
import os, time
print(os.environ["JUPYTER_PATH"], flush=True)
time.sleep(60)
"""


@pytest.mark.skipif(os.name == "nt", reason="Windows ends a process without asking it")
def test_a_request_to_terminate_ends_what_was_started(tmp_path):
    command = [sys.executable, "-c", STARTS_ANOTHER, BOOK, WAITS]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=tmp_path) as process:
        folder = Path(process.stdout.readline().strip())
        assert folder.is_dir()
        process.terminate()
        process.communicate(timeout=30)  # until nobody has its output open
    assert process.returncode == 143
    assert not folder.exists()
