import pandas as pd
import pytest
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output

from safe import notebook


@pytest.fixture
def shell():
    yield InteractiveShell.instance()
    InteractiveShell.clear_instance()


def test_a_table_carries_itself_along_as_csv(shell):
    notebook.prepare()
    table = pd.DataFrame({"n": [1]}, index=pd.Index(["a, b"], name="which"))
    shown, _ = shell.display_formatter.format(table)
    assert shown["text/csv"] == 'which,n\n"a, b",1\n'
    assert "<table" in shown["text/html"]


def test_names_in_a_table_are_no_markup(shell):
    notebook.prepare()
    shown, _ = shell.display_formatter.format(pd.DataFrame({"n": ["<script>alert(1)</script>"]}, ["$x$"]))
    assert "<script" not in shown["text/html"]
    assert "mathjax_ignore" in shown["text/html"]


def test_outside_of_jupyter_there_is_nothing_to_prepare_for():
    notebook.prepare()


def handed_on(table):
    with capture_output(stdout=False, stderr=False) as captured:
        notebook.hand_on(table)
    (output,) = captured.outputs
    return output.data["application/json"]


def test_numbers_are_handed_on_by_column_and_index(shell):
    index = pd.MultiIndex.from_tuples([("maze1", "safe"), ("maze2", "random")])
    table = pd.DataFrame({"successes": [326.0, float("nan")], "runs": [500, 500]}, index)
    assert handed_on(table) == {
        "successes_maze1_safe": 326,
        "successes_maze2_random": None,
        "runs_maze1_safe": 500,
        "runs_maze2_random": 500,
    }
    assert handed_on(pd.DataFrame({"claims": [3]}, ["all"])) == {"claims_all": 3}


@pytest.mark.parametrize("text", ["", "0,0", "0,0 1", "0,0 1,2,3", "0,0 a,b", "0,0 0,1000001", "0,0 1," + "9" * 30, 7])
def test_points_that_are_none(text):
    with pytest.raises(ValueError, match="points must be two or more of row,column, separated by blanks; was"):
        notebook.read_points(text)
