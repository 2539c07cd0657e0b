import platform
import subprocess

import pytest

from safe import __version__
from safe.experiments import provenance
from safe.kernel import sources


@pytest.fixture
def checkout(tmp_path, monkeypatch):
    """A checkout whose package has two rooms, and a function that runs git in it."""

    def git(*arguments):
        settings = ["-c", "user.name=A", "-c", "user.email=a@example.org", "-c", "commit.gpgsign=false"]
        done = subprocess.run(["git", *settings, *arguments], cwd=tmp_path, check=True, capture_output=True, text=True)
        return done.stdout.strip()

    for name in ("README", "safe/__init__.py", "safe/experiments/store.py", "safe/results/tables.py"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("")
    monkeypatch.setattr(provenance, "_PACKAGE", tmp_path / "safe")
    git("init", "--quiet")
    return tmp_path, git


def test_the_commit_of_a_checkout_and_whether_the_package_has_changed_since(checkout):
    folder, git = checkout
    git("add", ".")
    git("commit", "--quiet", "--message", "Begin")
    commit = git("rev-parse", "HEAD")
    assert provenance._commit() == commit
    (folder / "README").write_text("changed, and no part of the package")
    assert provenance._commit() == commit
    for change in ("safe/results/tables.py", "safe/maze.py"):  # in another room; a new file
        (folder / change).write_text("changed")
        assert provenance._commit() == f"{commit}+"
        git("stash", "--include-untracked")
        assert provenance._commit() == commit


def test_a_package_that_is_installed_inside_a_checkout_has_no_commit(checkout):
    _, git = checkout
    git("add", "README")
    git("commit", "--quiet", "--message", "Begin")
    assert provenance._commit() is None


def test_without_git_there_is_no_commit(monkeypatch):
    monkeypatch.setenv("PATH", "")
    assert provenance._commit() is None


def test_the_sources_are_those_that_were_loaded(monkeypatch):
    """If files have changed since, git cannot say which commit was loaded."""
    before = provenance.origin()
    assert before.sources == sources()
    monkeypatch.setattr(provenance, "sources", lambda: "edited")
    assert provenance.origin() == before  # asked before the edit, git was right
    provenance._origin.cache_clear()
    assert provenance.origin() == before._replace(commit=None)
    provenance._origin.cache_clear()


def test_origin():
    origin = provenance.origin()
    assert (origin.version, origin.python, origin.time) == (__version__, platform.python_version(), None)
    assert all([origin.numpy, origin.numba, origin.platform])
    assert origin is provenance.origin()
