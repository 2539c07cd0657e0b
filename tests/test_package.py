"""What is installed: besides its modules, the package takes its data along."""

import shutil
import subprocess
import sys
from pathlib import Path
from zipfile import ZipFile

import pytest

ROOT = Path(__file__).parents[1]


def test_a_wheel_holds_the_javascript(tmp_path):
    """The modules stand outside the package, which has but a link to their folder."""
    pytest.importorskip("setuptools", minversion="77", reason="pyproject.toml asks for setuptools 77 or later")
    modules = Path("book", "_static", "playground")
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, tmp_path)
    for folder in (Path("safe"), modules):
        shutil.copytree(ROOT / folder, tmp_path / folder, symlinks=True)
    command = "from setuptools import build_meta; build_meta.build_wheel('.')"
    built = subprocess.run([sys.executable, "-c", command], cwd=tmp_path, capture_output=True, text=True)
    assert built.returncode == 0, built.stderr
    (wheel,) = tmp_path.glob("*.whl")
    with ZipFile(wheel) as archive:
        folder = "safe/javascript/"
        packed = {
            name.removeprefix(folder): archive.read(name) for name in archive.namelist() if name.startswith(folder)
        }
    assert packed == {file.name: file.read_bytes() for file in (ROOT / modules).iterdir()}
    assert "engine.js" in packed
