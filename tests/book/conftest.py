"""What the tests of the book share: a copy of the checkout, with every notebook executed and the book built."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.helpers.browser import chromium, serving

ROOT = Path(__file__).parents[2]
RUNS = "4"
PARTS = ["_config.yml", "benchmarks", "book", "notebooks", "safe"]
DESKTOP, PHONE = {"width": 1280, "height": 900}, {"width": 390, "height": 800}


def call(folder, *command, runs=RUNS):
    environment = {**os.environ, "RUNS": runs, "NO_COLOR": "1"}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)


def execute(folder, *arguments, **options):
    return call(folder, sys.executable, "book/execute.py", *arguments, **options)


def build(folder, *arguments, **options):
    command = Path(sys.executable).with_name("jupyter-book")
    settings = "--toc", "book/_toc.yml", "-W", "--keep-going", "-n"
    return call(folder, command, "build", ".", *settings, *arguments, **options)


def output_of(process):
    return process.stdout + process.stderr


@pytest.fixture(scope="session")
def checkout(tmp_path_factory):
    """A checkout with all notebooks executed and the book built."""
    folder = tmp_path_factory.mktemp("checkout")
    for part in PARTS:
        if (ROOT / part).is_dir():
            shutil.copytree(ROOT / part, folder / part, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(ROOT / part, folder)
    executed = execute(folder)
    assert executed.returncode == 0, output_of(executed)
    built = build(folder)
    assert built.returncode == 0, output_of(built)
    return folder


@pytest.fixture(scope="session")
def html(checkout):
    return checkout / "_build" / "html"


@pytest.fixture(scope="package")
def site(html):
    """The address of the built book, served on this machine."""
    with serving(html) as address:
        yield address


@pytest.fixture(scope="package")  # as long as it is open, no other can be, nor anything run by asyncio
def browser():
    with chromium() as browser:
        yield browser
