# One command each: `make demo`, `make test`. Everything they need is installed first, once; nothing is asked.
# What is up to date is not done again: .venv/.dependencies follows pyproject.toml, .venv/.module the sources.

PYTHON ?= python3
HEXDBB_WERROR ?= OFF

VENV := .venv
BIN := $(VENV)/bin
STEP := .ci/scripts/step.sh
PIP_INSTALL := $(BIN)/python -m pip install --disable-pip-version-check --progress-bar off
PRESET := $(if $(filter ON,$(HEXDBB_WERROR)),ci,release)

CPP_SOURCES := $(shell find cpp/include cpp/src cpp/bindings cpp/start -name '*.[ch]pp' -o -name '*.h' -o -name CMakeLists.txt)
CPP_BUILD_FILES := CMakeLists.txt cpp/CMakeLists.txt
CPP_FORMATTED := $(shell find cpp $(wildcard tests/cpp) firmware_interfaces/linuxcnc -name '*.[ch]pp' -o -name '*.[ch]')
PYTHON_SOURCES := python tests .ci/scripts firmware_interfaces cpp/bench docs/site

# The Python module and the C++ tests hold the same engine, compiled with the same options by the same compiler (scikit-build
# would choose another name of it): the second time it comes from ccache. Asked for by each recipe, since the first
# installs it.
export CXX
export CMAKE_CXX_COMPILER_LAUNCHER = $(shell command -v ccache)
export CCACHE_DIR := $(CURDIR)/build/ccache

MAKEFLAGS += --no-print-directory
.DELETE_ON_ERROR:
.NOTPARALLEL:
.DEFAULT_GOAL := help

.PHONY: help
help:  ## this list
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## (.*)/  make \1\t\2/' | expand -t 22

# --- set-up ---------------------------------------------------------------------------------------------------------

.PHONY: setup
setup: $(VENV)/.module  ## system packages, virtual environment, build; done once

.PHONY: system
system:
	@PYTHON=$(PYTHON) .ci/scripts/system_packages.sh

$(VENV)/.dependencies: pyproject.toml .ci/scripts/requirements.py | system
	@$(BIN)/python -m pip --version >/dev/null 2>&1 || \
	  $(STEP) "Virtual environment in $(VENV)" $(PYTHON) -m venv --clear $(VENV)
	@$(BIN)/python .ci/scripts/requirements.py > $(VENV)/requirements.txt
	@$(STEP) "Python packages" $(PIP_INSTALL) --requirement $(VENV)/requirements.txt
	@touch $@

# The editable installation knows the Python files there were: it is renewed when one is added, moved or removed. What
# is in them needs nothing.
.PHONY: ALWAYS
$(VENV)/.python-files: ALWAYS | $(VENV)/.dependencies
	@find python/hexdbb python/hexdbb_start python/hexdbb_truth -name '*.py' | LC_ALL=C sort > $@.new
	@if cmp -s $@.new $@; then rm $@.new; else mv $@.new $@; fi

# Without build isolation the build directory and the pybind11 of the environment are used again: a change compiles
# what it touches only.
$(VENV)/.module: $(VENV)/.dependencies $(VENV)/.python-files $(CPP_SOURCES) $(CPP_BUILD_FILES)
	@SKBUILD_CMAKE_DEFINE=HEXDBB_WERROR=$(HEXDBB_WERROR) $(STEP) "Python module of the engine (C++)" \
	  $(PIP_INSTALL) --verbose --no-build-isolation --no-deps --editable .
	@touch $@

# --- tests ----------------------------------------------------------------------------------------------------------

.PHONY: build
build: setup  ## the engine and its C++ tests
	@$(STEP) "Configure the C++ tests ($(PRESET))" cmake --preset $(PRESET)
	@$(STEP) "Compile the C++ tests ($(PRESET))" cmake --build --preset $(PRESET)

.PHONY: test
test: test-cpp test-python  ## C++, Python, across processes, examples; without test-long

.PHONY: test-cpp
test-cpp: build  ## C++ tests
	@echo "==> C++ tests"
	@ctest --preset $(PRESET)

.PHONY: test-python
test-python: setup  ## Python tests
	@echo "==> Python tests"
	@$(BIN)/python -m pytest --numprocesses auto --dist loadfile -m "not long"

.PHONY: test-long
test-long: setup  ## the long tests: whole searches of causes
	@echo "==> Long Python tests"
	@$(BIN)/python -m pytest --numprocesses auto --dist worksteal -m long

.PHONY: foreign
foreign: setup  ## the controller against a CANopen stack that is not ours (needs node and npm)
	@$(STEP) "CANopen stack of npm" npm install --silent --no-save --prefix build/foreign canopen@6.2.1
	@HEXDBB_FOREIGN=ON $(BIN)/python -m pytest tests/python/capture/test_foreign_stack.py

.PHONY: sanitize
sanitize: | system  ## C++ tests under AddressSanitizer and UndefinedBehaviorSanitizer
	@$(STEP) "Configure the C++ tests (sanitize)" cmake --preset sanitize
	@$(STEP) "Compile the C++ tests (sanitize)" cmake --build --preset sanitize
	@echo "==> C++ tests under sanitizers"
	@ctest --preset sanitize

