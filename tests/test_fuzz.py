"""A few malformed inputs of every kind, and what no reader of files may do. `make fuzz` tries many more."""

import ast
from pathlib import Path

import pytest

import safe
from tests.helpers import fuzz

CASES = 3000  # of all targets together
PACKAGE = Path(safe.__file__).parent
SOURCES = sorted(PACKAGE.rglob("*.py"))
FORBIDDEN = {"eval", "exec", "compile", "__import__", "allow_pickle", "read_pickle"}
FORBIDDEN_MODULES = {"pickle", "cPickle", "dill", "joblib", "marshal", "shelve", "yaml"}


@pytest.mark.parametrize("name", fuzz.TARGETS)
def test_whatever_is_passed_in_is_accepted_or_refused(name):
    fuzz.fuzz(name, fuzz.share_of(name, CASES))
    assert fuzz.TRIED[name, "refused"] > 0


@pytest.mark.parametrize("source", SOURCES, ids=lambda source: str(source.relative_to(PACKAGE)))
def test_nothing_from_a_file_is_unpickled_or_evaluated(source):
    for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
        match node:
            case ast.Import(names=names):
                assert not FORBIDDEN_MODULES & {name.name.split(".")[0] for name in names}
            case ast.ImportFrom(module=module):
                assert module.split(".")[0] not in FORBIDDEN_MODULES
            case ast.Name(id=name) | ast.keyword(arg=name):
                assert name not in FORBIDDEN
            case ast.Attribute(attr="read_pickle"):
                raise AssertionError("pandas unpickles")
            case ast.Call(func=ast.Attribute(attr="query" | "eval"), args=[expression]):
                assert isinstance(expression, ast.Constant), "pandas evaluates expressions"
