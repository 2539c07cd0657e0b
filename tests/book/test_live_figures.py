"""The figures of chapters that are views of the playground."""

import re

import pytest
from axe_playwright_python.sync_playwright import Axe

import safe
from tests.helpers.addresses import maze_of, values_of
from tests.helpers.browser import DESKTOP, PHONE, needs_browser
from tests.helpers.playground_page import FIGURES, panel

pytestmark = needs_browser

ALL = [(page, name) for page, names in FIGURES.items() for name in names]
LOW = {"width": 1280, "height": 500}  # a window in which no figure but the first of a page is near
SCROLL = "node => window.scrollTo({ top: node.getBoundingClientRect().top + scrollY - 70, behavior: 'instant' })"
LETTERS = """node => [...node.querySelectorAll(".chart text")].filter((text) => text.checkVisibility()).map((text) =>
  parseFloat(getComputedStyle(text).fontSize) * Math.hypot(text.getScreenCTM().a, text.getScreenCTM().b))"""
SMALLEST = 9  # pixels that can be read
TWO_FRAMES = "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"


@pytest.fixture
def see(visit):
    """Open a chapter and scroll to one of its figures, which shows what it can."""

    def see(name, **device):
        (page_name,) = (page for page, names in FIGURES.items() if name in names)
        page = visit(page_name=f"book/{page_name}.html", **device)
        return scroll_to(page, name)

    return see


def scroll_to(page, name):
    figure = page.locator(f"#{name}")
    figure.evaluate(SCROLL)
    shown = {"drive": ".weight output", "watch": ".status:text-matches('best')", "runs": ".outcomes"}
    view = next(names[name] for names in FIGURES.values() if name in names)
    figure.locator(f".figure {shown[view]}").last.wait_for(state="attached")
    figure.locator(".figure:not(:has([aria-busy]))").wait_for()
    return figure


def link_of(figure):
    """The address in the playground that a figure's link has when it is reached."""
    link = figure.get_by_role("link", name="Open in the playground")
    link.focus()
    return link.get_attribute("href").split("#", 1)[1]


def generation_of(figure):
    return int(re.search(r"\d+", figure.locator(".status").first.inner_text()).group())


def wait_for_generation(page, name, generation):
    status = f"document.querySelector('#{name} .panel .status').textContent"
    page.wait_for_function(f"{status}.match(/\\d+/)?.[0] > {generation} || {status}.includes('uccess')")


def test_every_figure_is_named(visit):
    for page_name, names in FIGURES.items():
        page = visit(page_name=f"book/{page_name}.html")
        assert page.locator("figure:has(.live)").evaluate_all("nodes => nodes.map((node) => node.id)") == [*names]


@pytest.mark.parametrize("page_name", ["objective", "experiments", "safe"])
def test_the_script_is_loaded_once_a_figure_is_near(visit, tab, page_name):
    loaded = []
    tab[0].on("request", lambda request: loaded.append(request.url))
    page = visit(page_name=f"book/{page_name}.html", viewport=LOW)
    page.evaluate(TWO_FRAMES)  # in which the page would have noticed figures that are near
    assert not any("playground/bundle.js" in address for address in loaded)
    assert page.locator(".playground").count() == 0
    scroll_to(page, next(iter(FIGURES[page_name])))
    assert sum("playground/bundle.js" in address for address in loaded) == 1


def test_a_figure_is_mounted_once_it_is_near(visit):
    page = visit(page_name="book/novelty.html", viewport=LOW)
    scroll_to(page, "fig-crowded")
    page.evaluate(TWO_FRAMES)
    assert page.locator("#fig-memory .playground").count() == 0
    scroll_to(page, "fig-memory")
    assert page.locator(".live > img").evaluate_all("nodes => nodes.some((node) => node.checkVisibility())") is False


@pytest.mark.parametrize("name", ["fig-pocket", "fig-memory"])
def test_it_plays_while_it_is_seen(see, name):
    figure = see(name)
    figure.get_by_role("button", name="Pause").wait_for()
    wait_for_generation(figure.page, name, 1)
    figure.page.evaluate("window.scrollTo({ top: 0, behavior: 'instant' })")
    figure.locator("button.primary:text-is('Play')").wait_for(state="attached")
    paused = generation_of(figure)
    figure.evaluate(SCROLL)
    figure.get_by_role("button", name="Pause").wait_for()
    wait_for_generation(figure.page, name, paused)


def test_it_stays_paused_if_the_reader_paused_it(see):
    figure = see("fig-memory")
    figure.get_by_role("button", name="Pause").click()
    play = figure.get_by_role("button", name="Play")
    play.wait_for()
    figure.page.evaluate("window.scrollTo({ top: 0, behavior: 'instant' })")
    figure.page.evaluate(TWO_FRAMES)
    figure.evaluate(SCROLL)
    figure.page.evaluate(TWO_FRAMES)
    assert play.count() == 1
    play.click()
    figure.get_by_role("button", name="Pause").wait_for()


