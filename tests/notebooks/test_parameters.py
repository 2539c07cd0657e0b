"""The notebooks with other parameters: an error names a bad value, and mazes from files work."""

import json
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import pandas as pd
import papermill
import pytest

from tests.notebooks import NOTEBOOKS

mpl.use("agg")

BAD = {  # parameter: value, what the error says
    "maze": ("maze3", "maze must be one of 'hard', 'maze1', 'maze2', 'medium' or the path of a maze file; got 'maze3'"),
    "runs": (0, "runs must be an integer from 1 to 1000000; got 0"),
    "seed": (-1, "seed must be .*; got -1"),
    "measured": ("none.json", "measured must be the path of measurements; got 'none.json' .No such file or directory."),
    "scheduler": ("nowhere", "scheduler must be the address of a running Dask scheduler, or empty; got 'nowhere'"),
    "store": (".", "store must be .*; got"),
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
    "algorithm": ("best", "algorithm must be one of 'standard', .*'random'; got 'best'"),
    "repeats": (-1, "repeats must be an integer of at least 0; got -1"),
}


def every_parameter():
    for notebook in NOTEBOOKS:
        for name in papermill.inspect_notebook(notebook):
            yield pytest.param(notebook, name, id=f"{notebook.stem}-{name}")


def run(notebook: Path, **parameters):
    """The variables of a notebook, after its code has run here with these parameters in place of its own."""
    names = {}
    for cell in json.loads(notebook.read_text())["cells"]:
        if cell["cell_type"] == "code":
            exec("".join(cell["source"]), names)
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
MEASURED = str(Path(__file__).parents[2] / "benchmarks" / "results.json")
SMALL = {"runs": 2, "repeats": 1, "row": 0, "column": 2, "paths": 2}


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
