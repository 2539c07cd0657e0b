"""Keeps the user's own settings out of the book: its notebooks and its build.

Python, Jupyter, IPython, matplotlib, docutils and latexmk read settings from the environment, from the home directory
and from the working directory, and some of them change the book or stop its build. SOURCE_DATE_EPOCH is respected,
since it is set for the date in the book.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import sys
import tempfile
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

ROOT = Path(__file__).parent.parent
LEFT_OUT = ("MPLBACKEND", "PYTHONHOME", "PYTHONOPTIMIZE", "PYTHONPATH", "PYTHONSTARTUP", "PYTHONWARNINGS")


@contextlib.contextmanager
def isolated() -> Iterator[None]:
    """Inside this context, kernels and other programs start in this interpreter, without the user's settings."""
    before, terminate = dict(os.environ), signal.getsignal(signal.SIGTERM)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))  # so that what was started ends, too
    matplotlib = Path(find_spec("matplotlib").origin).parent  # not imported, since that would read its settings
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:  # Windows keeps what is open
        kernel = Path(folder, "kernels", "python3", "kernel.json")
        kernel.parent.mkdir(parents=True)
        command = [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"]
        kernel.write_text(json.dumps({"argv": command, "display_name": "Python 3", "language": "python"}))
        for name in LEFT_OUT:
            os.environ.pop(name, None)
        os.environ |= {
            "JUPYTER_PATH": folder,  # where Jupyter looks for kernels first
            "JUPYTER_CONFIG_DIR": folder,
            "IPYTHONDIR": folder,
            "MATPLOTLIBRC": str(matplotlib / "mpl-data" / "matplotlibrc"),
            "DOCUTILSCONFIG": "",  # no file, instead of docutils.conf here and .docutils at home
            "LATEXMKOPTS": "-norc -r latexmkrc",  # the book's own file, and not .latexmkrc at home
            "LATEXOPTS": "",
        }
        try:
            yield
        finally:
            os.environ.clear()
            os.environ.update(before)
            signal.signal(signal.SIGTERM, terminate)
