"""No build of the book that warned counts as made.

Sphinx warns while it reads a page, and does not read it again until it changes: a build that failed for a warning would
pass when it is repeated, with the fault in the book. So what a build has read is kept only if it ended without a
warning, an error or an interruption.
"""

from __future__ import annotations

import shutil
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.util.typing import ExtensionMetadata


def _mark(app: Sphinx) -> Path:
    return Path(app.doctreedir) / "made-without-a-warning"


def _forget(app: Sphinx, config) -> None:
    """Forget what an earlier build has read, unless it went well; from now on this one has not gone well."""
    if not _mark(app).exists():
        shutil.rmtree(app.doctreedir, ignore_errors=True)
    Path(app.doctreedir).mkdir(parents=True, exist_ok=True)
    _mark(app).unlink(missing_ok=True)


def _remember(app: Sphinx, exception: Exception | None) -> None:
    if exception is None and app._warncount == 0:
        _mark(app).touch()


def setup(app: Sphinx) -> ExtensionMetadata:
    app.connect("config-inited", _forget, priority=1)
    app.connect("build-finished", _remember, priority=999)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
