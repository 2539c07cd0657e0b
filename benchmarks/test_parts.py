"""What the parts of a generation cost, and the whole of it."""

import pytest

from benchmarks.workloads import workload
from safe import Parameters

PARTS = {
    "standard": ["robot", "fitness", "breeding", "all"],
    "novelty": ["robot", "novelty", "fitness", "breeding", "all"],
    "safe": [
        "robot",
        "novelty",
        "fitness",
        "breeding",
        "objective functions",
        "breeding of objective functions",
        "all",
    ],
}


@pytest.mark.parametrize("maze", ["maze1", "maze2"])
@pytest.mark.parametrize(("algorithm", "part"), [(algorithm, part) for algorithm in PARTS for part in PARTS[algorithm]])
def test_part(measure, sized, algorithm, maze, part):
    parameters = Parameters(generations=sized(500, check=5))
    function, arguments, generations = workload(part, maze, algorithm, parameters)
    measure("part", function, arguments, algorithm=algorithm, maze=maze, part=part, generations=generations)
