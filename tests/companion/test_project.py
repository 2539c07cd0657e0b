"""Where the project is, from several folders."""

import pytest

from safe.companion import project


def folders(root, *names):
    for name in names:
        (root / name).mkdir(parents=True, exist_ok=True)


@pytest.fixture
def package(tmp_path, monkeypatch):
    """The package, as if it were installed in a folder without a project."""
    monkeypatch.setattr(project, "__file__", str(tmp_path / "installed/safe/companion/project.py"))
    folders(tmp_path, "installed/safe/companion", "one/notebooks", "one/safe/companion", "home/notebooks", "home/safe")
    return tmp_path


@pytest.mark.parametrize(
    ("opened", "found"),
    [("one", "one"), ("one/notebooks", "one"), ("one/safe/companion", "one"), ("home/notebooks", None)],
)
def test_the_project_is_the_nearest_folder_that_holds_its_parts(package, monkeypatch, opened, found):
    monkeypatch.chdir(package / opened)
    assert project.folder() == (found and package / found)


def test_elsewhere_the_project_is_that_of_the_package(package, monkeypatch):
    folders(package, "installed/notebooks", "home")
    for opened, found in (("home", "installed"), ("one", "one")):
        monkeypatch.chdir(package / opened)
        assert project.folder() == package / found
