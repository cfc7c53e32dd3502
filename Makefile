# Knead's front door. Every target does all its own set-up; a second call does nothing.
# The work is done by CMake presets (CMakePresets.json) and the scripts in scripts/.

.DEFAULT_GOAL := help
.PHONY: help setup build wheel npm run studio test quick test-studio asan fuzz noexcept wasm format format-check lint check-long bench bench-compare instructions bench-studio figures examples clean

help: ## Show this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-13s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

setup: ## Install the Debian packages that building and testing need
	@scripts/setup.sh test

build: ## Build the command line: build/release/knead
	@scripts/build.sh

wheel: ## Package the Python module: out/dist/knead_cad-*.whl
	@scripts/wheel.sh

npm: ## Package the engine for JavaScript: out/dist/knead-cad-*.tgz
	@scripts/npm.sh

run: ## Sculpt the sample bonnet into out/, then serve the studio (SERVE=0: do not)
	@scripts/run.sh

studio: ## Build the studio, static files: web/dist
	@scripts/studio.sh

test-studio: ## Test the studio alone, in node and in headless Chromium
	@scripts/studio_test.sh

test: ## Build everything and run all tests
	@scripts/test.sh

quick: ## After a small change: build it and run the tests of the rooms it touches
	@scripts/quick.sh

asan: ## Run most tests under the address and undefined-behaviour sanitizers
	@scripts/asan.sh

fuzz: ## Run every fuzz target for KNEAD_FUZZ_SECONDS (default 10), with the objects of asan
	@scripts/fuzz.sh

noexcept: ## Build the core without exceptions and link a program against it
	@scripts/noexcept.sh

wasm: ## Build the library for WebAssembly
	@scripts/wasm.sh

format: ## Format all C++ sources in place
	@scripts/format.sh

format-check: ## Fail where a C++ source is not formatted
	@scripts/format.sh --check

lint: ## Run clang-tidy 19 over the library and the command line
	@scripts/lint.sh

check-long: ## The checks that take longer than CI should
	@scripts/check_long.sh

bench: ## Build and run the benchmarks
	@scripts/bench.sh

bench-compare: ## Fail where this commit is slower than BASE=<commit>
	@scripts/bench_compare.sh "$(BASE)" $(if $(FILTER),"$(FILTER)")

instructions: ## Count the instructions of key kernels, fail where they differ from bench/instructions.json
	@scripts/instructions.sh

bench-studio: ## Time the studio's steps, in node and in headless Chromium
	@scripts/bench_studio.sh

figures: ## Regenerate the thesis' tables and figures of Gramians, and draw the roofline: out/figures/
	@scripts/figures.sh

examples: ## Run the examples and draw the thesis' sculpting figures: out/examples/
	@scripts/examples.sh

clean: ## Remove build/ and out/
	@rm -rf build out
