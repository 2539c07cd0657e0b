"""The playground's engine, in Node and in a worker of Chromium, beside the package: whole runs.

Archives are full in all generations of a run but the first five. What is waited for is timed, since the engine works in
another process, and so the call of it is counted, too: the maze goes there as a drawing, and the run comes back.

`times_safe` is how many times as long a run takes as in the package: the median of pairs, one right after the other. It
means something only if nothing else keeps the cores busy: a browser may get another share of them than this process.
"""

import statistics
import time

import pytest

import safe
from benchmarks.workloads import SEED
from safe import Parameters
from tests.helpers.twin import TWINS, as_in_engine, run_of

PAIRS = 7


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
def test_run(benchmark, measure, sized, evolve, algorithm):
    make_run, method = evolve
    run = safe.load_maze("maze1"), algorithm, SEED, Parameters(generations=sized(600, check=3), success_distance=0)
    found = measure("twin", make_run, lambda: run, method=method, algorithm=algorithm, generations=run[-1].generations)
    assert found == as_in_engine(safe.evolve(*run))
    if benchmark.enabled and method != "safe":
        pairs = [[_seconds(one, run) for one in (make_run, safe.evolve)] for _ in range(PAIRS)]
        benchmark.extra_info["times_safe"] = statistics.median(ours / safes for ours, safes in pairs)


def _seconds(make_run, run):
    started = time.perf_counter()
    make_run(*run)
    return time.perf_counter() - started
