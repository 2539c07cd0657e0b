"""The student edition holds no solution, and is otherwise the same as the book."""

import html
import importlib
import json
import re
import shutil

import nbformat
import pytest

from tests.book.test_examples import PAGES
from tests.helpers.checkout import ROOT, build_for_students, output_of

MARK = "quincunx"  # a word that stands only in solutions
PAGE = f"""# A page

Something to read, at least as much as a description needs.

````{{exercise}} recall, 1 minutes
:label: ex-a

What is asked, with a hunch.

:::{{admonition}} Hint
:class: dropdown

A nudge.
:::
````

````{{solution}} ex-a
:class: dropdown

The {MARK}:

```pycon
>>> {MARK} = 1
```
````

## Afterwards

More to read.

```{{exercise}} open, 1 minutes
:label: ex-b

Another one.
```

:::{{solution}} ex-b
:class: dropdown

{MARK}
:::
"""
TOC = """format: jb-book
root: book/playground
chapters:
  - file: book/robot
  - file: book/fast
  - file: notebooks/exercise-robot
"""


@pytest.fixture
def student(monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "book")
    return importlib.import_module("student")


def is_solution(cell):
    return "solution" in cell["metadata"].get("tags", [])


def lines_outside_solutions(text):
    """The lines of a text that are in none of its solutions, without empty ones; found line by line."""
    kept, fence = [], None
    for line in text.splitlines():
        if fence is None and (opened := re.match(r"(`+|:+)\{solution\}", line)):
            fence = opened.group(1)
        elif fence is None:
            kept.append(line)
        elif line == fence:
            fence = None
    assert fence is None
    return [line for line in kept if line]


def kept_lines(text):
    return [line for line in text.splitlines() if line]


@pytest.mark.parametrize("page", [p for p in PAGES if p.suffix == ".md"], ids=lambda page: page.stem)
def test_a_page_loses_its_solutions_and_nothing_else(student, page):
    text = page.read_text(encoding="utf-8")
    left = student.without_solutions(text)
    assert kept_lines(left) == lines_outside_solutions(text)
    assert ("{solution}" in text) == (left != text)


@pytest.mark.parametrize("page", [p for p in PAGES if p.suffix == ".ipynb"], ids=lambda page: page.stem)
def test_a_notebook_loses_its_solutions_and_nothing_else(student, page):
    before = nbformat.read(page, as_version=4).cells
    after = student.notebook_without_solutions(nbformat.read(page, as_version=4)).cells
    expected = [
        (cell.id, lines_outside_solutions(cell.source) if cell.cell_type == "markdown" else kept_lines(cell.source))
        for cell in before
        if not is_solution(cell)
    ]
    assert [(cell.id, kept_lines(cell.source)) for cell in after] == [(i, lines) for i, lines in expected if lines]
    metadata = {cell.id: cell.metadata for cell in before}
    assert all(cell.metadata == metadata[cell.id] for cell in after)


@pytest.fixture(scope="module")
def small(checkout, tmp_path_factory):
    """A student edition of few pages, one of them a notebook to fill in, made from a project with an address."""
    project = tmp_path_factory.mktemp("small") / "project"
    for part in ("benchmarks", "book", "safe"):
        shutil.copytree(checkout / part, project / part, ignore=shutil.ignore_patterns("__pycache__", "*.md"))
    for folder in ("executed", "notebooks"):
        (project / folder).mkdir()
        shutil.copy(checkout / folder / "exercise-robot.ipynb", project / folder)
    config = (checkout / "_config.yml").read_text()
    (project / "_config.yml").write_text(config.replace('url: ""', 'url: "https://github.com/someone/something"'))
    (project / "book" / "_toc.yml").write_text(TOC)
    (project / "book" / "playground.md").write_text(PAGE)
    for name in ("robot", "fast"):
        title = (checkout / "book" / f"{name}.md").read_text().splitlines()[0]
        (project / "book" / f"{name}.md").write_text(
            f"{title}\n\nA page to which the notebook refers, with few words.\n"
        )
    made = build_for_students(project)
    assert made.returncode == 0, output_of(made)
    return project / "_build" / "student"


def solved_lines(notebook):
    """The lines of a notebook's solutions that stand nowhere else in it."""
    cells = json.loads(notebook.read_text())["cells"]
    kept, solved = (
        {line.strip() for cell in cells if is_solution(cell) == wanted for line in cell["source"]}
        for wanted in (False, True)
    )
    return solved - kept


def test_no_file_of_the_edition_holds_a_line_of_a_solution(small):
    solved = [line for line in solved_lines(ROOT / "notebooks" / "exercise-robot.ipynb") if len(line) > 20]
    assert len(solved) > 20
    found = [file for folder in ("html", "notebooks") for file in (small / folder).rglob("*") if file.is_file()]
    files = [file for file in found if "_static" not in file.parts]
    assert {".html", ".ipynb", ".js", ".md"} <= {file.suffix for file in files}
    for file in files:
        text = html.unescape(re.sub("<[^>]*>", "", file.read_text(encoding="utf-8", errors="replace")))
        assert [line for line in (MARK, "Solution to", *solved) if line in text] == [], file


def test_exercises_hints_and_checks_stay(small):
    page = (small / "html" / "book" / "playground.html").read_text()
    assert "with a hunch" in page
    assert "A nudge." in page
    assert "More to read." in page
    assert (small / "html" / "notebooks" / "exercise-robot.html").read_text().count("Not yet.") == 4


def test_the_page_of_a_notebook_is_that_of_the_book_without_its_solutions(small, checkout):
    name = "notebooks/exercise-robot.html"
    folders = small / "html", checkout / "_build" / "html"
    ours, full = (article_of((folder / name).read_text()) for folder in folders)
    position = 0
    for line in ours:
        assert line in full[position:], line
        position = full.index(line, position) + 1
    assert len(ours) > 100


def article_of(page):
    article = re.search("<article.*</article>", page, re.DOTALL).group()
    lines = html.unescape(re.sub("<[^>]*>", "", article)).splitlines()
    return [line.strip() for line in lines if line.strip()]


def test_notebooks_to_download_are_those_with_cells_to_fill(small):
    (ours,) = (small / "notebooks").iterdir()
    assert ours.name == "exercise-robot.ipynb"
    assert ours.read_bytes() == (small / "html" / "_sources" / "notebooks" / ours.name).read_bytes()
    cells = json.loads(ours.read_text())["cells"]
    assert sum("raise NotImplementedError" in "".join(cell["source"]) for cell in cells) == 4
    assert all(cell["outputs"] == [] for cell in cells if cell["cell_type"] == "code")


def test_no_button_leads_to_the_project_with_its_solutions(small):
    for page in (small / "html").rglob("*.html"):
        assert "someone/something" not in page.read_text(), page
