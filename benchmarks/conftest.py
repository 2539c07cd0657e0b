"""How the benchmarks measure, and which results they record.

benchmarks/results.json holds, for each benchmark, its group, the seconds of one round, and in `extra_info` what was
measured: most often the `generations` that one round covers, so that median / generations are seconds a generation.

Seconds are those of the processor, so that other programs on the machine disturb little (of all threads together, if
there are several); in the groups "paper", "first use" and "twin" they are those of the clock on the wall, since people
wait.
"""

import time
from importlib.metadata import version

import pytest

import safe

PACKAGES = "numpy", "numba", "scipy", "deap", "ribs"
MACHINE = "system", "machine", "python_implementation", "python_version"
STATISTICS = "min", "median", "max", "iqr", "rounds"


@pytest.fixture
def measure(benchmark):
    """Time a function: `once`, or in as many rounds as half a second holds, after one that compiles.

    What makes its arguments is called before every round, and not timed.
    """

    def measure(group, function, arguments=tuple, once=False, **about):
        benchmark.group = group
        benchmark.extra_info.update(about)
        rounds = 1
        if benchmark.enabled and not once:
            function(*arguments())
            given = arguments()
            started = time.perf_counter()
            function(*given)
            rounds = min(max(round(0.5 / (time.perf_counter() - started)), 3), 50)
        return benchmark.pedantic(function, setup=lambda: (arguments(), {}), rounds=rounds)

    return measure


@pytest.fixture
def sized(request):
    """A size, or a small one if benchmarks are only checked to work (--benchmark-disable)."""
    is_check = request.config.getoption("benchmark_disable")
    return lambda size, check: min(size, check) if is_check else size


def pytest_collection_modifyitems(items):
    """The paper's experiments first, since the memory they need is the most that the process has taken by then."""
    items.sort(key=lambda item: item.path.stem != "test_paper")
    for item in items:
        if item.get_closest_marker("benchmark") is None:
            item.add_marker(pytest.mark.benchmark(timer=time.process_time))


def pytest_benchmark_update_json(output_json):
    """Record measurements and what they depend on, but not the place or person, nor meaningless digits."""
    machine = output_json["machine_info"]
    output_json["machine_info"] = {name: machine[name] for name in MACHINE}
    output_json["machine_info"]["cpu"] = {name: machine["cpu"].get(name) for name in ("brand_raw", "count")}
    output_json["versions"] = {"safe": safe.__version__} | {name: version(name) for name in PACKAGES}
    del output_json["commit_info"]
    output_json["benchmarks"] = [
        {
            "group": benchmark["group"],
            "name": benchmark["name"],
            "extra_info": benchmark["extra_info"],
            "stats": {name: benchmark["stats"][name] for name in STATISTICS},
        }
        for benchmark in output_json["benchmarks"]
    ]
    output_json.update(_rounded(output_json))


def _rounded(value):
    """With four significant digits, however deep."""
    if isinstance(value, dict):
        return {key: _rounded(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_rounded(item) for item in value]
    return float(f"{value:.4g}") if isinstance(value, float) else value
