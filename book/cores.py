"""Sphinx writes pages on all cores, and reads them on one: not all extensions can merge what several have read."""

from __future__ import annotations

import sys

from sphinx.application import Sphinx
from sphinx.util.typing import ExtensionMetadata

from safe.experiments.cores import available_cores


def _use_all(app: Sphinx, env) -> None:
    if sys.platform == "linux":  # where to fork is safe: some libraries of macOS are not
        app.parallel = available_cores()


def setup(app: Sphinx) -> ExtensionMetadata:
    app.connect("env-updated", _use_all)  # after the pages are read
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
