"""The playground's page in a browser, as a reader uses it. All that it computes is compared with the package."""

import re
from pathlib import Path
from urllib.parse import quote

import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe

import safe
from safe.companion import paper
from safe.maze import ways_to_goal
from safe.playground import address
from safe.results import statistics
from tests.helpers.addresses import maze_of, run_at
from tests.helpers.browser import DESKTOP, PHONE, complaints_of, needs_browser

pytestmark = needs_browser

LARGEST = 150_000  # bytes of script and stylesheet
VIEWS = {"watch": "Watch", "drive": "Drive", "draw": "Draw", "runs": "Many runs"}
QUICK = "population=20&objectives=20&generations=30"
QUICK_PARAMETERS = safe.Parameters(population=20, objectives=20, generations=30)


@pytest.fixture
def visit(browser, site):
    """Open the playground at an address, as a reader would. Whatever goes wrong in a page fails the test."""
    visits = []

    def open_page(fragment="", viewport=DESKTOP, page_name="book/playground.html", **options):
        context = browser.new_context(viewport=viewport, **options)
        page = context.new_page()
        visits.append((context, complaints_of(page, (site, f"blob:{site}", "data:"), ("error", "warning"))))
        page.goto(f"{site}{page_name}" + (f"#{fragment}" if fragment else ""))
        return page

    yield open_page
    for context, _ in visits:
        context.close()
    assert [complaint for _, complaints in visits for complaint in complaints] == []


def panel(page, title):
    """The line in which the page says how far an algorithm has come."""
    return page.get_by_role("region", name=title).locator(".status")


def play_to_the_end(page, *titles):
    page.get_by_label("Speed").fill("6")
    page.get_by_role("button", name="Play").click()
    for title in titles:
        panel(page, title).get_by_text(re.compile("uccess")).wait_for()
    page.get_by_role("button", name="Play").wait_for()


def status_of(run):
    """What the page says of a run that is over."""
    cells = "1 cell" if run.distance == 1 else f"{run.distance} cells"
    outcome, fitness = "Success" if run.success else "No success", ""
    if run.coefficients:
        outcome += f" in generation {run.generation}" if run.success else f" in {run.generation + 1} generations"
        a, b = (f"{float(f'{c:.3g}'):g}" for c in run.coefficients)
        fitness = f" Its fitness: {a} · closeness + {b} · novelty."
    return f"{outcome}: best {cells} from the goal, after {run.evaluations} robots.{fitness}"


def address_of(page):
    """The keys and values of the address, once the page has written its state there."""
    page.evaluate("new Promise((done) => setTimeout(done, 250))")  # started after the page's own timer
    fragment = page.evaluate("decodeURIComponent(location.hash.slice(1))")
    return [tuple(part.split("=", 1)) for part in fragment.split("&")]


def driven(page):
    """The controller in the address of the page, which drives."""
    return [float(weight) for weight in dict(address_of(page))["controller"].split(",")]


def maze_at(page):
    """The maze in the address of the page, which draws."""
    return maze_of(dict(address_of(page))["maze"])


def wait_for_view(page, view):
    """Wait until a view is complete."""
    page.get_by_role("tab", name=VIEWS[view], selected=True).wait_for()
    shown = {
        "watch": "Generation",
        "drive": "After 300 steps",
        "draw": "The goal can be reached",
        "runs": "Runs so far",
    }
    page.get_by_role("tabpanel").get_by_text(shown[view]).locator("visible=true").first.wait_for()


# Watch


def test_a_first_visit_opens_on_a_run_about_to_succeed(visit):
    page = visit()
    panel(page, "SAFE").get_by_text("Generation 40").wait_for()
    assert "press Play" in page.locator(".welcome").inner_text()
    page.get_by_role("button", name="Play").click()
    panel(page, "SAFE").get_by_text("Success").wait_for()
    assert panel(page, "SAFE").inner_text() == status_of(safe.evolve("maze1", "safe", 3))


