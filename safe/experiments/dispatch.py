"""Sends the missing runs of an experiment to an executor, and stores them as they come back.

Runs travel in batches of about half a second of work; the first batches are of one run, until it is known how long a
run takes. An interruption or an error stops the runs, and what has finished by then is stored, too.

Ctrl-C takes effect where the next batch is awaited, and nowhere else: a KeyboardInterrupt inside the methods of an
executor can leave one of its locks closed, for which its threads, and then the program, would wait for ever.
"""

from __future__ import annotations

import signal
import threading
import time
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager, nullcontext, suppress
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from safe.evolution import RULES, Run, compile_kernels, evolve_until_stopped, has_choices
from safe.experiments.cores import available_cores
from safe.experiments.progress import bar
from safe.experiments.provenance import Origin, origin
from safe.experiments.store import Store, StoredExperiment, StoreError

if TYPE_CHECKING:
    from safe.experiments.experiment import Experiment

FIRST_IN_FLIGHT = 16  # batches, while it is unknown whether runs are short
MOST_IN_FLIGHT = 2000  # batches: enough for a thousand cores, and no burden to one
BATCH_SECONDS = 0.5  # of work in a batch: sending it costs little next to that
PATIENCE = 0.5  # seconds that an interruption waits for an executor of the caller


class Batch(NamedTuple):
    """Finished runs, and what made them."""

    rules: int
    origin: Origin
    runs: list[tuple[int, Run, float]]  # number, outcome, seconds
    failure: Exception | None  # of the run that follows these


