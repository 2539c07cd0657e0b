"""The program that makes everything, and the Makefile, which calls it."""

import os
import re
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

import make

ROOT = Path(__file__).parents[1]
PINS = ("pyproject.toml", "requirements.txt", "constraints.txt")
AFTER_CTRL_C = """
import pathlib, signal, sys, time
def finish(*_):
    time.sleep(0.5)  # longer than the standard library gives a process
    pathlib.Path(sys.argv[1]).touch()
    raise SystemExit
signal.signal(signal.SIGINT, finish)
print("ready", flush=True)
time.sleep(60)
"""


def test_every_target_of_the_makefile_is_a_step():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    (phony,) = re.findall(r"^\.PHONY: (.*)", makefile, re.MULTILINE)
    (targets,) = re.findall(r"^(env .*):$", makefile, re.MULTILINE)
    assert targets.split() == list(make.STEPS)
    assert phony.split() == ["help", *make.STEPS]


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A project whose environment has been made, and the list of the programs that are started in it."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(make.shutil, "which", lambda _: None)
    for name in PINS:
        (tmp_path / name).write_text(name, encoding="utf-8")
    program = tmp_path / make._program("uv")
    program.parent.mkdir(parents=True)
    for file in (program, tmp_path / make._program("pip"), tmp_path / ".venv" / "created"):
        file.touch()
    project = SimpleNamespace(started=[], failing=(), path=tmp_path)

    def start(*command, **options):
        project.started.append(command)
        code = int(bool({command, command[0], command[:3]} & {*project.failing}))
        return SimpleNamespace(poll=lambda: code, returncode=code)

    monkeypatch.setattr(make, "_start", start)
    return project


@pytest.mark.parametrize("name", PINS)
def test_packages_are_installed_again_only_if_what_is_asked_for_changes(project, name):
    make.env()
    make.env()
    assert [command[:3] for command in project.started] == [("uv", "pip", "install")]
    os.utime(name)
    make.env()
    assert len(project.started) == 1
    (project.path / name).write_text("changed", encoding="utf-8")
    os.utime(name, (0, 0))  # as old as a file from an archive can be
    make.env()
    assert len(project.started) == 2


def test_pip_installs_if_uv_cannot(project):
    project.failing = ("uv",)
    make.env()
    assert [command[:3] for command in project.started] == [("uv", "pip", "install"), ("python", "-m", "pip")]
    assert project.started[1][-4:] == ("--constraint", "constraints.txt", "--requirement", "requirements.txt")


def test_uv_on_the_path_is_used_in_an_environment_without_pip(project, monkeypatch):
    (project.path / ".venv" / "created").unlink()
    for name in ("pip", "uv"):
        (project.path / make._program(name)).unlink()
    elsewhere = project.path / "uv"
    elsewhere.touch()
    monkeypatch.setattr(make.shutil, "which", lambda name: str(elsewhere) if name == "uv" else None)
    made = []
    monkeypatch.setattr(
        make.subprocess, "Popen", lambda command: made.append(command) or SimpleNamespace(poll=lambda: 0, returncode=0)
    )
    make.env()
    assert made == [[sys.executable, "-m", "venv", ".venv", "--without-pip"]]
    assert [command[:3] for command in project.started] == [("uv", "pip", "install")]
    assert make._program("uv") == str(elsewhere)
    project.failing = ("uv",)
    (project.path / PINS[0]).write_text("changed", encoding="utf-8")
    make.env()
    assert [command[:4] for command in project.started[2:]] == [
        ("python", "-m", "ensurepip", "--default-pip"),
        ("python", "-m", "pip", "install"),
        ("python", "-m", "pip", "install"),
    ]


@pytest.mark.parametrize("has_pip", [True, False], ids=["pip", "no pip"])
def test_uv_is_installed_by_the_pip_of_this_python_or_else_by_one_of_the_environment(project, monkeypatch, has_pip):
    (project.path / ".venv" / "created").unlink()
    (project.path / make._program("uv")).unlink()
    called = []

    def popen(command, **_):
        called.append(command[2])
        code = int(command[2] == "pip" and not has_pip)
        return SimpleNamespace(poll=lambda: code, returncode=code)

    monkeypatch.setattr(make.subprocess, "Popen", popen)
    make._create()
    assert called == (["venv", "pip"] if has_pip else ["venv", "pip", "venv"])
    by_environment = [("python", "-m", "pip", "install", "uv")]
    assert [(*command[:4], command[-1]) for command in project.started] == ([] if has_pip else by_environment)


