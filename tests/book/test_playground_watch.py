"""The playground's view *Watch* in a browser, and runs of the book's tables replayed there.

All that it computes is compared with the package.
"""

import re
from dataclasses import replace

import numpy as np
import pytest

import safe
from tests.helpers.addresses import algorithm_of, run_at
from tests.helpers.browser import PHONE, needs_browser
from tests.helpers.playground_page import (
    QUICK,
    QUICK_PARAMETERS,
    address_of,
    driven,
    look_at,
    panel,
    place_of,
    play_to_the_end,
    short,
    status_of,
)

pytestmark = needs_browser


# Watch


def test_a_first_visit_opens_on_a_run_about_to_succeed(visit):
    page = visit()
    panel(page, "SAFE").get_by_text("Generation 40").wait_for()
    assert "press Play" in page.locator("p.welcome").inner_text()
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


def test_the_legend_has_the_colours_of_the_algorithms(visit):
    page = visit(f"algorithm=standard&algorithm=weighing-and-goals&seed=3&{QUICK}")
    panel(page, "Standard EA").get_by_text("Generation 0").wait_for()
    colours = page.locator(".legend .dot").evaluate_all(
        "nodes => nodes.map((node) => getComputedStyle(node).backgroundColor)"
    )
    lines = page.locator(".panel .swatch .line").evaluate_all(
        "nodes => nodes.map((node) => getComputedStyle(node).stroke)"
    )
    assert colours == lines
    assert len(set(colours)) == 2


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


def standings_of(generation, robot):
    """The rows of the table in which the page compares a robot with the others of its generation."""
    (closeness, novelty), scaled = generation.components, generation.scaled
    measures = {"closeness (1 / distance)": closeness}
    if scaled is not None and scaled[0].any():  # else no objective function can weigh it
        measures["closeness as weighed"] = scaled[0]
    if generation.novelty is not None:
        measures["novelty"] = novelty
        if scaled is not None:
            measures["novelty as weighed"] = scaled[1]
    if generation.fitness is not None:
        measures["fitness"] = generation.fitness
    return [
        [measure, short(values[robot]), short(values.max()), str(1 + (values > values[robot]).sum())]
        for measure, values in measures.items()
    ]


@pytest.mark.parametrize(
    ("algorithm", "admission"),
    [
        *((name, "lowest replaced") for name in ("safe", "novelty", "standard", "fixed", "random")),
        ("safe:genotypic:drawn:rank:drawn", "random"),
        ("safe:pearson:drawn:maximum:drawn", "rescored"),
        ("standard:none:1,0:rank:best", "lowest replaced"),
        ("novelty:none:0,1:maximum:best", "distinct"),
        ("fixed:none:0.5,0.5:maximum:drawn", "after scoring"),
        ("mine:none:-1,-0.5,-0.5,-1", "lowest replaced"),
    ],
)
def test_one_robot_is_explained(visit, algorithm, admission):
    parameters = replace(QUICK_PARAMETERS, admission=admission)
    generation = list(safe.generations("maze1", algorithm_of(algorithm), 4, parameters))[9]
    page = visit(f"algorithm={algorithm}&seed=4&{QUICK}&generation=9&admission={admission}")
    page.locator(".panel .status").get_by_text("Generation 9").wait_for()
    for individual in (0, 13):
        look_at(page, individual)
        row, column = generation.endpoints[individual]
        text = page.locator(".inspector").inner_text()
        assert f"Robot {individual} ended at row {row}, column {column}," in text
        standings = standings_of(generation, individual)
        table = page.get_by_role("table", name="Among the 20 robots")
        rows = table.locator("tbody tr").all()
        assert [row.locator("th, td").all_inner_texts() for row in rows] == standings
        bars = table.locator(".bar").evaluate_all(
            "bars => bars.map((bar) => parseFloat(getComputedStyle(bar).backgroundSize))"
        )
        shares = [max(0, float(value) / abs(float(largest))) for _, value, largest, _ in standings]
        assert bars == pytest.approx([100 * share for share in shares], abs=1)
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
        assert f"by objective function {winner} with a = {short(a)} and b = {short(b)}" in text
        wins = (generation.winners == winner).sum()
        given = f"Objective function {winner} gives {'all' if wins == 20 else f'{wins} of the'} 20 fitnesses"
        if algorithm.endswith("drawn") and len(generation.objectives) > 1:
            assert f"{given}. But parents are not chosen by fitness: each tournament draws its judge from all" in text
        else:
            assert f"{given}, by which tournaments choose parents." in text
        fitness = generation.fitness[individual]
        if fitness > 0:
            weighed = generation.components if generation.scaled is None else generation.scaled
            share = a * weighed[0, individual] / fitness
            assert f"({100 * share:.1f} %) and" in text
        else:
            assert "%" not in text
    page.get_by_role("button", name="Drive this robot").click()
    assert driven(page) == generation.genomes[13].tolist()


