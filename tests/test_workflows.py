"""What runs elsewhere: the workflows of GitHub, and Binder. Their work is done by make.py, which anybody can call."""

import os
import re
import shlex
import tomllib
from pathlib import Path

import pytest
import yaml

import make

ROOT = Path(__file__).parents[1]
WORKFLOWS = {file.name: yaml.safe_load(file.read_text(encoding="utf-8")) for file in ROOT.glob(".github/workflows/*")}


def commands():
    """All lines that the workflows run, as words."""
    for workflow in WORKFLOWS.values():
        for job in workflow["jobs"].values():
            for step in job["steps"]:
                yield from map(shlex.split, step.get("run", "").splitlines())


def test_python_versions_are_those_that_the_package_names():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    versions = [text.split(" :: ")[-1] for text in project["classifiers"] if "Python ::" in text]
    assert WORKFLOWS["test.yml"]["jobs"]["test"]["strategy"]["matrix"]["python"] == versions
    assert project["requires-python"] == f">={versions[0]}"
    steps = WORKFLOWS["book.yml"]["jobs"]["build"]["steps"]
    (published,) = (step["with"]["python-version"] for step in steps if "setup-python" in step.get("uses", ""))
    assert published in versions
    assert (ROOT / ".binder" / "runtime.txt").read_text(encoding="utf-8") == f"python-{published}\n"


def test_workflows_run_steps_of_make_py():
    steps = [step for words in commands() if words[:2] == ["python", "make.py"] for step in words[2:]]
    assert set(steps) == {"test", "book", "pdf"} <= make.STEPS.keys()


def test_the_packages_that_the_pdf_needs_are_those_of_contributing():
    contributing = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    (named,) = re.findall(r"`apt install (.*)`", contributing)
    (installed,) = (words for words in commands() if words[:3] == ["sudo", "apt-get", "install"])
    assert [word for word in installed[3:] if not word.startswith("-")] == named.split()


def test_binder_installs_the_packages_of_the_book():
    _, *lines, shows = (ROOT / ".binder" / "requirements.txt").read_text(encoding="utf-8").splitlines()
    assert shows == "jupyterlab-myst"
    options = dict(line.split() for line in lines)
    assert {key: (ROOT / ".binder" / file).resolve() for key, file in options.items()} == {
        "--constraint": ROOT / "constraints.txt",
        "--requirement": ROOT / "requirements.txt",
    }


@pytest.mark.skipif(os.name == "nt", reason="Windows does not know whether a file is a program")
def test_binder_can_run_what_it_runs():
    assert os.access(ROOT / ".binder" / "postBuild", os.X_OK)
