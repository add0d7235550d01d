# The front door. It sets up what is missing, then calls CMake, Vite, pytest and Playwright; each of them
# also works by itself (docs/development.md). `make help` lists the targets.
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := build
MAKEFLAGS += --no-print-directory
.NOTPARALLEL:

ROBOT ?= neuro
PORT ?= 8080
PREFIX ?= /usr/local
FUZZ_SECONDS ?= 30
# SECONDS is bash's own variable, so only one from the command line counts.
campaign_length = $(if $(TICKS),--ticks $(TICKS),$(if $(filter command,$(firstword $(origin SECONDS))),--seconds $(SECONDS)))

setup := verification/toolchain/setup
release := build/release
reports := build/reports
measure := verification/evidence/measure.py
export PATH := $(CURDIR)/build/venv/bin:$(PATH)
export PYTHONDONTWRITEBYTECODE := 1

web_sources = $(shell find web kernel/src kernel/include spec/openapi.yaml -name node_modules -prune -o -name dist -prune -o -type f -print)

.PHONY: help
help: ## List the targets
	@sed -nE 's/^([a-z-]+):.*## (.*)/\1\t\2/p' $(firstword $(MAKEFILE_LIST)) | expand -t 18

.PHONY: setup
setup: ## Install everything that any target needs; each target installs what it needs by itself
	@$(setup) lint docs bench provers

# setup-SET installs what the set needs (verification/toolchain/setup).
setup-%: FORCE
	@$(setup) $*
.PHONY: FORCE
FORCE:

.PHONY: generate
generate: ## Write the tables that come from spec/catalog.toml
	@/usr/bin/python3 spec/generate_catalog.py

$(release)/build.ninja: CMakePresets.json | setup-run
	@mkdir -p $(release)
	@cmake --preset release -DINTERLOCK_TESTS=OFF >$(release)/configure.log 2>&1 || { cat $(release)/configure.log; exit 1; }

# The same build with tests, benches and studies: what was compiled already is kept.
$(release)/tests.configured: CMakePresets.json | setup-test $(release)/build.ninja
	@cmake --preset release -DINTERLOCK_TESTS=ON >$(release)/configure.log 2>&1 || { cat $(release)/configure.log; exit 1; }
	@touch $@

build/stamps/console: $(web_sources) | setup-run
	@echo "build: console"
	@npm --prefix web run --silent build -- --logLevel warn
	@mkdir -p $(@D)
	@touch $@

# What ninja says about steps that are always run is no news; the rest is the progress of the build.
ninja = ninja -C $(release) $(1) | sed -uE '/: Entering directory|Re-checking globbed|Reading the commit|no work to do/d'

.PHONY: build build-tests
build: setup-run $(release)/build.ninja build/stamps/console ## Build what `make run` starts (the default)
	@$(call ninja,programs)

build-tests: setup-test $(release)/tests.configured build/stamps/console
	@$(call ninja,all)

.PHONY: run
run: build ## Start simulated robot, kernel, app and console: [ROBOT=neuro|prostate] [PORT=8080]
	@exec $(release)/bin/interlock run --robot $(ROBOT) --port $(PORT)

.PHONY: test test-unit test-console test-integration test-network test-browser
test: build-tests ## Run the unit, console, integration, network (as root) and browser tests; reports in build/reports/
	@tests/run unit console integration network browser

test-unit: build-tests ## Run the GoogleTest programs
	@tests/run unit

test-console: setup-test ## Run the console's unit tests, and compare its kernel with the native one
	@tests/run console

test-integration: build-tests ## Run the tests on real processes
	@tests/run integration

test-network: build-tests ## Run the tests that need root: they pull a cable in a network namespace, and act as another user
	@tests/run network

test-browser: build-tests ## Run the tests that click through the console
	@tests/run browser

.PHONY: test-loaded
test-loaded: setup-bench build-tests ## Run tests, then scenarios, three times in a row beside a load: [RUNS=3] [WHAT="test scenarios"]
	@tests/loaded $(or $(RUNS),3) $(or $(WHAT),test scenarios)

.PHONY: test-sanitizers test-threads
test-sanitizers: setup-bench build/stamps/console ## Run tests under the address, undefined-behaviour and thread sanitizers
	@$(measure) sanitizers python verification/sanitizers/run.py address
	@$(measure) thread_sanitizer python verification/sanitizers/run.py threads

test-threads: setup-test ## Run a part of the unit tests under the thread sanitizer
	@python verification/sanitizers/run.py threads-quick

.PHONY: test-reproducible
test-reproducible: setup-test ## Build twice in different folders, and compare every byte that is shipped
	@tests/machine/reproducible

.PHONY: fuzz
fuzz: setup-bench ## Throw bytes at the OpenIGTLink decoders under sanitizers: [FUZZ_SECONDS=30 | FUZZ_RUNS=10000000]
	@$(measure) fuzz tests/fuzz/run.py $(if $(FUZZ_RUNS),runs $(FUZZ_RUNS),seconds $(FUZZ_SECONDS))

.PHONY: soak
soak: build-tests ## Let the robot move for half an hour under OpenIGTLink clients and reconnect storms: [MINUTES=30]
	@$(measure) soak python verification/soak/run.py --minutes $(or $(MINUTES),30)

.PHONY: selftest
selftest: setup-provers build-tests ## Show that seeded faults turn tests and proofs red, where something changed: [FRESH=1] all
	@tests/failure/run.py
	@pytest -m provers tests/integration
	@verification/evidence/verify.py --report faults faults

