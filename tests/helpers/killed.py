"""What the tests of interruption run in other processes: an experiment that many kills do not outlast.

The server that these processes are forked from imports it once, so that each starts with everything compiled.
"""

import safe
from safe.evolution import compile_kernels

EXPERIMENT = safe.Experiment("safe", "maze2", runs=1500, seed=5, parameters=safe.Parameters(generations=20))

compile_kernels()


def work(store, runs):
    """Run the experiment with so many runs, into the store."""
    safe.run(safe.Experiment("safe", "maze2", runs, seed=5, parameters=EXPERIMENT.parameters), store)
