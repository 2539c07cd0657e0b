"""Every page in a browser. Skipped without Chromium."""

import io
import re
import time
from pathlib import Path
from urllib.parse import unquote, urljoin, urlparse

import matplotlib.pyplot as plt
import pytest

from tests.helpers.browser import DESKTOP, PHONE, complaints_of, needs_browser


@pytest.fixture(scope="module")
def names(html):
    return sorted(page.relative_to(html).as_posix() for page in html.rglob("*.html") if "_static" not in page.parts)


TABS = 8  # pages that load side by side
CUT_CODE = """() => {
  for (const details of document.querySelectorAll("details")) details.open = true;
  return [...document.querySelectorAll(".bd-article pre")]
    .filter((code) => code.scrollWidth > code.clientWidth)
    .map((code) => code.textContent.slice(0, 60));
}"""
# of the images and parts of images that are shown: how large they are, compared with how they were drawn
SCALES = """() => {
  for (const details of document.querySelectorAll("details")) details.open = true;
  const drawn = (cut) => {
    const [width, across] = ["--width", "--across"].map((name) => Number(cut.style.getPropertyValue(name)));
    return (width * across * 96) / 72;
  };
  const shown = (element) => element.getClientRects().length > 0;
  return [
    ...[...document.querySelectorAll(".cut")].map((cut) => [cut, drawn(cut)]),
    ...[...document.querySelectorAll("img.wide")].map((image) => [image, image.naturalWidth]),
  ].filter(([element]) => shown(element))
    .map(([element, width]) => element.getBoundingClientRect().width / width);
}"""
SMALLEST, DRAWN = 9, 11 * 96 / 72  # pixels: what can be read, and the size of letters in figures
WATCH_SHIFTS = """
  window.shifted = 0;
  new PerformanceObserver((list) => {
    for (const { value } of list.getEntries()) window.shifted += value;
  }).observe({ type: "layout-shift", buffered: true });
"""
STILL = 0.02  # shift of a page as it loads (Layout Instability) that is not noticed
QUIET = 0.5  # seconds without a request, after which pages have loaded all they want


@needs_browser
@pytest.mark.parametrize(
    ("viewport", "schemes"), [(DESKTOP, ["light", "dark"]), (PHONE, ["dark", "light"])], ids=["desktop", "phone"]
)
def test_every_page_without_an_error_a_request_elsewhere_a_shift_or_a_scroll_bar(
    site, browser, names, viewport, schemes
):
    """Each page is loaded in one colour scheme, and then changes to the other."""
    context = browser.new_context(viewport=viewport)
    context.add_init_script(WATCH_SHIFTS)
    tabs = [context.new_page() for _ in range(TABS)]
    complaints = [complaints_of(tab, (site, f"blob:{site}", "data:")) for tab in tabs]
    began = []  # when the requests began
    context.on("request", lambda _: began.append(time.monotonic()))
    for first in range(0, len(names), TABS):
        opened = list(zip(tabs, complaints, names[first : first + TABS], strict=False))
        for tab, _, name in opened:
            tab.emulate_media(color_scheme=schemes[0])
            tab.goto(urljoin(site, name), wait_until="commit")
            if name == "index.html":
                tab.wait_for_url(lambda address: address != urljoin(site, "index.html"))  # it leads to another page
        for tab, _, _ in opened:
            tab.wait_for_load_state("load")
        if viewport == DESKTOP:  # once for each page, wait until it asks for nothing more
            while time.monotonic() < began[-1] + QUIET:
                tabs[0].wait_for_timeout(100)
        for tab, complaints_of_tab, name in opened:
            assert tab.evaluate("window.shifted") < STILL, name
            for scheme in schemes:
                tab.emulate_media(color_scheme=scheme)
                wider = tab.evaluate("document.documentElement.scrollWidth - window.innerWidth")
                assert complaints_of_tab == [], (name, scheme)
                assert wider <= 0, f"{name} is {wider} pixels wider than the window ({scheme})"
            if viewport == DESKTOP:
                assert tab.evaluate(CUT_CODE) == [], name
            else:
                assert all(scale * DRAWN >= SMALLEST for scale in tab.evaluate(SCALES)), name
    context.close()