@pytest.mark.parametrize("name", ["fig-pocket", "fig-memory"])
def test_it_waits_for_readers_who_prefer_less_motion(see, name):
    figure = see(name, reduced_motion="reduce")
    figure.page.evaluate(TWO_FRAMES)
    assert figure.get_by_role("button", name="Play").count() == 1
    assert generation_of(figure) == 0
    figure.get_by_role("button", name="Play").click()
    wait_for_generation(figure.page, name, 0)


@pytest.mark.parametrize("page_name", FIGURES)
def test_the_keyboard_reaches_every_control(visit, page_name):
    page = visit(page_name=f"book/{page_name}.html", reduced_motion="reduce")
    for name in FIGURES[page_name]:
        assert_keys_reach_all(scroll_to(page, name))


def assert_keys_reach_all(figure):
    controls = "node => [...node.querySelectorAll('.figure :is(button, input, select, a, [tabindex=\"0\"])')]"
    visible = figure.evaluate(f"node => ({controls})(node).filter((one) => one.checkVisibility()).length")
    radios = figure.get_by_role("radio").count()
    figure.evaluate("node => { node.tabIndex = -1; node.focus(); }")
    reached = []
    while len(reached) <= visible:
        figure.page.keyboard.press("Tab")
        at = figure.evaluate(f"node => ({controls})(node).indexOf(document.activeElement)")
        if at < 0:
            break
        reached.append(at)
    assert len(set(reached)) == len(reached) == visible - max(0, radios - 1)  # of radio buttons Tab reaches one


def test_keys_set_a_weight_and_walk(see):
    figure = see("fig-three-weights")
    figure.get_by_role("slider", name="p7: dist up in h").focus()
    figure.page.keyboard.press("ArrowLeft")
    assert values_of(link_of(figure))["controller"].split(",")[6] == "-0.05"
    figure = see("fig-readings")
    figure.get_by_role("slider", name="Step").focus()
    figure.page.keyboard.press("ArrowRight")
    figure.get_by_text("Step 1:").locator("visible=true").wait_for()
    maze = safe.load_maze("maze1")
    controller = [float(weight) for weight in values_of(link_of(figure))["controller"].split(",")]
    readings = maze.readings(tuple(safe.path(maze, controller, steps=1)[-1]))
    shown = figure.locator(".weights tbody tr:not(.sums) td.number").all_inner_texts()
    assert shown == [f"{reading:.0f}" for reading in readings.values()]


def test_three_weights_lead_out_of_the_pocket(see):
    figure = see("fig-three-weights")
    for weight, value in (("p5: dist down in h", 0.55), ("p7: dist up in h", -1), ("p10: goal right in v", -1)):
        figure.get_by_role("slider", name=weight).fill(str(value))
    figure.get_by_text("a success.").wait_for()
    values = values_of(link_of(figure))
    assert values["maze"] == "trap"
    assert [weight for weight in values["controller"].split(",") if weight != "0"] == ["0.55", "-1", "-1"]


def test_a_choice_begins_its_own_run(see):
    figure = see("fig-memory", reduced_motion="reduce")
    figure.get_by_role("radio", name="none").check()
    values = values_of(link_of(figure))
    assert (values["archive"], values["population"], values["algorithm"]) == ("0", "20", "novelty")


def test_a_robot_keeps_its_place_when_the_scale_changes(see):
    figure = see("fig-scales")
    for scale, share in (("as ranks", "for closeness (59"), ("as they are", "for closeness (0.5 %)")):
        figure.get_by_role("radio", name=scale).check()
        figure.locator(".judgement").get_by_text(share).wait_for()
        assert figure.get_by_label("Robot", exact=True).input_value() == "5"


def test_runs_are_counted_as_soon_as_they_are_seen(see):
    figure = see("fig-how-many")
    figure.page.wait_for_function("document.querySelector('#fig-how-many .outcomes td')?.textContent > 2")
    figure.get_by_role("button", name="Stop").click()
    figure.get_by_role("button", name="Run", exact=True).wait_for()


