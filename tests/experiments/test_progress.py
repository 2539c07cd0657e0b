"""What a user sees while waiting, and where: in a terminal, not in a log."""

import os
import subprocess
import sys

import numba.core.event
import pytest

from safe.kernel import while_compiling

RUN = "import safe; safe.run(safe.Experiment('standard', 'maze1', runs=3, parameters=safe.Parameters(generations=2)))"


def seen_in_a_terminal(code, **environment):
    """What a Python program writes to stderr if that is a terminal."""
    termios = pytest.importorskip("termios", reason="a program can be a terminal only on Unix")
    pty = pytest.importorskip("pty")
    ours, theirs = pty.openpty()
    termios.tcsetwinsize(theirs, (24, 100))
    with subprocess.Popen([sys.executable, "-c", code], stderr=theirs, env=os.environ | environment):
        os.close(theirs)
        shown = b""
        while True:
            try:
                shown += os.read(ours, 1000)
            except OSError:  # the other side is closed
                break
    os.close(ours)
    return shown.decode()


def test_progress_in_a_terminal_and_silence_in_a_log():
    log = subprocess.run([sys.executable, "-c", RUN], capture_output=True, text=True, check=True)
    assert log.stderr == log.stdout == ""
    shown = seen_in_a_terminal(RUN)
    assert "standard on maze1: 100%" in shown
    assert "successes=0" in shown


def test_compiling_is_shown_only_when_it_takes_place(tmp_path):
    code = "from safe.kernel import kernel, while_compiling\n" + (
        "@kernel\ndef double(x):\n    return 2 * x\n\nwith while_compiling():\n    assert double(3) == 6"
    )
    (tmp_path / "doubling.py").write_text(code)
    run = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import doubling"
    cache = {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    assert "compiling, once on this machine: 1 functions" in seen_in_a_terminal(run, **cache)
    assert seen_in_a_terminal(run, **cache) == ""  # from the disk


def test_a_bar_can_be_switched_off():
    assert seen_in_a_terminal(RUN, TQDM_DISABLE="1") == ""
    assert seen_in_a_terminal(RUN.replace(")))", ")), progress=False)")) == ""


def test_another_thread_that_began_to_compile_earlier():
    with while_compiling():
        event = numba.core.event.Event("numba:compile", numba.core.event.EventStatus.END)
        numba.core.event.broadcast(event)
