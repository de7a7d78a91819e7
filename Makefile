# Two commands for users (demo, test), the rest for developers. `make` alone prints this list.
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
MAKEFLAGS += --no-print-directory
BIN := .venv/bin

.PHONY: help demo test build wheel lint format layers asan tsan tidy bench clean

help: ## this list
	@grep -hE '^[a-z]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z]+):.*## /\1\t/' | expand -t 10

demo: ## install what is missing, build, map simulated rooms, compare with the truth, draw the floor plan
	@scripts/setup
	@scripts/demo

test: ## install what is missing, build, then every check and test
	@scripts/setup test lint
	@$(MAKE) checks
	@scripts/ctest release
	@$(BIN)/python -m pytest -p no:cacheprovider

build: ## the package with its development tools into .venv
	@scripts/setup test lint

wheel: ## a self-contained wheel for every x86-64 processor since 2009, and the sdist, in dist/
	@scripts/setup wheel
	@scripts/wheel

lint: ## formatters, linters, type check, layer check
	@scripts/setup lint
	@$(MAKE) checks

checks:
	@tools/lint

format: ## rewrite C++ and Python sources in the project's style
	@scripts/setup lint
	@tools/format

asan: ## C++ tests under the address and undefined-behaviour sanitizers
	@scripts/setup test
	@scripts/ctest asan-ubsan

tsan: ## C++ tests under the thread sanitizer
	@scripts/setup test
	@scripts/ctest tsan

tidy: ## clang-tidy on every C++ source (slow)
	@scripts/setup test tidy
	@tools/tidy

bench: ## C++ benchmarks of the parts
	@scripts/setup test bench
	@scripts/bench

clean: ## remove builds, the virtual environment and the demo's output
	rm -rf build .venv out/demo dist .mypy_cache .ruff_cache .pytest_cache
