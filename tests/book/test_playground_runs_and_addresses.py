"""The playground's view *Many runs* in a browser, and its addresses.

All that it computes is compared with the package.
"""

from dataclasses import replace
from urllib.parse import quote

import pytest

import safe
from safe.judges import RATINGS
from safe.novelty import ADMISSIONS
from safe.results import statistics
from tests.helpers.browser import needs_browser
from tests.helpers.playground_page import (
    QUICK,
    QUICK_PARAMETERS,
    VIEWS,
    address_of,
    panel,
    play_to_the_end,
    status_of,
)

pytestmark = needs_browser


# Addresses


@pytest.mark.parametrize(
    ("fragment", "message"),
    [
        ("maze=maze9", "maze must be one of 'hard', 'maze1', 'maze2', 'medium'"),
        ("algorithm=genetic", "algorithm must be one of 'standard', 'novelty', 'safe'"),
        ("seed=-1", "seed must be an integer"),
        ("population=7", "population must be an even number; got 7"),
        ("controller=1,2", "controller must have the shape (16); got shape (2,)"),
        ("maze=3x3/0,0/9,9/AAA", "goal must be a (row, column) within the 3 by 3 cells; got (9, 9)"),
        ("maze=3x3/0,0/2,2/%E0%A4%A", "an address must be encoded as a browser does"),
        ("constructor=1", "an address must hold known keys; got 'constructor'"),
        (
            "view=<img src=x onerror=alert(1)>",
            "view must be one of 'watch', 'drive', 'draw', 'runs', 'challenges'; got '<img",
        ),
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


def test_choices_beyond_the_paper_reach_the_address_and_the_run(visit):
    page = visit(f"view=watch&algorithm=safe&algorithm=random&seed=3&{QUICK}")
    page.locator(".playground summary:visible").click()

    def choose(label, option):
        page.get_by_label(label).locator("visible=true").select_option(option)

    many = page.get_by_label("how many, in each generation").locator("visible=true")
    assert many.count() == 0
    rules = page.get_by_label("what enters the archive").locator("visible=true").locator("option")
    assert [rule.get_attribute("value") for rule in rules.all()] == list(ADMISSIONS)
    assert "undefined" not in page.locator(".playground option").all_inner_texts()
    choose("what enters the archive", "some, drawn at random")
    many.fill("9")
    page.keyboard.press("Enter")
    choose("what objective functions are bred for", "ranks that grow near the goal (Spearman)")
    choose("how components are weighed", "as ranks from 0 to 1")
    choose("who chooses parents", "one objective function, drawn each time")
    address = address_of(page)
    assert [value for key, value in address if key == "algorithm"] == ["safe:spearman:drawn:rank:drawn", "random"]
    assert address[-2:] == [("admission", "random"), ("admitted", "9")]
    page.get_by_role("checkbox", name="Novelty search (rank, drawn judge)").check()
    play_to_the_end(page, "SAFE (spearman, rank, drawn judge)", "Novelty search (rank, drawn judge)")
    parameters = replace(QUICK_PARAMETERS, admission="random", admitted=9)
    choices = {"scaling": "rank", "judging": "drawn judge"}
    for title, algorithm in (
        ("SAFE (spearman, rank, drawn judge)", safe.Algorithm("safe", None, "spearman", **choices)),
        ("Novelty search (rank, drawn judge)", safe.Algorithm("novelty", [(0, 1)], **choices)),
        ("Random search", "random"),
    ):
        assert panel(page, title).inner_text() == status_of(safe.evolve("maze1", algorithm, 3, parameters))
    choose("what enters the archive", "the most novel (paper)")
    choose("what objective functions are bred for", "nothing: they stay as drawn")
    unevolved = page.get_by_role("region", name="SAFE (unevolved, rank, drawn judge)")
    assert unevolved.get_by_text("judged by other objective functions").is_visible()
    choose("what objective functions are bred for", "being different (paper)")
    choose("how components are weighed", "as they are (paper)")
    choose("who chooses parents", "the best of all scores (paper)")
    assert [value for key, value in address_of(page) if key == "algorithm"] == ["safe", "random", "novelty"]
    page.get_by_role("checkbox", name="SAFE").uncheck()
    assert page.get_by_label("what objective functions are bred for").locator("visible=true").count() == 0
    assert page.get_by_label("who chooses parents").locator("visible=true").count() == 1


def test_kinds_pools_and_components_reach_the_address_and_the_run(visit):
    page = visit(f"view=watch&algorithm=safe&seed=3&{QUICK}")
    page.locator(".playground summary:visible").click()
    labels = {
        "kind": "what objective functions are",
        "rating": "what objective functions are bred for",
        "scaling": "how components are weighed",
        "judging": "who chooses parents",
        "pool": "from where parents are taken",
        "patience": "generations until it is given up",
    }

    def field(name):
        role = "spinbutton" if name == "patience" else "combobox"
        return page.get_by_role(role, name=labels[name], exact=True)

    def offered(name):
        return [option.get_attribute("value") for option in field(name).locator("option:not([disabled])").all()]

    def algorithms():
        return [value for key, value in address_of(page) if key == "algorithm"]

    assert [name for name in labels if field(name).count() == 1] == ["kind", "rating", "scaling", "judging"]
    assert offered("rating") == [rating for rating in RATINGS if rating != "patience"]
    for component in ("novelty", "path rarity", "closeness on the way"):
        page.get_by_role("checkbox", name=component, exact=True).click()
    assert algorithms() == ["safe:genotypic:drawn:raw:best:weights:generation:distance,rarity,way"]
    weighing = safe.Algorithm("safe", None, "genotypic novelty", components=("1 / distance", "path rarity", "1 / way"))
    title = "SAFE (closeness + path rarity + closeness on the way)"
    play_to_the_end(page, title)
    assert panel(page, title).inner_text() == status_of(safe.evolve("maze1", weighing, 3, QUICK_PARAMETERS), weighing)
    for component in ("closeness", "path rarity", "closeness on the way"):
        page.get_by_role("checkbox", name=component, exact=True).click()
    page.get_by_role("alert").get_by_text("components must be some of").wait_for()
    assert page.get_by_role("checkbox", name="closeness on the way", exact=True).is_checked()

    field("scaling").select_option("rank")
    field("rating").select_option("mutualism")
    field("kind").select_option("goal")
    assert [name for name in labels if field(name).count() == 1] == ["kind", "rating", "judging", "pool"]
    assert page.get_by_role("checkbox", name="path rarity").locator("visible=true").count() == 0
    field("rating").select_option("patience")
    field("patience").fill("4")
    page.keyboard.press("Enter")
    field("pool").select_option("repertoire")
    assert offered("judging") == ["drawn judge", "favourite"]
    assert algorithms() == ["safe:patience:drawn:raw:favourite:goal:repertoire:distance,novelty"]
    assert address_of(page)[-1] == ("patience", "4")
    title = "SAFE (goals, patience, favourite, repertoire)"
    play_to_the_end(page, title)
    goals = safe.Algorithm("safe", None, "patience", judging="favourite", kind="goal", pool="repertoire")
    run = safe.evolve("maze1", goals, 3, replace(QUICK_PARAMETERS, patience=4))
    assert panel(page, title).inner_text() == status_of(run, goals)

    field("kind").select_option("mixed")
    assert offered("rating") == ["none", "redrawn"]
    assert algorithms() == ["safe:redrawn:drawn:raw:favourite:mixed:repertoire:distance,novelty"]
    field("kind").select_option("weights")
    assert algorithms() == ["safe:redrawn:drawn:raw:favourite"]

    page.get_by_role("checkbox", name="Random search").check()
    page.get_by_role("checkbox", name="SAFE (redrawn, favourite)").click()
    assert [name for name in labels if field(name).count() == 1] == ["pool"]
    field("pool").select_option("repertoire")
    play_to_the_end(page, "MAP-Elites")
    nobody = safe.Algorithm("random", [], pool="repertoire")
    run = safe.evolve("maze1", nobody, 3, QUICK_PARAMETERS)
    assert panel(page, "MAP-Elites").inner_text() == status_of(run, nobody)


def test_the_links_of_the_page_lead_to_what_they_say(visit, html):
    page = visit()
    for link in page.locator('article a[href^="#view="]').all():
        link.click()
        view = dict(part.split("=", 1) for part in link.get_attribute("href")[1:].split("&"))["view"]
        page.get_by_role("tab", name=VIEWS[view], selected=True).wait_for()
        assert page.get_by_role("alert").count() == 0


# Many runs


def test_many_runs_count_as_the_package_counts(visit):
    maze = safe.Maze.from_drawing(_drawing_of(visit, "rooms"))
    page = visit(f"view=runs&algorithm=novelty&algorithm=random&seed=100&maze=rooms&{QUICK}")
    page.get_by_label("runs of each algorithm").fill("20")
    page.get_by_role("button", name="Run", exact=True).click()
    page.locator(".outcomes tbody tr").nth(1).get_by_text("20", exact=True).first.wait_for()
    page.get_by_role("button", name="Run", exact=True).wait_for()
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
