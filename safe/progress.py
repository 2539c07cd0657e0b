"""Progress bars, where somebody watches: in a terminal or a notebook, never in a log."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import numba.core.event
from tqdm import tqdm


def bar(description: str, progress: bool = True, **options: object) -> tqdm:
    """A tqdm bar with these options of tqdm's; silent where nobody watches, or without `progress`."""
    return tqdm(desc=description, disable=not (progress and _is_watched()), mininterval=0.5, **options)


@contextmanager
def while_compiling() -> Iterator[None]:
    """Show how many functions are compiled meanwhile; nothing where all of them come from the disk."""
    listener = _Compilations()
    try:
        with numba.core.event.install_listener("numba:compile", listener):
            yield
    finally:
        if listener.bar is not None:
            listener.bar.close()


class _Compilations(numba.core.event.Listener):
    bar: tqdm | None = None

    def on_start(self, event: numba.core.event.Event) -> None:
        if self.bar is None:
            self.bar = bar("compiling, once on this machine", bar_format="{desc}: {n_fmt} functions [{elapsed}]")

    def on_end(self, event: numba.core.event.Event) -> None:
        if self.bar is not None:  # it is, where another thread began to compile before
            self.bar.update()


def _is_watched() -> bool:
    """Does what this process writes to stderr reach a person: a terminal, or the page of a notebook?

    tqdm's own switch, TQDM_DISABLE, says that it does not.
    """
    return not os.environ.get("TQDM_DISABLE") and (sys.stderr.isatty() or "ipykernel" in sys.modules)
