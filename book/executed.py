"""Executed copies of the notebooks: how the book recognises stale ones, and reads the others.

Notebooks are committed without outputs. `book/execute.py` executes each into the folder `executed`, and stamps the
copy's metadata with the digests of the notebook, of the package and of the measurements, with the parameters, and with
the versions of Python and of the packages that the results depend on. As a Sphinx extension, this module substitutes
the executed copy when Sphinx reads a notebook, so that links to the source still lead to the clean notebook. It stops
the build if a copy is missing or stale.
"""

from __future__ import annotations

import hashlib
import json
import os
import platform
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING

from sphinx.errors import ExtensionError

from isolated import ROOT
from safe.companion.project import MEASUREMENTS

if TYPE_CHECKING:  # those who execute notebooks need not wait for the rest of Sphinx
    from sphinx.application import Sphinx
    from sphinx.util.typing import ExtensionMetadata

NOTEBOOKS = ROOT / "notebooks"
EXECUTED = ROOT / "executed"
DEPENDENCIES = ("numpy", "numba", "scipy", "statsmodels", "pandas", "matplotlib")
# of the package's files, unlike those of editors and systems
SUFFIXES = (".py", ".csv", ".xz", ".json", ".jsonl", ".maze", ".mplstyle", ".html")
STAMP = "executed_from"  # key in the metadata of an executed copy
SOLUTION = "solution"  # tag of a cell that solves an exercise
LEFT_OUT = (
    "text/csv",  # for book/tables.py alone
    "application/vnd.jupyter.widget-view+json",  # needs a kernel, and scripts from elsewhere; there is also a picture
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
    """All that the execution of a notebook with these parameters depends on, so not the code that browsers run."""
    package = hashlib.sha256()
    for file in sorted((ROOT / "safe").rglob("*")):
        is_hidden = file.name.startswith(".")
        if file.suffix in SUFFIXES and not is_hidden and "javascript" not in file.relative_to(ROOT).parts:
            package.update(f"{file.relative_to(ROOT).as_posix()}\0".encode() + file.read_bytes())
    return {
        "notebook": hashlib.sha256(notebook.read_bytes()).hexdigest(),
        "package": package.hexdigest(),
        "measurements": hashlib.sha256((ROOT / MEASUREMENTS).read_bytes()).hexdigest(),
        "packages": {"python": platform.python_version()} | {name: metadata.version(name) for name in DEPENDENCIES},
        "parameters": parameters,
    }


def what_is_wrong(notebook: Path, requested: dict[str, object]) -> str | None:
    """Why the executed copy of a notebook must not be used; None if it may.

    A copy was executed with those of the requested parameters that the notebook declares.
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
    """The numbers that notebooks export to the prose of the book: the JSON shown by their cells tagged `numbers`.

    Fractions have three digits, and a dash stands for a missing number.
    """
    numbers = {}
    for notebook in notebooks():
        for cell in json.loads((EXECUTED / notebook.name).read_text(encoding="utf-8"))["cells"]:
            if "numbers" in cell["metadata"].get("tags", []):
                for output in cell["outputs"]:
                    found = output["data"]["application/json"]
                    if twice := numbers.keys() & found.keys():
                        names = ", ".join(sorted(twice))
                        raise ExtensionError(f"{notebook.name} must export numbers by new names; got {names} again")
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
            if SOLUTION in cell["metadata"].get("tags", []):
                cell["metadata"]["mystnb"] = {
                    "code_prompt_show": "Show the solution",
                    "code_prompt_hide": "Hide the solution",
                }
            for output in cell.get("outputs", []):
                for kind in LEFT_OUT:
                    output.get("data", {}).pop(kind, None)
        source[0] = json.dumps(notebook)


def setup(app: Sphinx) -> ExtensionMetadata:
    app.connect("config-inited", _check_and_collect)
    app.connect("source-read", _swap_in)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
