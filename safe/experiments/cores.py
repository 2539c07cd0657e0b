"""How many cores this process may use, which can be fewer than the machine has."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from pathlib import Path

from safe import checks


def available_cores(system: Path = Path("/")) -> int:
    """How many cores this process may use: the least of what its affinity and its control groups allow; 1 or more.

    PYTHON_CPU_COUNT in the environment takes the place of the affinity, as in Python 3.13. A quota of a control group
    (Linux), such as that of a container or of a hub's user, is rounded up.

    Parameters
    ----------
    system : Path
        The folder that holds `proc` and `sys`.

    Raises
    ------
    ValueError
        If PYTHON_CPU_COUNT is no integer of at least 1.
    """
    return min([_without_quotas(), *_quotas(system)])


def _without_quotas() -> int:
    setting = os.environ.get("PYTHON_CPU_COUNT") or "default"
    if setting != "default":
        return checks.integer("PYTHON_CPU_COUNT", int(setting) if setting.isdecimal() else setting, 1)
    if hasattr(os, "process_cpu_count"):  # since Python 3.13, where `-X cpu_count` sets it
        return os.process_cpu_count() or 1
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _quotas(system: Path) -> Iterator[int]:
    """The quotas of the control groups that hold this process, its own and those around it, in cores."""
    try:
        memberships = (system / "proc/self/cgroup").read_text(errors="replace").splitlines()
    except OSError:  # not Linux
        return
    for membership in memberships:  # hierarchy:controllers:path, where version 2 has no controllers
        _, controllers, path = membership.split(":", 2)
        if controllers and "cpu" not in controllers.split(","):
            continue
        groups = system / "sys/fs/cgroup" / ("cpu" if controllers else "")
        own = groups / path.lstrip("/")  # in a container it may be missing, as `groups` itself is then the container's
        for group in (own, *own.parents):
            try:
                if controllers:
                    quota, period = ((group / f"cpu.cfs_{name}_us").read_text() for name in ("quota", "period"))
                else:
                    quota, period = (group / "cpu.max").read_text().split()
                cores = math.ceil(int(quota) / int(period))
            except (OSError, ValueError):  # the root has no such file, and "max" is no number
                continue
            if cores > 0:  # -1: no quota, in version 1
                yield cores
