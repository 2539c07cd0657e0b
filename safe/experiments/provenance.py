"""Where runs come from: the sources, versions, commit and platform that made them."""

from __future__ import annotations

import functools
import platform
import subprocess
from pathlib import Path
from typing import NamedTuple

import numba
import numpy as np

from safe.kernel import loaded_sources, sources
from safe.version import __version__

_PACKAGE = Path(__file__).parents[1]


class Origin(NamedTuple):
    """What made some runs. Its fields are columns of a store."""

    version: str  # of this package
    commit: str | None  # see `_commit`
    python: str
    numpy: str
    numba: str
    platform: str
    time: str | None = None  # when the first of these runs was stored, UTC; a store fills it in
    sources: str | None = None  # see `loaded_sources`; early versions did not record it


def origin() -> Origin:
    """What makes runs in this process."""
    return _origin(loaded_sources())


@functools.cache
def _origin(loaded: str | None) -> Origin:
    return Origin(
        version=__version__,
        commit=_commit() if loaded == sources() else None,  # or else git sees other files than those that are loaded
        python=platform.python_version(),
        numpy=np.__version__,
        numba=numba.__version__,
        platform=platform.platform(),
        sources=loaded,
    )


def _commit() -> str | None:
    """The commit of the checkout that holds this package, with "+" if the package has changed since; or else None."""

    def git(*arguments: str) -> str:
        command = ["git", "-C", str(_PACKAGE), *arguments]
        options = {"encoding": "utf-8", "errors": "replace", "timeout": 10}
        return subprocess.run(command, capture_output=True, check=True, **options).stdout.strip()

    try:
        git("ls-files", "--error-unmatch", "__init__.py")  # fails if the package is merely installed inside a checkout
        return git("rev-parse", "HEAD") + ("+" if git("status", "--porcelain", ".") else "")
    except (OSError, subprocess.SubprocessError):
        return None
