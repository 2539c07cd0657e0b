"""The widget in JupyterLab with a kernel, as a browser shows it."""

import json
import os
import re
import subprocess
import sys
import time
from contextlib import contextmanager

import nbformat

from tests.helpers.browser import chromium, complaints_of, needs_browser

PATIENCE = 60  # seconds to wait for anything, since a machine may be busy
SETTINGS = {
    "@jupyterlab/notebook-extension:tracker": {"windowingMode": "none"},  # cells out of sight are in the page, too
    "@jupyterlab/apputils-extension:notification": {"fetchNews": "false", "checkForUpdates": False},  # offline
}


@contextmanager
def jupyter(folder):
    """Start JupyterLab in a folder, with settings from there alone; gives its address."""
    settings = folder / "config" / "labconfig" / "default_setting_overrides.json"
    settings.parent.mkdir(parents=True)
    settings.write_text(json.dumps(SETTINGS))
    own = {f"JUPYTER_{kind.upper()}_DIR": str(folder / kind) for kind in ("config", "data", "runtime")}
    options = {
        "ServerApp.ip": "127.0.0.1",
        "ServerApp.port": 0,  # any free port
        "ServerApp.root_dir": folder,
        "ServerApp.allow_root": True,
        "IdentityProvider.token": "",
        "LabApp.extension_manager": "readonly",  # any other asks PyPI
    }
    command = [
        sys.executable,
        "-m",
        "jupyterlab",
        "--no-browser",
        *(f"--{key}={value}" for key, value in options.items()),
    ]
    environment = {**os.environ, **own, "IPYTHONDIR": str(folder / "ipython")}
    log = folder / "server.log"
    with log.open("w") as stderr, subprocess.Popen(command, env=environment, stderr=stderr) as server:
        try:
            late = time.monotonic() + PATIENCE
            while not (info := "".join(file.read_text() for file in (folder / "runtime").glob("jpserver-*.json"))):
                assert server.poll() is None, log.read_text()
                assert time.monotonic() < late, log.read_text()
                time.sleep(0.1)
            yield json.loads(info)["url"]  # the file is written when the server is ready
        finally:
            server.terminate()


class Notebook:
    """A notebook in a page of JupyterLab, with these cells."""

    def __init__(self, page, folder, address, cells):
        code = [nbformat.v4.new_code_cell(source, id=name) for name, source in cells.items()]
        kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3"}}
        nbformat.write(nbformat.v4.new_notebook(cells=code, metadata=kernel), folder / "test.ipynb")
        self.page, self.names = page, list(cells)
        page.goto(f"{address}doc/tree/test.ipynb")
        page.get_by_text(re.compile(r"^Python 3.* \| Idle$")).wait_for()  # before that, no cell runs

    def cell(self, name):
        return self.page.locator(".jp-Notebook .jp-CodeCell").nth(self.names.index(name))

    def run(self, name):
        """Run a cell to its end; returns what it prints."""
        cell = self.cell(name)
        prompt = cell.locator(".jp-InputPrompt")
        before = prompt.inner_text()
        cell.locator(".cm-content").click()
        self.page.keyboard.press("Shift+Enter")
        self.page.wait_for_function(
            "([prompt, before]) => prompt.innerText !== before && /[0-9]/.test(prompt.innerText)",
            arg=[prompt.element_handle(), before],
        )
        printed = "\n".join(cell.locator(".jp-OutputArea-output").all_inner_texts()).strip()
        assert "Traceback" not in printed, printed
        return printed

    def run_until(self, name, printed):
        """Run a cell again and again until it prints this: messages from the page to the kernel take time."""
        late = time.monotonic() + PATIENCE
        while (found := self.run(name)) != printed:
            assert time.monotonic() < late, f"{name} printed {found!r}"