.PHONY: verify
verify: setup-provers ## Climb the verification ladder where inputs changed, and one rung drawn by the commit: [FRESH=1] all
	@verification/evidence/verify.py

.PHONY: mutate mutate-proofs
mutate: setup-provers build-tests ## Draw mutants of the core and show each to tests and proofs: [SEED=] [COUNT=400] [MATRIX=1]
	@$(measure) mutation /usr/bin/python3 verification/mutation/run.py --count $(or $(COUNT),400) \
	  $(if $(SEED),--seed $(SEED)) $(if $(MATRIX),--matrix)

mutate-proofs: setup-provers build-tests ## Show a hundred mutants to the proofs alone: [SEED=] [COUNT=100] [MATRIX=1]
	@/usr/bin/python3 verification/mutation/run.py --without-tests --each 0 --count $(or $(COUNT),100) \
	  $(if $(SEED),--seed $(SEED)) $(if $(MATRIX),--matrix)

.PHONY: report keep-evidence
report: setup-docs ## Write and judge the trace report: [RELEASE=1] demands the long measurements, too
	@python verification/evidence/keep.py restore
	@python verification/trace/report.py $(if $(RELEASE),--release)

keep-evidence: setup-docs ## Keep evidence with the sources: other clones use it while its inputs are the same
	@python verification/evidence/keep.py keep
	@cp $(release)/clean-units $(release)/noticed-faults verification/evidence/kept/

.PHONY: docs
docs: setup-docs ## Write the documentation site, with search and the code's call graphs, to build/docs/site
	@python docs/site/build.py

.PHONY: campaign campaign-selftest
campaign: build-tests ## Throw faults at kernel core and plant: [SECONDS=300 | TICKS=] [SEED=1] [SCHEDULER=]
	@$(measure) campaign python verification/campaign/run.py --seed $(or $(SEED),1) $(campaign_length) \
	  $(if $(SCHEDULER),--scheduler $(SCHEDULER))

campaign-selftest: build-tests ## Show that the campaign finds each seeded fault of the kernel within a minute
	@$(measure) campaign_selftest python verification/campaign/selftest.py

.PHONY: scenarios
scenarios: build-tests ## Kill, freeze, starve and flood the real processes, 200 times: [SEED=1] [COUNT=200] [ONLY=number]
	@$(if $(ONLY),,$(measure) scenarios) python verification/scenarios/run_scenarios.py --seed $(or $(SEED),1) $(if $(ONLY),--only $(ONLY),--count $(or $(COUNT),200))

.PHONY: bench
bench: setup-bench build-tests ## Measure step, loop, reaction, link and rate beside cyclictest: [DURATION=10] [RATE_SECONDS=2]
	@$(measure) bench python verification/bench/run.py --duration $(or $(DURATION),10) --rate-seconds $(or $(RATE_SECONDS),2)

.PHONY: bench-start
bench-start: setup-test ## Measure `make run` in bare roots of Debian 12 and 13 (as root, with mmdebstrap): [DEBIAN="12 13"]
	@python tests/machine/bench_start.py $(DEBIAN)

.PHONY: bench-watch
bench-watch: setup-bench build-tests ## Watch the loop of one set-up for an hour beside cyclictest: [DURATION=3600] [SETUP=shipped_loaded]
	@python verification/bench/watch.py --duration $(or $(DURATION),3600) --setup $(or $(SETUP),shipped_loaded)

.PHONY: bench-console
bench-console: build-tests ## Measure load, response, memory and the app's processor time of the console: [MINUTES=10]
	@$(measure) console python verification/console/run.py --minutes $(or $(MINUTES),10)

.PHONY: pictures
pictures: build-tests ## Take the manual's pictures of every page, in both themes, into build/pictures/
	@npm --prefix web run --silent measure -- pictures.measure.ts

.PHONY: thesis
thesis: build-tests ## Run the targeting experiments of the thesis on the simulated ROBOT (docs/demo.md)
	@$(release)/bin/thesis_study $(ROBOT)

.PHONY: study
study: build-tests ## Measure homing, tracking, targeting, steering and membrane detection under errors, against their limits: [KEEP=--keep]
	@$(measure) steering python verification/study/run.py $(KEEP)

.PHONY: install
install: build ## Install programs, robot files and console: [PREFIX=/usr/local] [DESTDIR=]
	@cmake --install $(release) --prefix $(PREFIX) >/dev/null

.PHONY: package
package: setup-test build ## Make the Debian package, in build/release/package/
	@cd $(release) && SOURCE_DATE_EPOCH=$$(git log -1 --format=%ct) cpack --config CPackConfig.cmake >package.log || { cat package.log; exit 1; }
	@ls $(release)/package/*.deb

.PHONY: lint format
lint: setup-lint build-tests ## Check style, naming, generated files and leftovers
	@verification/toolchain/lint

format: setup-lint ## Rewrite C, C++ and Python in the project's style
	@git ls-files -co --exclude-standard '*.c' '*.h' '*.cpp' '*.hpp' \
	  | xargs grep -sL 'Generated from spec/catalog.toml' | xargs clang-format-19 -i
	@ruff check --quiet --fix
	@ruff format --quiet
	@npm --prefix web run --silent format

.PHONY: clean
clean: ## Remove everything that was built; run-time state stays
	rm -rf build web/dist web/node_modules web/kernel/kernel.wasm
