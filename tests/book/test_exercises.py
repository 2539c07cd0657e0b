"""Exercises have one form, in pages and in notebooks; notebooks to fill in have solutions that pass their checks."""

import json
import re
from pathlib import Path

import pytest
import yaml

from tests.book.test_examples import PAGES, text_of

ROOT = Path(__file__).parents[2]
LEVELS = ["recall", "apply", "analyse", "open"]
BLOCK = re.compile(r"^(`{3,}|:{3,})\{(exercise|solution)\}(?: ([^\n]*))?\n(.*?)^\1$", re.DOTALL | re.MULTILINE)
HINT = ":::{admonition} Hint\n:class: dropdown\n\n"
TO_FILL_IN = sorted((ROOT / "notebooks").glob("exercise-*.ipynb"))


def blocks(page):
    """The exercises and solutions of a page, in order: (kind, title or label, content)."""
    return [match.groups()[1:] for match in BLOCK.finditer(text_of(page))]


WITH_EXERCISES = [page for page in PAGES if blocks(page)]


@pytest.mark.parametrize("page", WITH_EXERCISES, ids=lambda page: page.stem)
def test_every_exercise_has_a_level_minutes_a_hint_and_a_solution(page):
    found = blocks(page)
    assert len(found) == len(re.findall(r"\{(exercise|solution)\}", text_of(page)))
    assert [kind for kind, _, _ in found] == ["exercise", "solution"] * (len(found) // 2)
    for (_, title, content), (_, solved, solution) in zip(found[::2], found[1::2], strict=True):
        assert content.startswith(f":label: {solved}\n")
        assert solution.startswith(":class: dropdown\n"), solved
        if ":nonumber:" in content:  # a question of a quiz
            continue
        assert re.fullmatch(rf"({'|'.join(LEVELS)}), \d+ minutes", title or ""), title
        assert content.count(HINT) == 1, solved
        assert content.rstrip().endswith(":::"), solved


def chapters(part):
    (chapters,) = (
        found["chapters"]
        for found in yaml.safe_load((ROOT / "book" / "_toc.yml").read_text())["parts"]
        if found["caption"] == part
    )
    return [chapter["file"] for chapter in chapters]


@pytest.mark.parametrize("chapter", chapters("The idea"))
def test_a_chapter_has_exercises_of_every_level_from_recall_to_open(chapter):
    text = text_of(ROOT / f"{chapter}.md")
    assert text.index("\n## Exercises\n") < text.index("{exercise}")
    levels = [title.split(",")[0] for kind, title, _ in blocks(ROOT / f"{chapter}.md") if kind == "exercise"]
    assert len(levels) >= 5
    assert levels == sorted(levels, key=LEVELS.index)
    assert set(levels) == set(LEVELS)


def is_solution(cell):
    return "solution" in cell["metadata"].get("tags", [])


@pytest.mark.parametrize("notebook", TO_FILL_IN, ids=lambda path: path.stem)
def test_every_function_to_write_has_a_check_and_a_solution_that_passes_it(checkout, notebook):
    cells = json.loads((checkout / "executed" / notebook.name).read_text())["cells"]
    tasks = [i for i, cell in enumerate(cells) if "raise NotImplementedError" in "".join(cell["source"])]
    assert len(tasks) >= 4
    for i in tasks:
        task, check, solution = cells[i : i + 3]
        name = re.search(r"^def (\w+)", "".join(task["source"]), re.MULTILINE).group(1)
        assert f"\n\ncheck_{name}()" in "".join(check["source"])
        assert said_by(check).startswith("Not yet.")
        assert solution["metadata"]["tags"] == ["solution", "hide-cell"]
        assert f"def {name}(" in "".join(solution["source"])
        assert said_by(solution).startswith("Right.")


def said_by(cell):
    return "".join(text for output in cell["outputs"] for text in output.get("text", []))


def test_there_are_notebooks_to_fill_in():
    assert len(TO_FILL_IN) >= 4


@pytest.mark.parametrize("notebook", TO_FILL_IN, ids=lambda path: path.stem)
def test_the_page_of_a_notebook_shows_its_solutions_folded(html, notebook):
    page = (html / "notebooks" / f"{notebook.stem}.html").read_text()
    count = sum(is_solution(cell) and cell["cell_type"] == "code" for cell in json.loads(notebook.read_text())["cells"])
    assert page.count("Show the solution") == count
    assert page.count('<details class="admonition hide') == count
