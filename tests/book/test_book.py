"""The whole pipeline, on a copy of the checkout: notebooks executed at a few runs, the book built from them."""

import json
import re
from html.parser import HTMLParser

import pytest

from tests.book.conftest import RUNS, build, execute, output


@pytest.fixture
def pages(checkout):
    html = checkout / "_build" / "html"
    return {str(page.relative_to(html)): page.read_text() for page in sorted(html.rglob("*.html"))}


def test_every_chapter_is_a_page(checkout, pages):
    chapters = re.findall(r"(?:root|file): (.+)", (checkout / "book" / "_toc.yml").read_text())
    assert len(chapters) > len(list((checkout / "notebooks").glob("*.ipynb")))
    assert {f"{chapter}.html" for chapter in chapters} <= set(pages)


def test_the_page_at_the_top_leads_to_the_book(pages):
    assert 'content="0; url=book/index.html"' in pages["index.html"]
    assert 'href="_static/favicon.svg"' in pages["index.html"]


def test_every_notebook_is_a_chapter(checkout):
    contents = (checkout / "book" / "_toc.yml").read_text()
    for notebook in (checkout / "notebooks").glob("*.ipynb"):
        assert f"notebooks/{notebook.stem}" in contents


def test_the_pages_show_what_was_computed(checkout, pages):
    table = pages["notebooks/table2-success.html"]
    assert f"of {RUNS}</td>" in table
    assert "322 of 500</td>" in table
    for notebook in ("figure1-mazes", "figure2-deception", "figure3-sensors", "table2-success", "figure5-solutions"):
        assert re.search(r'<img [^>]*src="\.\./_images/[0-9a-f]+\.svg"', pages[f"notebooks/{notebook}.html"]), notebook


def test_numbers_in_prose_are_those_of_the_table(checkout, pages):
    copy = json.loads((checkout / "executed" / "table2-success.ipynb").read_text())
    (rows,) = [
        cell["outputs"][0]["data"]["application/json"]
        for cell in copy["cells"]
        if "numbers" in cell["metadata"].get("tags", [])
    ]
    (successes,) = [row["successes"] for row in rows if (row["maze"], row["algorithm"]) == ("maze1", "safe")]
    prose = re.sub(r"\s+", " ", re.sub(r"<[^>]+>", "", pages["book/index.html"]))
    assert f"SAFE succeeds in {successes} of {RUNS} runs" in prose


class Loads(HTMLParser):
    """The addresses that a page loads something from."""

    def __init__(self, page):
        super().__init__()
        self.found = []
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if tag in ("script", "img", "iframe", "source"):
            self.found.append(attributes.get("src"))
        elif tag == "link" and attributes.get("rel") != "canonical":
            self.found.append(attributes.get("href"))


def test_no_page_loads_anything_from_elsewhere(pages):
    for name, page in pages.items():
        addresses = [address for address in Loads(page).found if address]
        assert addresses or name == "index.html"
        assert [address for address in addresses if re.match(r"(https?:)?//", address)] == [], name


def test_figures_have_a_caption_a_number_and_a_text(pages):
    for name, page in pages.items():
        for image in re.findall(r"<img [^>]*_images/[^>]*>", page):
            assert re.search(r'alt="[^"]{20,}"', image), (name, image)
        figures = re.findall(r"<figure.*?</figure>", page, re.DOTALL)
        for figure in figures:
            assert "caption-number" in figure, name


def test_no_script_on_a_page_names_an_address_elsewhere(pages):
    for name, page in pages.items():
        for script in re.findall(r"<script.*?</script>", page, re.DOTALL):
            assert "://" not in script, name


def test_the_download_is_the_clean_notebook(checkout):
    for notebook in (checkout / "notebooks").glob("*.ipynb"):
        assert (checkout / "_build/html/_sources/notebooks" / notebook.name).read_bytes() == notebook.read_bytes()


def test_what_is_up_to_date_is_not_executed_again(checkout):
    again = execute(checkout)
    assert again.stdout.count("up to date") == len(list((checkout / "notebooks").glob("*.ipynb")))


@pytest.mark.parametrize("change", ["notebook", "package", "runs", "missing"])
def test_stale_copies_are_refused(checkout, change):
    notebook = checkout / "notebooks" / "table2-success.ipynb"
    copy, module = checkout / "executed" / notebook.name, checkout / "safe" / "robot.py"
    before = {file: file.read_bytes() for file in (notebook, copy, module)}
    runs = RUNS
    if change == "notebook":
        notebook.write_bytes(before[notebook].replace(b"Who finds the goal", b"Who ever finds the goal"))
    elif change == "package":
        module.write_bytes(before[module] + b"# changed\n")
    elif change == "runs":
        runs = "5"
    else:
        copy.unlink()
    try:
        refused = build(checkout, runs=runs)
    finally:
        for file, content in before.items():
            file.write_bytes(content)
    assert refused.returncode != 0
    reason = {
        "missing": "was not executed",
        "runs": "was executed before the parameters changed",
    }.get(change, f"was executed before the {change} changed")
    assert f"table2-success.ipynb {reason}" in re.sub(r"\s+", " ", output(refused))


@pytest.mark.parametrize(
    ("arguments", "runs", "complaint"),
    [
        (["table2-success", "-p", "run", "5"], RUNS, "parameter must be one of maze, runs, seed, store; was run"),
        (["table3"], RUNS, "notebook must be one of figure1-mazes, .*; was 'table3'"),
        ([], "many", "RUNS must be an integer of at least 1; was 'many'"),
        ([], "0", "RUNS must be an integer of at least 1; was '0'"),
    ],
)
def test_the_runner_refuses_what_it_does_not_know(checkout, arguments, runs, complaint):
    refused = execute(checkout, *arguments, runs=runs)
    assert refused.returncode != 0
    assert re.search(complaint, re.sub(r"\s+", " ", refused.stderr))


def test_a_failed_execution_leaves_the_copy_as_it_was(checkout):
    copy = checkout / "executed" / "figure1-mazes.ipynb"
    before = copy.read_bytes()
    failed = execute(checkout, "figure1-mazes", "-p", "maze", "maze3")
    assert failed.returncode != 0
    (complaint,) = failed.stderr.splitlines()
    assert complaint.startswith("[1/1] figure1-mazes: ValueError: maze must be one of 'maze1', 'maze2'")
    assert copy.read_bytes() == before
