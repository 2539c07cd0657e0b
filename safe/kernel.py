"""How the compiled functions of this package are compiled, and how a user sees that they are."""

from __future__ import annotations

import copy
import functools
import gc
import glob
import hashlib
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import numba
import numba.core.event
import numpy as np
from numba.core.caching import CompileResultCacheImpl, FunctionCache
from tqdm import tqdm

_PACKAGE = Path(__file__).parent


def kernel(function: Callable | None = None, *, inline: str = "never", makes_arrays: bool = False) -> Callable:
    """Compile `function` with numba: no Python inside, GIL released, kept on disk, IEEE arithmetic.

    `fastmath` stays off: it lets a compiler reorder sums, so that a run would differ between machines.
    Division is numpy's, which raises no error: with Python's, numba would count references in inner loops.
    A kernel that another kernel calls is compiled for it alone: what a call from Python needs, above all the conversion
    of arrays, would take a seventh of the time. It is compiled for Python, too, once Python calls it.
    Only a kernel that makes arrays (as the assignment of a row does), or returns one, needs to count the references to
    arrays (`makes_arrays`). Counting costs time to compile and, in inner loops, to run. Calls from Python always count,
    since they take arrays from it.
    What is compiled in one place of a program with many arrays had better be inlined ("always"): by itself, it would be
    optimised once more in each function that leads to it.
    An argument that is a literal, or a variable set to one, has a type of its own, for which numba compiles a function
    once more; `np.int64(0)` has not.
    With NUMBA_DISABLE_JIT=1 in the environment functions stay plain Python, for a debugger to step through.
    """
    if function is None:
        return functools.partial(kernel, inline=inline, makes_arrays=makes_arrays)
    if numba.config.DISABLE_JIT:
        return function
    options = {"nogil": True, "error_model": "numpy", "inline": inline, "no_cfunc_wrapper": True}
    compiled = numba.njit(_nrt=True, **options)(function)
    inner = numba.njit(_nrt=makes_arrays, no_cpython_wrapper=True, **options)(function)
    inner.compile = functools.partial(_compile_inner, inner)
    compiled.get_call_template, compiled.get_overload = inner.get_call_template, inner.get_overload
    try:
        compiled._cache = _KernelCache(function)  # as numba's own `cache=True` does with a cache of its own
        inner._cache = compiled._cache.for_inner()
    except RuntimeError:  # no folder for it is writable
        _KernelCache.fault = "no folder is writable for its cache"
    return compiled


def _compile_inner(inner: numba.core.dispatcher.Dispatcher, signature: tuple) -> object:
    """Compile for a call from another kernel, as numba does, but say which kernel must be marked."""
    try:
        return type(inner).compile(inner, signature)
    except numba.core.errors.NumbaError as error:
        if any(symptom in str(error) for symptom in ("NRT required", "Only accept returning of array")):
            name = inner.py_func.__name__
            raise numba.core.errors.TypingError(f"{name} makes an array: mark it @kernel(makes_arrays=True)") from error
        raise


def sources() -> str:
    """The SHA-256 of all source files of the science, in hexadecimal: kernels are made of nothing else.

    It is read anew for each kernel, since an edited module may be reloaded in a session.
    """
    digest = hashlib.sha256()
    for file in sorted(_PACKAGE.glob("*.py")):
        digest.update(f"{file.name}\0".encode() + file.read_bytes() + b"\0")
    return digest.hexdigest()


_LOADED = {sources()}


def loaded_sources() -> str | None:
    """The digest of the sources that this process has loaded, whatever has become of the files since.

    None if kernels of different sources were loaded: a module was edited and reloaded.
    """
    return next(iter(_LOADED)) if len(_LOADED) == 1 else None


class _SourcesInTheName(CompileResultCacheImpl):
    """Names the files of a cache after all the sources of kernels.

    numba looks only at the file of the function itself, so without this an edit to robot.py would
    leave evolution.py running the old robot (https://github.com/numba/numba/issues/1833).
    """

    def get_filename_base(self, fullname: str, abiflags: str) -> str:
        digest = sources()
        _LOADED.add(digest)
        return f"{super().get_filename_base(fullname, abiflags)}-{digest[:16]}"


class _KernelCache(FunctionCache):
    """Compiled functions on disk: a convenience, so whatever is wrong with it, they are compiled anew."""

    _impl_class = _SourcesInTheName
    fault: str | None = None  # why what is compiled is not kept
    is_inner = False  # is it for calls from other kernels?

    def for_inner(self) -> _KernelCache:
        """The same cache, of the same function as other kernels call it."""
        inner = copy.copy(self)
        inner.is_inner = True
        return inner

    def _index_key(self, *arguments: object) -> tuple:
        return *super()._index_key(*arguments), self.is_inner

    def load_overload(self, *arguments: object) -> object:
        try:
            return super().load_overload(*arguments)
        except Exception:  # a damaged file can raise anything
            with suppress(OSError):
                self.flush()
            return None

    def save_overload(self, *arguments: object) -> None:
        try:
            super().save_overload(*arguments)
            self._remove_others()
        except OSError as error:
            _KernelCache.fault = f"its cache cannot be written ({error.strerror})"

    def _remove_others(self) -> None:
        """Remove the files of this function that were made of other sources."""
        function, *_, own = self._impl.filename_base.split("-")  # between them the line and the version of Python
        for file in Path(self.cache_path).glob(f"{glob.escape(function)}-*.nb[ci]"):
            if f"-{own}." not in file.name:
                with suppress(OSError):  # another process has removed it or, on Windows, is reading it
                    file.unlink()


@kernel
def index(n: int) -> int:
    """An index that cannot be negative: for any other, numba checks first whether it counts from the end."""
    return np.uint64(n)


@contextmanager
def while_compiling() -> Iterator[None]:
    """Show how many functions are compiled inside this context; nothing if all of them come from the disk.

    Meanwhile no garbage is collected: numba keeps most objects that it makes, and a search of them takes long.
    """
    listener = _CompilationListener()
    was_collecting = gc.isenabled()
    gc.disable()
    try:
        with numba.core.event.install_listener("numba:compile", listener):
            yield
    finally:
        if was_collecting:
            gc.enable()
        if listener.bar is not None:
            listener.bar.close()


class _CompilationListener(numba.core.event.Listener):
    bar: tqdm | None = None

    def on_start(self, event: numba.core.event.Event) -> None:
        if self.bar is None:
            self.bar = tqdm(
                desc=self._description(),
                bar_format="{desc}: {n_fmt} functions [{elapsed}]",
                disable=not is_watched(),
                mininterval=0.5,
            )

    def on_end(self, event: numba.core.event.Event) -> None:
        if self.bar is not None:  # it is None if another thread began to compile before this context
            self.bar.set_description_str(self._description(), refresh=False)
            self.bar.update()

    def _description(self) -> str:
        fault = _KernelCache.fault
        return f"compiling, in every process anew, since {fault}" if fault else "compiling, once on this machine"


def is_watched() -> bool:
    """Does stderr reach a person: in a terminal, or on the page of a notebook?

    tqdm's own switch, the environment variable TQDM_DISABLE, says that it does not.
    """
    return not os.environ.get("TQDM_DISABLE") and (sys.stderr.isatty() or "ipykernel" in sys.modules)