# --- use ------------------------------------------------------------------------------------------------------------

.PHONY: demo
demo: setup  ## circular tests on the simulated rig: diagnosed, compared, a hidden fault found and added
	@rm -rf demo
	@$(BIN)/hexdbb demo demo --all --rate 20

.PHONY: docs
docs: setup  ## the documentation site, build/site/html/index.html; a warning or a dead link is an error
	@$(STEP) "Documentation site" $(BIN)/python -m docs.site build/site
	@echo "build/site/html/index.html"

.PHONY: bench
bench: setup  ## benchmarks of the engine beside SciPy; rewrites docs/benchmarks.md, docs/real-time.md
	@$(STEP) "Configure the benchmarks" cmake --preset bench
	@$(STEP) "Compile the benchmarks" cmake --build --preset bench
	@PYTHONPATH=$(CURDIR) $(BIN)/python cpp/bench/report.py build/bench/cpp/bench/hexdbb_bench --output docs/benchmarks.md
	@$(BIN)/python cpp/bench/compensation_report.py build/bench/cpp/bench/hexdbb_compensation_bench --output docs/real-time.md

.PHONY: closed-loop
closed-loop: setup  ## compensation judged on unseen circles of machines of known truth; rewrites docs/closed-loop*.md
	@$(BIN)/python -m tests.truth.closed_loop -o docs/closed-loop.md
	@$(BIN)/python -m tests.truth.learned_loop -o docs/closed-loop-learned.md

.PHONY: calibration
calibration: setup  ## verdicts judged on machines with forms: hours, resumable; rewrites docs/discovery-calibration.md
	@$(BIN)/hexdbb study verdicts --cases 2000 -o build/verdicts --page docs/discovery-calibration.md

.PHONY: coverage
coverage: setup  ## stated uncertainties compared with the truth of 200 machines; rewrites docs/uncertainty.md
	@$(BIN)/hexdbb study coverage -o build/coverage --page docs/uncertainty.md

.PHONY: faults
faults: setup  ## every fault on the bus and in the rig, in lockstep and real time; rewrites docs/fault-table.md
	@$(BIN)/python -m tests.faults --realtime --pairs 30 --table docs/fault-table.md

.PHONY: soak
soak: setup  ## 100 runs in real time while the engine compiles, half an hour; rewrites docs/soak.md
	@$(BIN)/python -m tests.faults --soak 50 --table docs/soak.md

.PHONY: fuzz
fuzz: setup  ## 10000 damaged inputs over all formats; failing ones go to build/fuzz
	@$(BIN)/python -m tests.fuzz --count 10000

# --- packages -------------------------------------------------------------------------------------------------------

WHEEL_PYTHONS ?= $(PYTHON)

.PHONY: wheel
wheel: | system  ## wheels with all of C++ inside, for WHEEL_PYTHONS, into dist/; each is tried in an empty environment
	@.ci/scripts/wheel.sh $(WHEEL_PYTHONS)

.PHONY: deb
deb: export HEXDBB_DEB = ON
deb: | system  ## packages of Debian for the controller PC: the library, and LinuxCNC's module where its headers are
	@.ci/scripts/deb.sh

# --- upkeep ---------------------------------------------------------------------------------------------------------

.PHONY: lint lint-cpp lint-python lint-types lint-spelling lint-ci
lint: lint-cpp lint-python lint-types lint-spelling lint-ci  ## format, style, types, spelling, CI files

lint-cpp: $(VENV)/.dependencies
	$(BIN)/clang-format --dry-run -Werror $(CPP_FORMATTED)

lint-python: $(VENV)/.dependencies
	$(BIN)/ruff check --quiet $(PYTHON_SOURCES)
	$(BIN)/ruff format --check --quiet $(PYTHON_SOURCES)

lint-types: $(VENV)/.dependencies
	$(BIN)/mypy

lint-spelling: $(VENV)/.dependencies
	$(BIN)/codespell

lint-ci: $(VENV)/.dependencies
	$(BIN)/check-jsonschema --quiet --builtin-schema vendor.github-workflows .github/workflows/*.yml

.PHONY: format
format: $(VENV)/.dependencies  ## rewrite sources in the house format
	$(BIN)/clang-format -i $(CPP_FORMATTED)
	$(BIN)/ruff check --fix --quiet $(PYTHON_SOURCES)
	$(BIN)/ruff format --quiet $(PYTHON_SOURCES)

.PHONY: stubs
stubs: setup  ## python/hexdbb/_core.pyi from the compiled module
	$(BIN)/python .ci/scripts/make_stubs.py python/hexdbb/_core.pyi

.PHONY: schemas
schemas: setup  ## published JSON schemas from the result types
	@$(BIN)/python -m hexdbb.cli.schemas

.PHONY: clean
clean:  ## remove builds, packages, the virtual environment and the demo's results
	rm -rf build demo dist $(VENV) .mypy_cache .pytest_cache .ruff_cache .hypothesis
