"""The playground in the book: a script that its page and chapters load, and pictures in place of its widget."""

import json

import pytest

from safe.playground import bundle
from tests.helpers.browser import complaints_of, needs_browser
from tests.helpers.checkout import execute, output_of
from tests.helpers.playground_page import FIGURES


def test_only_its_page_and_chapters_with_its_figures_load_it(html):
    having = {"playground", "slides", *FIGURES}
    for file, loading in (("bundle.js", having), ("playground.css", having | {"class"})):
        loaded_by = [page for page in html.rglob("*.html") if f"_static/playground/{file}" in page.read_text()]
        assert sorted(loaded_by) == sorted(html / "book" / f"{name}.html" for name in loading)
    assert (html / "_static" / "playground" / "bundle.js").read_text().startswith(bundle.script())


@needs_browser
def test_it_works_in_a_page_opened_as_a_file(browser, html):
    page = browser.new_page()
    complaints = complaints_of(page, (html.as_uri(), "blob:", "data:"), logged=())  # no fonts are loaded for files
    page.goto((html / "book" / "playground.html").as_uri() + "#seed=4&generation=20")
    page.get_by_role("button", name="Play", exact=True).click()
    page.get_by_role("status").filter(has_text="Success in generation").wait_for()
    page.close()
    assert complaints == []


def test_a_picture_stands_for_the_widget(checkout):
    copy = json.loads((checkout / "executed" / "playground.ipynb").read_text())
    shown = [output["data"] for cell in copy["cells"] for output in cell.get("outputs", []) if "data" in output]
    widgets = [data for data in shown if "application/vnd.jupyter.widget-view+json" in data]
    assert len(widgets) == 2
    assert all("image/svg+xml" in data and "application/pdf" in data for data in widgets)
    assert "widgets" not in copy["metadata"]
    page = (checkout / "_build" / "html" / "notebooks" / "playground.html").read_text()
    assert page.count("_images/") == 2
    assert "jupyter.widget" not in page


@pytest.mark.usefixtures("alone_in_checkout")
def test_another_script_makes_no_notebook_stale(checkout):
    module = checkout / "safe" / "playground" / "javascript" / "engine.js"
    before = module.read_bytes()
    module.write_bytes(before + b"// changed\n")
    try:
        again = execute(checkout)
    finally:
        module.write_bytes(before)
    assert again.returncode == 0, output_of(again)
    assert again.stdout.count("up to date") == len(list((checkout / "notebooks").glob("*.ipynb")))
