"""The notebooks with other parameters: an error names a bad value, and mazes from files work."""

import json
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import pandas as pd
import papermill
import pytest
from IPython.core.inputtransformer2 import TransformerManager

from safe.companion import project as files
from tests.notebooks import NOTEBOOKS

mpl.use("agg")

BAD = {  # parameter: value, what the error says
    "maze": ("maze3", "maze must be one of 'hard', 'maze1', 'maze2', 'medium' or the path of a maze file; got 'maze3'"),
    "runs": (0, "runs must be an integer from 1 to 1000000; got 0"),
    "seed": (-1, "seed must be .*; got -1"),
    "measured": ("none.json", "measured must be the path of measurements; got 'none.json' .No such file or directory."),
    "scheduler": ("nowhere", "scheduler must be the address of a running Dask scheduler, or empty; got 'nowhere'"),
    "cores": (-1, "cores must be an integer of at least 0; got -1"),
    "store": (".", "store must be .*; got"),
    "stores": ("none.sqlite", "store must be the path of a results store, .*; got 'none.sqlite'"),
    "lines": ("none.txt", "lines must be the path of a file; got 'none.txt' .*No such file"),
    "seat_runs": (0, "runs must be an integer from 1 to 1000000; got 0"),
    "run": (-1, "run must be an integer of at least 0; got -1"),
    "row": (1000, r"cell must be a \(row, column\) within the 100 by 100 cells; got \(1000, 60\)"),
    "column": ("left", r"cell must be a \(row, column\) within the 100 by 100 cells; got \(37, 'left'\)"),
    "generation": (-1, "generation must be an integer of at least 0; got -1"),
    "population": (3, "population must be an even number; got 3"),
    "objectives": (0, "objectives must be an integer from 1 to 1000000; got 0"),
    "generations": ("all", "generations must be an integer from 1 to 1000000; got 'all'"),
    "k": (0, "k must be an integer .*; got 0"),
    "paths": (0, "paths must be an integer of at least 1; got 0"),
    "a": ("much", "objectives must be .*"),
    "b": (float("nan"), "objectives must be .*"),
    "points": ("0,0 1", "points must be two or more of row,column, separated by blanks; got '0,0 1'"),
    "algorithm": ("best", "algorithm must be one of 'standard', .*'weighing-and-goals'; got 'best'"),
    "traced": (-1, "traced must be an integer of at least 0; got -1"),
    "trials": (0, "trials must be an integer of at least 1; got 0"),
    "repeats": (-1, "repeats must be an integer of at least 0; got -1"),
}


def every_parameter():
    for notebook in NOTEBOOKS:
        for name in papermill.inspect_notebook(notebook):
            yield pytest.param(notebook, name, id=f"{notebook.stem}-{name}")


python = TransformerManager().transform_cell  # the code of a cell, without the syntax that is IPython's own


def run(notebook: Path, **parameters):
    """The variables of a notebook, after its code has run here with these parameters in place of its own."""
    names = {}
    for cell in json.loads(notebook.read_text())["cells"]:
        if cell["cell_type"] == "code":
            exec(python("".join(cell["source"])), names)
            if "parameters" in cell["metadata"].get("tags", []):
                names |= parameters
    plt.close("all")
    return names


@pytest.mark.parametrize(("notebook", "name"), list(every_parameter()))
def test_a_bad_value_is_named(notebook, name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    value, message = BAD[name]
    parameters = {name: value}
    if "store" in papermill.inspect_notebook(notebook) and name != "store":
        parameters["store"] = str(tmp_path / "results.sqlite")
    if name == "store" and "evidence.runs" in notebook.read_text():
        parameters["seed"] = 7  # of which no runs are recorded
    if name == "traced":  # which is asked for late
        Path("mine.txt").write_text(MAZE)
        parameters |= {"maze": "mine.txt", "runs": 2}
    with pytest.raises(ValueError, match=f"^{message}") as error:
        run(notebook, **parameters)
    assert "\n" not in str(error.value)


MAZE = """
S...#....
.##.#.##.
.#.....#.
.#.###.#.
...#...#G
"""
MEASURED = str(Path(__file__).parents[2] / files.MEASUREMENTS)
SMALL = {"runs": 2, "trials": 2, "repeats": 1, "row": 0, "column": 2, "paths": 2}


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_mazes_from_files(notebook, tmp_path, monkeypatch):
    """Two of the same name, if the notebook takes several: each has rows that differ from those of the other."""
    monkeypatch.chdir(tmp_path)
    Path("mine.txt").write_text(MAZE)
    Path("the other").mkdir()
    Path("the other/mine.txt").write_text(MAZE[::-1])
    known = papermill.inspect_notebook(notebook)
    takes_several = "maze" in known and " " in known["maze"]["default"]
    mazes = ["mine.txt", "the other/mine.txt"] if takes_several else "the other/mine.txt"
    parameters = SMALL | {"maze": mazes, "store": "results.sqlite", "measured": MEASURED}
    names = run(notebook, **{name: value for name, value in parameters.items() if name in known})
    shown = names.get("shown")
    if isinstance(shown, pd.DataFrame):
        assert shown.index.is_unique
        assert not takes_several or len(shown.index.unique(0)) >= 2


@pytest.fixture(params=["project", "project/notebooks", "elsewhere", "elsewhere, without a project"])
def store_by_default(request, tmp_path, monkeypatch):
    """Where the store of a notebook is to be made that is opened in a folder and given none."""
    project, package = tmp_path / "project", tmp_path / "project"
    for folder in ("notebooks", "safe/companion", "../elsewhere", "../site-packages/safe/companion"):
        (project / folder).mkdir(parents=True)
    folder, *without = request.param.split(", ")
    if without:
        project, package = tmp_path / folder, tmp_path / "site-packages"
    monkeypatch.setattr(files, "__file__", str(package / "safe/companion/project.py"))
    monkeypatch.chdir(tmp_path / folder)
    return project / "results.sqlite"


def test_a_notebook_finds_the_store_of_the_project_wherever_it_is_opened(store_by_default, tmp_path):
    Path("mine.txt").write_text(MAZE)
    names = run(NOTEBOOKS[0].with_stem("figure2-deception"), maze="mine.txt", run=0)
    assert names["results"]
    assert list(tmp_path.rglob("*.sqlite")) == [store_by_default]


def test_a_store_that_is_named_is_relative_to_the_working_directory(store_by_default, tmp_path):
    Path("mine.txt").write_text(MAZE)
    run(NOTEBOOKS[0].with_stem("figure2-deception"), maze="mine.txt", run=0, store="results.sqlite")
    assert list(tmp_path.rglob("*.sqlite")) == [Path.cwd() / "results.sqlite"]
