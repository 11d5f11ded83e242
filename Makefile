# make demo: set up and run the main job.   make test: set up, lint and test, in minutes.
# make test-all: the long tests as well.    make coverage: what they cover.    make site: the documentation site.
# make abuse: fuzz, paths and kills, hours of them.   make budget: make test on an idle machine, failing what takes too long.
PYTHON ?= python3
# For pip; .ci/versions has others, and leaves out lint, which depends on its own versions.
CONSTRAINTS ?= constraints.txt
LINT ?= lint
BIN := .venv/bin
# Small dense systems gain nothing from BLAS threads and lose much where cores are busy.
export OPENBLAS_NUM_THREADS ?= 1
# Tests start many processes, which shall not compile every source anew.
unexport PYTHONDONTWRITEBYTECODE

# Tests run on all processors, those of a file on one, as they share what is made for them. tests/conftest.py puts files
# that take long first.
PYTEST := $(BIN)/python -m pytest -q -n logical --dist loadfile --no-loadscope-reorder
# In plain Python a bad index raises: a few kernels in `make test`, in test-all a march of each kind, for coverage all.
PLAIN := $(addprefix tests/particle/test_, bernstein.py drive.py in_plane_motion.py runge_kutta.py slide.py stick.py)
MARCHES := tests/particle $(addprefix tests/physics/test_, body.py flight.py jumps.py) tests/regression/test_motion.py
ALL_MARCHES := tests/particle tests/physics tests/regression tests/validation/test_single_stroke.py
# Only in test-all: tests marked slow, and files that take long as a whole.
LONG := *_in_browser.py $(addprefix test_, aim_examples.py cluster.py large_arrays.py paper_figures.py platform_examples.py)
LONG += $(addprefix test_, ring_example.py rivals.py study_examples.py wheel.py)
CHOSEN := -m "not slow" $(LONG:%=--ignore-glob='*/%')

.PHONY: demo test budget test-all coverage forget-coverage plain lint kernels docs site paper benchmark abuse fuzz paths kills clean

demo: .venv/installed
	$(BIN)/active-surface run examples/transport.toml

test: .venv/developer
	@$(MAKE) --no-print-directory -j2 kernels plain PLAIN="$(PLAIN)" COVERAGE="$(COVERAGE)"
	@echo "== tests with compiled kernels (2 of 2)"
	$(PYTEST) $(COVERAGE) $(CHOSEN)

# The same tests, each within its budget of processor time; beside other work any of them takes longer.
budget: CHOSEN += --budget
budget: test

plain: $(LINT)
	@echo "== kernels in plain Python (1 of 2)"
	NUMBA_DISABLE_JIT=1 $(PYTEST) $(COVERAGE) -m "not slow and not compiled" $(PLAIN)

# In one pass with the others, as tests of a file share what is made for them.
test-all: PLAIN := $(MARCHES)
coverage: PLAIN := $(ALL_MARCHES)
test-all coverage: CHOSEN :=
test-all: test

# Which lines all these tests run, those of kernels too.
coverage: COVERAGE := --cov --cov-append --cov-report=
coverage: forget-coverage test
	$(BIN)/coverage report

forget-coverage:
	rm -f .coverage

# Compiled once, on one processor, before several processes would do so at a time: those of a face and of a point.
kernels: .venv/developer
	@$(BIN)/active-surface run examples/transport.toml --quiet --output build/kernels
	@$(BIN)/active-surface run examples/two_actuators.toml --quiet --output build/kernels

lint: .venv/developer
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

benchmark: .venv/benchmarks
	$(BIN)/python benchmarks/plate.py
	$(BIN)/python benchmarks/contact.py
	$(BIN)/python benchmarks/schemes.py
	$(BIN)/python benchmarks/top_face.py
	$(BIN)/python benchmarks/faces.py
	$(BIN)/python benchmarks/with_ngsolve_large_deflection.py
	$(BIN)/python benchmarks/stretching_sweeps.py
	$(BIN)/python benchmarks/inertia.py
	$(BIN)/python benchmarks/paths.py
	$(BIN)/python benchmarks/paths.py --many
	$(BIN)/python benchmarks/starting.py

# Abuse: mutated and generated inputs, random paths, killed commands. docs/trust.md and docs/accuracy.md have what they show.
SECONDS ?= 600
SEED ?= 1
COUNT ?= 1000000

abuse: fuzz paths kills

fuzz: .venv/developer
	cd tests/abuse && ../../$(BIN)/python -m fuzz --seconds $(SECONDS) --count $(COUNT) --seed $(SEED)

paths: .venv/developer
	$(BIN)/python tests/abuse/random_paths.py --seconds $(SECONDS) --count $(COUNT) --seed $(SEED) --oracle 1000

kills: .venv/developer
	$(BIN)/python tests/abuse/kill_anywhere.py --seed $(SEED)

docs: .venv/developer
	$(BIN)/python docs/pictures.py

site: .venv/site
	$(BIN)/python docs/scorecard.py --check
	$(BIN)/python -m sphinx -W --keep-going -q -b html docs build/site
	@echo "wrote       build/site/index.html"

# The page about the paper, with its pictures.
paper: .venv/installed
	$(BIN)/active-surface reproduce all --output docs

.venv/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "Python 3.11 or newer is needed; try make PYTHON=python3.12"; exit 2; }
	$(PYTHON) -m venv .venv
	@touch $@

.venv/installed: .venv/python pyproject.toml $(CONSTRAINTS)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c $(CONSTRAINTS) -e ".[app]"
	@touch $@

.venv/developer: .venv/python pyproject.toml $(CONSTRAINTS)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c $(CONSTRAINTS) -e ".[dev,cluster,parquet]"
	@touch .venv/installed $@

.venv/benchmarks: .venv/installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c $(CONSTRAINTS) -e ".[benchmarks]"
	@touch $@

.venv/site: .venv/installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c $(CONSTRAINTS) -e ".[docs]"
	@touch $@

clean:
	rm -rf .venv build results .coverage .hypothesis .mypy_cache .ruff_cache .pytest_cache .import_linter_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
