"""The package as users get it: in an archive of the repository, a wheel or a source distribution."""

import ast
import importlib
import json
import os
import shutil
import subprocess
import sys
import tarfile
from fnmatch import fnmatch
from pathlib import Path
from zipfile import ZipFile

import pytest

import safe
from safe.playground import bundle

ROOT = Path(__file__).parents[1]
JAVASCRIPT = "safe/playground/javascript"
IGNORED = [".git", *(pattern.rstrip("/") for pattern in (ROOT / ".gitignore").read_text().split())]


def files(folder=ROOT):
    """The files of the repository, without those that .gitignore leaves out."""
    for path in folder.iterdir():
        if any(fnmatch(path.name, pattern) for pattern in IGNORED):
            continue
        if path.is_dir() and not path.is_symlink():
            yield from files(path)
        else:
            yield path


def run(folder, code, **environment):
    command = [sys.executable, "-c", code]
    return subprocess.run(command, cwd=folder, env=os.environ | environment, capture_output=True, text=True)


def build(kind, source, target):
    """Build a wheel or an sdist, by what is installed and without a network."""
    pytest.importorskip("setuptools", minversion="77", reason="pyproject.toml asks for setuptools 77 or later")
    built = run(source, f"from setuptools import build_meta; build_meta.build_{kind}({str(target)!r})")
    assert built.returncode == 0, built.stderr
    (file,) = target.iterdir()
    return file


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory):
    """A zip archive of the repository, unpacked."""
    folder = tmp_path_factory.mktemp("archive")
    with ZipFile(folder / "repository.zip", "w") as archive:
        for file in files():
            archive.write(file, Path("repository") / file.relative_to(ROOT))
    with ZipFile(folder / "repository.zip") as archive:
        archive.extractall(folder)
    return folder / "repository"


@pytest.fixture(scope="module")
def wheel(unpacked, tmp_path_factory):
    """What a wheel installs."""
    folder = tmp_path_factory.mktemp("installed")
    with ZipFile(build("wheel", unpacked, tmp_path_factory.mktemp("wheel"))) as archive:
        archive.extractall(folder)
    return folder


def contents(folder):
    return {file.name: file.read_bytes() for file in folder.iterdir()}


def test_no_file_is_a_symbolic_link():
    found = list(files())
    assert ROOT / "Makefile" in found
    assert [file for file in found if file.is_symlink()] == []


def test_lines_end_alike_on_every_system():
    """Digests of these files say which results are stale, and git would end lines on Windows in another way."""
    data = ROOT / "tests" / "data"
    texts = [file for file in files() if file.suffix not in (".pdf", ".xz") and data not in file.parents]
    assert [file for file in texts if b"\r" in file.read_bytes()] == []


def test_a_wheel_holds_the_javascript(wheel):
    assert contents(wheel / JAVASCRIPT) == contents(ROOT / JAVASCRIPT)
    assert (wheel / JAVASCRIPT / "engine.js").exists()


def test_a_source_distribution_holds_the_javascript(unpacked, tmp_path):
    with tarfile.open(build("sdist", unpacked, tmp_path)) as archive:
        members = [member for member in archive if member.isfile() and f"/{JAVASCRIPT}/" in member.name]
        packed = {Path(member.name).name: archive.extractfile(member).read() for member in members}
    assert packed == contents(ROOT / JAVASCRIPT)


@pytest.mark.parametrize("source", ["unpacked", "wheel"])
def test_the_playground_works(source, request, tmp_path):
    folder = request.getfixturevalue(source)
    code = """
import json, safe
playground = safe.Playground("maze1")
print(json.dumps([safe.__file__, playground.maze.name, str(playground._esm), str(playground._css)]))
"""
    made = run(tmp_path, code, PYTHONPATH=str(folder))
    assert made.returncode == 0, made.stderr
    file, maze, script, stylesheet = json.loads(made.stdout)
    assert Path(file) == folder / "safe" / "__init__.py"
    assert maze == "maze1"
    assert bundle.script(("widget.js", "worker.js")) in script
    assert stylesheet == bundle.stylesheet()


def test_a_package_without_its_javascript_says_so(wheel, tmp_path):
    shutil.copytree(wheel / "safe", tmp_path / "safe", ignore=shutil.ignore_patterns("javascript"))
    refused = run(tmp_path, "import safe; print('imported'); safe.Playground", PYTHONPATH=str(tmp_path))
    assert refused.stdout == "imported\n"
    *_, complaint = refused.stderr.splitlines()
    assert complaint == (
        "AttributeError: safe.Playground needs the package's JavaScript; "
        f"there is no folder {tmp_path / JAVASCRIPT}: install the package again"
    )


# What importing it loads


def loaded_after(code, folder):
    """The packages that a new process has loaded after this code."""
    made = run(folder, f"{code}; import sys; print(*sys.modules)", PYTHONPATH=str(ROOT))
    assert made.returncode == 0, made.stderr
    return set(made.stdout.split())


def test_what_takes_long_is_imported_on_first_use(tmp_path):
    slow = {"IPython", "matplotlib", "numba", "numpy", "pandas", "scipy", "sqlite3", "statsmodels", "tqdm"}
    assert slow & loaded_after("import safe", tmp_path) == set()
    shown = {"IPython", "matplotlib", "pandas", "scipy.ndimage", "scipy.sparse", "statsmodels"}
    computed = loaded_after("import safe; safe.Experiment, safe.run, safe.evolve, safe.merge, safe.verify", tmp_path)
    assert shown & computed == set()
    assert slow - shown <= computed


def test_every_public_name_is_what_its_module_defines():
    assert {*safe._MODULES} == {*safe.__all__, "Playground"} - {"__version__"}
    for name, module in safe._MODULES.items():
        assert getattr(safe, name) is getattr(importlib.import_module(module), name)
        if callable(getattr(safe, name)):
            assert getattr(safe, name).__module__ == module
    assert {*safe._MODULES, "__version__"} <= {*dir(safe)}
    with pytest.raises(AttributeError, match="module 'safe' has no attribute 'evolv'"):
        safe.evolv  # noqa: B018


def test_type_checkers_find_each_public_name_where_it_is():
    (block,) = (
        node for node in ast.parse(Path(safe.__file__).read_text(encoding="utf-8")).body if isinstance(node, ast.If)
    )
    assert ast.unparse(block.test) == "TYPE_CHECKING"
    found = {name.asname or name.name: node.module for node in block.body for name in node.names}
    assert found == safe._MODULES
