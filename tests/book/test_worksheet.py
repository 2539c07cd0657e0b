"""The worksheet on paper."""

import re

import pytest

import make
from tests.helpers.browser import needs_browser

A4 = (210, 297)  # millimetres


def pages_of(pdf):
    """The size of each page of a PDF, in millimetres."""
    boxes = re.findall(rb"/MediaBox ?\[ ?0 0 ([\d.]+) ([\d.]+) ?\]", pdf)
    return [tuple(round(float(side) / 72 * 25.4) for side in box) for box in boxes]


@needs_browser
def test_it_is_printed_on_two_pages(html, tmp_path):
    pdf = tmp_path / "worksheet.pdf"
    make._print(html / "book" / "worksheet.html", pdf)
    assert pages_of(pdf.read_bytes()) == [A4, A4]


@needs_browser
def test_it_fits_on_two_pages_of_either_paper(visit):
    page = visit(page_name="book/worksheet.html")
    for paper in "A4", "Letter":
        pdf = page.pdf(format=paper, prefer_css_page_size=False, margin=dict.fromkeys(("top", "bottom"), "12mm"))
        assert len(pages_of(pdf)) == 2, paper
    page.emulate_media(media="print")
    assert page.locator("main :visible:text('Teaching with this book')").count() == 0
    assert page.locator(".sheet:visible").count() == 2
    page.emulate_media(media="null")


def test_without_a_browser_it_is_said_which_can_print(tmp_path, monkeypatch):
    monkeypatch.setattr(make.shutil, "which", lambda _: None)
    with pytest.raises(SystemExit, match="install Chromium, Chrome or Edge"):
        make._print(tmp_path / "worksheet.html", tmp_path / "worksheet.pdf")