def test_algorithms_side_by_side_are_those_of_the_package(visit):
    names = {"Standard EA": "standard", "Novelty search": "novelty", "SAFE": "safe", "Random search": "random"}
    algorithms = "&".join(f"algorithm={name}" for name in names.values())
    page = visit(f"maze=maze2&{algorithms}&seed=5&{QUICK}")
    play_to_the_end(page, *names)
    for title, name in names.items():
        run = safe.evolve("maze2", name, 5, QUICK_PARAMETERS)
        assert panel(page, title).inner_text() == status_of(run)
        page.get_by_role("region", name=title).get_by_role("button", name="Drive the best").click()
        assert driven(page) == list(run.controller)
        page.get_by_role("tab", name="Watch").click()


def test_one_generation_at_a_time_and_any_by_its_number(visit):
    generations = [g.distance for g in safe.generations("maze1", "novelty", 8, QUICK_PARAMETERS)]
    page = visit(f"algorithm=novelty&seed=8&{QUICK}")
    status = panel(page, "Novelty search")
    status.get_by_text("Generation 0:").wait_for()
    page.get_by_role("button", name="One generation").click()
    status.get_by_text(f"Generation 1: best {generations[1]} cells").wait_for()
    page.get_by_label("Generation", exact=True).fill("17")
    page.keyboard.press("Enter")
    status.get_by_text(f"Generation 17: best {generations[17]} cells").wait_for()
    assert ("generation", "17") in address_of(page)
    page.get_by_role("button", name="From the start").click()
    status.get_by_text("Generation 0:").wait_for()


def test_playing_can_be_paused_and_goes_on(visit):
    page = visit("algorithm=standard&seed=1")
    page.get_by_label("Speed").fill("4")
    page.get_by_role("button", name="Play").click()
    page.wait_for_function("document.querySelector('.panel .status').textContent.match(/\\d+/)[0] > 5")
    page.get_by_role("button", name="Pause").click()
    page.wait_for_function("location.hash.includes('&generation=')")  # once the one in the making is there
    page.get_by_role("button", name="Play").wait_for()
    reached = int(dict(address_of(page))["generation"])
    assert f"Generation {reached}:" in panel(page, "Standard EA").inner_text()
    play_to_the_end(page, "Standard EA")
    assert panel(page, "Standard EA").inner_text() == status_of(safe.evolve("maze1", "standard", 1))


def test_charts_show_the_run_so_far(visit):
    generations = list(safe.generations("maze1", "safe", 2, QUICK_PARAMETERS))
    page = visit(f"algorithm=safe&seed=2&{QUICK}&generation=12")
    panel(page, "SAFE").get_by_text("Generation 12").wait_for()
    now = generations[12]
    for title, value in (
        ("Best distance", now.distance),
        ("Mean novelty", now.novelty.mean()),
        ("Points in the archive", len(now.archive[0])),
    ):
        chart = page.get_by_role("img", name=title)
        assert chart.get_attribute("aria-label").endswith(f"SAFE: {float(f'{value:.3g}'):g} at 12")
        assert chart.locator("polyline").get_attribute("points").count(",") == 13
    square = page.get_by_role("img", name="Objective functions")
    assert square.locator(".judge").count() == 20
    assert square.locator(".winner").count() == len(set(now.winners.tolist()))


