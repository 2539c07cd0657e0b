"""Whether a new build would make the book that is there.

    python book/unchanged.py            ends with 0 if so, or else notes what the build that follows begins with
    python book/unchanged.py --made     notes that this build has gone well

What a build reads counts by its content: files of the project, the installed packages, and settings in the environment.
What it makes counts by sizes and times: executed notebooks, stored results, and pages. If something changes while the
book is built, the next build does not take it for unchanged.
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
import sysconfig
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parent.parent
READ = ("_config.yml", "benchmarks", "book", "make.py", "notebooks", "safe")
MADE = ("executed", "results.sqlite", "results.sqlite-wal", "_build/html")
SETTINGS = ("RUNS", "SOURCE_DATE_EPOCH")
BEGUN = Path("_build", "begun-with.json")
ENDED = Path("_build", "made-from.json")


def what_is_read() -> list[object]:
    """All that a build depends on."""
    content = hashlib.sha256()
    for file in _files(READ):
        content.update(f"{file.relative_to(ROOT).as_posix()}\0{file.stat().st_size}\0".encode() + file.read_bytes())
    packages = Path(sysconfig.get_path("purelib")), Path(sysconfig.get_path("platlib"))
    installed = {
        (entry.name, entry.stat().st_mtime_ns)
        for folder in packages
        for entry in folder.iterdir()
        if entry.suffix in (".dist-info", ".egg-link", ".pth")
    }
    return [content.hexdigest(), sys.version, sorted(map(list, installed)), [os.environ.get(name) for name in SETTINGS]]


def what_is_made() -> list[object]:
    """All that a build leaves, except what only Sphinx reads."""
    return [[str(file.relative_to(ROOT)), file.stat().st_size, file.stat().st_mtime_ns] for file in _files(MADE)]


def _files(parts: tuple[str, ...]) -> Iterator[Path]:
    """The files in these folders and these files themselves, in order, without what Python compiles."""
    for part in parts:
        found = [ROOT / part, *sorted((ROOT / part).rglob("*"))]
        yield from (file for file in found if file.is_file() and file.parent.name != "__pycache__")


def is_unchanged() -> bool:
    """Is the book the one that a new build would make? If not, note what the build begins with."""
    read = what_is_read()
    if _noted(ENDED) == [read, what_is_made()]:
        return True
    (ROOT / ENDED).unlink(missing_ok=True)
    _note(BEGUN, read)
    return False


def note_made() -> None:
    """Note that a build has gone well, unless something changed meanwhile."""
    read = what_is_read()
    if _noted(BEGUN) == read:
        _note(ENDED, [read, what_is_made()])


def _note(place: Path, what: list[object]) -> None:
    (ROOT / place).parent.mkdir(exist_ok=True)
    (ROOT / place).write_text(json.dumps(what), encoding="utf-8")


def _noted(place: Path) -> object:
    try:
        return json.loads((ROOT / place).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


if __name__ == "__main__":
    if sys.argv[1:] == ["--made"]:
        note_made()
    else:
        sys.exit(not is_unchanged())
