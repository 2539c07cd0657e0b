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
            compile_kernels()  # before they are copied
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