@pytest.mark.parametrize("algorithm", ["safe", "novelty", "standard", "random"])
def test_one_robot_is_explained(visit, algorithm):
    generation = list(safe.generations("maze1", algorithm, 4, QUICK_PARAMETERS))[9]
    page = visit(f"algorithm={algorithm}&seed=4&{QUICK}&generation=9")
    page.locator(".panel .status").get_by_text("Generation 9").wait_for()
    for individual in (0, 13):
        page.get_by_label("Robot", exact=True).fill(str(individual))
        page.keyboard.press("Enter")
        row, column = generation.endpoints[individual]
        page.get_by_text(f"Robot {individual} ended at row {row}, column {column}").wait_for()
        text = page.locator(".inspector").inner_text()
        if generation.novelty is not None:
            total = int(re.search(r"add up to (\d+)", text)[1])
            assert total / 15 == generation.novelty[individual]
            distances = re.search(r"\(([\d +]+)\)", text)[1].split(" + ")
            assert len(distances) == 15
            assert sum(map(int, distances)) == total
        if generation.fitness is None:
            assert "Nobody judges it" in text
            continue
        winner = generation.winners[individual]
        a, b = generation.objectives[winner]
        assert f"by objective function {winner} with a = {float(f'{a:.3g}'):g} and b = {float(f'{b:.3g}'):g}" in text
        fitness = generation.fitness[individual]
        if fitness > 0:
            share = a * generation.components[0, individual] / fitness
            assert f"({100 * share:.1f} %) and" in text
        else:
            assert "%" not in text
    page.get_by_role("button", name="Drive this robot").click()
    assert driven(page) == generation.genomes[13].tolist()


def test_a_click_selects_the_robot_that_ended_there(visit):
    generation = next(iter(safe.generations("maze1", "novelty", 4, QUICK_PARAMETERS)))
    page = visit(f"algorithm=novelty&seed=4&{QUICK}")
    panel(page, "Novelty search").get_by_text("Generation 0").wait_for()
    row, column = generation.endpoints[7].tolist()
    canvas = page.get_by_role("region", name="Novelty search").locator("canvas")
    box = canvas.bounding_box()
    canvas.click(position={"x": (column + 0.5) * box["width"] / 100, "y": (row + 0.5) * box["height"] / 100})
    page.get_by_text(f"ended at row {row}, column {column},").wait_for()


def test_a_click_while_playing_selects_from_the_generation_that_stays(visit):
    generations = {g.generation: g for g in safe.generations("maze2", "novelty", 4, QUICK_PARAMETERS)}
    page = visit(f"maze=maze2&algorithm=novelty&seed=4&{QUICK}")
    panel(page, "Novelty search").get_by_text("Generation 0").wait_for()
    page.get_by_label("Speed").fill("4")
    page.get_by_role("button", name="Play").click()
    page.wait_for_function("document.querySelector('.panel .status').textContent.match(/\\d+/)[0] > 3")
    page.get_by_role("region", name="Novelty search").locator("canvas").click(position={"x": 200, "y": 200})
    line = page.get_by_text(re.compile("^Robot .* ended at"))
    line.wait_for()
    generation = generations[int(page.get_by_label("Generation", exact=True).input_value())]
    robot, row, column = map(int, re.findall(r"\d+", line.inner_text())[:3])
    assert generation.endpoints[robot].tolist() == [row, column]


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("Run", "-1", "run must be an integer from 0 to 1000000; got -1"),
        ("Run", "1.5", "run must be an integer from 0 to 1000000; got 1.5"),
        ("Generation", "10000000000", "generation must be an integer from 0 to 1000000; got 10000000000"),
        ("population", "7", "population must be an even number; got 7"),
        ("mutation probability", "2", "mutation must be a number from 0 to 1; got 2"),
    ],
)
def test_a_number_out_of_range_is_refused_and_what_was_there_comes_back(visit, field, value, message):
    page = visit(f"algorithm=standard&seed=3/5&{QUICK}")
    panel(page, "Standard EA").get_by_text("Generation 0").wait_for()
    page.locator(".playground summary:visible").click()
    number = page.get_by_role("spinbutton", name=field, exact=True)
    before = number.input_value()
    number.fill(value)
    page.keyboard.press("Enter")
    page.get_by_role("alert").get_by_text(message).wait_for()
    assert number.input_value() == before


def test_less_motion_if_the_reader_asks_for_it(visit):
    page = visit(f"algorithm=standard&seed=1&{QUICK}", reduced_motion="reduce")
    panel(page, "Standard EA").get_by_text("Generation 0").wait_for()
    page.evaluate("""() => {
        globalThis.seen = [];
        const status = document.querySelector(".panel .status");
        const look = () => seen.push(parseInt(status.textContent.match(/\\d+/)));
        new MutationObserver(look).observe(status, { childList: true });
    }""")
    page.get_by_label("Speed").fill("3")  # ten generations a second, in one picture
    page.get_by_role("button", name="Play").click()
    panel(page, "Standard EA").get_by_text("No success").wait_for()
    assert page.evaluate("seen") == [10, 20, 30]


