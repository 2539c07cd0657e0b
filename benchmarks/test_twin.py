"""The playground's engine, in Node and in a worker of Chromium, beside the package: whole runs.

Archives are full in all generations of a run but the first five. What is waited for is timed, since the engine works in
another process, and so the call of it is counted, too: the maze goes there as a drawing, and the run comes back.
"""

import time

import pytest

import safe
from benchmarks.workloads import SEED
from safe import Parameters
from tests.helpers.twin import TWINS, as_in_engine, run_of


@pytest.fixture(scope="module", params=[None, *TWINS], ids=lambda twin: "safe" if twin is None else None)
def evolve(request):
    """The arguments of a run, and its outcome."""
    if request.param is None:
        yield lambda *run: as_in_engine(safe.evolve(*run)), "safe"
        return
    with request.param() as twin:
        (host,) = twin.results([{"function": "host"}])
        yield lambda *run: twin.results([run_of("evolve", *run)])[0], host


@pytest.mark.benchmark(timer=time.perf_counter)
@pytest.mark.parametrize("algorithm", ["standard", "novelty", "safe"])
def test_run(measure, sized, evolve, algorithm):
    make_run, method = evolve
    run = safe.load_maze("maze1"), algorithm, SEED, Parameters(generations=sized(600, check=3), success_distance=0)
    found = measure("twin", make_run, lambda: run, method=method, algorithm=algorithm, generations=run[-1].generations)
    assert found == as_in_engine(safe.evolve(*run))
