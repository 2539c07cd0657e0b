"""A browser for the tests, and a server of files. Without Chromium, the tests that need it are skipped."""

import functools
import http.server
import threading
from contextlib import contextmanager

import pytest

import make

BROWSER = make.browser()

DESKTOP, PHONE = {"width": 1280, "height": 900}, {"width": 390, "height": 800}

needs_browser = pytest.mark.skipif(
    BROWSER is None, reason="no Chromium found: install Debian's chromium-headless-shell, or Chrome"
)


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *arguments):
        pass


class Server(http.server.ThreadingHTTPServer):
    request_queue_size = 128  # several tabs load at once, and a connection beyond the queue waits for seconds


@contextmanager
def serving(folder):
    """Serve a folder to this machine alone; gives its address."""
    handler = functools.partial(Quiet, directory=folder)
    with Server(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever).start()
        try:
            yield f"http://127.0.0.1:{server.server_port}/"
        finally:
            server.shutdown()


def complaints_of(page, here, logged=("error",)):
    """A list that collects what goes wrong in a page: messages of the kinds in `logged`, uncaught errors, answers with
    an error status, and requests to addresses that do not begin with one of `here`."""
    complaints = []

    def add_where(is_wrong, complaint):
        if is_wrong:
            complaints.append(complaint)

    page.on("console", lambda message: add_where(message.type in logged, f"{message.text} {message.location}"))
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on("request", lambda request: add_where(not request.url.startswith(here), request.url))
    page.on("response", lambda answer: add_where(answer.status >= 400, f"{answer.status} {answer.url}"))
    return complaints


@contextmanager
def chromium():
    """A browser without a window."""
    sync_api = pytest.importorskip("playwright.sync_api")
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=BROWSER, args=["--no-sandbox", "--disable-gpu"])
        yield browser
        browser.close()
