"""Kernels that are forked are as those that Jupyter starts."""

import json
import subprocess
import sys
import time
from pathlib import Path

import pytest

BOOK = Path(__file__).parents[2] / "book"
NOTICED = """
import json, os, signal, sys
import matplotlib.pyplot as plt
import numpy as np
OWN = "JPY_PARENT_PID", "JUPYTER_PATH", "JUPYTER_CONFIG_DIR", "IPYTHONDIR"  # folders made for each
print(json.dumps({
    "path": sys.path,
    "flags": str(sys.flags),
    "folder": os.getcwd(),
    "environment": {name: value for name, value in os.environ.items() if name not in OWN},
    "backend": plt.get_backend(),
    "settings": str(dict(plt.rcParams)),
    "random": np.random.random(),
    "names": [name for name in globals() if not name.startswith("_")],
    "interrupted by": str(signal.getsignal(signal.SIGINT)).split(" at ")[0],
    "children": str(signal.getsignal(signal.SIGCHLD)),
    "own session": os.getsid(0) == os.getpid(),
}))
"""
CLIENT = """
import json, sys
import nbformat
from nbclient import NotebookClient
sys.path.insert(0, sys.argv[1])
from isolated import isolated
from kernels import fork_kernels
code, is_forked = json.loads(sys.argv[2])
notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(code)])
with isolated():
    if is_forked:
        fork_kernels()
    NotebookClient(notebook).execute()
print(notebook.cells[0].outputs[0].text)
"""

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere no kernel is forked")


def started(folder, code, is_forked=True):
    """A process that executes some code in a kernel, and prints what the code prints."""
    order = json.dumps([code, is_forked])
    return subprocess.Popen([sys.executable, "-c", CLIENT, BOOK, order], cwd=folder, stdout=subprocess.PIPE, text=True)


def test_what_a_notebook_can_notice_is_the_same(tmp_path):
    forked, usual = (started(tmp_path, NOTICED, is_forked) for is_forked in (True, False))
    noticed, expected = (json.loads(process.communicate()[0]) for process in (forked, usual))
    assert noticed.pop("random") != expected.pop("random")
    assert noticed == expected


def test_a_kernel_ends_with_the_program_that_needs_it(tmp_path):
    file = tmp_path / "pid"
    code = f"import os, pathlib, time\npathlib.Path({str(file)!r}).write_text(str(os.getpid()))\ntime.sleep(99)"
    process = started(tmp_path, code)
    while not (file.exists() and file.read_text()):
        assert process.poll() is None
        time.sleep(0.1)
    process.kill()
    process.communicate()
    while Path(f"/proc/{file.read_text()}").exists():
        time.sleep(0.1)
