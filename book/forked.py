"""Kernels of Jupyter that start quickly: forked from a process that has imported what the book's notebooks import.

A kernel spends most of its start on imports, the same for every notebook. So one process, this module as a program,
imports once, and is forked for each kernel. A kernel still begins without variables, and nothing it does reaches
another. In Jupyter's client a provisioner starts kernels; `fork_jupyters_kernels` makes this one the default.
"""

from __future__ import annotations

import contextlib
import functools
import gc
import importlib
import json
import os
import signal
import subprocess
import sys
import threading
from importlib.metadata import EntryPoint
from pathlib import Path

from jupyter_client.provisioning import KernelProvisionerFactory, LocalProvisioner

from isolated import ROOT

IMPORTED = (
    "ipykernel.kernelapp",
    "matplotlib.backends.backend_pdf",  # with all that fits fonts into files
    "matplotlib.backends.backend_svg",
    "safe.companion.ledger",
    "safe.companion.notebook",
    "safe.playground.widget",
)
COMPILE = """
import sys
sys.path.insert(0, sys.argv[1])
from safe.evolution import compile_kernels
compile_kernels(with_choices=sys.argv[2] == "True")
"""
_ordering = threading.Lock()  # notebooks are executed side by side
BACKEND = "module://matplotlib_inline.backend_inline"  # a kernel would name it before matplotlib is imported


def fork_jupyters_kernels() -> None:
    """Let kernels that this process starts be forked, on Linux, where that is safe: some libraries of macOS are not."""
    if sys.platform == "linux":
        factory = KernelProvisionerFactory.instance()
        factory.provisioners["forked"] = EntryPoint("forked", f"{__name__}:ForkedKernel", factory.GROUP_NAME)
        factory.default_provisioner_name = "forked"


class ForkedKernel(LocalProvisioner):
    """Starts a kernel by forking."""

    async def launch_kernel(self, cmd: list[str], **options: object) -> dict[str, object]:
        order = {
            "command": cmd[2:],
            "folder": str(options.get("cwd") or Path.cwd()),
            "environment": dict(options["env"]),
        }
        self.process = _Process(_ask(order))
        self.pid = self.process.pid
        return self.connection_info


class _Process:
    """What a provisioner uses of subprocess.Popen, for a process that is not a child of this one."""

    stdin = stdout = stderr = None

    def __init__(self, pid: int) -> None:
        self.pid = pid

    def send_signal(self, number: int) -> None:
        os.kill(self.pid, number)

    def kill(self) -> None:
        self.send_signal(signal.SIGKILL)

    def terminate(self) -> None:
        self.send_signal(signal.SIGTERM)

    def poll(self) -> int | None:
        """None as long as it runs; its status is not known to this process."""
        try:
            self.send_signal(0)
        except ProcessLookupError:
            return 0
        return None

    wait = poll  # a provisioner waits only for what has ended


@functools.cache
def _processes() -> tuple[subprocess.Popen, subprocess.Popen]:
    """The process to fork, which ends with this one, as its standard input does, and one that compiles meanwhile.

    Two processes work at any time. Kernels with choices come last, since they use the others.
    """
    of_paper = _compile(with_choices=False)
    server = subprocess.Popen(
        [sys.executable, __file__], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8"
    )
    server.stdout.readline()  # it has imported all it needs
    with_choices = _compile(with_choices=True)
    of_paper.wait()
    return server, with_choices


def _compile(with_choices: bool) -> subprocess.Popen:
    return subprocess.Popen([sys.executable, "-c", COMPILE, str(ROOT), str(with_choices)])


def _ask(order: dict[str, object]) -> int:
    """Have a kernel started; gives the number of its process."""
    with _ordering:
        server, with_choices = _processes()
        order["with_choices"] = with_choices.poll() is not None  # what needs no choices need not wait for them
        with contextlib.suppress(BrokenPipeError):
            server.stdin.write(json.dumps(order) + "\n")
            server.stdin.flush()
        answer = server.stdout.readline()
    if not answer:
        raise RuntimeError("the process that is forked for kernels has ended")
    return int(answer)


def serve() -> None:
    """Answer each order, a line of JSON, with the number of a process that has become a kernel."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the program that gives the orders
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # or else kernels that have ended would seem to live
    sys.path[0] = str(ROOT)  # where `safe` is, if this is not the checkout that is installed
    os.environ["MPLBACKEND"] = BACKEND
    sys.modules["debugpy"] = None  # a kernel would import it, which takes longer than all else, and nobody debugs
    for name in IMPORTED:
        importlib.import_module(name)
    print("imported", flush=True)
    for line in sys.stdin:
        order = json.loads(line)
        # they are on the disk by then: to compile would start threads, which no fork has
        for with_choices in {False, order.pop("with_choices")}:
            importlib.import_module("safe.evolution").compile_kernels(with_choices)
        gc.freeze()  # no kernel looks for garbage among what it was forked with
        number = os.fork()
        if number == 0:
            become_kernel(**order)
            return
        print(number, flush=True)


def become_kernel(command: list[str], folder: str, environment: dict[str, str]) -> None:
    """Do what a new process that was started by this command would do, until it ends."""
    import numpy as np
    from ipykernel import kernelapp

    os.setsid()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(2, 1)
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    del sys.path[0]
    np.random.seed()  # noqa: NPY002, or else all kernels would draw the same numbers
    sys.argv = [*command, f"--IPKernelApp.parent_handle={os.getppid()}"]  # a kernel ends when this process does
    kernelapp.launch_new_instance()


if __name__ == "__main__":
    serve()
