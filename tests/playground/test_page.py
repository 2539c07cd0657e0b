"""The engine as modules that a page loads itself, without a worker: the runs are the same."""

import safe
from tests.helpers.browser import needs_browser
from tests.helpers.runs import runs_of_every_kind
from tests.helpers.twin import IN_PAGE, as_in_engine, in_browser, run_of


@needs_browser
def test_some_runs_in_a_page():
    runs = runs_of_every_kind()[:20]
    with in_browser(IN_PAGE) as page:
        found = page.results(run_of("evolve", *run) for run in runs)
    assert found == [as_in_engine(safe.evolve(*run)) for run in runs]
