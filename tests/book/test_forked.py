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
OWN = {
    "JPY_PARENT_PID", "JUPYTER_PATH", "JUPYTER_CONFIG_DIR", "IPYTHONDIR",  # of each
    "PYDEVD_USE_FRAME_EVAL",  # of the debugger, which forked kernels do without
}
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
from forked import fork_jupyters_kernels
code, is_forked, kernels = json.loads(sys.argv[2])
with isolated():
    if is_forked:
        fork_jupyters_kernels()
    for _ in range(kernels):
        notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(code)])
        NotebookClient(notebook).execute()
        print(notebook.cells[0].outputs[0].text, end="")
"""

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere no kernel is forked")


@pytest.fixture
def started(tmp_path):
    """Starts a process that executes some code in kernels, and prints what the code prints."""
    processes = []

    def started(code, is_forked=True, kernels=1):
        order = json.dumps([code, is_forked, kernels])
        command = [sys.executable, "-c", CLIENT, BOOK, order]
        processes.append(subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, text=True))
        return processes[-1]

    yield started
    for process in processes:
        process.kill()
        process.wait()
        process.stdout.close()


def test_what_a_notebook_can_notice_is_the_same(started):
    forked, usual = started(NOTICED, kernels=2), started(NOTICED, is_forked=False)
    (one, other), (expected,) = (map(json.loads, process.communicate()[0].splitlines()) for process in (forked, usual))
    assert len({noticed.pop("random") for noticed in (one, other, expected)}) == 3
    assert one == other == expected


def test_a_kernel_ends_with_the_program_that_needs_it(started, tmp_path):
    file = tmp_path / "pid"
    code = f"import os, pathlib, time\npathlib.Path({str(file)!r}).write_text(str(os.getpid()))\ntime.sleep(99)"
    process = started(code)
    wait_until(lambda: file.exists() and file.read_text())
    assert not has_ended(file.read_text())
    process.kill()
    wait_until(lambda: has_ended(file.read_text()))


def wait_until(is_so):
    deadline = time.monotonic() + 60
    while not is_so():
        assert time.monotonic() < deadline
        time.sleep(0.1)


def has_ended(pid):
    """A process that nobody has asked how it ended is still listed, as a zombie."""
    status = Path(f"/proc/{pid}/stat")
    return not status.exists() or status.read_text().rpartition(")")[2].split()[0] == "Z"
