"""The cost of a generation and of its parts."""

import pytest

from benchmarks.workloads import workload
from safe import Parameters
from safe.companion.speed import PARTS

OF_NOVELTY_SEARCH = [part for part in PARTS if "objective functions" not in part]
OF = {
    "standard": [part for part in OF_NOVELTY_SEARCH if part != "novelty"],
    "novelty": OF_NOVELTY_SEARCH,
    "safe": PARTS,
}


@pytest.mark.parametrize("maze", ["maze1", "maze2"])
@pytest.mark.parametrize(("algorithm", "part"), [(algorithm, part) for algorithm in OF for part in OF[algorithm]])
def test_part(measure, sized, algorithm, maze, part):
    parameters = Parameters(generations=sized(500, check=5))
    function, arguments, generations = workload(part, maze, algorithm, parameters)
    measure("part", function, arguments, algorithm=algorithm, maze=maze, part=part, generations=generations)
