from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import replace

import pandas as pd
import pytest

import safe
from safe import Algorithm, Experiment, Maze, Parameters, run
from safe.experiments import experiment as module

SHORT = Parameters(generations=4)
EXPERIMENT = Experiment("safe", "maze1", runs=12, seed=3, parameters=SHORT)


def results(experiment, *arguments, **options):
    """The table, without the time it took."""
    return run(experiment, *arguments, progress=False, **options).drop(columns="seconds")


@pytest.fixture(scope="module")
def uninterrupted():
    return results(EXPERIMENT)


def test_one_row_a_run(uninterrupted):
    assert list(uninterrupted) == [
        *("run", "success", "generation", "distance"),
        *(f"p{i}" for i in range(1, 17)),
        *("a", "b", "evaluations"),
    ]
    assert uninterrupted.run.tolist() == list(range(12))
    assert uninterrupted.success.dtype == bool
    for row in uninterrupted.itertuples():
        replayed = safe.evolve("maze1", "safe", EXPERIMENT.seed_sequence(row.run), SHORT)
        assert (row.success, row.generation, row.distance) == (
            replayed.success,
            replayed.generation,
            replayed.distance,
        )
        assert row[5:21] == replayed.controller
        assert (row.a, row.b) == replayed.coefficients
        assert row.evaluations == replayed.evaluations


def test_random_search_has_no_coefficients():
    table = results(replace(EXPERIMENT, algorithm="random", runs=2))
    assert "a" not in table
    assert len(table) == 2


class InThisThread(Executor):
    """Computes each batch at once, counts the runs, and fails after so many where it is told to."""

    def __init__(self, stop_before=None, error=KeyboardInterrupt):
        self.runs, self.batches, self.stop_before, self.error = 0, 0, stop_before, error

    def submit(self, function, experiment, numbers, stop):
        if self.runs == self.stop_before:
            raise self.error
        self.runs += len(numbers)
        self.batches += 1
        future = Future()
        future.set_result(function(experiment, numbers, stop))
        return future


def test_the_executor_does_not_matter(uninterrupted):
    with ThreadPoolExecutor(1) as one, ThreadPoolExecutor(5) as five, ProcessPoolExecutor(2) as processes:
        for executor in (one, five, processes, InThisThread()):
            pd.testing.assert_frame_equal(results(EXPERIMENT, executor=executor), uninterrupted)


def test_short_runs_travel_together_and_long_ones_alone():
    executor = InThisThread()
    table = results(replace(EXPERIMENT, runs=600), executor=executor)
    assert executor.runs == len(table) == 600
    assert executor.batches < 300
    assert module._batch_size(10_000, seconds=0.01) == 50
    assert module._batch_size(10_000, seconds=9.0) == 1
    # towards the end few, so that nobody waits for one who has many left
    assert module._batch_size(64, seconds=1e-4) == 2
    assert module._batch_size(1, seconds=1e-4) == 1


def test_many_cores_do_not_wait_for_the_first_long_run():
    class Large(InThisThread):
        """Gives nothing back until it has got all."""

        def submit(self, *arguments):
            done = super().submit(*arguments)
            waiting.append((Future(), done.result()))
            given = waiting[-1][0]
            if self.runs == 60:
                for future, result in waiting:
                    future.set_result(result)
            return given

    waiting = []
    assert len(results(replace(EXPERIMENT, runs=60), executor=Large())) == 60
    assert len(waiting) == 60


def test_what_computes_by_other_rules_is_refused(tmp_path):
    class Elsewhere(InThisThread):
        def submit(self, *arguments):
            future = super().submit(*arguments)
            other = Future()
            other.set_result(future.result()._replace(rules=99))
            return other

    with pytest.raises(ValueError, match="executor must compute by the rules 1 of this version; got 99"):
        results(EXPERIMENT, tmp_path / "s.sqlite", Elsewhere())
    rest = InThisThread()
    results(EXPERIMENT, tmp_path / "s.sqlite", rest)
    assert rest.runs == 12


@pytest.mark.parametrize("executor", [7, "threads", ThreadPoolExecutor])
def test_what_is_no_executor(executor):
    with pytest.raises(ValueError, match=r"executor must be a concurrent\.futures\.Executor; got"):
        run(EXPERIMENT, executor=executor)


def test_a_callers_executor_is_left_open():
    with ThreadPoolExecutor(2) as pool:
        results(EXPERIMENT, executor=pool)
        assert pool.submit(int).result() == 0


