"""Rules for every compiled function; and an edited function never runs in its old form."""

import dis
import importlib
import inspect
import os
import pkgutil
import subprocess
import sys
import types
from pathlib import Path

import numba
import pytest

import safe

MODULES = [importlib.import_module(f"safe.{module.name}") for module in pkgutil.iter_modules(safe.__path__)]


def is_kernel(value):
    return isinstance(value, numba.core.dispatcher.Dispatcher)


KERNELS = {
    f"{module.__name__}.{name}": function
    for module in MODULES
    for name, function in vars(module).items()
    if is_kernel(function) and function.py_func.__module__ == module.__name__
}


def test_there_are_kernels():
    assert {"safe.robot.walk", "safe.novelty.score_cells", "safe.evolution.run_to_end"} <= set(KERNELS)


@pytest.mark.parametrize("kernel", KERNELS.values(), ids=KERNELS)
def test_a_kernel_releases_the_gil_is_kept_on_disk_and_keeps_to_ieee_arithmetic(kernel):
    assert kernel.targetoptions["nogil"]
    assert not kernel.targetoptions.get("fastmath")
    assert kernel.stats.cache_path


@pytest.mark.parametrize("kernel", KERNELS.values(), ids=KERNELS)
def test_a_kernel_uses_only_numpy_math_numbers_named_tuples_and_other_kernels(kernel):
    names = {i.argval for i in dis.get_instructions(kernel.py_func) if i.opname == "LOAD_GLOBAL"}
    for name, value in inspect.getclosurevars(kernel.py_func).globals.items():
        if name not in names:  # an attribute of that name
            continue
        is_library = isinstance(value, types.ModuleType) and value.__name__ in ("numpy", "math", "numba")
        is_record = isinstance(value, type) and issubclass(value, tuple)
        assert is_library or is_record or is_kernel(value) or isinstance(value, int | float), name


def test_without_compiling_a_run_is_the_same():
    code = (
        "import safe; print(safe.evolve('maze1', 'safe', 2, "
        "safe.Parameters(population=6, objectives=6, generations=4, archive=9, k=3)))"
    )
    outputs = [
        subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "NUMBA_DISABLE_JIT": disable},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for disable in ("0", "1")
    ]
    assert outputs[0] == outputs[1] != ""


def test_an_edited_kernel_is_compiled_again_in_every_file_that_calls_it(tmp_path):
    package = tmp_path / "tiny"
    package.mkdir()
    source = Path(safe.__file__).with_name("kernel.py").read_text()
    (package / "kernel.py").write_text(source)
    (package / "__init__.py").write_text("")
    (package / "upper.py").write_text(
        "from tiny.kernel import kernel\nfrom tiny.lower import low\n\n@kernel\ndef up():\n    return 10 * low()\n"
    )
    lower = package / "lower.py"

    def up(returning, time):
        lower.write_text(f"from tiny.kernel import kernel\n\n@kernel\ndef low():\n    return {returning}\n")
        os.utime(lower, (time, time))
        code = "from tiny.upper import up; print(up())"
        environment = {k: v for k, v in os.environ.items() if k != "NUMBA_CACHE_DIR"}
        command = [sys.executable, "-c", code]
        return subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=True).stdout

    past, future = 1_000_000_000, 4_000_000_000
    for file in package.iterdir():
        os.utime(file, (past, past))
    assert up(1, past) == "10\n"
    index = next((package / "__pycache__").glob("upper.up-*.nbi"))
    compiled = index.stat().st_mtime_ns
    assert up(1, past) == "10\n"
    assert index.stat().st_mtime_ns == compiled  # kept as long as nothing changes
    assert up(2, future) == "20\n"
