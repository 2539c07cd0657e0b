"""Pages on a projector: one section at a time (see book/_static/projector.js)."""

import re

import pytest
from axe_playwright_python.sync_playwright import Axe

from tests.helpers.browser import DESKTOP, complaints_of, needs_browser

pytestmark = needs_browser

SIZES = [{"width": 1024, "height": 768}, {"width": 1920, "height": 1080}]
SLACK = 0.05  # of a window; see projector.js


@pytest.fixture
def project(visit):
    """Open a page on a projector, at one of its sections."""

    def project(page_name="book/slides.html", section="", viewport=SIZES[0], **options):
        page = visit(section, f"{page_name}?projector", viewport, reduced_motion="reduce", **options)
        page.locator(".projector-bar").wait_for()
        return page

    return project


def section_of(page):
    """The section that is shown, by its heading, which has the focus; the address names it as well."""
    shown = page.locator("section.projected")
    assert shown.get_attribute("id") == page.evaluate("location.hash.slice(1)")
    heading = shown.locator(":scope > :is(h1, h2, h3)")
    assert heading.evaluate("node => node === document.activeElement")
    assert heading.is_visible()
    assert page.locator(".bd-article :is(h2, h3):visible:not(.projected > *, .playground *)").count() == 0
    return shown.get_attribute("id")


def test_keys_turn_the_sections(project):
    page = project()
    sections = page.locator(".bd-article section:has(> :is(h1, h2))").evaluate_all("nodes => nodes.map((n) => n.id)")
    assert section_of(page) == sections[0]
    assert page.locator(".bd-sidebar-primary, .bd-header-article, .prev-next-footer, .bd-footer-content").count() == 4
    for chrome in page.locator(".bd-sidebar-primary, .bd-header-article, .prev-next-footer, .bd-footer-content").all():
        assert not chrome.is_visible()
    for number, key in enumerate(("PageDown", "ArrowRight", "ArrowDown", "Space"), start=1):
        page.keyboard.press(key)
        assert section_of(page) == sections[number]
    for number, key in zip((3, 2, 1, 0), ("PageUp", "ArrowLeft", "ArrowUp", "Shift+Space"), strict=True):
        page.keyboard.press(key)
        assert section_of(page) == sections[number]
    page.keyboard.press("End")
    assert section_of(page) == sections[-1]
    page.keyboard.press("PageDown")
    assert section_of(page) == sections[-1]
    assert page.locator(".projector-bar").inner_text().split()[1:4] == [str(len(sections)), "/", str(len(sections))]
    page.keyboard.press("Home")
    assert section_of(page) == sections[0]
    page.get_by_role("button", name="Next").click()
    assert section_of(page) == sections[1]


def test_a_reload_stays_at_the_section_and_escape_leaves_there(project):
    page = project(section="novelty-by-hand")
    page.reload()
    assert section_of(page) == "novelty-by-hand"
    page.keyboard.press("Escape")
    assert "projector" not in page.url
    assert page.evaluate("document.activeElement.parentElement.id") == "novelty-by-hand"
    assert page.locator("#novelty-by-hand h2").bounding_box()["y"] < SIZES[0]["height"]
    assert page.locator("section:visible").count() > 10
    assert page.locator(".bd-header-article").is_visible()
    page.keyboard.press("PageDown")
    assert page.locator(".projected").count() == 0


def test_a_figure_and_its_fields_keep_their_keys(project):
    page = project(section="a-robot-that-must-find-its-way")
    slider = page.get_by_role("slider").first
    slider.focus()
    value = slider.input_value()
    page.keyboard.press("ArrowRight")
    assert slider.input_value() != value
    for key in ("PageDown", "End", "n", "Space"):
        page.keyboard.press(key)
    assert page.locator("section.projected").get_attribute("id") == "a-robot-that-must-find-its-way"
    page.keyboard.press("Escape")
    assert section_of(page) == "a-robot-that-must-find-its-way"
    page.keyboard.press("PageDown")
    assert section_of(page) == "sixteen-weights-and-no-memory"
    play = page.get_by_role("button", name="Play")
    play.focus()
    page.keyboard.press("Space")
    page.get_by_role("button", name="Pause").wait_for()
    page.keyboard.press("PageDown")  # from a presenter: no button uses it
    assert section_of(page) == "predict"