def test_only_missing_runs_are_computed(tmp_path, uninterrupted):
    store = tmp_path / "s.sqlite"
    for runs, computed in ((5, 5), (5, 0), (12, 7), (3, 0)):
        executor = InThisThread()
        table = results(replace(EXPERIMENT, runs=runs), store, executor)
        assert executor.runs == computed
        pd.testing.assert_frame_equal(table, uninterrupted[:runs])


@pytest.mark.parametrize("error", [KeyboardInterrupt, MemoryError])
def test_interrupted_and_asked_for_again(tmp_path, uninterrupted, error):
    store = tmp_path / "s.sqlite"
    with pytest.raises(error) as caught:
        results(EXPERIMENT, store, InThisThread(stop_before=5, error=error))
    assert caught.value.__notes__ == [
        f"5 of 12 runs are kept in {store}; the same experiment asked for again computes the rest"
    ]
    with pytest.raises(error) as caught:
        results(EXPERIMENT, None, InThisThread(stop_before=5, error=error))
    assert caught.value.__notes__ == ["5 of 12 runs were finished; without a store they are not kept"]
    rest = InThisThread()
    pd.testing.assert_frame_equal(results(EXPERIMENT, store, rest), uninterrupted)
    assert rest.runs == 7


def test_a_failing_run_is_told_and_the_others_are_kept(tmp_path, monkeypatch, uninterrupted):
    store, really = tmp_path / "s.sqlite", module.evolve_until_stopped

    def evolve_until_stopped(stop, maze, algorithm, seed, parameters):
        if seed.spawn_key == (4,):
            raise RuntimeError("no luck")
        return really(stop, maze, algorithm, seed, parameters)

    with monkeypatch.context() as patch:
        patch.setattr(module, "evolve_until_stopped", evolve_until_stopped)
        with pytest.raises(RuntimeError, match="no luck"):
            results(EXPERIMENT, store, InThisThread())
    rest = InThisThread()
    pd.testing.assert_frame_equal(results(EXPERIMENT, store, rest), uninterrupted)
    assert rest.runs == 1


def test_what_an_experiment_is():
    same = [
        replace(EXPERIMENT, runs=500),
        replace(EXPERIMENT, algorithm=Algorithm("by another name", rating="genotypic novelty")),
        replace(EXPERIMENT, maze=Maze.from_drawing(safe.load_maze("maze1").drawing(), name="copy")),
    ]
    others = [
        replace(EXPERIMENT, seed=4),
        replace(EXPERIMENT, algorithm="novelty"),
        replace(EXPERIMENT, maze="maze2"),
        replace(EXPERIMENT, parameters=Parameters(generations=4, k=14)),
    ]
    assert {experiment.digest for experiment in same} == {EXPERIMENT.digest}
    assert len({experiment.digest for experiment in [EXPERIMENT, *others]}) == 5
    assert EXPERIMENT.content["parameters"] == {"generations": 4}


def test_rules_that_have_changed_make_another_experiment(monkeypatch):
    before = replace(EXPERIMENT).digest
    monkeypatch.setattr(module, "RULES", module.RULES + 1)
    assert replace(EXPERIMENT).digest != before


def test_the_digest_that_random_streams_are_spawned_from():
    """Were this to change, every table would: raise RULES, and say so in the changelog."""
    assert Experiment("safe", "maze1").digest[:16] == "33ae0854440296ca"


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ({"algorithm": "x"}, "algorithm must be one of"),
        ({"maze": "x"}, "maze must be one of"),
        ({"runs": 0}, "runs must be an integer from 1 to 1000000; got 0"),
        ({"runs": 10**12}, "runs must be an integer from 1 to 1000000; got 1000000000000"),
        ({"runs": "500"}, "runs must be an integer from 1 to 1000000; got '500'"),
        ({"seed": -1}, "seed must be an integer from 0 to 340282366920938463463374607431768211455; got -1"),
        ({"seed": 10**5000}, "seed must be an integer from 0"),  # which JSON could not write down
        ({"seed": None}, "seed must be an integer from 0 to 340282366920938463463374607431768211455; got None"),
        ({"parameters": {}}, "parameters must be a Parameters; got {}"),
    ],
)
def test_bad_experiments(arguments, complaint):
    with pytest.raises(ValueError, match=complaint):
        Experiment(**{"algorithm": "safe", "maze": "maze1", **arguments})
