# `make` alone lists the targets. `make book` and `make test` need nothing but Python and make.

PYTHON ?= python3
RUNS ?= 500
export RUNS
CASES ?= 100000
unexport PYTHONDONTWRITEBYTECODE # many processes import the package: read what the first has compiled

BIN := .venv/bin
# $(WHAT) by uv, which is fast, or else by pip: uv may be missing, and does not know pip's settings of proxies and mirrors
INSTALL = $(BIN)/uv pip install --quiet --python $(BIN)/python $(FIXED) $(WHAT) || \
	$(BIN)/python -m pip install --quiet --quiet --disable-pip-version-check $(FIXED) $(WHAT)
FIXED := --constraint constraints.txt
DENO := DENO_NO_UPDATE_CHECK=1 $(BIN)/deno
BUILD := $(BIN)/python book/build.py
# before the tests, or else each of their processes would; the kernels that check bounds meanwhile on another core
COMPILE := $(BIN)/python -c 'from safe.evolution import compile_kernels; compile_kernels()'
BOUNDS_CHECKED := NUMBA_BOUNDSCHECK=1 NUMBA_CACHE_DIR=.numba-boundscheck

.PHONY: help env execute book pdf test bench fuzz format picture constraints clean

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z]+:.*## / {printf "make %-12s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

env: .venv/installed ## the environment alone, in .venv (PYTHON=python3.12 for another Python)

execute: env ## execute the notebooks that are stale, with RUNS runs of each experiment (500)
	$(BIN)/python book/execute.py

book: execute ## everything from nothing: environment, every notebook, the book (RUNS=20 for a class)
	$(BUILD)
	@echo "The book: _build/html/index.html"

pdf: execute ## the book as a PDF, by xelatex (what to install: see CONTRIBUTING.md)
	@mkdir -p _build
	$(BUILD) --builder pdflatex >_build/pdf.log 2>&1 || { tail -n 30 _build/pdf.log; exit 1; }
	@echo "The book: _build/latex/safe.pdf"

test: .venv/installed-for-tests ## everything from nothing: environment, the tests
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(DENO) fmt --check
	$(DENO) lint
	$(COMPILE) & $(BOUNDS_CHECKED) $(COMPILE) && wait
	$(BIN)/pytest --numprocesses auto --dist loadfile --no-loadscope-reorder

fuzz: .venv/installed-for-fuzzing ## CASES malformed inputs (100000), with bounds checking
	$(BOUNDS_CHECKED) $(BIN)/python -m tests.helpers.fuzz $(CASES)
	@if $(BIN)/python -c 'import atheris' 2>/dev/null; then set -x; \
		$(BOUNDS_CHECKED) $(BIN)/python -m tests.helpers.fuzz_atheris "maze texts" 20000 && \
		$(BOUNDS_CHECKED) $(BIN)/python -m tests.helpers.fuzz_atheris "damaged stores" 2000; \
	else echo "No wheel of atheris for this system: without the cases that it would generate."; fi

bench: .venv/installed-for-tests ## time the package's parts, the paper's experiments and peers, with RUNS runs of each (500)
	$(BIN)/pytest benchmarks --benchmark-json=benchmarks/results.json --benchmark-columns=median,iqr,rounds

format: .venv/installed-for-tests ## format and lint the code
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .
	$(DENO) lint --fix
	$(DENO) fmt

picture: env ## draw the picture of the README
	$(BIN)/python book/picture.py

constraints: env ## choose the newest versions of all packages (constraints.txt)
	$(BIN)/python -m pip install --quiet uv
	$(BIN)/uv pip compile --universal --python-version 3.11 --all-extras --upgrade --no-annotate \
		--custom-compile-command "make constraints" --output-file constraints.txt pyproject.toml

clean: ## remove what can be made again, except the environment and the results
	rm -rf _build executed .numba-boundscheck .pytest_cache .hypothesis .ruff_cache
	find safe tests book benchmarks -name __pycache__ -exec rm -rf {} +

# Without uv the newest pip, since older ones take minutes to resolve what constraints.txt has fixed.
.venv/created:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or later is needed; this is " + sys.version.split()[0] + ". Name another: make PYTHON=...")'
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --quiet --disable-pip-version-check --only-binary :all: uv || \
		$(BIN)/python -m pip install --quiet --quiet --upgrade pip
	touch $@

.venv/installed: WHAT := --requirement requirements.txt
.venv/installed: .venv/created pyproject.toml requirements.txt constraints.txt
	$(INSTALL)
	touch $@

.venv/installed-for-tests: WHAT := --editable .[book,test,bench]
.venv/installed-for-tests: .venv/created pyproject.toml requirements.txt constraints.txt
	$(INSTALL)
	touch .venv/installed $@

.venv/installed-for-fuzzing: WHAT := --editable .[fuzz]
.venv/installed-for-fuzzing: .venv/installed-for-tests
	$(INSTALL)
	touch $@
