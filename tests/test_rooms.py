"""Imports point one way: a room uses only what stands above it in this list, and the science only its foundations."""

import ast
from pathlib import Path

import pytest

import safe

PACKAGE = Path(safe.__file__).parent
FOUNDATIONS = ("version", "checks", "kernel")
ROOMS = ("experiments", "results", "companion", "playground")
FILES = {
    file.relative_to(PACKAGE).as_posix(): file for file in PACKAGE.rglob("*.py") if file != PACKAGE / "__init__.py"
}


def imported(file):
    """The modules and rooms of `safe` that a file imports, wherever it does so."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        match node:
            case ast.ImportFrom(module="safe", names=names):
                yield from (name.name for name in names)
            case ast.ImportFrom(module=module) if module.startswith("safe."):
                yield module.split(".")[1]
            case ast.Import(names=names):
                yield from (name.name.split(".")[1] for name in names if name.name.startswith("safe."))


@pytest.mark.parametrize("name", FILES)
def test_imports_point_one_way(name):
    room = name.split("/")[0]
    science = {file.stem for file in PACKAGE.glob("*.py")} - {"__init__", "version"}
    rooms = ROOMS[: ROOMS.index(room) + 1] if room in ROOMS else ()
    allowed = set() if name.removesuffix(".py") in FOUNDATIONS else science.union(rooms, ["version"] if rooms else [])
    assert set(imported(FILES[name])) <= allowed
