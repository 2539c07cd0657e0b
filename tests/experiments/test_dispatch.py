import signal
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import replace

import pandas as pd
import pytest

from safe import run, run_all
from safe.experiments import dispatch
from safe.experiments.store import Store, StoreError
from tests.experiments import EXPERIMENT


def results(experiment, *arguments, **options):
    """The table, without the time that its runs took."""
    return run(experiment, *arguments, progress=False, **options).drop(columns="seconds")


class InThisThread(Executor):
    """Computes each batch at once, counts the runs, and raises an error after so many if `stop_before` says so."""

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


class ByOtherRules(InThisThread):
    def submit(self, *arguments):
        other = Future()
        other.set_result(super().submit(*arguments).result()._replace(rules=99))
        return other


def test_the_executor_does_not_matter(uninterrupted):
    with ThreadPoolExecutor(1) as one, ThreadPoolExecutor(5) as five, ProcessPoolExecutor(2) as processes:
        for executor in (one, five, processes, InThisThread()):
            pd.testing.assert_frame_equal(results(EXPERIMENT, executor=executor), uninterrupted)


def test_a_callers_executor_stays_open():
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


def test_short_runs_travel_together_and_long_ones_alone():
    executor = InThisThread()
    table = results(replace(EXPERIMENT, runs=600), executor=executor)
    assert executor.runs == len(table) == 600
    assert executor.batches < 300
    assert dispatch.batch_size(10_000, seconds=0.01) == 50
    assert dispatch.batch_size(10_000, seconds=9.0) == 1
    # small batches towards the end, so that nobody waits for the one who got many
    assert dispatch.batch_size(64, seconds=1e-4) == 2
    assert dispatch.batch_size(1, seconds=1e-4) == 1


def test_many_cores_do_not_wait_for_the_first_long_run():
    class Large(InThisThread):
        """Returns nothing until it has received every run."""

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


def test_an_executor_that_computes_by_other_rules_is_refused(tmp_path):
    with pytest.raises(ValueError, match="executor must compute by the rules 1 of this version; got 99") as caught:
        results(EXPERIMENT, tmp_path / "s.sqlite", ByOtherRules())
    assert caught.value.__notes__[0].startswith("0 of 12 runs are kept")
    rest = InThisThread()
    results(EXPERIMENT, tmp_path / "s.sqlite", rest)
    assert rest.runs == 12


def test_an_interruption_stores_nothing_that_was_computed_by_other_rules(tmp_path):
    with pytest.raises(KeyboardInterrupt) as caught:
        results(EXPERIMENT, tmp_path / "s.sqlite", ByOtherRules(stop_before=5))
    assert caught.value.__notes__[0].startswith("0 of 12 runs are kept")


@pytest.mark.parametrize("error", [KeyboardInterrupt, MemoryError])
def test_an_interrupted_experiment_continues_where_it_stopped(tmp_path, uninterrupted, error):
    store = tmp_path / "s.sqlite"
    with pytest.raises(error) as caught:
        results(EXPERIMENT, store, InThisThread(stop_before=5, error=error))
    assert caught.value.__notes__ == [f"5 of 12 runs are kept in {store}; run the experiment again to compute the rest"]
    with pytest.raises(error) as caught:
        results(EXPERIMENT, None, InThisThread(stop_before=5, error=error))
    assert caught.value.__notes__ == ["5 of 12 runs were finished; without a store they are not kept"]
    rest = InThisThread()
    pd.testing.assert_frame_equal(results(EXPERIMENT, store, rest), uninterrupted)
    assert rest.runs == 7


class Interrupted(InThisThread):
    """Is interrupted, so many times, while the first batch is handed over."""

    def __init__(self, times):
        super().__init__()
        self.times, self.handed_over = times, 0

    def submit(self, *arguments):
        while self.times > 0:
            self.times -= 1
            signal.raise_signal(signal.SIGINT)
        self.handed_over += 1
        return super().submit(*arguments)