CELLS = {
    "show": "import safe\nplayground = safe.Playground(seed=4)\nplayground",
    "again": "playground",
    "another": "safe.Playground('maze2')",
    "weights": "print(playground.controller[:2])",
    "weigh": "playground.controller = [0.25] * 16",
    "maze": "print(playground.maze.name, playground.maze.shape)",
    "draw": "playground.maze = 'S..\\n.#.\\n..G'",
    "seed": "print(playground.seed)",
    "sow": "playground.maze, playground.seed = 'maze1', safe.Experiment('safe', 'maze1').seed_sequence(1)",
    "run": "run = safe.evolve(playground.maze, 'safe', playground.seed)\nprint(run.success)",
    "result": "print(playground.result == run)",
    "driven": "print(playground.controller == run.controller)",
    "give": "from dataclasses import replace\nplayground.result = replace(run, controller=(0.5,) * 16)",
    "close": "playground.close()",
}


@needs_browser
def test_page_and_kernel_change_the_same(tmp_path):
    with jupyter(tmp_path) as address, chromium() as browser:
        page = browser.new_page(viewport={"width": 1280, "height": 900})
        page.set_default_timeout(1000 * PATIENCE)
        complaints = complaints_of(page, (address, address.replace("http", "ws"), "data:", f"blob:{address}"))
        notebook = Notebook(page, tmp_path, address, CELLS)
        notebook.run("show")
        notebook.run("again")
        view, other, another = (notebook.cell(name).locator(".playground") for name in ("show", "again", "another"))
        for shown in (view, other):
            shown.get_by_role("tab", name="Drive").click()

        def field(role, name, shown=view):
            return shown.get_by_role(role, name=re.compile(f"^{name}\\b"))

        def wait_for(value, *field_of):
            handle = field(*field_of).element_handle()
            page.wait_for_function("([field, value]) => field.value === value", arg=[handle, value])

        # a weight, by the page and by the kernel
        wait_for("0", "slider", "p1")
        field("slider", "p1").press("ArrowLeft")
        notebook.run_until("weights", "(-0.05, 0.0)")
        wait_for("-0.05", "slider", "p1", other)
        notebook.run("weigh")
        wait_for("0.25", "slider", "p1")
        wait_for("0.25", "slider", "p1", other)

        # the maze
        wait_for("maze1", "combobox", "Maze")
        field("combobox", "Maze").select_option("trap")
        notebook.run_until("maze", "drawing (41, 41)")
        wait_for("trap", "combobox", "Maze", other)
        notebook.run("another")
        wait_for("maze2", "combobox", "Maze", another)

        # two widgets share no names, and keys that mean something to a notebook stay in them
        ids = page.locator(".playground [id]").evaluate_all("nodes => nodes.map((node) => node.id)")
        assert len(ids) == len(set(ids)) > 0
        another.get_by_role("tab", name="Draw").click()
        assert field("radio", "Wall", another).is_checked()
        cells = page.locator(".jp-Notebook .jp-CodeCell").count()
        another.locator("canvas.editor").focus()
        for key in "bdd":
            page.keyboard.press(key)
        assert page.locator(".jp-Notebook .jp-CodeCell").count() == cells
        notebook.run("draw")
        wait_for("drawn", "combobox", "Maze")
        wait_for("maze2", "combobox", "Maze", another)

        # a run
        view.get_by_role("tab", name="Watch").click()
        wait_for("4", "textbox", "Seed")
        field("textbox", "Seed").fill("1,2")
        field("textbox", "Seed").press("Enter")
        notebook.run_until("seed", "(1, 2)")
        notebook.run("sow")
        wait_for("1", "spinbutton", "Run")
        field("slider", "Speed").press("End")
        field("button", "Play").click()
        assert notebook.run("run").endswith("True")  # after messages about compiling
        notebook.run_until("result", "True")
        assert notebook.run("driven") == "True"
        view.get_by_role("tab", name="Drive").click()
        notebook.run("give")
        wait_for("0.5", "slider", "p1")
        notebook.run("close")
        view.wait_for(state="detached")
        other.wait_for(state="detached")
        assert complaints == []
