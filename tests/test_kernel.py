"""Rules for every compiled function; and an edited function never runs in its old form."""

import dis
import errno
import importlib
import importlib.util
import inspect
import os
import pkgutil
import re
import shutil
import subprocess
import sys
import types

import numba
import numpy as np
import pytest

import safe

MODULES = [importlib.import_module(module.name) for module in pkgutil.walk_packages(safe.__path__, "safe.")]


def is_kernel(value):
    return isinstance(value, numba.core.dispatcher.Dispatcher)


KERNELS = {
    f"{module.__name__}.{name}": function
    for module in MODULES
    for name, function in vars(module).items()
    if is_kernel(function) and function.py_func.__module__ == module.__name__
}


def test_there_are_kernels():
    assert {"safe.robot.walk", "safe.evolution.advance", "safe.results.mechanism.moments"} <= set(KERNELS)


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


@pytest.mark.parametrize("kernel", KERNELS.values(), ids=KERNELS)
def test_a_kernel_that_does_not_count_references_returns_only_numbers(kernel):
    counts = kernel.get_overload.__self__.targetoptions["_nrt"]
    assert counts or holds_only_numbers(kernel.py_func.__annotations__["return"], kernel.py_func.__globals__)


def holds_only_numbers(annotation, names):
    """Is it that of numbers, of a tuple of them, or of a named tuple of such values?"""
    text = getattr(annotation, "__forward_arg__", annotation)
    records = [names.get(word) for word in set(re.findall(r"\w+", text)) - {"None", "int", "float", "bool", "tuple"}]
    return all(
        isinstance(record, type)
        and issubclass(record, tuple)
        and all(holds_only_numbers(field, names) for field in record.__annotations__.values())
        for record in records
    )


def test_a_kernel_keeps_none_of_its_arguments():
    rng, genomes = np.random.Generator(np.random.SFC64(1)), np.zeros((2, 3))
    before = sys.getrefcount(rng), sys.getrefcount(genomes)
    safe.operators.draw_genomes(rng, 0.0, 1.0, genomes)
    assert (sys.getrefcount(rng), sys.getrefcount(genomes)) == before


def test_a_kernel_is_compiled_for_python_only_if_python_calls_it():
    @safe.kernel.kernel
    def low(x):
        return x + 1

    @safe.kernel.kernel
    def up(x):
        return 2 * low(x)

    assert up(1) == 4
    assert len(up.signatures) == 1
    assert low.signatures == []
    assert low(1) == 2
    assert len(low.signatures) == 1


@pytest.mark.parametrize("make", [lambda row: np.empty(2), lambda row: row[1:]], ids=["new", "view"])
def test_a_kernel_that_makes_an_array_and_does_not_say_so_is_named(make):
    makes = safe.kernel.kernel(make)

    @safe.kernel.kernel
    def calls(row):
        return makes(row)[0]

    with pytest.raises(numba.TypingError, match=r"<lambda> makes an array: mark it @kernel\(makes_arrays=True\)"):
        calls(np.zeros(3))


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


@pytest.fixture
def tiny(tmp_path):
    """A package of two kernels, one of which calls the other, and a function that calls it in a new process."""
    package = tmp_path / "tiny"
    package.mkdir()
    shutil.copy(safe.kernel.__file__, package)
    (package / "__init__.py").write_text("")
    (package / "upper.py").write_text(
        "from tiny.kernel import kernel, while_compiling\nfrom tiny.lower import low\n\n"
        "@kernel\ndef up():\n    return 10 * low()\n"
    )

    def up(returning, **environment):
        """What `up` returns if `low` returns this; all files have one time, whatever they hold."""
        blank = "\n" * returning  # so that the function moves, too
        source = f"from tiny.kernel import kernel\n{blank}\n@kernel\ndef low():\n    return {returning}\n"
        (package / "lower.py").write_text(source)
        for file in package.glob("*.py"):
            os.utime(file, (1_000_000_000, 1_000_000_000))
        code = "from tiny.upper import up, while_compiling\nwith while_compiling(): print(up())"
        kept = {k: v for k, v in os.environ.items() if k != "NUMBA_CACHE_DIR"}
        command = [sys.executable, "-B", "-c", code]
        done = subprocess.run(command, cwd=tmp_path, env=kept | environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return int(done.stdout)

    return up


def test_an_edited_kernel_is_compiled_again_in_every_file_that_calls_it(tiny, tmp_path):
    cache = tmp_path / "tiny" / "__pycache__"

    def made():
        return {file.name: file.stat().st_mtime_ns for file in cache.iterdir()}

    assert tiny(1) == 10
    files = made()
    assert tiny(1) == 10
    assert made() == files  # kept as long as nothing changes
    shutil.copytree(cache, tmp_path / "before")
    assert tiny(2) == 20
    assert len(made()) == len(files)  # what is of no use any more is removed
    shutil.copytree(tmp_path / "before", cache, dirs_exist_ok=True)
    assert tiny(2) == 20


def test_a_damaged_cache_is_made_again(tiny, tmp_path):
    assert tiny(1) == 10
    for file in (tmp_path / "tiny" / "__pycache__").iterdir():
        file.write_bytes(b"" if file.suffix == ".nbi" else b"\0" * 100)
    assert tiny(1) == 10


def test_without_a_place_for_a_cache_kernels_are_compiled(tiny, tmp_path):
    file = tmp_path / "tiny" / "__pycache__"
    file.write_text("a file where numba would make a folder")
    assert tiny(1, HOME=str(file), XDG_CACHE_HOME=str(file), LOCALAPPDATA=str(file)) == 10


def test_a_full_disk_is_no_reason_not_to_run(monkeypatch):
    def save(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(numba.core.caching.IndexDataCacheFile, "save", save)
    monkeypatch.setattr(safe.kernel._KernelCache, "fault", None)
    assert safe.kernel.kernel(lambda: 3)() == 3
    assert safe.kernel._KernelCache.fault == "its cache cannot be written (No space left on device)"


def test_what_was_loaded_stays_known_after_an_edit(tmp_path):
    """A reloaded module is another matter: its kernels are new, and the others are not."""
    shutil.copy(safe.kernel.__file__, tmp_path)
    (tmp_path / "lower.py").write_text("")
    specification = importlib.util.spec_from_file_location("copy_of_kernel", tmp_path / "kernel.py")
    copy = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(copy)
    copy.kernel(is_kernel)
    loaded = copy.sources()
    assert copy.loaded_sources() == loaded
    (tmp_path / "lower.py").write_text("edited = True")
    assert copy.loaded_sources() == loaded != copy.sources()
    copy.kernel(is_kernel)
    assert copy.loaded_sources() is None
