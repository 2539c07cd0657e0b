# Every target is a step of make.py, which needs nothing but Python; `make` alone lists them.
# What stands on the command line reaches it: make book RUNS=20, make env PYTHON=python3.12, make fuzz CASES=1000.

PYTHON ?= python3

.PHONY: help env execute book student pdf worksheet test develop bench fuzz evidence format picture constraints clean
.NOTPARALLEL: # steps share one environment

help:
	@$(PYTHON) make.py

env execute book student pdf worksheet test develop bench fuzz evidence format picture constraints clean:
	@$(PYTHON) make.py $@
