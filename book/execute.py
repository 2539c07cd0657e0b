"""Execute the book's notebooks whose executed copies are missing or stale, side by side.

    python book/execute.py                                  with the parameters of the book
    python book/execute.py table2-success -p runs 100       one notebook, with your own parameters

A copy is written under another name and renamed when it is complete, so an interrupted execution leaves none behind.
Notebooks run in this program's interpreter and in the project's folder, to which paths in parameters are relative. None
of the user's own settings reach them (see `isolated`).
"""

from __future__ import annotations

import argparse
import contextlib
import os
import platform
import sys
import time
from multiprocessing.pool import ThreadPool
from pathlib import Path

import nbformat
import papermill

from executed import EXECUTED, NOTEBOOKS, ROOT, STAMP, notebooks, requested_parameters, stamp, what_is_wrong
from forked import fork_jupyters_kernels
from isolated import isolated
from safe.experiments.cores import available_cores

FIRST = "ledger"  # makes all runs that several notebooks show
MUST_SHOW = {  # by a key in the metadata of a cell: what it stands for, and the output that shows it
    "table": ("table", "text/csv"),
    "mystnb": ("figure", "image/svg+xml"),
}


def execute(notebook: Path, parameters: dict[str, object]) -> None:
    """Execute a notebook with those of these parameters that it declares."""
    declared = papermill.inspect_notebook(notebook)
    own = {name: value for name, value in parameters.items() if name in declared}
    departures = {name: value for name, value in own.items() if repr(value) != declared[name]["default"]}
    made_from = stamp(notebook, own)  # what changes from now on makes the copy stale
    unfinished = unfinished_copy(notebook)
    executed = papermill.execute_notebook(
        notebook,
        unfinished,
        departures,  # papermill then adds no cell that only repeats the notebook's own values
        request_save_on_cell_execute=False,  # but at the end: twice for each cell takes as long as all else here
        progress_bar=False,
        stderr_file=sys.stderr if sys.stderr.isatty() else None,
        store_widget_state=False,  # it would hold all of the playground's scripts
        extra_arguments=["--log-level=CRITICAL"],  # of the kernel: it warns of TCP, and of being shut down
    )
    check_outputs(executed)
    for cell in executed.cells:
        if cell.cell_type == "code":
            cell.outputs = [output for output in cell.outputs if not is_progress_bar(output)]
    executed.metadata[STAMP] = made_from
    nbformat.write(executed, unfinished)
    unfinished.replace(EXECUTED / notebook.name)


def complaint_of(notebook: Path, parameters: dict[str, object]) -> str | None:
    """Execute a notebook; gives what goes wrong."""
    try:
        execute(notebook, parameters)
    except papermill.PapermillExecutionError as error:
        complaint = f"{error.ename}: {error.evalue}"
    except ValueError as error:
        complaint = str(error)
    except Exception as error:  # none may be lost in its thread; there is no copy yet
        return f"{type(error).__name__}: {error}"
    else:
        return None
    return f"{complaint} (in full in {unfinished_copy(notebook)})"


def unfinished_copy(notebook: Path) -> Path:
    """The file that holds a notebook's copy until its execution is complete."""
    return EXECUTED / f".{notebook.name}"


def check_outputs(executed: nbformat.NotebookNode) -> None:
    """Raise a ValueError if a cell that stands for a table or a figure shows none, for whatever reason."""
    for cell in executed.cells:
        for key in MUST_SHOW.keys() & cell.metadata.keys():
            what, kind = MUST_SHOW[key]
            if not any(kind in output.get("data", {}) for output in cell.outputs):
                raise ValueError(f"cell {cell.id} must show a {what}; got none")


def is_progress_bar(output: nbformat.NotebookNode) -> bool:
    """Is this the output of a progress bar, which moves by carriage returns and ends with a bare new line?"""
    return output.get("name") == "stderr" and ("\r" in output.text or not output.text.strip())


def _value(text: str) -> object:
    """A parameter's value as papermill would read it: as a number if it is one."""
    for number in (int, float):
        with contextlib.suppress(ValueError):
            return number(text)
    return text


def main() -> None:
    parser = argparse.ArgumentParser(
        description="Execute the book's notebooks whose executed copies are missing or stale."
    )
    parser.add_argument("names", nargs="*", metavar="notebook", help="name without folder and ending; default: all")
    parser.add_argument("-p", nargs=2, action="append", default=[], metavar=("NAME", "VALUE"), help="set a parameter")
    options = parser.parse_args()
    try:
        chosen = [NOTEBOOKS / f"{name}.ipynb" for name in options.names] or notebooks()
        for notebook in chosen:
            if not notebook.exists():
                known = ", ".join(path.stem for path in notebooks())
                raise ValueError(f"notebook must be one of {known}; got {notebook.stem!r}")
        given = {name: _value(text) for name, text in options.p}
        known = {name for notebook in chosen for name in papermill.inspect_notebook(notebook)}
        if unknown := given.keys() - known:
            raise ValueError(f"parameter must be one of {', '.join(sorted(known))}; got {', '.join(sorted(unknown))}")
        parameters = requested_parameters() | given
    except ValueError as error:
        parser.error(str(error))
    with isolated():
        fork_jupyters_kernels()
        _execute_all(chosen, parameters, bool(given))


def _execute_all(chosen: list[Path], parameters: dict[str, object], always: bool) -> None:
    """Execute these notebooks, those that are up to date only if they are `always` executed.

    No two make the same runs: most of those that keep runs wait for the one that makes what they share, while others
    are executed. Large notebooks come before small ones, so that all cores have work until the end.
    """
    print(f"Python {platform.python_version()} in {sys.prefix}", flush=True)
    labels = {notebook: f"[{number}/{len(chosen)}] {notebook.stem}" for number, notebook in enumerate(chosen, start=1)}
    stale = [notebook for notebook in chosen if always or what_is_wrong(notebook, parameters)]
    for notebook in chosen:
        if notebook not in stale:
            print(f"{labels[notebook]}: up to date", flush=True)
    if not stale:
        return

    def timed(notebook: Path) -> tuple[Path, float, str | None]:
        started = time.perf_counter()
        complaint = complaint_of(notebook, parameters)
        return notebook, time.perf_counter() - started, complaint

    EXECUTED.mkdir(exist_ok=True)
    os.environ["TQDM_DISABLE"] = "" if sys.stderr.isatty() else "1"  # kernels inherit it: bars are for people
    stale.sort(key=lambda notebook: (notebook.stem == FIRST, notebook.stat().st_size), reverse=True)
    waits = {notebook: notebook.stem != FIRST and "store" in papermill.inspect_notebook(notebook) for notebook in stale}
    # threads of such a pool end with this program, and so do kernels: nothing outlives a failure or an interruption
    # one more than cores, since a kernel that begins or ends leaves its core idle
    with contextlib.chdir(ROOT), ThreadPool(available_cores() + 1) as pool:
        for group in (False, True):
            for notebook, seconds, complaint in pool.imap_unordered(timed, [n for n in stale if waits[n] == group]):
                if complaint is not None:
                    sys.exit(f"{labels[notebook]}: {complaint}")
                print(f"{labels[notebook]}: {seconds:.1f} s", flush=True)


if __name__ == "__main__":
    main()
