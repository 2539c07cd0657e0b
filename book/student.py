"""Make the student edition: the book and its notebooks without the solutions of exercises.

    python book/student.py

The pages are built in `_build/student/html`, and the notebooks written to `_build/student/notebooks`. Both come from a
copy of the project in which no solution is left, so no page, index, source or download can hold one. There, too, a
page or a notebook reads as in the book, and what has been executed is shown as it was.
"""

from __future__ import annotations

import hashlib
import re
import shutil
import subprocess
import sys
from pathlib import Path

import nbformat
import yaml

from executed import EXECUTED, ROOT, SOLUTION, STAMP, notebooks

PARTS = ("benchmarks", "book", "notebooks", "safe")
STUDENT = ROOT / "_build" / "student"
COPY = STUDENT / "project"
BLOCK = re.compile(r"^(`{3,}|:{3,})\{solution\}.*?^\1[ \t]*(?:\n+|\Z)", re.DOTALL | re.MULTILINE)


def without_solutions(text: str) -> str:
    """A page, or the text of a cell, without its `{solution}` blocks."""
    return BLOCK.sub("", text).rstrip() + "\n" if BLOCK.search(text) else text


def notebook_without_solutions(notebook: nbformat.NotebookNode) -> nbformat.NotebookNode:
    """A notebook, clean or executed, without its cells that are solutions, and without solutions in its texts."""
    notebook.cells = [cell for cell in notebook.cells if SOLUTION not in cell.metadata.get("tags", [])]
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            cell.source = without_solutions(cell.source)
    notebook.cells = [cell for cell in notebook.cells if cell.source.strip()]
    return notebook


def copy_project() -> None:
    """Copy the project without solutions, and without the address where readers would find them."""
    left_out = shutil.ignore_patterns("__pycache__", ".*")
    for part in PARTS:
        shutil.rmtree(COPY / part, ignore_errors=True)
        shutil.copytree(ROOT / part, COPY / part, ignore=left_out)
    config = yaml.safe_load((ROOT / "_config.yml").read_text(encoding="utf-8"))
    config["repository"]["url"] = ""
    (COPY / "_config.yml").write_text(yaml.safe_dump(config, sort_keys=False), encoding="utf-8")
    for page in (ROOT / "book").glob("*.md"):
        text = without_solutions(page.read_text(encoding="utf-8"))
        _write(COPY / "book" / page.name, text.encode(), page)
    (COPY / EXECUTED.name).mkdir(exist_ok=True)  # what earlier builds have written into it is needed by pages that stay
    for unneeded in (COPY / EXECUTED.name).glob("*.ipynb"):
        unneeded.unlink()
    for notebook in notebooks():
        clean = _without_solutions(notebook)
        _write(COPY / "notebooks" / notebook.name, _bytes(clean), notebook)
        executed = _without_solutions(EXECUTED / notebook.name)
        stamp = executed.metadata.get(STAMP, {})
        if stamp.get("notebook") == _digest(notebook.read_bytes()):
            stamp["notebook"] = _digest(_bytes(clean))
        _write(COPY / EXECUTED.name / notebook.name, _bytes(executed), EXECUTED / notebook.name)


def _without_solutions(file: Path) -> nbformat.NotebookNode:
    return notebook_without_solutions(nbformat.read(file, as_version=4))


def _bytes(notebook: nbformat.NotebookNode) -> bytes:
    return f"{nbformat.writes(notebook)}\n".encode()


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _write(file: Path, content: bytes, source: Path) -> None:
    """Write a file that is as old as its source, so that a build reads it again only if that has changed."""
    file.write_bytes(content)
    shutil.copystat(source, file)


def main() -> int:
    """Build the student edition; gives the exit status of the build."""
    html, made = STUDENT / "html", COPY / "_build" / "html"
    copy_project()
    shutil.rmtree(STUDENT / "notebooks", ignore_errors=True)
    (STUDENT / "notebooks").mkdir()
    for notebook in notebooks():
        shutil.copy2(COPY / "notebooks" / notebook.name, STUDENT / "notebooks")
    if html.exists():  # the build goes on from what the last one has made
        shutil.rmtree(made, ignore_errors=True)
        html.rename(made)
    status = subprocess.run([sys.executable, "book/build.py"], cwd=COPY).returncode
    if status == 0:
        made.rename(html)
    return status


if __name__ == "__main__":
    sys.exit(main())
