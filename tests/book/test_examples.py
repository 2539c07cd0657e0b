"""Examples on the pages and in the notebooks' texts give the results that they show."""

import doctest
import json
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [*sorted((ROOT / "book").glob("*.md")), *sorted((ROOT / "notebooks").glob("*.ipynb"))]


def text_of(page):
    text = page.read_text(encoding="utf-8")
    if page.suffix == ".ipynb":
        return "\n".join(
            "".join(cell["source"]) for cell in json.loads(text)["cells"] if cell["cell_type"] == "markdown"
        )
    return text


def examples(page):
    return "\n".join(re.findall(r"^```pycon\n(.*?)^```", text_of(page), re.DOTALL | re.MULTILINE))


WITH_EXAMPLES = [page for page in PAGES if examples(page)]


def test_there_are_examples():
    assert {page.suffix for page in WITH_EXAMPLES} == {".md", ".ipynb"}


@pytest.mark.parametrize("page", WITH_EXAMPLES, ids=lambda page: page.stem)
def test_examples(page):
    test = doctest.DocTestParser().get_doctest(examples(page), {}, page.name, str(page), 0)
    report = []
    doctest.DocTestRunner(optionflags=doctest.IGNORE_EXCEPTION_DETAIL).run(test, out=report.append)
    assert not report, "".join(report)
