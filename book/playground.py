"""The pages that run the playground's JavaScript: the playground, and the one that pools the runs of a class.

Each gets its modules as one script, which also works in a page opened as a file, and the playground's stylesheet.
"""

from __future__ import annotations

import json
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.util.typing import ExtensionMetadata

from safe.companion import paper
from safe.experiments.experiment import Experiment
from safe.playground import bundle

PAGE, CLASS_PAGE = "book/playground", "book/class"
SCRIPT, CLASS_SCRIPT, STYLE = "playground/bundle.js", "playground/class.js", "playground/playground.css"  # in _static
_START = """
(() => {
  const element = document.getElementById("playground"); // chapters have figures instead
  if (!element) return;
  const { mount, makeWorker } = playground();
  mount(element, { makeWorker, address: window });
})();
"""
_CLASS_START = """
(() => {
  const { mountClass, makeWorker } = playground();
  const [element, codes] = ["class", "codes"].map((id) => document.getElementById(id));
  mountClass(element, codes, { makeWorker, address: window, published: %s });
})();
"""


def _published() -> dict[str, list[int]]:
    """The successes and runs that the paper reports, by maze and algorithm."""
    counts = {}
    for maze in paper.MAZES:
        for algorithm in paper.ALGORITHMS:
            reported = paper.reported(Experiment(algorithm, maze))
            if "successes" in reported.index:
                counts[f"{maze} {algorithm}"] = reported.loc["successes", ["mean", "n"]].astype(int).tolist()
    return counts


def _write_files(app: Sphinx) -> None:
    if app.builder.format == "html":
        static = Path(app.outdir, "_static")
        texts = {
            SCRIPT: bundle.script() + _START,
            CLASS_SCRIPT: bundle.script(bundle.CLASS_ENTRIES) + _CLASS_START % json.dumps(_published()),
            STYLE: bundle.stylesheet(),
        }
        (static / SCRIPT).parent.mkdir(parents=True, exist_ok=True)
        for name, text in texts.items():
            (static / name).write_text(text, encoding="utf-8")


def _read_again(app: Sphinx, env, added: set, changed: set, removed: set) -> list[str]:
    """If no page has changed Sphinx writes none, and these would name their scripts with the old checksums."""
    return [PAGE, CLASS_PAGE]


def _load(app: Sphinx, pagename: str, templatename: str, context: dict, doctree) -> None:
    if pagename in (PAGE, CLASS_PAGE):
        app.add_js_file(SCRIPT if pagename == PAGE else CLASS_SCRIPT, defer="defer")
        app.add_css_file(STYLE)


def setup(app: Sphinx) -> ExtensionMetadata:
    app.connect("builder-inited", _write_files)  # before pages are written, which name the files with their checksums
    app.connect("env-get-outdated", _read_again)
    app.connect("html-page-context", _load)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
