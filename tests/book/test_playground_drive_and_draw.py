"""The playground's views *Drive* and *Draw* in a browser.

All that it computes is compared with the package.
"""

import re

import numpy as np
import pytest

import safe
from safe.companion import paper
from safe.maze import ways_to_goal
from safe.playground import address
from tests.helpers.browser import DESKTOP, PHONE, needs_browser
from tests.helpers.playground_page import (
    address_of,
    driven,
    maze_at,
)

pytestmark = needs_browser


# Drive


def test_driving_with_sliders(visit):
    page = visit("view=drive&maze=maze1&controller=" + ",".join(["0"] * 16))
    controller = np.zeros(16)
    for slider, weight in (("p1: dist right in h", -0.35), ("p10: goal right in v", 0.6), ("p16: goal up in v", -1)):
        page.get_by_label(slider).fill(str(weight))
        controller[int(re.search(r"\d+", slider)[0]) - 1] = weight
        distance = safe.load_maze("maze1").distance(safe.path("maze1", controller)[-1])
        assert f"After 300 steps the robot is {distance} cells from the goal" in page.locator(".outcome").inner_text()
    assert driven(page) == controller.tolist()


def test_sensors_are_shown_at_any_step(visit):
    maze, controller = safe.load_maze("maze2"), np.round(np.linspace(-1, 1, 16), 2)
    page = visit(f"view=drive&maze=maze2&controller={','.join(map(str, controller.tolist()))}")
    path = safe.path(maze, controller)
    for step in (0, 7, 300):
        page.get_by_role("slider", name="Step").fill(str(step))
        row, column = path[step].tolist()
        assert f"Step {step}: row {row}, column {column}," in page.locator(".status:visible").inner_text()
        readings = maze.readings((row, column))
        shown = page.locator(".weights tbody tr:not(.sums)")
        cells = [shown.nth(i).locator("td").first.inner_text() for i in range(8)]
        assert cells == [f"{reading:.0f}" for reading in readings.values()]
        sums = controller.reshape(2, 8) @ list(readings.values())
        expected = [f"h = {sums[0]:.1f}: {'right' if sums[0] >= 0 else 'left'}"]
        expected.append(f"v = {sums[1]:.1f}: {'down' if sums[1] >= 0 else 'up'}")
        assert page.locator(".sums td.number").all_inner_texts() == expected
    page.get_by_role("button", name="Back to the start").click()
    page.get_by_role("button", name="One step").click()
    assert "Step 1:" in page.locator(".status:visible").inner_text()
    page.get_by_role("button", name="Play").click()
    page.wait_for_function("document.querySelector('input[type=range][max=\"300\"]').value > 5")
    page.get_by_role("button", name="Pause").click()


def test_weights_to_start_from(visit):
    page = visit("view=drive")
    choice = page.get_by_role("combobox", name="Weights")
    titles = choice.locator("option").all_inner_texts()
    assert any("wall follower" in title for title in titles)
    published = paper.published()
    for name in ("maze1", "maze2"):
        choice.select_option(label=next(title for title in titles if "Table 3" in title and name in title))
        rows = published[(published.table == "3") & (published.maze == name)].set_index("item")
        assert driven(page) == [rows.loc[f"p{i}", "mean"] for i in range(1, 17)]
    for name in ("maze1", "maze2"):
        page.get_by_role("combobox", name="Maze").select_option(name)
        choice.select_option(label=next(title for title in titles if "best of a run" in title))
        page.get_by_text("It was evolved just now").wait_for()
        end = safe.path(name, driven(page))[-1]
        assert safe.load_maze(name).distance(end) <= 2
        assert "a success" in page.locator(".outcome").inner_text()


def test_weights_that_are_being_evolved_do_not_overwrite_others(visit):
    page = visit("view=drive")
    choice = page.get_by_role("combobox", name="Weights")
    titles = choice.locator("option").all_inner_texts()
    choice.select_option(label=next(title for title in titles if "best of a run" in title))
    choice.select_option("random")
    chosen = driven(page)
    page.wait_for_timeout(1500)  # as long as the run would have taken, and more
    assert driven(page) == chosen


# Draw


def editor_at(page, maze):
    """A function that gives the position on the page of a cell of the editor."""
    page.locator("canvas.editor").scroll_into_view_if_needed()
    box = page.locator("canvas.editor").bounding_box()
    height, width = maze.shape

    def at(row, column):
        return box["x"] + (column + 0.5) * box["width"] / width, box["y"] + (row + 0.5) * box["height"] / height

    return at


def cells_address(maze):
    """The address of a maze to draw on."""
    return address.drive_address(maze).replace("view=drive", "view=draw")


def drag(page, at, start, end):
    """A stroke of the mouse from one cell to another."""
    page.mouse.move(*at(*start))
    page.mouse.down()
    page.mouse.move(*at(*end))
    page.mouse.up()


ROOM = safe.Maze(np.zeros((12, 20), dtype=bool), (1, 1), (10, 18))


