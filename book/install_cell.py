"""Write into every notebook the cell that installs the package where it is missing, as in Colab.

    python book/install_cell.py

A notebook that is opened in Colab comes without the project, and so without the setting that holds the repository's
address: the cell must name it. It is the second of each notebook, after the title. As long as there is no address, it
says how to install the package. Its first line says which page of the book the notebook is, and no page shows it.
"""

from __future__ import annotations

from pathlib import Path

import nbformat
import yaml

from executed import ROOT, notebooks

ID = "install"
PAGE = "# In the book, this notebook is the page notebooks/{name}.html.\n"
TRY = """\
from importlib import import_module

try:
    import_module("safe.companion")
except ModuleNotFoundError:
"""
EXPLAIN = """\
    raise ModuleNotFoundError(
        "This kernel has no package `safe`: choose the project's .venv as "
        "kernel, or run `%pip install PATH` with the path of the project."
    ) from None"""
INSTALL = """\
    origin = "git+{address}@{branch}"
    %pip install --quiet "safe-evolution[playground] @ {{origin}}\""""


def source(address: str, branch: str) -> str:
    """The code of the cell, for a repository with this address, or for none."""
    return TRY + (INSTALL.format(address=address, branch=branch) if address else EXPLAIN)


def configured(notebook: Path) -> str:
    """The code of a notebook's cell, for the repository that _config.yml names."""
    repository = yaml.safe_load((ROOT / "_config.yml").read_text(encoding="utf-8"))["repository"]
    return PAGE.format(name=notebook.stem) + source(repository["url"], repository["branch"])


def write(notebook: Path, code: str) -> None:
    """Write the cell into a notebook, in place of one that is there."""
    content = nbformat.read(notebook, as_version=4)
    cell = nbformat.v4.new_code_cell(code, id=ID, metadata={"tags": ["remove-cell"]})
    title, *rest = (cell for cell in content.cells if cell.id != ID)
    content.cells = [title, cell, *rest]
    nbformat.write(content, notebook)


if __name__ == "__main__":
    for notebook in notebooks():
        write(notebook, configured(notebook))
