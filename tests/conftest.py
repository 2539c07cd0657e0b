"""How Hypothesis tries examples, in how many processes the tests run, and in which order."""

import os
from pathlib import Path

from hypothesis import HealthCheck, settings

collect_ignore = ["helpers/fuzz_atheris.py"]  # a program for atheris, which few have installed

# the first call compiles, so no example has a deadline
settings.register_profile("default", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("default")

HERE = Path(__file__).parent
FIRST = (
    "book/test_book.py",  # makes the checkout, for which the rest of the book waits
    "test_bounds.py",
    "notebooks/test_parameters.py",
    "test_benchmarks.py",
    "playground/test_widget_in_jupyterlab.py",
)
LAST = (
    "book/test_live_figures.py",
    "book/test_playground_watch.py",
    "book/test_pages.py",
    "book/test_playground_drive_and_draw.py",
    "book/test_playground_runs_and_addresses.py",
    "book/test_playground_for_everybody.py",
    "book/test_playground_in_firefox.py",
    "book/test_links.py",
    "book/test_bundled.py",
    "book/test_student.py",
    "book/test_exercises.py",
)


def pytest_xdist_auto_num_workers():
    """Three processes for two cores, since tests often wait: for a browser, a kernel or another process."""
    cores = os.cpu_count() or 1
    return cores + (cores + 1) // 2


def pytest_collection_modifyitems(items):
    """Long files first, so that processes side by side end together; what needs the book last, when it is built."""
    place = {HERE / name: i - len(FIRST) for i, name in enumerate(FIRST)}
    place |= {HERE / name: i for i, name in enumerate(LAST, start=1)}
    items.sort(key=lambda item: place.get(item.path, 0))
