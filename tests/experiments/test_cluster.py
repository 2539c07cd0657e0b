"""A real Dask cluster: a scheduler and three workers, each a process, one of which is killed."""

import subprocess
import sys
import time
from dataclasses import replace

import pandas as pd
import pytest
from distributed import Client

from safe import Experiment, Parameters, run
from safe.companion.notebook import executor_at
from safe.experiments.store import Store

EXPERIMENT = Experiment("safe", "maze2", runs=120, seed=9, parameters=Parameters(generations=50))


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    """A client of a scheduler with three workers, and the workers."""
    folder = tmp_path_factory.mktemp("cluster")
    file = folder / "scheduler.json"

    def start(what, *options):
        command = [sys.executable, "-m", f"distributed.cli.dask_{what}", "--scheduler-file", file, *options]
        return subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    scheduler = start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
    while not file.exists():
        assert scheduler.poll() is None
        time.sleep(0.05)
    workers = [start("worker", "--nthreads", "1", "--no-nanny", "--no-dashboard") for _ in range(3)]
    with Client(scheduler_file=file) as client:
        client.wait_for_workers(3, timeout=60)
        yield client, workers
    for process in [*workers, scheduler]:
        process.kill()
        process.wait()


def test_a_killed_worker_changes_no_table(cluster, tmp_path):
    client, workers = cluster
    store = tmp_path / "s.sqlite"
    with run_in_background(store, client) as running:
        while not (store.exists() and 10 < kept(store) < EXPERIMENT.runs // 2):
            assert running.poll() is None
            time.sleep(0.02)
        workers[1].kill()
        assert running.wait(timeout=120) == 0
    assert len(client.scheduler_info()["workers"]) == 2
    table, threads = run(EXPERIMENT, store, progress=False), run(EXPERIMENT, progress=False)
    pd.testing.assert_frame_equal(table.drop(columns="seconds"), threads.drop(columns="seconds"))


def kept(path):
    with Store.for_reading(path) as store:
        return sum(len(store.finished(entry)) for entry in store.experiments())


def run_in_background(store, client):
    address = client.scheduler.address
    code = f"""
import safe
from safe.companion.notebook import executor_at
parameters = safe.Parameters(generations={EXPERIMENT.parameters.generations})
experiment = safe.Experiment("safe", "maze2", {EXPERIMENT.runs}, {EXPERIMENT.seed}, parameters)
safe.run(experiment, {str(store)!r}, executor_at({address!r}))
"""
    return subprocess.Popen([sys.executable, "-c", code])


def test_the_store_says_what_the_workers_were(cluster, tmp_path):
    client, _ = cluster
    run(replace(EXPERIMENT, runs=2), tmp_path / "s.sqlite", client.get_executor(), progress=False)
    with Store.for_reading(tmp_path / "s.sqlite") as store:
        (found,) = store.experiments()
        assert store.origin_of(next(store.runs(found)).batch).python == sys.version.split()[0]


def test_without_a_scheduler_there_is_no_executor():
    assert executor_at("") is None


@pytest.mark.parametrize("address", ["nowhere", "tcp://127.0.0.1:1", 7])
def test_bad_addresses(address):
    with pytest.raises(ValueError, match="scheduler must be the address of a running Dask scheduler"):
        executor_at(address, patience=1)


def test_a_refused_address_blocks_no_later_client():
    """It would if the garbage collector took the refused client while another one starts."""
    code = """
import gc
from distributed.utils import LoopRunner
from safe.companion.notebook import executor_at
begin = LoopRunner._start_unlocked
LoopRunner._start_unlocked = lambda self: (gc.collect(), begin(self))
for address in ["nowhere", "tcp://127.0.0.1:1"]:
    try:
        executor_at(address, patience=1)
    except ValueError as error:
        print("refused")
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=30)
    assert done.stdout.split() == ["refused"] * 2, done.stderr