class Dispatcher:
    """Computes runs of an experiment on an executor, by default on a thread for each core, and stores them.

    `entry` is the experiment's entry in the store. Without an executor, `cores` is the number of threads.
    """

    def __init__(
        self,
        experiment: Experiment,
        store: Store,
        entry: StoredExperiment,
        executor: Executor | None,
        cores: int | None = None,
    ) -> None:
        self.experiment, self.store, self.entry = experiment, store, entry
        self.is_callers = executor is not None
        self.executor = executor if self.is_callers else ThreadPoolExecutor(cores or available_cores())
        self.waiting: deque[int] = deque()
        self.in_flight: set[Future] = set()
        self.returned: SimpleQueue[Future | None] = SimpleQueue()  # None after Ctrl-C
        self.is_interrupted = False
        self.stop = np.zeros(1, dtype=bool)  # shared with threads; other processes have a copy and finish their batch
        self.runs, self.seconds = 0, 0.0  # received, and how long they took

    def compute(self, missing: Sequence[int], progress: bool) -> None:
        """Compute the missing runs, and store them as they come back."""
        compile_kernels(has_choices(self.experiment.algorithm, self.experiment.parameters))
        self.waiting.extend(missing)
        total, successes = self.experiment.runs, self.store.successes(self.entry, self.experiment.runs)
        label = f"{self.experiment.algorithm.name} on {self.experiment.maze.name}"
        with (
            self._interrupted_between_batches(),
            nullcontext() if self.is_callers else self.executor,
            bar(label, progress, total=total, initial=total - len(missing), unit="run") as shown,
        ):
            try:
                self._send(FIRST_IN_FLIGHT)
                while self.in_flight:
                    batch = self._receive()
                    successes += sum(outcome.success for _, outcome, _ in batch.runs)
                    shown.set_postfix(successes=successes, refresh=False)
                    shown.update(len(batch.runs))
                    self._send(MOST_IN_FLIGHT)
                if self.is_interrupted:
                    raise KeyboardInterrupt
            except BaseException as error:
                self._stop()
                with suppress(StoreError):  # if the store has failed, it may fail again
                    self._salvage()
                with suppress(StoreError):
                    error.add_note(self._note())
                raise

    @contextmanager
    def _interrupted_between_batches(self) -> Iterator[None]:
        """Let the first Ctrl-C wait for `_next`; the second, of somebody impatient, is one as usual."""
        usual = signal.default_int_handler
        if threading.current_thread() is not threading.main_thread() or signal.getsignal(signal.SIGINT) is not usual:
            yield  # here Ctrl-C raises no KeyboardInterrupt
            return

        def notice(*signalled: object) -> None:
            if self.is_interrupted:
                usual(*signalled)
            self.is_interrupted = True
            self.returned.put(None)

        signal.signal(signal.SIGINT, notice)
        try:
            yield
        finally:
            signal.signal(signal.SIGINT, usual)

    def _send(self, most: int) -> None:
        """Send batches until so many are in flight."""
        while self.waiting and len(self.in_flight) < most:
            size = batch_size(len(self.waiting), self.seconds / self.runs) if self.runs else 1
            numbers = [self.waiting.popleft() for _ in range(size)]
            future = self.executor.submit(compute_batch, self.experiment, numbers, self.stop)
            self.in_flight.add(future)
            future.add_done_callback(self.returned.put)

    def _receive(self) -> Batch:
        """Store the next batch that comes back."""
        future = self._next()
        batch = future.result()
        if batch.rules != RULES:
            raise ValueError(f"executor must compute by the rules {RULES} of this version; got {batch.rules}")
        self._keep(batch)
        self.in_flight.discard(future)  # not before: an interruption salvages what is in flight
        if batch.failure is not None:
            raise batch.failure
        self.runs += len(batch.runs)
        self.seconds += sum(seconds for _, _, seconds in batch.runs)
        return batch

    def _next(self) -> Future:
        """The next future that is done."""
        while True:
            try:
                future = self.returned.get(timeout=BATCH_SECONDS)  # on Windows, Ctrl-C is noticed only between waits
            except Empty:
                if not self.runs:
                    self._send(MOST_IN_FLIGHT)  # runs are long: each is a batch, and there should be one for every core
            else:
                if future is None:
                    raise KeyboardInterrupt
                return future

    def _keep(self, batch: Batch) -> None:
        self.store.add(self.entry, batch.origin, batch.runs)

    def _stop(self) -> None:
        """Stop the runs in flight."""
        self.stop[0] = True
        for future in self.in_flight:
            future.cancel()
        wait(self.in_flight, timeout=PATIENCE if self.is_callers else None)  # our threads stop after a generation

    def _salvage(self) -> None:
        """Store what has come back since."""
        for future in self.in_flight:
            if future.done() and not future.cancelled() and future.exception() is None:
                batch = future.result()
                if batch.rules == RULES:
                    self._keep(batch)

    def _note(self) -> str:
        """What is stored, and how to go on: the note that an interruption or error carries."""
        total = self.experiment.runs
        kept = len(self.store.finished(self.entry, total))
        if self.store.path is None:
            return f"{kept} of {total} runs were finished; without a store they are not kept"
        return f"{kept} of {total} runs are kept in {self.store.path}; run the experiment again to compute the rest"


def batch_size(waiting: int, seconds: float) -> int:
    """How many runs of so many seconds each make a batch; fewer towards the end, so that all cores finish together."""
    return max(1, min(int(BATCH_SECONDS / seconds), waiting // 32))


def compute_batch(experiment: Experiment, numbers: list[int], stop: np.ndarray) -> Batch:
    """Compute some runs of an experiment, wherever the executor does so; after `stop` is set, or a failure, no more."""
    compile_kernels(has_choices(experiment.algorithm, experiment.parameters))
    runs: list[tuple[int, Run, float]] = []
    failure = None
    for number in numbers:
        started = time.perf_counter()
        seed = experiment.seed_sequence(number)
        try:
            outcome = evolve_until_stopped(stop, experiment.maze, experiment.algorithm, seed, experiment.parameters)
        except Exception as error:
            failure = error
            break
        if outcome is None:
            break
        runs.append((number, outcome, time.perf_counter() - started))
    return Batch(RULES, origin(), runs, failure)
