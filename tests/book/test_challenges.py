"""The challenges in the browser: opened, solved, remembered, and shown to a teacher by a code."""

import pytest
from axe_playwright_python.sync_playwright import Axe

from safe.experiments.store import sha256
from tests.helpers.browser import PHONE, needs_browser
from tests.helpers.playground_page import address_of

pytestmark = needs_browser


def solve_two(page):
    """Solve the first challenge by hand, and the sixth by runs."""
    page.get_by_role("button", name="Open challenge 1: Two weights").click()
    page.get_by_text("Not solved yet.").wait_for()
    for weight in ("p4: goal left in h", "p16: goal up in v"):
        page.get_by_role("slider", name=weight).focus()
        page.keyboard.press("Home")
    page.get_by_text("✓ Solved.").wait_for()
    assert address_of(page)[-1] == ("challenge", "1")
    page.get_by_role("button", name="All challenges").click()
    page.get_by_text("Solved: 1 of 10.").wait_for()
    page.get_by_role("button", name="Open challenge 6").press("Enter")
    page.locator(".playground summary:visible", has_text="Parameters").click()
    page.get_by_label("archive size").locator("visible=true").fill("0")
    page.keyboard.press("Enter")
    assert page.get_by_text("Not solved yet.").is_visible()
    page.get_by_role("button", name="Run", exact=True).click()
    page.get_by_text("✓ Solved.").wait_for()
    page.get_by_role("button", name="All challenges").click()


def test_challenges_are_solved_remembered_and_shown(visit):
    solve_two(visit("view=challenges"))
    page = visit("view=challenges&challenge=3")
    page.get_by_text("Solved: 2 of 10.").wait_for()
    assert page.get_by_role("button", name="Open challenge 3").evaluate("node => node === document.activeElement")
    page.get_by_label("Your name").fill("Ada; ½")
    code = page.get_by_label("Code of what you have solved").input_value()

    page = visit(page_name="book/class.html")
    codes = page.get_by_label("Codes of challenges")
    codes.fill(f"{code}\n{code.replace('archive=0', 'archive=1')}\n")
    page.get_by_text("This code is damaged.").wait_for()
    page.get_by_text("Ada; ½ has solved 2 of 10: 1 and 6.").wait_for()
    forged = "SAFE-challenges-1;Eve;1:view=drive&maze=open;"
    codes.fill(f"{forged}{sha256(forged)[:8]};")
    page.get_by_text("Eve has solved 0 of 10. Not solved, although the code says so: 1.").wait_for()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_an_open_challenge_has_no_violation_of_accessibility(visit, scheme):
    page = visit("view=drive&maze=open&challenge=1", viewport=PHONE, color_scheme=scheme)
    page.get_by_text("Not solved yet.").wait_for()
    found = Axe().run(page, context="#playground", options={"preload": False}).response["violations"]
    assert [(v["id"], [node["html"][:120] for node in v["nodes"]]) for v in found] == []
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["width"]
