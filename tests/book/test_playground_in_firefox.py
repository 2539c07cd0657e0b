"""The playground's main uses in Firefox, whose engine shares nothing with Chromium's.

All that it computes is compared with the package; the other tests of the page look closer, in Chromium.
"""

import numpy as np
import pytest

import safe
from safe.playground import address
from tests.helpers.firefox import Page, complaints_in, firefox, needs_firefox
from tests.helpers.playground_page import QUICK, QUICK_PARAMETERS, address_of, driven, maze_at, status_of

pytestmark = needs_firefox

STATUS = ".panel .status"


@pytest.fixture(scope="module")
def started(tmp_path_factory):
    with firefox(tmp_path_factory.mktemp("profile")) as started:
        yield started


@pytest.fixture
def visit(started, site):
    """Open the playground at an address. Whatever goes wrong in the page fails the test."""
    send, events = started
    pages = []
    events.clear()

    def open_page(fragment):
        pages.append(Page(send, f"{site}book/playground.html#{fragment}"))
        pages[-1].wait_for("document.querySelector('.playground [aria-selected=true]') !== null")
        return pages[-1]

    yield open_page
    for page in pages:
        page.close()
    assert complaints_in(events, (site, f"blob:{site}", "data:")) == []


def test_a_run_is_watched_to_its_end(visit):
    page = visit(f"maze=maze2&algorithm=safe&seed=5&{QUICK}")
    page.wait_for(f"document.querySelector('{STATUS}')?.innerText.includes('Generation 0')")
    page.click("button", "One generation")
    page.wait_for(f"document.querySelector('{STATUS}').innerText.includes('Generation 1')")
    assert ("generation", "1") in address_of(page)
    page.click("slider", "Speed")
    page.type("\ue010")  # the key End
    page.click("button", "Play")
    page.wait_for(f"/uccess/.test(document.querySelector('{STATUS}').innerText)")
    run = safe.evolve("maze2", "safe", 5, QUICK_PARAMETERS)
    assert page.text_of(STATUS) == status_of(run)
    page.click("button", "Drive the best")
    assert driven(page) == list(run.controller)


def test_an_address_opens_what_it_says(visit):
    page = visit(f"maze=trap&algorithm=novelty&seed=1,2/3&{QUICK}&k=3&generation=4")
    page.wait_for(f"document.querySelector('{STATUS}')?.innerText.includes('Generation 4')")
    page.evaluate("void (location.hash = 'view=drive&maze=maze2')")
    page.wait_for("document.querySelector('[role=tab][aria-selected=true]').innerText == 'Drive'")
    assert dict(address_of(page))["maze"] == "maze2"


def test_a_robot_is_driven_with_sliders(visit):
    page = visit("view=drive&maze=maze1&controller=" + ",".join(["0"] * 16))
    page.click("slider", "p1: dist right in h")
    page.type("\ue012" * 7)  # the key with the arrow to the left
    controller = np.array(driven(page))
    assert controller[0] < 0
    assert not controller[1:].any()
    distance = safe.load_maze("maze1").distance(safe.path("maze1", controller)[-1])
    assert f"After 300 steps the robot is {distance} cells from the goal" in page.text_of(".outcome")


def test_a_wall_is_drawn_with_a_mouse(visit):
    room = safe.Maze(np.zeros((12, 20), dtype=bool), (1, 1), (10, 18))
    page = visit(address.drive_address(room).replace("view=drive", "view=draw"))
    page.evaluate("document.querySelector('canvas.editor').scrollIntoView({ block: 'center' })")
    box = page.evaluate("document.querySelector('canvas.editor').getBoundingClientRect()")
    cell = box["width"] / 20
    y = box["y"] + 3.5 * cell
    page.drag((box["x"] + 0.5 * cell, y), (box["x"] + 17.5 * cell, y))
    walls = room.walls.copy()
    walls[3, :18] = True
    assert maze_at(page) == safe.Maze(walls, room.start, room.goal)
    assert "The goal can be reached" in page.text_of(".checks")


def test_many_runs_are_made_in_a_worker(visit):
    page = visit(f"view=runs&algorithm=novelty&seed=100&maze=maze1&runs=20&{QUICK}")
    page.click("button", "Run")
    cells = "[...document.querySelectorAll('.outcomes tbody td.number')].map((cell) => cell.innerText)"
    page.wait_for(f"{cells}[0] === '20' && {cells}")
    successes = sum(safe.evolve("maze1", "novelty", 100 + i, QUICK_PARAMETERS).success for i in range(20))
    assert page.evaluate(cells)[:2] == ["20", str(successes)]
