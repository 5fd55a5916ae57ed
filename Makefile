# Two commands for a machine with Python ≥ 3.11 and make: `make rank` and `make test`.
# `make help` lists all targets, from the lines that begin with ##.
# `make rank ARGS="--samples 500 --by CTN"` passes options on; see `gsp rank --help`.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
export OPENBLAS_NUM_THREADS ?= 1
# Processes of the tests: one more than processors, as some tests wait for a browser or a database.
WORKERS ?= $(shell $(PYTHON) -c 'import os; print(1 + len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else 1 + os.cpu_count())')
# Byte code is made when a module is imported: of all files, as pip does, it takes half of the time.
# An environment that forbids it would have each process compile all that it imports.
export PYTHONDONTWRITEBYTECODE =
PIP_INSTALL := $(BIN)/python -m pip install --quiet --no-compile

.PHONY: rank help test compiled check-long matrix docs notebooks hooks lint bench proof pictures

## set up .venv, rank the 195 mechanisms (the default)
rank: $(VENV)/.installed
	$(BIN)/gsp rank $(ARGS)

## list the targets
help:
	@awk '/^## / {text = substr($$0, 4); next} text {sub(/:.*/, ""); printf "make %-12s%s\n", $$0, text} {text = ""}' $(firstword $(MAKEFILE_LIST))

## set up .venv, check style and types, run the tests
test:
	$(MAKE) -j3 compiled lint
	$(BIN)/python -m pytest -n $(WORKERS) --dist worksteal $(ARGS)

# Compiled functions in the cache, in two parts while tools are installed and types are checked: each
# takes one to two minutes on one core.
## compile what numba caches
compiled: compiled-proofs compiled-workspaces

compiled-%: $(VENV)/.installed
	$(BIN)/python -m tests.compile $*

## every check, with the whole campaigns of thousands of designs (hours)
check-long: lint compiled
	$(BIN)/python -m pytest -n $(WORKERS) --dist worksteal --campaign=full $(ARGS)

## check style and types
lint: $(VENV)/.tools
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy

# The tests on every Python from 3.11 on that is found by its name, and on the lowest versions that
# pyproject.toml claims. Environments are kept in build/matrix.
PYTHONS ?= python3.11 python3.12 python3.13 python3.14 python3.15
## run the core tests on each installed Python, and with the lowest versions
matrix:
	@for python in $(PYTHONS); do \
	  $$python --version >/dev/null 2>&1 || { echo "$$python: not found"; continue; }; \
	  $(MAKE) build/matrix/$$python.passed PYTHON=$$python MATRIX=$$python || exit 1; \
	done
	$(MAKE) build/matrix/lowest.passed MATRIX=lowest CONSTRAINTS="--constraint tests/lowest.txt"

# The core: without simulators, pages, packaging and figures.
MATRIX_TESTS ?= $(addprefix tests/,catalogue determinant evaluation families files geometry \
  indices kernels kinematics limits model planar published ranking sweeps)

build/matrix/$(MATRIX).passed: pyproject.toml tests/lowest.txt
	$(PYTHON) -m venv build/matrix/$(MATRIX)
	build/matrix/$(MATRIX)/bin/python -m pip install --quiet --upgrade "pip>=25.1"
	build/matrix/$(MATRIX)/bin/python -m pip install --quiet $(CONSTRAINTS) --editable ".[plots,tables,verify]" --group test
	build/matrix/$(MATRIX)/bin/python -m pytest -n auto --dist worksteal $(MATRIX_TESTS)
	touch $@

## run the checks of `make lint` before every commit
hooks: $(VENV)/.tools
	$(PIP_INSTALL) pre-commit
	$(BIN)/pre-commit install

# A warning is an error. Results are kept in build/website.
## build the documentation site in build/site
docs: $(VENV)/.docs
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --strict $(ARGS)

# `make docs` shows them. Without this the tests execute them, some in a short form.
## execute all notebooks in full, write them with their outputs to build/website
notebooks: $(VENV)/.docs
	$(BIN)/python -m website.notebooks

## compare all mechanisms with Pinocchio and MuJoCo, write docs/proof.md (a few minutes)
proof: $(VENV)/.installed
	$(BIN)/gsp prove --mujoco --out docs/proof.md --force $(ARGS)

## measure, write the tables of docs/performance.md (the comparison with C needs gcc)
bench: $(VENV)/.installed
	$(BIN)/python -m benchmarks $(ARGS)

# The last two need OpenGL: egl or osmesa.
## draw the pictures of the README, of docs/exploration.md, docs/app.md, docs/bridges.md and docs/drives.md
pictures: $(VENV)/.installed
	$(BIN)/gsp rank --out results/readme.csv --force
	mkdir -p docs/images && cp results/readme.png docs/images/ranking.png
	$(BIN)/gsp show toz-kucuk-2016-d1-d2-d3-d4-a1-2 --plot docs/images/mechanism.png --force
	$(BIN)/python docs/images/placements.py
	PYTHONPATH=. $(BIN)/python docs/images/app.py
	MUJOCO_GL=$${MUJOCO_GL:-egl} $(BIN)/python docs/images/exotic.py
	MUJOCO_GL=$${MUJOCO_GL:-egl} $(BIN)/python docs/images/driven.py

$(BIN)/pip:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "expected Python >= 3.11, found " + sys.version.split()[0] + "; try make PYTHON=python3.12")'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade "pip>=25.1"

$(VENV)/.installed: pyproject.toml | $(BIN)/pip
	$(PIP_INSTALL) --editable ".[all]"
	touch $@

$(VENV)/.tools: pyproject.toml $(VENV)/.installed
	$(PIP_INSTALL) --group dev
	touch $@

$(VENV)/.docs: pyproject.toml $(VENV)/.installed
	$(PIP_INSTALL) --group docs
	touch $@
