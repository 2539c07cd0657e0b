"""No finished run is lost: not if a process is killed, not if several write at once, not by Ctrl-C."""

import multiprocessing
import random
import signal
import subprocess
import sys
import time
from dataclasses import replace

import pandas as pd
import pytest
from jupyter_client.manager import start_new_kernel

from safe import run
from safe.experiments.store import Store
from tests.helpers.killed import EXPERIMENT, work

on_unix = pytest.mark.skipif(sys.platform == "win32", reason="processes are forked and sent Ctrl-C only on Unix")
KILLS = 50
MANY = 20_000  # runs: more than any machine makes between the kills
ENDLESS = """
import signal, sys, safe
from safe.evolution import compile_kernels
signal.signal(signal.SIGINT, signal.default_int_handler)  # a background process may ignore it
compile_kernels()
print("ready", flush=True)
parameters = safe.Parameters(generations=1_000_000, success_distance=0)
safe.run(safe.Experiment("safe", "maze2", 80, parameters=parameters), sys.argv[1])
"""


@pytest.fixture(scope="module")
def processes():
    context = multiprocessing.get_context("forkserver")
    # the main program may be pytest's script: each process would import pytest first, and be killed before any run
    context.set_forkserver_preload(["pytest", "tests.helpers.killed"])
    return context


def kept(path):
    """The runs of the experiment that a store holds."""
    with Store.for_reading(path, must_exist=False) as store:
        return [run for entry in store.experiments() for run in store.runs(entry)]


def assert_same_except_for_time(table, expected):
    pd.testing.assert_frame_equal(table.drop(columns="seconds"), expected.drop(columns="seconds"))


@on_unix
def test_killed_at_many_random_moments_and_run_again(tmp_path, processes):
    store, moments = tmp_path / "s.sqlite", random.Random(1)
    before, alive = {}, 0
    for number in range(2):  # the first also starts the server
        started = time.monotonic()
        process = processes.Process(target=work, args=(tmp_path / str(number), 1))
        process.start()
        process.join()
    one_run = time.monotonic() - started
    for _ in range(KILLS):
        process = processes.Process(target=work, args=(store, MANY))
        process.start()
        time.sleep(moments.uniform(0, 2 * one_run))
        alive += process.is_alive()
        process.kill()
        process.join()
        now = {r.number: r.seconds for r in kept(store)}
        assert before.items() <= now.items()  # the same runs: made again, they would have taken another time
        before = now
    assert alive > KILLS // 2
    assert before
    experiment = replace(EXPERIMENT, runs=max(before) + 50)
    table = run(experiment, store, progress=False)
    assert_same_except_for_time(table, run(experiment, progress=False))
    assert table.seconds[list(before)].tolist() == list(before.values())


@on_unix
def test_processes_that_run_overlapping_experiments_into_one_new_store(tmp_path, processes):
    store = tmp_path / "s.sqlite"
    started = [processes.Process(target=work, args=(store, runs)) for runs in (EXPERIMENT.runs, 400, 200)]
    for process in started:
        process.start()
    for process in started:
        process.join(timeout=120)
    assert [process.exitcode for process in started] == [0, 0, 0]
    assert [r.number for r in kept(store)] == list(range(EXPERIMENT.runs))
    assert_same_except_for_time(run(EXPERIMENT, store, progress=False), run(EXPERIMENT, progress=False))


@on_unix
def test_ctrl_c_ends_runs_of_any_length_and_says_how_to_go_on(tmp_path):
    process = subprocess.Popen(
        [sys.executable, "-c", ENDLESS, tmp_path / "s.sqlite"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    _, complaint = process.communicate(timeout=10)  # one run would take many minutes
    assert process.returncode != 0
    assert "0 of 80 runs are kept in" in complaint
    assert "run the experiment again to compute the rest" in complaint


def test_interrupted_in_a_notebook(tmp_path):
    manager, client = start_new_kernel(kernel_name="python3", extra_arguments=["--log-level=CRITICAL"])
    try:
        store = tmp_path / "s.sqlite"
        long = f"safe.Experiment('safe', 'maze2', {MANY}, 5, safe.Parameters(generations=4))"
        asked = client.execute(f"import safe; safe.run({long}, {str(store)!r})")
        deadline = time.monotonic() + 60
        while not (store.exists() and kept(store)):
            assert time.monotonic() < deadline
            time.sleep(0.05)
        manager.interrupt_kernel()
        while (message := client.get_shell_msg(timeout=10))["parent_header"]["msg_id"] != asked:
            pass  # a late answer to the client's greeting
    finally:
        client.stop_channels()
        manager.shutdown_kernel(now=True)
    reply = message["content"]
    assert reply["ename"] == "KeyboardInterrupt"
    assert f"of {MANY} runs are kept in {store}; run the experiment again" in "\n".join(reply["traceback"])
    runs = kept(store)
    table = run(replace(EXPERIMENT, runs=5), store, progress=False)
    assert len(runs) > 0
    assert_same_except_for_time(table, run(replace(EXPERIMENT, runs=5), progress=False))