@pytest.mark.parametrize(
    ("algorithm", "says"),
    [
        ("goals:mutualism:drawn:raw:best:goal:generation:distance,novelty", "by which tournaments choose parents."),
        (
            "goals:patience:drawn:raw:favourite:goal:generation:distance,novelty",
            "each is the favourite of one, drawn from all 20 objective functions.",
        ),
        (
            "goals:none:drawn:raw:drawn:goal:repertoire:distance,novelty",
            "each tournament draws its judge from all 20 objective functions, among the latest robots of the {} cells",
        ),
        (
            "both:redrawn:drawn:raw:favourite:mixed:repertoire:novelty,rarity,way",
            "drawn from all 20 objective functions; goals choose among the latest robots of the {} cells",
        ),
        ("random:none::raw:best:weights:repertoire:distance,novelty", "drawn from the latest robots of the {} cells"),
        ("three:discovery:drawn:rank:best:weights:generation:distance,novelty,rarity", "tournaments choose parents."),
        ("one:none:2:raw:best:weights:generation:rarity", "Objective function 0 gives all 20 fitnesses, by which"),
    ],
)
def test_a_robot_is_explained_whoever_judges_it(visit, algorithm, says):
    given = algorithm_of(algorithm)
    generation = list(safe.generations("maze1", given, 4, QUICK_PARAMETERS))[9]
    page = visit(f"algorithm={algorithm}&seed=4&{QUICK}&generation=9")
    page.locator(".panel .status").get_by_text("Generation 9").wait_for()
    reached = None if generation.repertoire is None else len(generation.repertoire[1])
    for robot in range(3):
        look_at(page, robot)
        text = page.locator(".inspector").inner_text()
        assert says.format(reached) in text
        if generation.winners is None:
            assert "Nobody judges it: parents are drawn" in text
            continue
        winner = generation.winners[robot]
        genes = generation.objectives[winner]
        assert f"Fitness {short(generation.fitness[robot])}, by objective function {winner}" in text
        if given.kind == "goal" or (given.kind == "mixed" and winner >= 10):
            row, column = place_of(genes)
            away = -int(generation.fitness[robot])
            assert f"a goal: the place ({row}, {column}), {away} cell" in text
        else:
            weighed = generation.components if generation.scaled is None else generation.scaled
            for letter, gene, value in zip("abcd", genes, weighed[:, robot], strict=False):
                assert f"{letter} = {short(gene)}" in text
                assert f"{short(gene * value)} for " in text
    table = page.get_by_role("table", name="Among the 20 robots")
    rows = [row.locator("th, td").all_inner_texts() for row in table.locator("tbody tr").all()]
    assert ["fitness" in row for row in rows].count(True) == (generation.fitness is not None)
    play_to_the_end(page, page.locator(".panel h2").inner_text())
    if given.kind != "mixed":
        assert page.locator(".panel .status").inner_text() == status_of(
            safe.evolve("maze1", given, 4, QUICK_PARAMETERS), given
        )


