"""How the compiled functions of this package are compiled, and how a user sees that they are."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numba
import numba.core.event
import numpy as np
from tqdm import tqdm

_PACKAGE = Path(__file__).parent


def kernel(function: Callable) -> Callable:
    """Compile `function` with numba: no Python inside, GIL released, kept on disk, IEEE arithmetic.

    `fastmath` stays off: it lets a compiler reorder sums, so that a run would differ between machines.
    Division is numpy's, which raises no error: with Python's, numba would count references in inner loops.
    With NUMBA_DISABLE_JIT=1 in the environment functions stay plain Python, for a debugger to step through.
    """
    if numba.config.DISABLE_JIT:
        return function
    compiled = numba.njit(nogil=True, cache=True, error_model="numpy")(function)
    _forget_stale_cache(compiled)
    return compiled


def _forget_stale_cache(compiled: Callable) -> None:
    """Remove a kernel's files on disk if any source file of the science is newer.

    numba looks only at the file of the function itself, so without this an edit to robot.py would
    leave evolution.py running the old robot (https://github.com/numba/numba/issues/1833).
    """
    newest_source = max(source.stat().st_mtime for source in _PACKAGE.glob("*.py"))
    name = f"{Path(compiled.py_func.__code__.co_filename).stem}.{compiled.py_func.__qualname__}-"
    for index_file in Path(compiled.stats.cache_path).glob(name + "*.nbi"):
        if index_file.stat().st_mtime < newest_source:
            index_file.unlink(missing_ok=True)


@kernel
def index(n: int) -> int:
    """An index that cannot be negative: for any other, numba checks first whether it counts from the end."""
    return np.uint64(n)


@contextmanager
def while_compiling() -> Iterator[None]:
    """Show how many functions are compiled inside this context; nothing if all of them come from the disk."""
    listener = _CompilationListener()
    try:
        with numba.core.event.install_listener("numba:compile", listener):
            yield
    finally:
        if listener.bar is not None:
            listener.bar.close()


class _CompilationListener(numba.core.event.Listener):
    bar: tqdm | None = None

    def on_start(self, event: numba.core.event.Event) -> None:
        if self.bar is None:
            self.bar = tqdm(
                desc="compiling, once on this machine",
                bar_format="{desc}: {n_fmt} functions [{elapsed}]",
                disable=not is_watched(),
                mininterval=0.5,
            )

    def on_end(self, event: numba.core.event.Event) -> None:
        if self.bar is not None:  # it is None if another thread began to compile before this context
            self.bar.update()


def is_watched() -> bool:
    """Does stderr reach a person: in a terminal, or on the page of a notebook?

    tqdm's own switch, the environment variable TQDM_DISABLE, says that it does not.
    """
    return not os.environ.get("TQDM_DISABLE") and (sys.stderr.isatty() or "ipykernel" in sys.modules)
