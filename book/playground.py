"""The playground's page: its modules as one script, which works in a page opened as a file, and its stylesheet."""

from __future__ import annotations

from pathlib import Path

from sphinx.application import Sphinx
from sphinx.util.typing import ExtensionMetadata

from safe import bundle

PAGE = "book/playground"
SCRIPT = "playground/bundle.js"  # in _static, as is the stylesheet
STYLE = "playground/playground.css"
_START = """
(() => {
  const { mount, makeWorker } = playground();
  mount(document.getElementById("playground"), { makeWorker, address: window });
})();
"""


def _write_script(app: Sphinx) -> None:
    if app.builder.format == "html":
        script = Path(app.outdir, "_static", SCRIPT)
        script.parent.mkdir(parents=True, exist_ok=True)
        script.write_text(bundle.script() + _START, encoding="utf-8")


def _read_again(app: Sphinx, env, added: set, changed: set, removed: set) -> list[str]:
    """Where no page has changed Sphinx copies no static file, and the page would name the script of before."""
    return [PAGE]


def _load(app: Sphinx, pagename: str, templatename: str, context: dict, doctree) -> None:
    if pagename == PAGE:
        app.add_js_file(SCRIPT, defer="defer")
        app.add_css_file(STYLE)


def setup(app: Sphinx) -> ExtensionMetadata:
    app.connect("builder-inited", _write_script)  # before pages are written, which name the script with its checksum
    app.connect("env-get-outdated", _read_again)
    app.connect("html-page-context", _load)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