# Replay


def test_ten_rows_of_the_tables_open_their_runs(visit, html):
    """Two that fail, the first to succeed of each page, and others that succeed early; each is played to its end."""
    pages = ["table2-success", "fixed-weights", "unevolved", "coefficients", "table3-evolved", "generations", "replay"]
    runs, of_page = {}, {}
    for name in pages:
        text = (html / "notebooks" / f"{name}.html").read_text(encoding="utf-8")
        for href in re.findall(r'href="\.\./book/playground\.html#(view=watch[^"]*seed=[^"]*)"', text):
            href = href.replace("&amp;", "&")
            if href not in runs:
                runs[href], of_page[href] = run_at(href), name
    soonest = sorted(runs, key=lambda href: runs[href].generation)
    failures = [href for href in soonest if not runs[href].success][:2]
    soonest_of_pages = {of_page[href]: href for href in reversed(soonest)}.values()
    hrefs = list(dict.fromkeys([*failures, *soonest_of_pages, *soonest]))[:10]
    assert (len(hrefs), len(failures)) == (10, 2)
    assert len(soonest_of_pages) > 2
    for href in hrefs:
        page = visit(href)
        page.locator(".panel .status").get_by_text("Generation 0").wait_for()
        play_to_the_end(page, page.locator(".panel h2").inner_text())
        assert page.locator(".panel .status").inner_text() == status_of(runs[href])
        page.get_by_role("button", name="Drive the best").click()
        assert driven(page) == list(runs[href].controller)
        page.context.close()


def test_other_runs_of_an_experiment_are_a_number_away(visit):
    experiment = safe.Experiment("novelty", "maze1", parameters=QUICK_PARAMETERS)
    page = visit(f"algorithm=novelty&seed=0x{experiment.digest}/0&{QUICK}")
    panel(page, "Novelty search").get_by_text("Generation 0").wait_for()
    page.get_by_role("spinbutton", name="Run").fill("6")
    page.keyboard.press("Enter")
    play_to_the_end(page, "Novelty search")
    *_, last = experiment.replay(6)
    assert panel(page, "Novelty search").inner_text() == status_of(last.run)


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
@pytest.mark.parametrize("name", ["maze1", "rooms"])
def test_a_maze_is_saved_and_loaded(visit, tmp_path, button, name):
    page = visit(f"view=draw&maze={name}")
    with page.expect_download() as download:
        page.get_by_role("button", name=button).click()
    file = tmp_path / download.value.suggested_filename
    download.value.save_as(file)
    maze = safe.load_maze(file)
    if name == "maze1":
        assert maze == safe.load_maze("maze1")
    page.get_by_role("combobox", name="Maze").select_option("maze2")
    page.get_by_label("A file").set_input_files(file)
    page.get_by_text(f"{maze.distance(np.array(maze.start))} cells away").wait_for()
    page.get_by_role("button", name="Show as drawing below").click()
    assert safe.Maze.from_drawing(page.get_by_label("or its text").input_value()) == maze


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("S..\n.x.\n..G", "the drawing of a maze must use only . 0 # 1 S 2 G 3; got 'x' in row 2"),
        ("<img src=x onerror=alert(1)>", "the drawing of a maze must use only . 0 # 1 S 2 G 3; got '<' in row 1"),
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


# Addresses


