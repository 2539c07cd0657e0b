"""Executed copies of the notebooks: how they are made and recognised as stale, and how the book takes them in.

Notebooks are committed without outputs. `book/execute.py` executes each into the folder `executed`, with a stamp in its
metadata: the digests of the notebook, of the package and of the measurements, and the parameters. As a Sphinx
extension, this module puts the executed copy in the place of the notebook when a page is read, so that links to the
source still lead to the clean notebook, and stops the build where a copy is missing or stale.
"""

from __future__ import annotations

import hashlib
import json
import os
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.errors import ExtensionError
from sphinx.util.typing import ExtensionMetadata

ROOT = Path(__file__).parent.parent
NOTEBOOKS = ROOT / "notebooks"
EXECUTED = ROOT / "executed"
MEASUREMENTS = ROOT / "benchmarks" / "results.json"
STAMP = "executed_from"  # key in the metadata of an executed copy
LEFT_OUT = (
    "text/csv",  # for book/tables.py alone
    "application/vnd.jupyter.widget-view+json",  # needs a kernel, and scripts from elsewhere; a picture comes with it
)


def notebooks() -> list[Path]:
    """All notebooks of the book."""
    return sorted(NOTEBOOKS.glob("*.ipynb"))


def requested_parameters() -> dict[str, int]:
    """The parameters that the whole book is executed with; RUNS in the environment sets the number of runs."""
    runs = os.environ.get("RUNS", "500")
    if not runs.isdecimal() or int(runs) < 1:
        raise ValueError(f"RUNS must be an integer of at least 1; got {runs!r}")
    return {"runs": int(runs)}


def stamp(notebook: Path, parameters: dict[str, object]) -> dict[str, object]:
    """What an execution of a notebook with these parameters depends on: not on what only runs in a browser."""
    package = hashlib.sha256()
    for file in sorted((ROOT / "safe").rglob("*")):
        if file.is_file() and not {"__pycache__", "javascript"} & set(file.relative_to(ROOT).parts):
            package.update(f"{file.relative_to(ROOT)}\0".encode() + file.read_bytes())
    return {
        "notebook": hashlib.sha256(notebook.read_bytes()).hexdigest(),
        "package": package.hexdigest(),
        "measurements": hashlib.sha256(MEASUREMENTS.read_bytes()).hexdigest(),
        "parameters": parameters,
    }


def what_is_wrong(notebook: Path, requested: dict[str, object]) -> str | None:
    """Why the executed copy of a notebook cannot stand for it; None where it can.

    A copy was executed with those of the requested parameters that the notebook has.
    """
    copy = EXECUTED / notebook.name
    if not copy.exists():
        return "was not executed"
    found = json.loads(copy.read_text(encoding="utf-8"))["metadata"].get(STAMP, {})
    parameters = found.get("parameters", {})
    expected = stamp(notebook, {name: requested[name] for name in parameters if name in requested})
    if found != expected:
        changed = [key for key, value in expected.items() if found.get(key) != value]
        return f"was executed before the {' and the '.join(changed)} changed"
    return None


def collect_numbers() -> dict[str, str]:
    """What notebooks hand on to the prose of the book: the JSON shown by their cells tagged `numbers`.

    Fractions are given to three digits; what there is none of is a dash.
    """
    numbers = {}
    for notebook in notebooks():
        for cell in json.loads((EXECUTED / notebook.name).read_text(encoding="utf-8"))["cells"]:
            if "numbers" in cell["metadata"].get("tags", []):
                for output in cell["outputs"]:
                    found = output["data"]["application/json"]
                    if twice := numbers.keys() & found.keys():
                        raise ExtensionError(f"{notebook.name} hands on again: {', '.join(sorted(twice))}")
                    numbers |= {name: _in_words(value) for name, value in found.items()}
    return numbers


def _in_words(value: float | str | None) -> str:
    if value is None:
        return "–"
    is_fraction = isinstance(value, float) and not value.is_integer()
    return f"{value:.3g}" if is_fraction else f"{value:.0f}" if isinstance(value, float) else str(value)


def _check_and_collect(app: Sphinx, config) -> None:
    requested = requested_parameters()
    wrong = [f"{notebook.name} {fault}" for notebook in notebooks() if (fault := what_is_wrong(notebook, requested))]
    if wrong:
        raise ExtensionError("the book needs its notebooks executed (make execute): " + "; ".join(wrong))
    config.myst_substitutions = collect_numbers()


def _swap_in(app: Sphinx, docname: str, source: list[str]) -> None:
    path = Path(app.env.doc2path(docname))
    if path.suffix == ".ipynb" and path.parent == NOTEBOOKS:
        copy = EXECUTED / path.name
        app.env.note_dependency(str(copy))
        notebook = json.loads(copy.read_text(encoding="utf-8"))
        for cell in notebook["cells"]:
            for output in cell.get("outputs", []):
                for kind in LEFT_OUT:
                    output.get("data", {}).pop(kind, None)
        source[0] = json.dumps(notebook)


def setup(app: Sphinx) -> ExtensionMetadata:
    app.connect("config-inited", _check_and_collect)
    app.connect("source-read", _swap_in)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
