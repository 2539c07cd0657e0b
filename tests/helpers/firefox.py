"""Firefox for the tests, as Debian packages it. Without it, the tests that need it are skipped.

Playwright drives only builds of Firefox made for it. This is a small client of WebDriver BiDi
(https://w3c.github.io/webdriver-bidi/), the protocol that every Firefox speaks by itself.
"""

import json
import shutil
import subprocess
import time
from contextlib import contextmanager

import pytest

from tests.helpers.browser import DESKTOP

FIREFOX = shutil.which("firefox-esr")  # other systems may shut Firefox up in a box, where it sees no profile of ours
PATIENCE = 60  # seconds to wait for anything, since a machine may be busy
EVENTS = ["log.entryAdded", "network.beforeRequestSent", "network.responseCompleted"]

needs_firefox = pytest.mark.skipif(FIREFOX is None, reason="no Firefox found: install Debian's firefox-esr")


@contextmanager
def firefox(folder):
    """Firefox without a window, with its profile in a folder: a function that sends commands, and a list of events."""
    websocket = pytest.importorskip("websocket")
    command = [FIREFOX, "--headless", "--no-remote", "--profile", folder, "--remote-debugging-port", "0"]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        try:
            server = _read_when_written(folder / "WebDriverBiDiServer.json", process)
            address = f"ws://{server['ws_host']}:{server['ws_port']}/session"
            socket = websocket.create_connection(address, timeout=PATIENCE, suppress_origin=True)
            events, sent = [], 0

            def send(method, **parameters):
                nonlocal sent
                sent += 1
                socket.send(json.dumps({"id": sent, "method": method, "params": parameters}))
                while (message := json.loads(socket.recv())).get("id") != sent:
                    events.append(message)
                assert message["type"] == "success", message
                return message["result"]

            send("session.new", capabilities={})
            send("session.subscribe", events=EVENTS)
            yield send, events
            socket.close()
        finally:
            process.terminate()


def _read_when_written(file, process):
    late = time.monotonic() + PATIENCE
    while True:
        try:
            return json.loads(file.read_text(encoding="utf-8"))
        except (FileNotFoundError, json.JSONDecodeError):
            assert process.poll() is None, "Firefox has ended"
            assert time.monotonic() < late
            time.sleep(0.05)


def complaints_in(events, here):
    """What goes wrong in pages, as in `complaints_of` for Chromium, with requests to addresses that do not begin with
    one of `here`."""
    found = []
    for event in events:
        match event:
            case {"method": "log.entryAdded", "params": {"level": "error" | "warn", "text": text}}:
                found.append(text)
            case {"method": "network.responseCompleted", "params": {"response": {"status": status, "url": url}}}:
                found += [f"{status} {url}"] * (status >= 400)
            case {"method": "network.beforeRequestSent", "params": {"request": {"url": url}}}:
                found += [url] * (not url.startswith(here))
    return found


class Page:
    """A page in Firefox, at an address."""

    def __init__(self, send, address):
        self._send = send
        self._context = send("browsingContext.create", type="tab")["context"]
        send("browsingContext.setViewport", context=self._context, viewport=DESKTOP)
        send("browsingContext.navigate", context=self._context, url=address, wait="complete")

    def evaluate(self, expression):
        """The value of an expression of JavaScript, which may be a promise."""
        answer = self._send(
            "script.evaluate",
            expression=f"Promise.resolve({expression}).then((value) => JSON.stringify(value ?? null))",
            target={"context": self._context},
            awaitPromise=True,
        )
        assert answer["type"] == "success", answer
        return json.loads(answer["result"]["value"])

    def wait_for(self, expression):
        """Wait until an expression is true; gives its value."""
        late = time.monotonic() + PATIENCE
        while not (value := self.evaluate(expression)):
            assert time.monotonic() < late, expression
            time.sleep(0.05)
        return value

    def text_of(self, selector):
        return self.evaluate(f"document.querySelector({json.dumps(selector)})?.innerText")

    def click(self, role, name):
        """Click the visible element with this role and name, as assistive software finds it."""
        locator = {"type": "accessibility", "value": {"role": role, "name": name}}
        (node,) = self._send("browsingContext.locateNodes", context=self._context, locator=locator)["nodes"]
        element = {"sharedId": node["sharedId"]}
        self._send(
            "script.callFunction",
            functionDeclaration="(element) => element.scrollIntoView({ block: 'center', behavior: 'instant' })",
            arguments=[element],
            target={"context": self._context},
            awaitPromise=False,
        )
        self._move_mouse({"x": 0, "y": 0, "origin": {"type": "element", "element": element}})

    def drag(self, *points):
        """Press the mouse at the first of some points (x, y) of the window, and move it to the others."""
        self._move_mouse(*({"x": round(x), "y": round(y)} for x, y in points))

    def _move_mouse(self, first, *others):
        moves = [{"type": "pointerMove", **point} for point in (first, *others)]
        button = [{"type": kind, "button": 0} for kind in ("pointerDown", "pointerUp")]
        actions = [moves[0], button[0], *moves[1:], button[1]]
        self._perform({"type": "pointer", "id": "mouse", "actions": actions})

    def type(self, text):
        """Press and release the key of each character."""
        actions = [{"type": kind, "value": key} for key in text for kind in ("keyDown", "keyUp")]
        self._perform({"type": "key", "id": "keyboard", "actions": actions})

    def _perform(self, source):
        self._send("input.performActions", context=self._context, actions=[source])

    def close(self):
        self._send("browsingContext.close", context=self._context)
