"""Files made up by atheris, which sees what lines of the readers they reach, and goes on from those that reach more.

    python -m tests.helpers.fuzz_atheris "maze texts" 20000

It tries out those targets of `tests.helpers.fuzz` that take the bytes of a file, and starts from the same mazes and
stores as hypothesis.
"""

from __future__ import annotations

import sys
import tempfile
import warnings
from pathlib import Path

import atheris

READERS = {"checks", "maze", "store"}
PACKAGE = Path(__file__).parents[2] / "safe"
# Atheris knows only whole packages and what to leave out of them. Kernels cannot be compiled with its marks in them.
OTHERS = [f"safe.{file.stem}" for file in PACKAGE.glob("*.py") if file.stem not in READERS]

with atheris.instrument_imports(include=["safe"], exclude=OTHERS):
    from tests.helpers import fuzz


def main() -> None:
    warnings.simplefilter("error")
    name, cases = sys.argv[1], int(sys.argv[2])
    originals = {"maze texts": fuzz.MAZE_TEXTS, "damaged stores": [file for file, _ in fuzz.stores()]}[name]
    fuzz.warm_up()
    folder = tempfile.TemporaryDirectory()
    for number, original in enumerate(originals):
        (Path(folder.name) / str(number)).write_bytes(original)

    def try_out(data: bytes) -> None:
        fuzz.attempt(name, data if name == "maze texts" else (data, b""))
        if fuzz.TRIED.total() == cases:  # said here, as Fuzz() ends the process
            fuzz.report(name)
            folder.cleanup()

    options = [f"-runs={cases}", "-seed=1", f"-timeout={fuzz.SLOW}", "-max_len=65536", "-verbosity=0"]
    atheris.Setup([sys.argv[0], *options, f"-artifact_prefix={folder.name}-", folder.name], try_out)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