@pytest.mark.parametrize(("times", "handed_over"), [(1, 12), (2, 0)])
def test_ctrl_c_waits_until_batches_are_handed_over_and_the_second_does_not(tmp_path, times, handed_over):
    """In the middle of it, executors hold locks that nobody would open."""
    executor = Interrupted(times)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    with pytest.raises(KeyboardInterrupt) as interrupted:
        run(EXPERIMENT, tmp_path / "s.sqlite", executor, progress=False)
    assert executor.handed_over == handed_over
    (note,) = interrupted.value.__notes__
    assert note.startswith(f"{handed_over} of {EXPERIMENT.runs} runs are kept in")
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_ctrl_c_while_the_last_batch_is_stored_is_not_forgotten(tmp_path, monkeypatch):
    add = Store.add
    monkeypatch.setattr(Store, "add", lambda *arguments: (signal.raise_signal(signal.SIGINT), add(*arguments)))
    with pytest.raises(KeyboardInterrupt) as interrupted:
        run(replace(EXPERIMENT, runs=1), tmp_path / "s.sqlite", progress=False)
    assert interrupted.value.__notes__[0].startswith("1 of 1 runs are kept in")


def test_no_wait_is_endless(monkeypatch):
    """On Windows Ctrl-C is noticed only between waits, and a run may take hours."""

    class Waits(dispatch.SimpleQueue):
        def get(self, block=True, timeout=None):
            assert timeout is not None
            return super().get(block, timeout)

    monkeypatch.setattr(dispatch, "SimpleQueue", Waits)
    assert len(run(EXPERIMENT, progress=False)) == EXPERIMENT.runs


def test_a_handler_of_the_callers_own_is_left_alone():
    def own(*_):
        raise InterruptedError

    usual = signal.signal(signal.SIGINT, own)
    try:
        with pytest.raises(InterruptedError):
            run(EXPERIMENT, executor=Interrupted(1), progress=False)
        assert signal.getsignal(signal.SIGINT) is own
    finally:
        signal.signal(signal.SIGINT, usual)


def test_a_store_that_fails_hides_no_interruption(tmp_path, monkeypatch):
    def fail(*arguments):
        raise StoreError

    monkeypatch.setattr(Store, "add", fail)
    with pytest.raises(KeyboardInterrupt) as caught:
        results(EXPERIMENT, tmp_path / "s.sqlite", InThisThread(stop_before=5))
    assert caught.value.__notes__[0].startswith("0 of 12 runs are kept")


def test_other_errors_while_runs_are_salvaged_are_shown(tmp_path, monkeypatch):
    def fail(*arguments):
        raise ValueError("not of the store")

    monkeypatch.setattr(Store, "add", fail)
    with pytest.raises(ValueError, match="not of the store"):
        results(EXPERIMENT, tmp_path / "s.sqlite", InThisThread(stop_before=5))


def test_the_error_of_a_failing_run_is_raised_and_the_other_runs_are_stored(tmp_path, monkeypatch, uninterrupted):
    store, really = tmp_path / "s.sqlite", dispatch.evolve_until_stopped

    def evolve_until_stopped(stop, maze, algorithm, seed, parameters):
        if seed.spawn_key == (4,):
            raise RuntimeError("no luck")
        return really(stop, maze, algorithm, seed, parameters)

    with monkeypatch.context() as patch:
        patch.setattr(dispatch, "evolve_until_stopped", evolve_until_stopped)
        with pytest.raises(RuntimeError, match="no luck"):
            results(EXPERIMENT, store, InThisThread())
    rest = InThisThread()
    pd.testing.assert_frame_equal(results(EXPERIMENT, store, rest), uninterrupted)
    assert rest.runs == 1


def test_cores_are_threads(monkeypatch, uninterrupted):
    monkeypatch.setattr(dispatch, "available_cores", lambda: 3)
    threads = []
    monkeypatch.setattr(dispatch, "ThreadPoolExecutor", lambda most: threads.append(most) or ThreadPoolExecutor(most))
    for cores in (None, 1, 5):
        pd.testing.assert_frame_equal(results(EXPERIMENT, cores=cores), uninterrupted)
    run_all(["random"], ["maze1"], 1, 0, cores=2)
    assert threads == [3, 1, 5, 2]


@pytest.mark.parametrize("cores", [0, -1, 1.5, "all", True])
def test_cores_that_are_no_number_of_threads(tmp_path, cores):
    with pytest.raises(ValueError, match="cores must be an integer of at least 1; got"):
        run(EXPERIMENT, tmp_path / "s.sqlite", cores=cores)
    assert not (tmp_path / "s.sqlite").exists()


def test_an_executor_has_cores_of_its_own():
    with pytest.raises(ValueError, match="cores must be left out if an executor or a scheduler is given; got 2"):
        run(EXPERIMENT, executor=InThisThread(), cores=2)