def test_drawing_with_a_mouse(visit):
    page = visit(cells_address(ROOM))
    at = editor_at(page, ROOM)
    drag(page, at, (3, 0), (3, 17))
    walls = ROOM.walls.copy()
    walls[3, :18] = True
    assert np.array_equal(maze_at(page).walls, walls)
    drawn = safe.Maze(walls, ROOM.start, ROOM.goal)
    checks = page.locator(".checks").inner_text()
    assert "The goal can be reached" in checks
    assert f"26 cells away in rows and columns, and {ways_to_goal(drawn)[drawn.start]} on the shortest way" in checks

    page.get_by_label("Erase").check()
    page.mouse.click(*at(3, 5))
    page.get_by_label("Start", exact=True).check()
    page.mouse.click(*at(8, 2))
    page.get_by_label("Goal", exact=True).check()
    page.mouse.click(*at(3, 6))
    walls[3, 5] = walls[3, 6] = False
    assert maze_at(page) == safe.Maze(walls, (8, 2), (3, 6))
    for _ in range(3):
        page.get_by_role("button", name="Undo").click()
    assert maze_at(page) == drawn
    page.get_by_role("button", name="Redo").click()
    walls[3, 6] = True
    assert maze_at(page) == safe.Maze(walls, ROOM.start, ROOM.goal)


def test_a_stroke_that_leaves_the_maze_draws_nothing_outside(visit):
    page = visit(cells_address(ROOM))
    at = editor_at(page, ROOM)
    drag(page, at, (6, 4), (-3, 4))
    walls = ROOM.walls.copy()
    walls[:7, 4] = True
    assert np.array_equal(maze_at(page).walls, walls)


def test_a_narrow_maze_makes_no_endless_page(visit):
    page = visit(cells_address(safe.Maze(np.zeros((400, 2), dtype=bool), (0, 0), (399, 1))))
    page.locator("canvas.editor").wait_for()
    assert page.locator("canvas.editor").bounding_box()["height"] < DESKTOP["height"]


def test_what_was_drawn_is_not_lost_to_another_maze(visit):
    page = visit(cells_address(ROOM))
    page.mouse.click(*editor_at(page, ROOM)(6, 9))
    drawn = maze_at(page)
    page.get_by_role("combobox", name="Maze").select_option("spiral")
    assert dict(address_of(page))["maze"] == "spiral"
    page.get_by_role("button", name="Undo").click()
    assert maze_at(page) == drawn


def test_a_drawing_whose_goal_is_cut_off_is_not_a_maze_yet(visit):
    page = visit(cells_address(ROOM))
    drag(page, editor_at(page, ROOM), (5, 0), (5, 19))
    assert "goal must be reachable from the start" in page.locator(".checks").inner_text()
    page.get_by_role("tab", name="Drive").click()
    assert maze_at(page) == ROOM


def test_drawing_with_a_finger(visit):
    page = visit(cells_address(ROOM), viewport=PHONE, has_touch=True, is_mobile=True)
    at = editor_at(page, ROOM)
    page.touchscreen.tap(*at(6, 9))
    walls = ROOM.walls.copy()
    walls[6, 9] = True
    assert np.array_equal(maze_at(page).walls, walls)


def test_drawing_with_the_keyboard(visit):
    page = visit(cells_address(ROOM))
    page.locator("canvas.editor").focus()
    for key in ("ArrowDown", "ArrowRight", "Space", "ArrowRight", "Enter", "Shift+ArrowRight", "Space"):
        page.keyboard.press(key)
    assert "Row 2, column 13: wall" in page.locator("[role=status]:visible").all_inner_texts()[0]
    walls = ROOM.walls.copy()
    walls[2, [2, 3, 13]] = True
    assert np.array_equal(maze_at(page).walls, walls)
    page.keyboard.press("Control+z")
    walls[2, 13] = False
    assert np.array_equal(maze_at(page).walls, walls)


@pytest.mark.parametrize("button", ["Save as drawing", "Save as maze file"])
@pytest.mark.parametrize("name", ["medium", "rooms"])
def test_a_maze_is_saved_and_loaded(visit, tmp_path, button, name):
    page = visit(f"view=draw&maze={name}")
    with page.expect_download() as download:
        page.get_by_role("button", name=button).click()
    file = tmp_path / download.value.suggested_filename
    download.value.save_as(file)
    maze = safe.load_maze(file)
    if name == "medium":
        assert maze == safe.load_maze("medium")
    file.write_text(file.read_text(encoding="utf-8"), encoding="utf-16")  # as an editor on Windows might
    page.get_by_role("combobox", name="Maze").select_option("maze2")
    page.get_by_label("A file").set_input_files(file)
    page.get_by_text(f"{maze.distance(np.array(maze.start))} cells away").wait_for()
    page.get_by_role("button", name="Show as drawing below").click()
    assert safe.Maze.from_drawing(page.get_by_label("or its text").input_value()) == maze


UNKNOWN = (
    "a maze must be a drawing in . 0 or blanks (open), # 1 X + - | or blocks (wall), S 2 (start) and G E 3 (goal), or "
    "a list that gives its size, or line segments"
)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("S..\n.y.\n..G", f"{UNKNOWN}; got 'y' in row 2"),
        ("<img src=x onerror=alert(1)>", f"{UNKNOWN}; got '<' in row 1"),
        ("size 3,3\nstart 0,0", "a maze file must give the goal; got none"),
        ("", "the drawing of a maze must have at least one row; got none"),
    ],
)
def test_nonsense_gets_one_clear_line(visit, tmp_path, text, message):
    page = visit("view=draw&maze=maze2")
    file = tmp_path / "nonsense.maze"
    file.write_text(text, encoding="utf-8")
    page.get_by_label("A file").set_input_files(file)
    problem = page.get_by_role("alert")
    problem.get_by_text(message).wait_for()
    assert problem.inner_text() == message
    assert page.get_by_role("combobox", name="Maze").input_value() == "maze2"
    page.get_by_label("or its text").fill("S.G")
    page.get_by_role("button", name="Load this text").click()
    problem.wait_for(state="hidden")
    assert maze_at(page) == safe.Maze.from_drawing("S.G")