@needs_browser
def test_a_phone_shows_the_panels_of_a_figure_one_below_the_other(site, browser):
    page = browser.new_page(viewport=PHONE)
    page.goto(urljoin(site, "notebooks/table2-success.html"))
    figure = page.locator("figure", has=page.locator(".panels")).first
    whole, panels = figure.locator("img.whole"), figure.locator(".panel")
    assert not whole.is_visible()
    assert figure.get_by_role("img", name=whole.get_attribute("alt")).count() == 1
    first, second = (panels.nth(number).bounding_box() for number in range(2))
    assert panels.count() == 2
    assert first["y"] + first["height"] <= second["y"]
    page.set_viewport_size(DESKTOP)
    assert whole.is_visible()
    assert not panels.first.is_visible()
    page.close()


@needs_browser
def test_a_phone_shows_the_first_rows_of_a_long_table_until_all_are_asked_for(site, browser):
    page = browser.new_page(viewport=PHONE)
    page.goto(urljoin(site, "notebooks/ledger.html"))
    output = page.locator(".cell_output", has=page.locator(".all-rows")).first
    rows, switch = output.locator("tbody tr"), output.get_by_role("checkbox")
    assert output.locator("tbody tr:visible").count() == 5
    assert switch.evaluate("node => node.parentElement.innerText.trim()") == f"Show all {rows.count()} rows"
    switch.check()
    assert output.locator("tbody tr:visible").count() == rows.count() > 5
    switch.uncheck()
    page.set_viewport_size(DESKTOP)
    assert output.locator("tbody tr:visible").count() == rows.count()
    assert not switch.is_visible()
    page.close()


@needs_browser
def test_paper_is_light(site, browser):
    page = browser.new_page(viewport=DESKTOP, color_scheme="dark")
    page.goto(urljoin(site, "book/settled.html"))
    theme = "document.documentElement.dataset.theme"
    assert page.evaluate(f"dispatchEvent(new Event('beforeprint')), {theme}") == "light"
    assert page.evaluate(f"dispatchEvent(new Event('afterprint')), {theme}") == "dark"
    page.close()


@needs_browser
@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("name", ["book/robot.html", "book/evolutionary.html", "notebooks/replay.html"])
def test_the_ground_of_figures_is_that_of_the_page(site, browser, name, scheme):
    page = browser.new_page(viewport=DESKTOP, color_scheme=scheme)
    page.goto(urljoin(site, name))
    ground = page.evaluate("getComputedStyle(document.body).backgroundColor")
    expected = [int(part) for part in re.findall(r"\d+", ground)[:3]]
    for image in page.locator(".bd-article img:visible").all():
        pixels = plt.imread(io.BytesIO(image.screenshot()))
        assert (255 * pixels[2, 2, :3]).round().tolist() == pytest.approx(expected, abs=1)
    page.close()


@needs_browser
def test_the_replay_plays(site, browser):
    page = browser.new_page()
    page.goto(urljoin(site, "notebooks/replay.html"))
    player = page.locator(".player")
    slider, button, image = player.get_by_role("slider"), player.get_by_role("button"), player.get_by_role("img")
    first = image.get_attribute("src")
    assert slider.input_value() == "0"
    button.click()
    page.wait_for_function("document.querySelector('.player input').value > 1")
    assert button.get_attribute("aria-pressed") == "true"
    button.click()
    assert button.inner_text() == "Play"
    stopped = slider.input_value()
    assert image.get_attribute("src") != first
    slider.focus()
    page.keyboard.press("Home")
    assert stopped != slider.input_value() == "0"
    assert image.get_attribute("src") == first
    page.close()


def test_every_link_within_the_book_leads_somewhere(html, names):
    anchors = {name: set(re.findall(r'\bid="([^"]+)"', (html / name).read_text())) for name in names}
    for name in names:
        for link in re.findall(r'<a [^>]*href="([^"]+)"', (html / name).read_text()):
            address = urlparse(link)
            if address.scheme or link == "#":
                continue
            target = (
                name if not address.path else str(Path(urljoin("/" + name, unquote(address.path))).relative_to("/"))
            )
            assert (html / target).exists(), f"{name}: {link}"
            says_what_to_show = target == "book/playground.html" and "=" in address.fragment
            if address.fragment and target in anchors and not says_what_to_show:
                assert address.fragment in anchors[target], f"{name}: {link}"
