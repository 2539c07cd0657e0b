"""How every compiled function of this package is compiled."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numba
import numpy as np

_PACKAGE = Path(__file__).parent


def kernel(function: Callable) -> Callable:
    """Compile `function` with numba: no Python inside, GIL released, kept on disk, IEEE arithmetic.

    `fastmath` stays off: it lets a compiler reorder sums, and then a run would differ between machines.
    Division is numpy's, which raises no error: where one might be raised, numba counts references in inner loops.
    With NUMBA_DISABLE_JIT=1 in the environment functions stay plain Python, for a debugger to step through.
    """
    if numba.config.DISABLE_JIT:
        return function
    compiled = numba.njit(nogil=True, cache=True, error_model="numpy")(function)
    _forget_stale_cache(compiled)
    return compiled


def _forget_stale_cache(compiled: Callable) -> None:
    """Remove what is kept on disk of a kernel where any source of the package is newer.

    numba looks only at the file of the function itself, so without this an edit to robot.py would
    leave evolution.py running the robot of before (https://github.com/numba/numba/issues/1833).
    """
    newest_source = max(source.stat().st_mtime for source in _PACKAGE.glob("*.py"))
    name = f"{Path(compiled.py_func.__code__.co_filename).stem}.{compiled.py_func.__qualname__}-"
    for index in Path(compiled.stats.cache_path).glob(name + "*.nbi"):
        if index.stat().st_mtime < newest_source:
            index.unlink(missing_ok=True)


@kernel
def index(n: int) -> int:
    """An index that is known not to be negative: at any other numba looks first whether it counts from the end."""
    return np.uint64(n)
