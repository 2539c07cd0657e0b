"""The playground's page: its modules as one script, which also works in a page opened as a file, and its stylesheet."""

from __future__ import annotations

from pathlib import Path

from sphinx.application import Sphinx
from sphinx.util.typing import ExtensionMetadata

from safe.playground import bundle

PAGE = "book/playground"
SCRIPT, STYLE = "playground/bundle.js", "playground/playground.css"  # in _static
_START = """
(() => {
  const element = document.getElementById("playground"); // chapters have figures instead
  if (!element) return;
  const { mount, makeWorker } = playground();
  mount(element, { makeWorker, address: window });
})();
"""


def _write_files(app: Sphinx) -> None:
    if app.builder.format == "html":
        static = Path(app.outdir, "_static")
        (static / SCRIPT).parent.mkdir(parents=True, exist_ok=True)
        (static / SCRIPT).write_text(bundle.script() + _START, encoding="utf-8")
        (static / STYLE).write_text(bundle.stylesheet(), encoding="utf-8")


def _read_again(app: Sphinx, env, added: set, changed: set, removed: set) -> list[str]:
    """If no page has changed Sphinx writes none, and this one would name the script with its old checksum."""
    return [PAGE]


def _load(app: Sphinx, pagename: str, templatename: str, context: dict, doctree) -> None:
    if pagename == PAGE:
        app.add_js_file(SCRIPT, defer="defer")
        app.add_css_file(STYLE)


def setup(app: Sphinx) -> ExtensionMetadata:
    app.connect("builder-inited", _write_files)  # before pages are written, which name the files with their checksums
    app.connect("env-get-outdated", _read_again)
    app.connect("html-page-context", _load)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
