"""What the tests of the book share: a checkout with every notebook executed, and the book built from it."""

import pytest

from safe.evolution import compile_kernels
from tests.helpers.browser import DESKTOP, chromium, complaints_of, serving
from tests.helpers.checkout import locked, make


@pytest.fixture(scope="session")
def checkout(tmp_path_factory, worker_id):
    """A checkout with all notebooks executed and the book built: one for all the processes that run tests."""
    temporary = tmp_path_factory.getbasetemp()
    folder = (temporary if worker_id == "master" else temporary.parent) / "checkout"
    made = folder.with_suffix(".made")
    with locked(folder):
        if not made.exists():
            for with_choices in (False, True):
                compile_kernels(with_choices)  # before they are copied
            make(folder)
            made.touch()
    return folder


@pytest.fixture
def alone_in_checkout(checkout):
    """For a test that changes the checkout, or would notice that another does: they run one after the other."""
    with locked(checkout):
        yield


@pytest.fixture(scope="session")
def html(checkout):
    return checkout / "_build" / "html"


@pytest.fixture(scope="package")
def site(html):
    """The address of the built book, served on this machine."""
    with serving(html) as address:
        yield address


@pytest.fixture(scope="package")  # while it is open, nothing else may use Playwright or asyncio
def browser():
    with chromium() as browser:
        yield browser


@pytest.fixture(scope="package")
def tab(browser, site):
    """A tab for all tests, since a new one would compile all scripts again, and what goes wrong in it."""
    page = browser.new_page()
    return page, _complaints_at(page, site)


@pytest.fixture
def visit(browser, site, tab):
    """Open the playground at an address, as a reader would. Whatever goes wrong in a page fails the test.

    The next visit leaves the page of the one before, unless that is on a device of its own.
    """
    page, complaints = tab
    devices = []

    def open_page(
        fragment="",
        page_name="book/playground.html",
        viewport=DESKTOP,
        color_scheme="light",
        reduced_motion="no-preference",
        **device,
    ):
        opened = page
        if device:
            opened = browser.new_page(**device)
            devices.append((opened, _complaints_at(opened, site)))
        opened.set_viewport_size(viewport)
        opened.emulate_media(color_scheme=color_scheme, reduced_motion=reduced_motion)
        opened.goto("about:blank")  # or else another fragment would not load the page anew
        opened.goto(f"{site}{page_name}" + (f"#{fragment}" if fragment else ""))
        return opened

    yield open_page
    page.evaluate("if (location.protocol !== 'about:') localStorage.clear()")
    page.goto("about:blank")
    for opened, _ in devices:
        opened.context.close()
    wrong = [*complaints, *(complaint for _, those in devices for complaint in those)]
    complaints.clear()
    assert wrong == []


def _complaints_at(page, site):
    return complaints_of(page, (site, f"blob:{site}", "data:", "about:blank"), ("error", "warning"))
