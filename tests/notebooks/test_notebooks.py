"""Rules for every notebook. The tests of the book execute them."""

import importlib
import json
import sys
import tomllib
from pathlib import Path

import papermill
import pytest
from IPython.core.interactiveshell import InteractiveShell

from tests.notebooks import NOTEBOOKS

ROOT = Path(__file__).parents[2]


@pytest.fixture(params=NOTEBOOKS, ids=lambda path: path.stem)
def notebook(request):
    return request.param


def test_there_are_notebooks():
    assert NOTEBOOKS


def test_it_is_committed_without_outputs(notebook):
    for cell in json.loads(notebook.read_text())["cells"]:
        if cell["cell_type"] == "code":
            assert cell["outputs"] == []
            assert cell["execution_count"] is None


def test_its_parameters_are_typed_and_explained(notebook):
    parameters = papermill.inspect_notebook(notebook)
    assert parameters
    for parameter in parameters.values():
        assert parameter["inferred_type_name"] in ("str", "int", "float", "bool"), parameter
        assert parameter["default"], parameter
        assert parameter["help"], parameter


def test_what_makes_runs_can_be_told_where_to_keep_and_to_compute_them(notebook):
    found = papermill.inspect_notebook(notebook).keys() & {"store", "scheduler", "cores"}
    makes_runs = any(call in notebook.read_text() for call in ("safe.run_all", "evidence.runs"))
    assert len(found) == (3 if makes_runs else 0)


def test_it_begins_with_its_title(notebook):
    first = json.loads(notebook.read_text())["cells"][0]
    assert first["cell_type"] == "markdown"
    assert first["source"][0].startswith("# ")


def test_its_second_cell_installs_the_package_from_the_repositorys_address(notebook, install_cell):
    """After a change of the address, or for a new notebook: `python book/install_cell.py`."""
    second = json.loads(notebook.read_text())["cells"][1]
    assert second["id"] == install_cell.ID
    assert second["metadata"] == {"tags": ["remove-cell"]}
    assert "".join(second["source"]) == install_cell.configured(notebook)
    assert second["source"][0] == f"# In the book, this notebook is the page notebooks/{notebook.stem}.html.\n"


@pytest.fixture
def install_cell(monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "book")
    return importlib.import_module("install_cell")


@pytest.fixture
def installed(monkeypatch):
    """A cell's code, run in a kernel that has the package or has not, gives its error and what it let pip install."""

    def installed(code, is_missing):
        if is_missing:
            monkeypatch.setitem(sys.modules, "safe.companion", None)
        calls, shell = [], InteractiveShell()
        shell.register_magic_function(calls.append, magic_name="pip")
        return shell.run_cell(code).error_in_exec, calls

    return installed


@pytest.mark.parametrize("address", ["", "https://github.com/NAME/REPOSITORY"])
def test_where_the_package_is_nothing_is_installed(install_cell, installed, address):
    assert installed(install_cell.source(address, "main"), is_missing=False) == (None, [])


def test_with_an_address_a_missing_package_is_installed(install_cell, installed):
    error, (line,) = installed(install_cell.source("https://github.com/NAME/REPOSITORY", "dev"), is_missing=True)
    assert error is None
    name = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["name"]
    assert line == f'install --quiet "{name}[playground] @ git+https://github.com/NAME/REPOSITORY@dev"'


def test_without_an_address_a_missing_package_is_an_error_that_says_how_to_install_it(install_cell, installed):
    error, calls = installed(install_cell.source("", "main"), is_missing=True)
    assert isinstance(error, ModuleNotFoundError)
    assert calls == []
    assert "%pip install" in str(error)
    assert "\n" not in str(error)


def test_the_cell_is_written_once(install_cell, tmp_path):
    """Another takes its place, and nothing else changes."""
    copy = tmp_path / NOTEBOOKS[0].name
    copy.write_bytes(NOTEBOOKS[0].read_bytes())
    install_cell.write(copy, "1")
    assert json.loads(copy.read_text())["cells"][1]["source"] == ["1"]
    install_cell.write(copy, install_cell.configured(copy))
    assert copy.read_bytes() == NOTEBOOKS[0].read_bytes()
