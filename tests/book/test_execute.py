"""Notebooks are executed side by side."""

import importlib
import threading
import time
from pathlib import Path

import papermill
import pytest

from tests.helpers.checkout import ROOT

NAMES = ["coefficients", "figure1-mazes", "figure3-sensors", "fixed-weights", "ledger"]


@pytest.fixture
def execute(monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "book")
    module = importlib.import_module("execute")
    monkeypatch.setattr(module, "what_is_wrong", lambda notebook, _: None if "figure3" in notebook.name else "stale")
    monkeypatch.setattr(module, "available_cores", lambda: 2)
    monkeypatch.setenv("TQDM_DISABLE", "1")
    return module


def execute_all(module, always=False):
    module._execute_all([module.NOTEBOOKS / f"{name}.ipynb" for name in NAMES], {}, always)


@pytest.mark.parametrize("always", [False, True])
def test_notebooks_that_keep_runs_wait_for_the_one_that_makes_what_they_share(execute, monkeypatch, capsys, always):
    events, both = [], threading.Barrier(2, timeout=60)

    def slow(notebook, parameters):
        events.append(("begins", notebook.stem))
        if notebook.stem in ("ledger", "figure1-mazes"):
            both.wait()  # each waits until the other has begun
        if notebook.stem == "ledger":
            time.sleep(0.2)
        events.append(("ends", notebook.stem))

    monkeypatch.setattr(execute, "execute", slow)
    execute_all(execute, always)
    executed = {*NAMES} - ({"figure3-sensors"} if not always else set())
    assert sorted(events) == sorted((event, name) for event in ("begins", "ends") for name in executed)
    assert events[0] == ("begins", "ledger")
    for name in ("coefficients", "fixed-weights"):
        assert events.index(("begins", name)) > events.index(("ends", "ledger"))
    said = capsys.readouterr().out
    assert ("[3/5] figure3-sensors: up to date\n" in said) == (not always)
    assert all(f"[{number}/5] {name}: " in said for number, name in enumerate(NAMES, start=1))


@pytest.mark.parametrize(
    ("failure", "complaint"),
    [
        (ValueError("cell 7 must show a table; got none"), "cell 7 must show a table; got none (in full in {copy})"),
        (papermill.PapermillExecutionError(0, 1, "", "KeyError", "'p17'", []), "KeyError: 'p17' (in full in {copy})"),
        (RuntimeError("the process has ended"), "RuntimeError: the process has ended"),
    ],
)
def test_a_failure_ends_the_others(execute, monkeypatch, failure, complaint):
    begun = []

    def fail(notebook, parameters):
        begun.append(notebook.stem)
        if notebook.stem == "ledger":
            raise failure

    monkeypatch.setattr(execute, "execute", fail)
    with pytest.raises(SystemExit) as ended:
        execute_all(execute)
    copy = Path(execute.EXECUTED, ".ledger.ipynb")
    assert ended.value.code == "[5/5] ledger: " + complaint.format(copy=copy)
    assert not {"coefficients", "fixed-weights"} & {*begun}
