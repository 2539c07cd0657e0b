import pytest

from safe import run
from tests.experiments import EXPERIMENT


@pytest.fixture(scope="package")
def uninterrupted():
    """The table of the experiment, without the time that its runs took."""
    return run(EXPERIMENT, progress=False).drop(columns="seconds")


@pytest.fixture
def store(tmp_path):
    """The path of a store that holds the experiment and its twelve runs."""
    path = tmp_path / "s.sqlite"
    run(EXPERIMENT, path, progress=False)
    return path
