"""Make the book, or a part of it: `python make.py book`. Without a step, list all steps.

This program needs Python 3.11 or later and nothing else, on Linux, macOS and Windows. The Makefile calls it, so that
`make book` does the same. An older Python 3 can read it, too, and then says that it is too old.
"""

import argparse
import hashlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

IS_WINDOWS = os.name == "nt"
ENVIRONMENT = Path(".venv")
PIP = ("python", "-m", "pip", "install", "--quiet", "--quiet", "--disable-pip-version-check")
FIXED = ("--constraint", "constraints.txt")
EXECUTE = ("python", "book/execute.py")
VERIFY = ("python", "book/verify.py")
BUILD = ("python", "book/build.py")
UNCHANGED = ("python", "book/unchanged.py")
COMPILE = ("python", "-c", "from safe.evolution import compile_kernels as run; run(), run(with_choices=True)")
BOUNDS_CHECKED = {"NUMBA_BOUNDSCHECK": "1", "NUMBA_CACHE_DIR": ".numba-boundscheck"}
ATHERIS = ("python", "-m", "tests.helpers.fuzz_atheris")
BROWSERS = (  # that print and that tests drive: programs of these names, or files
    "chromium-headless-shell",  # the same engine without windows, which takes half the time
    "chromium",
    "chromium-browser",
    "google-chrome",
    "microsoft-edge",
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
    "/Applications/Microsoft Edge.app/Contents/MacOS/Microsoft Edge",
    *(
        os.path.join(os.environ.get(folder, ""), *program.split("/"))
        for program in ("Google/Chrome/Application/chrome.exe", "Microsoft/Edge/Application/msedge.exe")
        for folder in ("PROGRAMFILES", "PROGRAMFILES(X86)", "LOCALAPPDATA")
    ),
)


# Steps


def env():
    """the environment alone, in .venv, for the Python that runs this program"""
    _install("installed", "--requirement", "requirements.txt")


def execute():
    """execute the notebooks that are stale, with RUNS runs of each experiment (500)"""
    env()
    _run(*EXECUTE)
    _run(*VERIFY)


def book():
    """everything from nothing: environment, every notebook, the book (RUNS=20 for a class)"""
    env()
    if _end(_start(*UNCHANGED)):
        _run(*EXECUTE)
        _check(_end(_start(*BUILD), _start(*VERIFY)))  # Sphinx leaves a core idle most of the time
        _run(*UNCHANGED, "--made")
    print("The book: _build/html/index.html", flush=True)


def student():
    """the student edition: the book and its notebooks without the solutions of exercises"""
    execute()
    _run("python", "book/student.py")
    print("The student edition: _build/student/html/index.html, and the notebooks beside it", flush=True)


def pdf():
    """the book as a PDF, by xelatex (what to install: see CONTRIBUTING.md)"""
    execute()
    log = Path("_build", "pdf.log")
    log.parent.mkdir(exist_ok=True)
    with log.open("w", encoding="utf-8") as file:
        code = _end(_start(*BUILD, "--builder", "pdflatex", stdout=file, stderr=subprocess.STDOUT))
    if code:
        print(*log.read_text(encoding="utf-8", errors="replace").splitlines()[-30:], sep="\n", flush=True)
    _check(code)
    print("The book: _build/latex/safe.pdf", flush=True)


def worksheet():
    """print the worksheet, as _build/worksheet.pdf, by an installed Chromium, Chrome or Edge"""
    book()
    _print(Path("_build", "html", "book", "worksheet.html"), Path("_build", "worksheet.pdf"))
    print("The worksheet: _build/worksheet.pdf", flush=True)


def test():
    """everything from nothing: environment, the tests"""
    develop()
    _run("ruff", "format", "--check", ".")
    _run("ruff", "check", ".")
    _run("deno", "fmt", "--check")
    _run("deno", "lint")
    _run("zizmor", "--offline", "--quiet", ".github")
    # before the tests, or else each of their processes would; the kernels that check bounds meanwhile on another core
    _check(_end(_start(*COMPILE), _start(*COMPILE, **BOUNDS_CHECKED)))
    _run("pytest", "--numprocesses", "auto", "--dist", "loadfile", "--no-loadscope-reorder")


def develop():
    """the environment with all that the tests need"""
    _install("installed-for-tests", "--editable", ".[book,test,bench]")