PIXELS = """cells => {
    const canvas = document.querySelector(".panel canvas"), scale = canvas.width / 100;
    const context = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
    Object.assign(context.canvas, { width: canvas.width, height: canvas.height });
    context.drawImage(canvas, 0, 0);
    return cells.map(([row, column]) =>
        Array.from(context.getImageData((column + 0.5) * scale - 1, (row + 0.5) * scale - 1, 3, 3).data));
}"""
PLACE = {"light": [0x1D, 0x4E, 0xD8], "dark": [0x8F, 0xB4, 0xFF]}  # see playground.css


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("pool", ["generation", "repertoire"])
def test_goals_are_places_on_the_maze_and_may_be_linked_to_their_favourites(visit, pool, scheme):
    algorithm = f"goals:redrawn:drawn:raw:favourite:goal:{pool}:distance,novelty"
    generation = list(safe.generations("maze1", algorithm_of(algorithm), 4, QUICK_PARAMETERS))[9]
    places = np.array([place_of(goal) for goal in generation.objectives])
    ends = generation.endpoints if pool == "generation" else generation.repertoire[1]
    favourites = np.array([ends[np.abs(ends - place).sum(axis=1).argmin()] for place in places])

    page = visit(f"algorithm={algorithm}&seed=4&{QUICK}&generation=9", color_scheme=scheme)
    page.evaluate("theme => document.documentElement.dataset.theme = theme", scheme)
    page.locator(".panel .status").get_by_text("Generation 9").wait_for()

    def shown(cells):
        page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        return np.reshape(page.evaluate(PIXELS, cells.tolist()), (len(cells), 9, 4))[:, :, :3]

    assert "the places of 20 goals," in page.locator(".panel canvas").get_attribute("aria-label")
    assert page.get_by_text("places that goals name").is_visible()
    assert page.get_by_role("img", name="Objective functions").count() == 0
    differences = np.abs(shown(places) - PLACE[scheme]).sum(axis=2).min(axis=1)
    assert (differences < 40).mean() > 0.8  # others lie below the start, the goal or the best robot

    middles, is_far = (places + favourites) / 2, np.abs(places - favourites).sum(axis=1) > 6
    assert is_far.sum() > 4
    linking = page.get_by_label("link places to their favourites")
    before = shown(middles)
    linking.check()
    assert (shown(middles) != before).any(axis=(1, 2))[is_far].mean() > 0.8
    linking.uncheck()
    assert (shown(middles) == before).all()

    robot = next(i for i, end in enumerate(generation.endpoints) if (favourites == end).all(axis=1)[is_far].any())
    is_own = (favourites == generation.endpoints[robot]).all(axis=1)
    look_at(page, robot)
    alone = shown(middles)
    linking.check()
    together = shown(middles)
    assert (alone == together).all(axis=(1, 2))[is_far & is_own].all()  # its own places are linked all the time
    assert (alone != together).any(axis=(1, 2))[is_far & ~is_own].any()


def test_without_goals_there_are_no_places(visit):
    page = visit(f"algorithm=safe&seed=4&{QUICK}&generation=2")
    panel(page, "SAFE").get_by_text("Generation 2").wait_for()
    assert page.get_by_label("link places to their favourites").count() == 1
    assert not page.get_by_label("link places to their favourites").is_visible()
    assert not page.get_by_text("places that goals name").is_visible()
    assert "goals" not in page.locator(".panel canvas").get_attribute("aria-label")


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
        page = visit(href, viewport=PHONE)  # where less is drawn
        page.locator(".panel .status").get_by_text("Generation 0").wait_for()
        play_to_the_end(page, page.locator(".panel h2").inner_text())
        assert page.locator(".panel .status").inner_text() == status_of(runs[href])
        page.get_by_role("button", name="Drive the best").click()
        assert driven(page) == list(runs[href].controller)


def test_other_runs_of_an_experiment_are_a_number_away(visit):
    experiment = safe.Experiment("novelty", "maze1", parameters=QUICK_PARAMETERS)
    page = visit(f"algorithm=novelty&seed=0x{experiment.digest}/0&{QUICK}")
    panel(page, "Novelty search").get_by_text("Generation 0").wait_for()
    page.get_by_role("spinbutton", name="Run").fill("6")
    page.keyboard.press("Enter")
    play_to_the_end(page, "Novelty search")
    *_, last = experiment.replay(6)
    assert panel(page, "Novelty search").inner_text() == status_of(last.run)