def test_notes_are_hidden_until_they_are_asked_for(project):
    page = project(section="predict")
    notes = page.locator("#predict .notes")
    assert not notes.is_visible()
    page.keyboard.press("n")
    assert notes.get_by_text("Collect two or three predictions").is_visible()
    assert page.get_by_role("button", name="Notes").get_attribute("aria-pressed") == "true"
    page.keyboard.press("n")
    assert not notes.is_visible()
    page.keyboard.press("Escape")
    assert notes.get_by_text("Notes").is_visible()
    assert not notes.get_by_text("Collect two or three predictions").is_visible()


def test_the_button_of_a_page_begins_at_the_section_that_is_read(visit):
    page = visit(page_name="book/robot.html", reduced_motion="reduce")
    page.locator("#what-it-does").evaluate("node => node.scrollIntoView({ behavior: 'instant' })")
    page.get_by_role("button", name="Show on a projector").evaluate("node => node.click()")  # without scrolling to it
    assert section_of(page) == "what-it-does"


def test_what_is_longer_than_the_screen_is_scrolled_first(project):
    page = project("book/novelty.html", "the-measure")
    page.keyboard.press("PageDown")
    assert section_of(page) == "the-measure"
    assert page.evaluate("scrollY") > SIZES[0]["height"] / 2
    page.keyboard.press("ArrowLeft")
    assert page.evaluate("scrollY") == 0
    page.evaluate("scrollTo({ top: 1e6, behavior: 'instant' })")
    page.keyboard.press("PageDown")
    assert section_of(page) != "the-measure"


def test_every_slide_fits_and_figures_fill_it(project):
    page = project(color_scheme="dark")
    for _ in range(page.locator(".bd-article section:has(> :is(h1, h2))").count()):
        slide = section_of(page)
        figure = page.locator(".projected > figure")
        if figure.locator(".live").count():
            figure.locator(".figure").wait_for()
        for viewport in SIZES:
            page.set_viewport_size(viewport)
            page.evaluate("new Promise(requestAnimationFrame)")  # before which the window says that it has changed
            hidden = page.evaluate("document.documentElement.scrollHeight - innerHeight")
            assert hidden <= SLACK * viewport["height"], (slide, viewport)
            if figure.count():
                box = figure.locator(".live, img").first.bounding_box()
                assert box["height"] > 0.35 * viewport["height"], (slide, viewport)
                assert 0 <= box["x"] <= box["x"] + box["width"] <= viewport["width"], (slide, viewport)
        page.keyboard.press("PageDown")


def test_the_state_of_the_playground_stays_in_the_address(project):
    page = project("book/playground.html", "view=drive&maze=trap")
    page.get_by_role("tab", name="Drive", selected=True).wait_for()
    page.keyboard.press("Escape")
    assert re.search(r"/playground\.html#view=drive&maze=trap", page.url)


def test_it_works_in_a_page_that_is_opened_as_a_file(html, browser):
    page = browser.new_page(viewport=DESKTOP)
    complaints = complaints_of(page, ("file:", "blob:", "data:"), logged=())  # it cannot load fonts there
    page.goto(f"{(html / 'book' / 'slides.html').as_uri()}?projector#predict")
    page.keyboard.press("PageDown")
    assert section_of(page) == "closeness-against-newness"
    page.locator(".projected .figure canvas").first.wait_for()
    page.keyboard.press("Escape")
    assert "projector" not in page.url
    assert complaints == []
    page.close()


def test_no_violation_of_accessibility(project):
    page = project(section="who-finds-the-goal")
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        found = Axe().run(page, options={"preload": False}).response["violations"]
        assert [(scheme, v["id"], [node["html"][:120] for node in v["nodes"]]) for v in found] == []