def bench():
    """time the package's parts, the paper's experiments and peers, with RUNS runs of each (500)"""
    develop()
    _run("pytest", "benchmarks", "--benchmark-json=benchmarks/results.json", "--benchmark-columns=median,iqr,rounds")


def fuzz():
    """CASES malformed inputs (100000), with bounds checking"""
    develop()
    _install("installed-for-fuzzing", "--editable", ".[fuzz]")
    _run("python", "-m", "tests.helpers.fuzz", os.environ.get("CASES", "100000"), **BOUNDS_CHECKED)
    if _end(_start("python", "-c", "import atheris", stderr=subprocess.DEVNULL)):
        print("No wheel of atheris for this system: without the cases that it would generate.")
    else:
        _run(*ATHERIS, "maze texts", "20000", **BOUNDS_CHECKED)
        _run(*ATHERIS, "damaged stores", "2000", **BOUNDS_CHECKED)


def evidence():
    """make again what is recorded beyond the paper"""
    env()
    for module in ("evidence", "peers"):
        _run("python", "-m", f"safe.companion.{module}")


def format():
    """format and lint the code"""
    develop()
    _run("ruff", "check", "--fix", ".")
    _run("ruff", "format", ".")
    _run("deno", "lint", "--fix")
    _run("deno", "fmt")


def picture():
    """draw the pictures that no notebook makes"""
    env()
    _run("python", "book/picture.py")


def constraints():
    """choose the newest versions of all packages (constraints.txt)"""
    env()
    if not Path(_program("uv")).exists():
        _run(*PIP, "uv")
    options = "--universal --python-version 3.11 --all-extras --upgrade --no-annotate --output-file constraints.txt"
    _run("uv", "pip", "compile", *options.split(), "--custom-compile-command", "make constraints", "pyproject.toml")


def clean():
    """remove what can be made again, except the environment and the results"""
    made = ("_build", "executed", ".numba-boundscheck", ".pytest_cache", ".hypothesis", ".ruff_cache")
    compiled = (cache for part in ("safe", "tests", "book", "benchmarks") for cache in Path(part).rglob("__pycache__"))
    for folder in [*map(Path, made), *compiled]:
        if folder.exists():
            shutil.rmtree(folder)


STEPS = {
    step.__name__: step
    for step in (
        env,
        execute,
        book,
        student,
        pdf,
        worksheet,
        test,
        develop,
        bench,
        fuzz,
        evidence,
        format,
        picture,
        constraints,
        clean,
    )
}


# Browsers


def browser():
    """The first of `BROWSERS` that is installed, or None."""
    return next((found for name in BROWSERS if (found := shutil.which(name))), None)


def _print(page, pdf):
    """Print a page of the book."""
    program = browser()
    if program is None:
        sys.exit(f"No browser found that can print: install Chromium, Chrome or Edge, or print {page} from another.")
    pdf.unlink(missing_ok=True)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:  # not that of a browser that is open
        command = [
            program,
            "--headless",
            "--disable-gpu",
            "--no-sandbox",  # the page is ours, and containers have no sandbox
            "--no-pdf-header-footer",
            f"--user-data-dir={profile}",
            f"--print-to-pdf={pdf.resolve()}",
            page.resolve().as_uri(),
        ]
        _check(_end(subprocess.Popen(command, stderr=subprocess.DEVNULL)))
    if not pdf.exists():
        sys.exit(f"{program} has not printed {page}")


# The environment


def _create():
    if (ENVIRONMENT / "created").exists():
        return
    if sys.version_info < (3, 11):  # noqa: UP036
        found = ".".join(map(str, sys.version_info[:3]))
        another = "py -3.12 make.py ..." if IS_WINDOWS else "make PYTHON=python3.12 ..."
        sys.exit("Python 3.11 or later is needed; this is %s. Use another: %s" % (found, another))  # noqa: UP031
    venv = [sys.executable, "-m", "venv", str(ENVIRONMENT)]
    _check(_end(subprocess.Popen([*venv, "--without-pip"])))  # to add pip takes longer than uv to install everything
    if not Path(_program("uv")).exists():
        uv = (*PIP[3:], "--only-binary", ":all:", "uv")
        own_pip = [sys.executable, "-m", "pip", "--python", _program("python")]
        if _end(subprocess.Popen([*own_pip, *uv], stderr=subprocess.DEVNULL)):  # missing, or too old
            _check(_end(subprocess.Popen(venv)))
            # without uv the newest pip, since older ones take minutes to resolve what constraints.txt has fixed
            if _end(_start(*PIP[:3], *uv)):
                _run(*PIP, "--upgrade", "pip")
    (ENVIRONMENT / "created").touch()


