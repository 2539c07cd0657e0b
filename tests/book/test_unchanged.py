"""A book is taken for unchanged only if nothing has changed that a build reads or makes."""

import importlib
import os
import shutil

import pytest

from tests.helpers.checkout import PARTS, ROOT


@pytest.fixture
def unchanged(tmp_path, monkeypatch):
    """The module, for a project in which a build has gone well."""
    monkeypatch.syspath_prepend(ROOT / "book")
    module = importlib.import_module("unchanged")
    monkeypatch.setattr(module, "ROOT", tmp_path)
    packages = tmp_path / "site-packages"
    (packages / "numpy-2.0.0.dist-info").mkdir(parents=True)
    monkeypatch.setattr(module.sysconfig, "get_path", lambda _: str(packages))
    for name in module.SETTINGS:
        monkeypatch.delenv(name, raising=False)
    for file in (*READ, *MADE):
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file).write_text("as built", encoding="utf-8")
    assert not module.is_unchanged()
    module.note_made()
    assert module.is_unchanged()
    return module


READ = (
    "_config.yml",
    "benchmarks/results.json",
    "book/_static/book.css",
    "book/index.md",
    "make.py",
    "notebooks/ledger.ipynb",
    "safe/companion/record/designs/runs.csv.xz",
    "safe/evolution.py",
    "safe/playground/javascript/engine.js",
)
MADE = (
    "_build/html/book/index.html",
    "_build/html/objects.inv",
    "executed/ledger.ipynb",
    "results.sqlite",
)


def test_all_parts_that_a_book_is_made_of_are_read(unchanged):
    assert {*PARTS, "make.py"} == {*unchanged.READ}


@pytest.mark.parametrize("name", READ)
def test_a_file_with_other_contents(unchanged, tmp_path, name):
    before = (tmp_path / name).stat()
    (tmp_path / name).write_text("As built", encoding="utf-8")
    os.utime(tmp_path / name, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert not unchanged.is_unchanged()


@pytest.mark.parametrize("name", READ)
def test_the_time_of_what_is_read_does_not_count(unchanged, tmp_path, name):
    os.utime(tmp_path / name, (0, 0))
    assert unchanged.is_unchanged()


@pytest.mark.parametrize("name", READ + MADE)
def test_a_file_that_is_missing_or_has_another_name(unchanged, tmp_path, name):
    (tmp_path / name).rename((tmp_path / name).with_name("another"))
    assert not unchanged.is_unchanged()


@pytest.mark.parametrize("name", MADE)
def test_a_file_that_was_made_and_written_since(unchanged, tmp_path, name):
    os.utime(tmp_path / name, (1, 1))
    assert not unchanged.is_unchanged()


@pytest.mark.parametrize("name", ["book/new.md", "safe/new.py", "notebooks/new.ipynb", "_build/html/new.html"])
def test_a_new_file(unchanged, tmp_path, name):
    (tmp_path / name).touch()
    assert not unchanged.is_unchanged()


def test_what_python_compiles_does_not_count(unchanged, tmp_path):
    (tmp_path / "safe" / "__pycache__").mkdir()
    (tmp_path / "safe" / "__pycache__" / "evolution.cpython-313.pyc").touch()
    assert unchanged.is_unchanged()


@pytest.mark.parametrize("name", ["RUNS", "SOURCE_DATE_EPOCH"])
def test_a_setting(unchanged, monkeypatch, name):
    monkeypatch.setenv(name, "20")
    assert not unchanged.is_unchanged()


def test_other_packages(unchanged, tmp_path):
    installed = tmp_path / "site-packages"
    (installed / "numpy-2.0.0.dist-info").rename(installed / "numpy-2.0.1.dist-info")
    assert not unchanged.is_unchanged()


def test_another_python(unchanged, monkeypatch):
    monkeypatch.setattr(unchanged.sys, "version", "3.99.0")
    assert not unchanged.is_unchanged()


@pytest.mark.parametrize("note", ["BEGUN", "ENDED"])
def test_a_damaged_note(unchanged, tmp_path, note):
    (tmp_path / unchanged.ENDED).write_text("[" if note == "ENDED" else "null", encoding="utf-8")
    assert not unchanged.is_unchanged()
    (tmp_path / getattr(unchanged, note)).write_text("[", encoding="utf-8")
    assert not unchanged.is_unchanged()


def test_a_build_that_fails_is_not_the_book(unchanged, tmp_path):
    before = (tmp_path / "book" / "index.md").read_text(encoding="utf-8")
    (tmp_path / "book" / "index.md").write_text("does not build", encoding="utf-8")
    assert not unchanged.is_unchanged()
    (tmp_path / "book" / "index.md").write_text(before, encoding="utf-8")
    assert not unchanged.is_unchanged()


def test_a_change_during_the_build(unchanged, tmp_path):
    (tmp_path / "book" / "index.md").write_text("before", encoding="utf-8")
    assert not unchanged.is_unchanged()
    (tmp_path / "book" / "index.md").write_text("meanwhile", encoding="utf-8")
    unchanged.note_made()
    assert not unchanged.is_unchanged()


def test_a_book_that_is_cleaned_away(unchanged, tmp_path):
    shutil.rmtree(tmp_path / "_build")
    assert not unchanged.is_unchanged()
