"""The playground's page for every reader: by keyboard, on a phone, with a screen reader, in light and dark."""

from pathlib import Path

import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe

from tests.helpers.browser import PHONE, needs_browser
from tests.helpers.playground_page import (
    QUICK,
    VIEWS,
    driven,
    look_at,
    panel,
    wait_for_view,
)

pytestmark = needs_browser


LARGEST = 196_000  # bytes of script and stylesheet


GOALS = "goals:patience:drawn:raw:favourite:goal:repertoire:distance,novelty"


def test_keyboard_alone_is_enough(visit):
    page = visit(f"algorithm=safe&seed=3&{QUICK}")
    panel(page, "SAFE").get_by_text("Generation 0").wait_for()
    page.get_by_role("tab", name="Watch").focus()

    def tab_to(name, role="button"):
        for _ in range(40):
            page.keyboard.press("Tab")
            target = page.get_by_role(role, name=name, exact=True)
            if target.count() == 1 and target.evaluate("node => node === document.activeElement"):
                return
        raise AssertionError(f"no way to {name} by the Tab key")

    tab_to("Play")
    page.keyboard.press("Enter")
    panel(page, "SAFE").get_by_text("Generation 2").wait_for()
    page.keyboard.press("Space")
    page.get_by_role("button", name="Play").wait_for()
    tab_to("Novelty search", "checkbox")
    page.keyboard.press("Space")
    panel(page, "Novelty search").get_by_text("Generation 0").wait_for()
    assert page.get_by_role("checkbox", name="Novelty search").evaluate("node => node === document.activeElement")
    page.get_by_role("tab", name="Watch").focus()
    page.keyboard.press("ArrowRight")
    assert page.get_by_role("tab", name="Drive", selected=True).evaluate("node => node === document.activeElement")
    tab_to("p3: dist left in h", "slider")
    before = driven(page)
    page.keyboard.press("ArrowRight")
    page.keyboard.press("PageUp")
    assert np.round(np.subtract(driven(page), before), 9).tolist() == [0, 0, 0.3] + [0] * 13
    page.get_by_role("tab", name="Drive").focus()
    page.keyboard.press("End")
    page.keyboard.press("ArrowLeft")
    tab_to("Run")
    page.keyboard.press("Enter")
    page.wait_for_function("document.querySelector('.outcomes tbody td')?.textContent > 0")


@pytest.mark.parametrize("view", VIEWS)
def test_on_a_phone_nothing_is_cut_off(visit, view):
    algorithms = f"algorithm=safe:genotypic:drawn:rank:drawn&algorithm=standard&algorithm={GOALS}"
    page = visit(f"view={view}&{algorithms}&seed=3&generation=5", viewport=PHONE)
    wait_for_view(page, view)
    if view == "watch":
        panel(page, "Standard EA").get_by_text("Generation 5").wait_for()
        look_at(page, 4)
    for summary in page.locator(".playground summary:visible").all():
        summary.click()
    root = page.locator(".playground")
    width = root.bounding_box()["width"]
    wider = root.evaluate(
        """(root, right) => [...root.querySelectorAll("*")]
            .filter((node) => node.checkVisibility() && !node.closest(".scroll table"))
            .filter((node) => node.getBoundingClientRect().right > right + 1)
            .map((node) => node.outerHTML.slice(0, 80))""",
        root.bounding_box()["x"] + width,
    )
    assert wider == []
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["width"]
    buttons = page.locator(".playground button:visible, .playground select:visible").all()
    assert all(button.bounding_box()["height"] >= 24 for button in buttons)


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("view", VIEWS)
def test_no_violation_of_accessibility(visit, view, scheme):
    algorithms = f"algorithm=safe&algorithm=novelty&algorithm={GOALS}"
    page = visit(f"view={view}&{algorithms}&seed=3&generation=5&{QUICK}", color_scheme=scheme)
    wait_for_view(page, view)
    if view == "watch":
        panel(page, "SAFE").get_by_text("Generation 5").wait_for()
        look_at(page, 4)
        page.locator(".playground summary:visible").click()
    found = Axe().run(page, context="#playground", options={"preload": False}).response["violations"]
    assert [(v["id"], [node["html"][:120] for node in v["nodes"]]) for v in found] == []


def test_it_follows_the_theme_of_the_book(visit):
    page = visit("view=drive", color_scheme="light")
    colour = "getComputedStyle(document.querySelector('.playground')).backgroundColor"
    light = page.evaluate(colour)
    page.evaluate("document.documentElement.dataset.theme = 'dark'")
    assert page.evaluate(colour) != light


def test_forced_colours_leave_curves_dots_and_the_focus_visible(visit):
    page = visit(f"algorithm=safe&seed=3&generation=5&{QUICK}")
    panel(page, "SAFE").get_by_text("Generation 5").wait_for()
    page.emulate_media(forced_colors="active", color_scheme="dark")
    for drawing in page.locator(".playground :is(.chart svg, .maze canvas, .legend):visible").all():
        ground = drawing.evaluate("node => getComputedStyle(node).backgroundColor")
        assert ground == page.locator(".playground").evaluate(
            "node => { node.style.forcedColorAdjust = 'none'; return getComputedStyle(node).backgroundColor; }"
        )
    page.get_by_role("tab", name="Watch").focus()
    page.keyboard.press("Tab")
    assert page.evaluate("getComputedStyle(document.activeElement).outlineStyle") == "solid"
    page.emulate_media(forced_colors="none")


def test_it_is_small(html):
    files = [Path(html, "_static", "playground", name) for name in ("bundle.js", "playground.css")]
    assert sum(file.stat().st_size for file in files) < LARGEST
