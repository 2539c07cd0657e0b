import re
from pathlib import Path

import matplotlib.pyplot as plt
import pandas as pd
import pytest
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output

from safe.companion import notebook, project


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


def test_outside_jupyter_prepare_works_too():
    notebook.prepare()


def exported(table):
    with capture_output(stdout=False, stderr=False) as captured:
        notebook.export_numbers(table)
    (output,) = captured.outputs
    return output.data["application/json"]


def test_numbers_are_exported_by_column_and_index(shell):
    index = pd.MultiIndex.from_tuples([("maze1", "safe"), ("maze2", "random")])
    table = pd.DataFrame({"successes": [326.0, float("nan")], "runs": [500, 500]}, index)
    assert exported(table) == {
        "successes_maze1_safe": 326,
        "successes_maze2_random": None,
        "runs_maze1_safe": 500,
        "runs_maze2_random": 500,
    }
    assert exported(pd.DataFrame({"claims": [3]}, ["all"])) == {"claims_all": 3}


def test_sentences_with_numbers_are_shown_as_markdown(shell):
    with capture_output(stdout=False, stderr=False) as captured:
        notebook.say("**326** of 500 runs\n- 3 of 4")
    (output,) = captured.outputs
    assert output.data == dict.fromkeys(["text/markdown", "text/plain"], "**326** of 500 runs\n- 3 of 4")


def test_a_table_with_links_is_shown_as_it_is_and_its_links_beside_the_csv(shell):
    notebook.prepare()
    table = pd.DataFrame({"n": [1, 2]}, index=pd.Index(["a", "b"], name="which"))
    plain, _ = shell.display_formatter.format(table)
    with capture_output(stdout=False, stderr=False) as captured:
        notebook.show_table(table, [[("run 3", "view=watch")], []])
    (output,) = captured.outputs
    assert output.data == plain
    assert output.metadata == {"text/csv": {"links": [[["run 3", "view=watch"]], []], "heading": "replay"}}


def test_a_figure_has_its_links_where_their_parts_are(shell):
    notebook.prepare()
    figure, axes = plt.subplots(figsize=(4, 2), layout="none")
    axes.set_position((0, 0, 1, 1))
    left, right = axes.imshow([[0]], extent=(0, 1, 0, 1)), axes.imshow([[0]], extent=(3, 4, 1, 2))
    axes.set(xlim=(0, 4), ylim=(0, 2))
    axes.set_axis_off()
    with capture_output(stdout=False, stderr=False) as captured:
        notebook.show_figure(figure, [(left, "one", "view=drive"), (right, "other", "view=watch")])
    (output,) = captured.outputs
    pad = plt.rcParams["savefig.pad_inches"]
    width, height = 4 + 2 * pad, 2 + 2 * pad
    found = output.metadata["image/svg+xml"]["links"]
    assert [link[:2] for link in found] == [["one", "view=drive"], ["other", "view=watch"]]
    for (_, _, *found_box), (x, y) in zip(found, ((0, 1), (3, 0)), strict=True):
        box = [(x + pad) / width, (y + pad) / height, 1 / width, 1 / height]
        assert found_box == pytest.approx([100 * part for part in box], abs=0.02)
    assert plt.get_fignums() == []


def test_a_figure_says_where_its_panels_are_in_the_image_that_is_shown(shell):
    notebook.prepare()
    figure, grid = plt.subplots(1, 2, figsize=(7, 3))
    for axes in grid:
        axes.set(xlabel="step", aspect="equal")
    shown, metadata = shell.display_formatter.format(figure)
    width, height = map(float, re.search(r'viewBox="0 0 ([\d.]+) ([\d.]+)"', shown["image/svg+xml"]).groups())
    layout = metadata["image/svg+xml"]["layout"]
    assert layout["size"] == pytest.approx([width, height], abs=0.1)
    assert len(layout["panels"]) == 2
    plt.close(figure)


def test_links_of_another_number_of_rows():
    with pytest.raises(ValueError, match="links must be as many as the 2 rows of the table; got 1"):
        notebook.show_table(pd.DataFrame({"n": [1, 2]}), [[("run 3", "view=watch")]])


@pytest.mark.parametrize("text", ["", "0,0", "0,0 1", "0,0 1,2,3", "0,0 a,b", "0,0 0,1000001", "0,0 1," + "9" * 30, 7])
def test_texts_that_are_no_points(text):
    with pytest.raises(ValueError, match="points must be two or more of row,column, separated by blanks; got"):
        notebook.read_points(text)


def test_what_runs_need(tmp_path, monkeypatch):
    monkeypatch.setattr(project, "folder", lambda: tmp_path)
    resources = {"store": tmp_path / "results.sqlite", "executor": None, "cores": None}
    assert notebook.resources("", "", 0) == resources
    assert notebook.resources("mine.sqlite", "", 3) == resources | {"store": "mine.sqlite", "cores": 3}
    monkeypatch.setattr(project, "folder", lambda: None)
    assert notebook.resources("", "", 0)["store"] == Path.cwd() / "results.sqlite"
