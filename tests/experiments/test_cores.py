"""How many cores a process may use, on systems that are written into a folder."""

import os

import pytest

from safe.experiments.cores import available_cores


@pytest.fixture(autouse=True)
def eight_cores(monkeypatch):
    monkeypatch.delenv("PYTHON_CPU_COUNT", raising=False)
    monkeypatch.delattr(os, "process_cpu_count", raising=False)
    monkeypatch.setattr(os, "sched_getaffinity", lambda pid: set(range(8)), raising=False)


def system(folder, files):
    for name, text in files.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text + "\n")
    return folder


OF_VERSION_1 = "5:cpuacct,cpu:/docker/ab\n4:memory:/docker/ab\n0::/docker/ab"


@pytest.mark.parametrize(
    ("membership", "files", "cores"),
    [
        ("0::/", {"cpu.max": "150000 100000"}, 2),
        ("0::/", {"cpu.max": "10000 100000"}, 1),
        ("0::/", {"cpu.max": "max 100000"}, 8),
        ("0::/", {"cpu.max": "1600000 100000"}, 8),
        ("0::/", {}, 8),
        ("0::/hub/user", {"cpu.max": "max 100000", "hub/user/cpu.max": "300000 100000"}, 3),
        ("0::/hub/user", {"hub/cpu.max": "300000 100000", "hub/user/cpu.max": "max 100000"}, 3),
        ("0::/hub/user", {"hub/cpu.max": "300000 100000", "hub/user/cpu.max": "200000 100000"}, 2),
        ("0::/hub/user", {"cpu.max": "200000 100000"}, 2),  # in a container that sees its own groups alone
        ("0::/../../hub", {"cpu.max": "200000 100000"}, 2),
        ("0::/a:b", {"a:b/cpu.max": "200000 100000"}, 2),
        (OF_VERSION_1, {"cpu/docker/ab/cpu.cfs_quota_us": "250000"}, 3),
        (OF_VERSION_1, {"cpu/cpu.cfs_quota_us": "250000"}, 3),
        (OF_VERSION_1, {"cpu/docker/ab/cpu.cfs_quota_us": "-1"}, 8),
    ],
)
def test_the_least_quota_counts_and_is_rounded_up(tmp_path, membership, files, cores):
    periods = {name.replace("quota", "period"): "100000" for name in files if "quota" in name}
    groups = {f"sys/fs/cgroup/{name}": text for name, text in (files | periods).items()}
    assert available_cores(system(tmp_path, {"proc/self/cgroup": membership} | groups)) == cores


def test_without_control_groups(tmp_path, monkeypatch):
    assert available_cores(tmp_path) == 8
    monkeypatch.delattr(os, "sched_getaffinity")
    monkeypatch.setattr(os, "cpu_count", lambda: None)
    assert available_cores(tmp_path) == 1
    monkeypatch.setattr(os, "process_cpu_count", lambda: 5, raising=False)  # of Python 3.13
    assert available_cores(tmp_path) == 5


def test_the_variable_of_python(tmp_path, monkeypatch):
    for setting, cores in (("3", 3), ("16", 16), ("default", 8), ("", 8)):
        monkeypatch.setenv("PYTHON_CPU_COUNT", setting)
        assert available_cores(tmp_path) == cores
    for setting in ("0", "-1", "1.5", "many"):
        monkeypatch.setenv("PYTHON_CPU_COUNT", setting)
        with pytest.raises(ValueError, match=f"PYTHON_CPU_COUNT must be an integer of at least 1; got '?{setting}'?$"):
            available_cores(tmp_path)
