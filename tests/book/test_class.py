"""A class of thirty in the browser: its members make runs in the playground, and the page of the class pools them."""

import re

import pytest
from axe_playwright_python.sync_playwright import Axe

import safe
from safe.playground.lines import Course, pool, read_lines, verify_lines
from tests.helpers.browser import PHONE, needs_browser

pytestmark = needs_browser

SEATS = 30
COURSE = Course(
    "room 12 ½",
    ["novelty", "random"],
    "maze1",
    runs=3,
    seats=SEATS,
    parameters=safe.Parameters(population=10, generations=4, success_distance=15, steps=100),
)
CLASS = "book/class.html"


@pytest.fixture(scope="module")
def lines():
    """What the members of the class send; see the first test."""
    return {}


def line_of(page):
    page.get_by_role("button", name="Run", exact=True).click()
    line = page.get_by_label("Line with your runs")
    line.wait_for()
    return line.input_value()


def test_every_seat_makes_runs_of_its_own(visit, lines):
    page = visit(COURSE.address)
    assert page.get_by_role("button", name="Run", exact=True).is_disabled()
    page.get_by_role("button", name="7", exact=True).focus()
    page.keyboard.press("Enter")
    page.get_by_role("heading", name=f"Class room 12 ½: seat 7 of {SEATS}").wait_for()
    page.get_by_text("Your runs are 18 to 20 of Novelty search and Random search on maze1").wait_for()
    assert not page.get_by_label("Seed").locator("visible=true").count()
    page = visit(COURSE.address)
    page.get_by_role("heading", name="seat 7").wait_for()  # the browser remembers it
    for seat in range(1, SEATS + 1):
        lines[seat] = line_of(visit(f"{COURSE.address}&seat={seat}"))
    pooled = pool(read_lines("\n".join(lines.values())), COURSE)
    assert pooled.missing == pooled.refused == []
    for experiment, table in pooled.results.items():
        runs = safe.run(experiment, progress=False)
        assert 0 < runs.success.sum() < len(runs)
        assert table.success.tolist() == runs.success.tolist()
        assert table.number.tolist() == runs.generation.where(runs.success, runs.distance).tolist()
    assert len(verify_lines(pooled, sample=1)) == SEATS


def test_the_page_pools_the_lines(visit, lines, tmp_path):
    page = visit(COURSE.address, CLASS)
    page.get_by_text(f"Class room 12 ½: 0 of {SEATS} seats.").wait_for()
    changed = {**lines, 3: lines[3][:-30], 5: lines[5].replace("seed=0", "seed=1")}
    del changed[9]
    (tmp_path / "sent.txt").write_text("\n".join(changed[seat] for seat in range(20, SEATS + 1)))
    page.get_by_label("Lines of the class").fill("\n".join(changed[seat] for seat in changed if seat < 20))
    page.get_by_label("or files").set_input_files(tmp_path / "sent.txt")
    page.get_by_text("Lines: 27 counted, 2 refused.").wait_for()
    page.get_by_text(f"27 of {SEATS} seats. Missing: 3, 5 and 9.").wait_for()
    assert page.locator(".checks .bad").all_inner_texts() == [
        "Line 3 is cut off before its end.",
        "Line 5 is damaged: its checksum does not fit.",
    ]
    left = [run for run in range(3 * SEATS) if run // 3 + 1 not in (3, 5, 9)]
    for row, experiment in zip(page.locator(".playground tbody tr").all(), COURSE.experiments, strict=True):
        successes = safe.run(experiment, progress=False).success[left].sum()
        assert row.locator("td").all_inner_texts()[:2] == ["81", str(successes)]
    page.get_by_text("drawn at random: 54 of 162 runs.").wait_for()
    page.get_by_role("button", name="Check 2 more of each seat").click()
    page.get_by_text("drawn at random: 108 of 162 runs.").wait_for()


def test_the_page_refuses_an_invented_outcome(visit, lines):
    (read,) = read_lines(lines[4])
    invented = [[outcome._replace(success=False, number=99) for outcome in those] for those in read.outcomes]
    page = visit(page_name=CLASS)
    page.get_by_label("Lines of the class").fill(safe.playground.lines.write_line(COURSE, 4, invented))
    page.get_by_text("Line 1, of seat 4, is not what the algorithm makes: it says of run").wait_for()
    page.get_by_text(re.compile(r"of (novelty|random): failure 99 cells from the goal; made again: ")).wait_for()
    page.get_by_text(f"0 of {SEATS} seats.").wait_for()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_no_violation_of_accessibility(visit, lines, scheme):
    for page_name, fragment, context in (
        ("book/playground.html", COURSE.address, "#playground"),
        (CLASS, COURSE.address, "#class"),
    ):
        page = visit(fragment, page_name, viewport=PHONE, color_scheme=scheme)
        if context == "#class":
            page.get_by_label("Lines of the class").fill(f"{lines[1]}\n{lines[2][:50]}")
            page.get_by_text("Lines: 1 counted, 1 refused.").wait_for()
        else:
            page.get_by_role("button", name="30", exact=True).wait_for()
        found = Axe().run(page, context=context, options={"preload": False}).response["violations"]
        assert [(v["id"], [node["html"][:120] for node in v["nodes"]]) for v in found] == []
        assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["width"]


def test_a_class_is_made_from_the_settings_of_many_runs(visit):
    page = visit("view=runs&maze=trap&algorithm=safe&seed=5&runs=4&population=10&generations=3")
    page.get_by_text("Share these runs in a class").click()
    page.get_by_label("Name of the class").fill("monday")
    page.get_by_label("Seats").fill("2")
    page.get_by_role("button", name="Make the link").click()
    page.get_by_role("button", name="2", exact=True).click()
    page.get_by_text("The link of this class").click()
    link = page.get_by_label("Link for the class").input_value()
    line = line_of(page)
    page.get_by_role("button", name="a failure").click()
    page.get_by_role("tab", name="Watch", selected=True).wait_for()
    page.locator(".head select").select_option("maze2")
    page.get_by_role("tab", name="Many runs").click()
    assert page.get_by_label("Line with your runs").input_value() == line
    assert page.locator(".head select").input_value() == "trap"
    page.get_by_role("button", name="Leave the class").click()
    assert page.get_by_label("Seed").locator("visible=true").input_value() == "5"
    ((course, seat),) = [(read.course, read.seat) for read in read_lines(line)]
    assert (seat, link.split("#")[1]) == (2, course.address)
    assert (course.seats, course.runs, course.seed) == (2, 4, 5)
