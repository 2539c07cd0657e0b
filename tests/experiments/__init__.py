from safe import Experiment, Parameters

EXPERIMENT = Experiment("safe", "maze1", runs=12, seed=3, parameters=Parameters(generations=4))
