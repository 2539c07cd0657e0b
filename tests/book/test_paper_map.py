"""The page that maps the paper to the book leaves nothing of the paper out."""

import re
from pathlib import Path

import pytest

BOOK = Path(__file__).parents[2] / "book"
ITEMS = {"Section": 8, "Figure": 5, "Table": 3, "Algorithm": 2, "Equation": 1}  # how many the paper has


def rows():
    """The rows of all tables of the page: the item, its subject, and where it is in the book."""
    text = (BOOK / "paper-map.md").read_text("utf-8").replace("&nbsp;", " ")
    cells = [line.strip("|").split("|") for line in text.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in row] for row in cells if row[0].strip() not in ("---", "the paper")]


@pytest.mark.parametrize("kind", ITEMS)
def test_every_item_of_the_paper_has_a_row(kind):
    numbers = [item.removeprefix(kind) for item, _, _ in rows() if re.fullmatch(rf"{kind} \d+", item)]
    assert [int(number) for number in numbers] == [*range(1, ITEMS[kind] + 1)]


def test_every_row_leads_to_pages_that_the_book_has():
    contents = (BOOK / "_toc.yml").read_text("utf-8")
    for item, _, place in rows():
        pages = re.findall(r"{doc}`(.*?)`", place)
        assert pages, item
        for page in pages:
            name = page.removeprefix("../") if page.startswith("../") else f"book/{page}"
            assert f"file: {name}\n" in contents, item