def test_a_book_that_is_unchanged_is_not_made_again(project):
    project.failing = (make.UNCHANGED,)
    make.book()
    assert [command[1:] for command in project.started[1:]] == [
        ("book/unchanged.py",),
        ("book/execute.py",),
        ("book/build.py",),
        ("book/verify.py",),
        ("book/unchanged.py", "--made"),
    ]
    project.started.clear()
    project.failing = ()
    make.book()
    assert project.started == [make.UNCHANGED]


def test_packages_that_could_not_be_installed_are_asked_for_again(project):
    project.failing = ("uv", "python")
    for _ in range(2):
        with pytest.raises(SystemExit, match="1"):
            make.env()
    assert len(project.started) == 4


def test_an_older_python_is_refused_before_anything_is_made(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "version_info", (3, 10, 4))
    with pytest.raises(SystemExit, match=r"Python 3.11 or later is needed; this is 3\.10\.4\. Use another: "):
        make.env()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "steps"), [(["book", "pdf", "--runs", "20"], ["book", "pdf"]), ([], []), (["--cases", "7"], [])]
)
def test_steps_are_made_in_order(monkeypatch, capsys, arguments, steps):
    made = []
    monkeypatch.setattr(make, "STEPS", {name: lambda name=name: made.append(name) for name in make.STEPS})
    monkeypatch.setattr(sys, "argv", ["make.py", *arguments])
    monkeypatch.setattr(os, "environ", {"RUNS": "3", "PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": "/usr/lib"})
    monkeypatch.setattr(signal, "signal", lambda *_: None)
    monkeypatch.setattr(os, "chdir", lambda _: None)
    make.main()
    assert made == steps
    assert os.environ["RUNS"] == ("20" if "--runs" in arguments else "3")
    assert os.environ.get("CASES") == ("7" if "--cases" in arguments else None)
    assert not os.environ.keys() & {"PYTHONDONTWRITEBYTECODE", "PYTHONPATH"}


def test_an_unknown_step_is_refused(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["make.py", "boook"])
    with pytest.raises(SystemExit, match="2"):
        make.main()
    assert "step must be one of env, execute, book, " in capsys.readouterr().err


def test_exit_codes_are_passed_on():
    codes = (0, 3, 0)
    processes = [subprocess.Popen([sys.executable, "-S", "-c", f"raise SystemExit({code})"]) for code in codes]
    assert make._end(*processes) == 3
    with pytest.raises(SystemExit) as ended:
        make._check(-9)
    assert ended.value.code == 137


@pytest.mark.skipif(os.name == "nt", reason="Windows sends Ctrl-C to all processes of a console, with these tests")
@pytest.mark.parametrize(
    ("send", "code"),
    [(lambda ours: os.killpg(ours.pid, signal.SIGINT), 130), (lambda ours: ours.send_signal(signal.SIGTERM), 143)],
    ids=["Ctrl-C", "terminated"],
)
def test_an_interruption_leaves_no_process_behind(tmp_path, send, code):
    """Ctrl-C lets it finish in its own time; a request to terminate reaches the first process alone."""
    command = [sys.executable, "-S", "-c", AFTER_CTRL_C, str(tmp_path / "finished")]
    ours = (
        "import signal, subprocess, sys, make\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)  # a background process may ignore it\n"
        f"make.STEPS = {{'test': lambda: make._check(make._end(subprocess.Popen({command})))}}\n"
        "sys.argv[1:] = ['test']\n"
        "make.main()"
    )
    started = subprocess.Popen(
        [sys.executable, "-S", "-c", ours], cwd=ROOT, stdout=subprocess.PIPE, start_new_session=True
    )
    assert started.stdout.readline() == b"ready\n"
    send(started)
    started.communicate(timeout=30)  # until no process has its output open
    assert started.returncode == code
    assert (tmp_path / "finished").exists() == (code == 130)