@pytest.mark.parametrize("name", [name for _, name in ALL])
def test_its_link_opens_the_same_in_the_playground(see, name):
    figure = see(name, reduced_motion="reduce")
    address = link_of(figure)
    said = figure.locator(".status, .outcome").all_inner_texts()
    assert maze_of(values_of(address)["maze"]) if "maze1" in address else "maze=trap" in address
    figure.page.keyboard.press("Enter")
    figure.page.wait_for_url("**/playground.html#*")
    figure.page.locator("#playground .playground").wait_for()
    if address.startswith("view=watch"):
        for title in figure.page.locator("#playground .panel h2").all_inner_texts():
            panel(figure.page, title).get_by_text("best").wait_for()
        assert figure.page.locator("#playground .panel .status").all_inner_texts() == said
    tab = {"watch": "Watch", "drive": "Drive", "runs": "Many runs"}[values_of(address)["view"]]
    figure.page.get_by_role("tab", name=tab, selected=True).wait_for()
    assert figure.page.evaluate("location.hash.slice(1)") == address


def test_the_address_of_a_paused_run_has_its_generation(see):
    figure = see("fig-pocket")
    wait_for_generation(figure.page, "fig-pocket", 1)
    figure.get_by_role("button", name="Pause").click()
    figure.get_by_role("button", name="Play").wait_for()
    figure.page.wait_for_function("document.querySelector('#fig-pocket .opener').href.includes('&generation=')")
    assert f"&generation={generation_of(figure)}" in link_of(figure)


def is_alone(figure):
    """Is the picture of a figure there, without the view?"""
    image = figure.locator(".live > img")
    return image.is_visible() and image.bounding_box()["height"] > 100 and figure.locator(".figure").is_hidden()


@pytest.mark.parametrize("page_name", FIGURES)
def test_pictures_are_there_without_a_script(browser, site, page_name):
    page = browser.new_page(java_script_enabled=False)
    page.goto(f"{site}book/{page_name}.html")
    assert [name for name in FIGURES[page_name] if not is_alone(page.locator(f"#{name}"))] == []
    page.close()


@pytest.mark.parametrize("page_name", FIGURES)
def test_pictures_are_printed(visit, page_name):
    page = visit(page_name=f"book/{page_name}.html", reduced_motion="reduce")
    figures = [scroll_to(page, name) for name in FIGURES[page_name]]
    page.emulate_media(media="print")
    assert all(map(is_alone, figures))
    page.emulate_media(media="null")


@pytest.mark.parametrize("viewport", [DESKTOP, PHONE], ids=["desktop", "phone"])
@pytest.mark.parametrize("page_name", FIGURES)
def test_nothing_shifts(visit, page_name, viewport):
    page = visit(page_name=f"book/{page_name}.html", viewport=viewport)
    page.evaluate("() => document.fonts.ready")
    page.evaluate(TWO_FRAMES)
    page.evaluate("""() => {
        window.shifts = [];
        new PerformanceObserver((list) => {
            for (const { value, sources } of list.getEntries()) {
                window.shifts.push([value, ...sources.map(({ node }) => node?.className ?? node?.nodeName)]);
            }
        }).observe({ type: "layout-shift" });
    }""")
    for name, view in FIGURES[page_name].items():
        figure = scroll_to(page, name)
        if figure.get_by_role("button", name="Pause").count() == 1:
            wait_for_generation(page, name, 3)
        if view == "watch" and figure.locator(".inspector").is_visible():
            figure.get_by_text("ended at row").wait_for()
        page.evaluate(TWO_FRAMES)
        box = figure.locator(".live")
        assert box.evaluate("node => node.offsetHeight - Math.round(parseFloat(getComputedStyle(node).minHeight))") == 0
    assert page.evaluate("window.shifts") == []


@pytest.mark.parametrize("page_name", FIGURES)
def test_no_violation_of_accessibility(visit, page_name):
    page = visit(page_name=f"book/{page_name}.html", reduced_motion="reduce")
    for name in FIGURES[page_name]:
        scroll_to(page, name)
        for scheme in ("light", "dark"):
            page.emulate_media(color_scheme=scheme)
            found = Axe().run(page, context=f"#{name}", options={"preload": False}).response["violations"]
            assert [(name, scheme, v["id"], [node["html"][:120] for node in v["nodes"]]) for v in found] == []


@pytest.mark.parametrize("page_name", FIGURES)
def test_on_a_phone_nothing_is_cut_off(visit, page_name):
    page = visit(page_name=f"book/{page_name}.html", viewport=PHONE, reduced_motion="reduce")
    for name in FIGURES[page_name]:
        figure = scroll_to(page, name)
        wider = figure.locator(".figure").evaluate(
            """(root) => [...root.querySelectorAll("*")]
                .filter((node) => node.checkVisibility() && !node.closest(".scroll table"))
                .filter((node) => node.getBoundingClientRect().right > root.getBoundingClientRect().right + 1)
                .map((node) => node.outerHTML.slice(0, 80))"""
        )
        assert wider == [], name
        assert all(size >= SMALLEST for size in figure.evaluate(LETTERS)), name
        controls = figure.locator(":is(button, .opener):visible").all()
        assert all(control.bounding_box()["height"] >= 24 for control in controls), name
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["width"]
