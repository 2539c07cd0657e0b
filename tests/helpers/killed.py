"""What the tests of interruption run in other processes.

The server that these processes are forked from imports it once, so that each starts with everything compiled.
"""

import safe
from safe.evolution import compile_kernels

EXPERIMENT = safe.Experiment("safe", "maze2", runs=600, seed=5, parameters=safe.Parameters(generations=4))

compile_kernels()


def work(store, runs):
    """Run the experiment with so many runs, into the store."""
    safe.run(safe.Experiment("safe", "maze2", runs, seed=5, parameters=EXPERIMENT.parameters), store)