@pytest.mark.parametrize(
    ("fragment", "message"),
    [
        ("maze=maze9", "maze must be one of 'maze1', 'maze2'"),
        ("algorithm=genetic", "algorithm must be one of 'standard', 'novelty', 'safe'"),
        ("seed=-1", "seed must be an integer"),
        ("population=7", "population must be an even number; got 7"),
        ("controller=1,2", "controller must have the shape (16); got shape (2,)"),
        ("maze=3x3/0,0/9,9/AAA", "goal must be a (row, column) within the 3 by 3 cells; got (9, 9)"),
        ("maze=3x3/0,0/2,2/%E0%A4%A", "an address must be encoded as a browser does"),
        ("constructor=1", "an address must hold known keys; got 'constructor'"),
        ("view=<img src=x onerror=alert(1)>", "view must be one of 'watch', 'drive', 'draw', 'runs'; got '<img"),
        ("algorithm=<b>bold</b>:none:x", "algorithm must be a name, or name:rating:a,b,..."),
    ],
)
def test_a_broken_link_gets_one_clear_line_and_still_shows_something(visit, fragment, message):
    page = visit(fragment)
    problem = page.get_by_role("alert")
    problem.wait_for()
    assert message in problem.inner_text()
    assert "\n" not in problem.inner_text()
    assert page.locator(".playground img, .playground b").count() == 0
    panel(page, "SAFE").get_by_text("Generation 0").wait_for()


def test_a_name_in_an_address_is_never_markup(visit):
    name = "<img src=x onerror=alert(1)>"
    page = visit(f"algorithm={quote(name)}:none:0.5,0.5&{QUICK}")
    page.get_by_role("heading", name=name).wait_for()
    assert page.locator(".playground img").count() == 0


def test_the_address_holds_the_whole_state(visit):
    page = visit(f"view=watch&maze=trap&algorithm=novelty&algorithm=standard&seed=1,2/3&{QUICK}&k=3&generation=4")
    panel(page, "Novelty search").get_by_text("Generation 4").wait_for()
    page.get_by_role("button", name="One generation").click()
    panel(page, "Standard EA").get_by_text("Generation 5").wait_for()
    assert address_of(page) == [
        ("view", "watch"),
        ("maze", "trap"),
        ("algorithm", "novelty"),
        ("algorithm", "standard"),
        ("seed", "1,2/3"),
        ("population", "20"),
        ("objectives", "20"),
        ("generations", "30"),
        ("k", "3"),
        ("generation", "5"),
    ]
    again = visit(page.evaluate("location.hash.slice(1)"))
    panel(again, "Standard EA").get_by_text("Generation 5").wait_for()
    assert panel(again, "Standard EA").inner_text() == panel(page, "Standard EA").inner_text()


def test_the_links_of_the_page_lead_to_what_they_say(visit, html):
    page = visit()
    for link in page.locator('article a[href^="#view="]').all():
        link.click()
        view = dict(part.split("=", 1) for part in link.get_attribute("href")[1:].split("&"))["view"]
        page.get_by_role("tab", name=VIEWS[view], selected=True).wait_for()
        assert page.get_by_role("alert").count() == 0


def test_the_links_of_the_lesson_are_read(visit, html):
    links = re.findall(r'href="playground\.html#([^"]+)"', (html / "book" / "use.html").read_text(encoding="utf-8"))
    assert len(links) == 5
    for link in links:
        page = visit(link.replace("&amp;", "&"))
        page.get_by_role("tab", selected=True).wait_for()
        assert page.get_by_role("alert").count() == 0


# Many runs