def _install(mark, *what):
    """Install packages, unless a file with this name in .venv says that they are there, at the versions asked for.

    By uv, which is fast, or else by pip: uv may be missing, and does not know pip's settings of proxies and mirrors.
    Either way the environment has pip, for what its owner installs.
    """
    _create()
    asked = hashlib.sha256()
    for file in ("pyproject.toml", "requirements.txt", "constraints.txt"):
        asked.update(Path(file).read_bytes())
    installed = ENVIRONMENT / mark
    if installed.exists() and installed.read_text(encoding="utf-8") == asked.hexdigest():
        return
    uv = ("uv", "pip", "install", "--quiet", "--python", _program("python"))
    if not Path(_program("uv")).exists() or _end(_start(*uv, *FIXED, "pip", *what)):
        if not Path(_program("pip")).exists():
            _run("python", "-m", "ensurepip", "--default-pip")
            _run(*PIP, "--upgrade", "pip")
        _run(*PIP, *FIXED, *what)
    installed.write_text(asked.hexdigest(), encoding="utf-8")


# Programs of the environment


def _program(name):
    """The file of a program of the environment, or of uv, which may be installed outside it."""
    if name == "uv" and (found := shutil.which(name)):
        return found
    return str(ENVIRONMENT / "Scripts" / (name + ".exe") if IS_WINDOWS else ENVIRONMENT / "bin" / name)


def _start(name, *arguments, stdout=None, stderr=None, **variables):
    """Start a program of the environment, with these variables in its environment."""
    command = [_program(name), *arguments]
    print(*(f"{key}={value}" for key, value in variables.items()), subprocess.list2cmdline(command), flush=True)
    return subprocess.Popen(command, env={**os.environ, **variables}, stdout=stdout, stderr=stderr)


def _end(*processes):
    """The exit code of processes, once they have ended: 0 if all of theirs are.

    Ctrl-C reaches them as well. They end in their own time, since they store what is finished, and this program waits.
    """
    is_interrupted = False
    try:
        for process in processes:
            while process.poll() is None:
                try:
                    process.wait()
                except KeyboardInterrupt:
                    is_interrupted = True
    finally:  # a request to terminate reaches this program alone
        for process in processes:
            if process.poll() is None:
                process.terminate()
                process.wait()
    if is_interrupted:
        raise KeyboardInterrupt
    return next((process.returncode for process in processes if process.returncode), 0)


def _check(code):
    """End this program unless an exit code is that of success."""
    if code:
        sys.exit(code if code > 0 else 128 - code)  # as shells count a signal


def _run(*command, **variables):
    _check(_end(_start(*command, **variables)))


def main():
    steps = "\n".join(f"  {name:12} {step.__doc__}" for name, step in STEPS.items())
    parser = argparse.ArgumentParser(
        description=__doc__.splitlines()[0],
        epilog="steps:\n" + steps,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("steps", nargs="*", metavar="step")
    parser.add_argument("--runs", help="runs of each experiment (RUNS in the environment, or 500)")
    parser.add_argument("--cases", help="malformed inputs (CASES in the environment, or 100000)")
    options = parser.parse_args()
    unknown = [name for name in options.steps if name not in STEPS]
    if unknown:
        parser.error(f"step must be one of {', '.join(STEPS)}; got {unknown[0]!r}")
    if not options.steps:
        parser.print_help()
    for name in ("RUNS", "CASES"):
        given = getattr(options, name.lower())
        if given is not None:
            os.environ[name] = given
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # many processes import the package: read what the first compiled
    for name in ("PYTHONHOME", "PYTHONPATH"):  # packages of another Python
        os.environ.pop(name, None)
    os.environ["PYTHONUTF8"] = "1"  # also on Windows
    os.environ["OPENBLAS_NUM_THREADS"] = "1"  # processes run side by side, and their matrices are small
    os.environ["DENO_NO_UPDATE_CHECK"] = "1"
    os.chdir(Path(__file__).resolve().parent)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    try:
        for name in options.steps:
            STEPS[name]()
    except KeyboardInterrupt:
        sys.exit(128 + signal.SIGINT)


if __name__ == "__main__":
    main()
