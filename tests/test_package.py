"""What is installed: besides its modules, the package takes its data along."""

import shutil
import subprocess
import sys
from pathlib import Path
from zipfile import ZipFile

import pytest

ROOT = Path(__file__).parents[1]


def test_a_wheel_holds_the_javascript(tmp_path):
    pytest.importorskip("setuptools", minversion="77", reason="pyproject.toml asks for setuptools 77 or later")
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, tmp_path)
    shutil.copytree(ROOT / "safe", tmp_path / "safe")
    command = "from setuptools import build_meta; build_meta.build_wheel('.')"
    built = subprocess.run([sys.executable, "-c", command], cwd=tmp_path, capture_output=True, text=True)
    assert built.returncode == 0, built.stderr
    (wheel,) = tmp_path.glob("*.whl")
    modules = "safe/playground/javascript/"
    with ZipFile(wheel) as archive:
        packed = {
            name.removeprefix(modules): archive.read(name) for name in archive.namelist() if name.startswith(modules)
        }
    assert packed == {file.name: file.read_bytes() for file in (ROOT / modules).iterdir()}
    assert "engine.js" in packed