def test_many_runs_count_as_the_package_counts(visit):
    page = visit(f"view=runs&algorithm=novelty&algorithm=random&seed=100&maze=rooms&{QUICK}")
    page.get_by_label("runs of each algorithm").fill("20")
    page.get_by_role("button", name="Run", exact=True).click()
    page.locator(".outcomes tbody tr").nth(1).get_by_text("20", exact=True).first.wait_for()
    page.get_by_role("button", name="Run", exact=True).wait_for()
    maze = safe.Maze.from_drawing(_drawing_of(visit, "rooms"))
    for row, name in enumerate(("novelty", "random")):
        runs = [safe.evolve(maze, name, 100 + i, QUICK_PARAMETERS) for i in range(20)]
        successes = sum(run.success for run in runs)
        low, high = statistics.success_interval(successes, 20)
        cells = page.locator(".outcomes tbody tr").nth(row).locator("td.number").all_inner_texts()
        rate, low, high = (f"{100 * share:.{int(0 < share < 0.1)}f}" for share in (successes / 20, low, high))
        assert cells == ["20", str(successes), f"{rate} %", f"{low} to {high} %"]
    outcomes = page.locator(".outcomes").inner_text()
    failed = [run.success for run in runs].index(False)
    page.locator(".outcomes tbody tr").nth(1).get_by_role("button", name="a failure").click()
    assert ("seed", str(100 + failed)) in address_of(page)
    page.get_by_role("tab", name="Many runs").click()
    assert page.locator(".outcomes").inner_text() == outcomes
    assert [value for key, value in address_of(page) if key in ("algorithm", "seed")] == ["novelty", "random", "100"]
    page.get_by_label("Seed").locator("visible=true").fill("7")
    page.keyboard.press("Enter")
    assert page.locator(".outcomes tbody tr").count() == 0


def _drawing_of(visit, name):
    page = visit(f"view=draw&maze={name}")
    page.get_by_role("button", name="Show as drawing below").click()
    return page.get_by_label("or its text").input_value()


def test_many_runs_stop_and_go_on(visit):
    page = visit("view=runs&algorithm=standard&seed=0&population=20&objectives=20&generations=150")
    count, button = page.get_by_label("runs of each"), page.get_by_role("button", name="Run", exact=True)
    count.fill("500")
    button.click()
    page.wait_for_function("document.querySelector('.outcomes tbody td')?.textContent > 2")
    page.get_by_role("button", name="Stop").click()
    done = int(page.locator(".outcomes tbody td").first.inner_text())
    more = done + 20
    count.fill(str(more))
    page.evaluate("""() => {
        globalThis.seen = [];
        const rows = document.querySelector(".outcomes tbody");
        const look = () => seen.push(parseInt(rows.querySelector("td").textContent));
        new MutationObserver(look).observe(rows, { childList: true, subtree: true });
    }""")
    button.click()
    page.wait_for_function(f"document.querySelector('.outcomes tbody td').textContent >= {more}")
    button.wait_for()
    seen = page.evaluate("seen")
    assert seen == sorted(seen)
    assert done <= seen[0] < seen[-1] == more


# Good to use


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
    tab_to("Run")
    page.keyboard.press("Enter")
    page.wait_for_function("document.querySelector('.outcomes tbody td')?.textContent > 0")


@pytest.mark.parametrize("view", VIEWS)
def test_on_a_phone_nothing_is_cut_off(visit, view):
    page = visit(f"view={view}&algorithm=safe&algorithm=standard&seed=3&generation=5", viewport=PHONE)
    wait_for_view(page, view)
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
    page = visit(f"view={view}&algorithm=safe&algorithm=novelty&seed=3&generation=5&{QUICK}", color_scheme=scheme)
    wait_for_view(page, view)
    if view == "watch":
        panel(page, "SAFE").get_by_text("Generation 5").wait_for()
        page.get_by_label("Robot", exact=True).fill("4")
        page.keyboard.press("Enter")
        page.get_by_text("Robot 4 ended").wait_for()
        page.locator(".playground summary:visible").click()
    found = Axe().run(page, context="#playground", options={"preload": False}).response["violations"]
    assert [(v["id"], [node["html"][:120] for node in v["nodes"]]) for v in found] == []


def test_it_follows_the_theme_of_the_book(visit):
    page = visit("view=drive", color_scheme="light")
    colour = "getComputedStyle(document.querySelector('.playground')).backgroundColor"
    light = page.evaluate(colour)
    page.evaluate("document.documentElement.dataset.theme = 'dark'")
    assert page.evaluate(colour) != light


def test_it_is_small(html):
    files = [Path(html, "_static", "playground", name) for name in ("bundle.js", "playground.css")]
    assert sum(file.stat().st_size for file in files) < LARGEST
