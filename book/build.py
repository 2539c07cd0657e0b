"""Build the book from its executed notebooks.

    python book/build.py                         as pages, in _build/html
    python book/build.py --builder pdflatex      as a PDF, in _build/latex

Every warning is an error. None of the user's own settings reach the build (see `isolated`).
"""

from __future__ import annotations

import argparse
import subprocess
import sys

from isolated import ROOT, isolated

BUILDERS = ("html", "latex", "pdflatex")  # latex: the sources of the PDF
# its folder comes first: an installed package can have the name of an extension of the book, as PyTables has
PROGRAM = "import sys; sys.path.insert(0, 'book'); from jupyter_book.cli.main import main; main()"
OPTIONS = ("--toc", "book/_toc.yml", "--quiet", "--warningiserror", "--keep-going", "--nitpick")


def main(builder: str = "html") -> int:
    """Build the book in another process; gives its exit status."""
    command = [sys.executable, "-P", "-c", PROGRAM, "build", ".", *OPTIONS, "--builder", builder]
    with isolated():
        return subprocess.run(command, cwd=ROOT).returncode


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Build the book from its executed notebooks.")
    parser.add_argument("--builder", choices=BUILDERS, default=BUILDERS[0])
    sys.exit(main(parser.parse_args().builder))
