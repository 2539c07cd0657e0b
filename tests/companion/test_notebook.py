import pandas as pd
import pytest
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output

import safe
from safe.companion import notebook
from safe.playground.address import run_address


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
        notebook.export_numbers(table)
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


def test_a_table_with_links_is_shown_as_it_is_and_its_links_beside_the_csv(shell):
    notebook.prepare()
    table = pd.DataFrame({"n": [1, 2]}, index=pd.Index(["a", "b"], name="which"))
    plain, _ = shell.display_formatter.format(table)
    with capture_output(stdout=False, stderr=False) as captured:
        notebook.show_table(table, [[("run 3", "view=watch")], []])
    (output,) = captured.outputs
    assert output.data == plain
    assert output.metadata == {"text/csv": {"links": [[["run 3", "view=watch"]], []], "heading": "replay"}}


def test_links_of_another_number_of_rows():
    with pytest.raises(ValueError, match="links must be as many as the 2 rows of the table; got 1"):
        notebook.show_table(pd.DataFrame({"n": [1, 2]}), [[("run 3", "view=watch")]])


SMALL = safe.Parameters(population=4, elites=0, generations=1)


def results_of(*experiments):
    """Made-up runs: where they succeed is given with each experiment."""
    return {
        safe.Experiment(algorithm, maze, len(success), seed, SMALL): pd.DataFrame(
            {"run": range(len(success)), "success": success}
        )
        for algorithm, maze, seed, success in experiments
    }


def test_a_replay_is_of_the_first_run_that_succeeded_or_else_of_the_first():
    results = results_of(("safe", "maze1", 0, [False, False, True, True]), ("random", "maze1", 0, [False, False]))
    solved, unsolved = results
    assert notebook.replays(results) == [
        ("safe: run 2", run_address(solved, 2)),
        ("random: run 0", run_address(unsolved, 0)),
    ]
    assert notebook.replays({}) == []


@pytest.mark.parametrize(
    ("others", "texts"),
    [
        ([], ["run 0"]),
        ([("safe", "maze2", 0, [True])], ["maze1: run 0", "maze2: run 0"]),
        ([("safe", "maze1", 7, [False, True])], ["seed 0: run 0", "seed 7: run 1"]),
        ([("novelty", "maze2", 0, [True])], ["maze1, safe: run 0", "maze2, novelty: run 0"]),
    ],
)
def test_the_text_of_a_replay_says_what_experiments_differ_in(others, texts):
    results = results_of(("safe", "maze1", 0, [True]), *others)
    assert [text for text, _ in notebook.replays(results)] == texts


def test_rows_lead_to_the_experiments_that_they_name():
    results = results_of(*((a, m, 0, [True]) for m in ("maze1", "maze2") for a in ("novelty", "safe", "fixed")))
    links = {e: ("run 0", run_address(e, 0)) for e in results}
    by_name = {(e.maze.name, e.algorithm.name): links[e] for e in results}

    def of_rows(names, *rows):
        index = pd.MultiIndex.from_tuples(rows, names=names)
        return notebook.replays_of_rows(pd.DataFrame({"n": range(len(rows))}, index), results)

    rows = ("maze2", "safe"), ("maze1", "novelty"), ("maze1", "random")
    assert of_rows(["maze", "algorithm"], *rows) == [[by_name[rows[0]]], [by_name[rows[1]]], []]
    (pair,) = of_rows(["maze", "first", "second"], ("maze2", "safe", "novelty"))
    assert [text for text, _ in pair] == ["safe: run 0", "novelty: run 0"]
    assert [address for _, address in pair] == [by_name["maze2", name][1] for name in ("safe", "novelty")]
    first, second = of_rows(["maze", "item"], ("maze1", "a"), ("maze1", "b"))
    assert first == second
    assert [text for text, _ in first] == ["novelty: run 0", "safe: run 0", "fixed: run 0"]


@pytest.mark.parametrize("text", ["", "0,0", "0,0 1", "0,0 1,2,3", "0,0 a,b", "0,0 0,1000001", "0,0 1," + "9" * 30, 7])
def test_points_that_are_none(text):
    with pytest.raises(ValueError, match="points must be two or more of row,column, separated by blanks; got"):
        notebook.read_points(text)
