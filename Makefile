# `make demo` shows what Kinematify does, `make test` proves it; both set up .venv first.
# `make help` lists the rest.

SHELL := bash
.SHELLFLAGS := -o pipefail -c
# The first of these that runs.
FOUND := $(shell for v in 3.11 3.12 3.13; do python$$v -c '' 2> /dev/null && echo python$$v; done; true)
PYTHON ?= $(firstword $(FOUND) python3.11)
VENV := .venv
# Tests and demo start hundreds of processes: each would compile every module again.
unexport PYTHONDONTWRITEBYTECODE
IN_VENV := $(VENV)/bin/python -m
# Says which package it is at; modules are compiled when they are first used, which saves time and 100 MB.
install = $(IN_VENV) pip install --no-compile $(1) | sed -u -n 's/^Collecting \([^ ]*\).*/  \1/p'
JOBS ?= $(shell getconf _NPROCESSORS_ONLN)
# Test files or options for pytest, e.g. `make test ARGS="tests/test_cli.py -k infer"`.
ARGS ?=
# Commit or branch that `make check` compares with.
BASE ?= main
# What `make demo` builds.
export SENTENCE := a kitchen cabinet with two doors above three drawers, 80 cm wide
# Folder of URDFs to measure, or `pip` for the robots of a package; see `kinematify bench --help`.
DATA ?= pip

# torch goes first and exactly: left to the resolver, another build of several GB may be chosen.
TORCH := $(shell sed -n 's/.*"\(torch==[0-9.]*\)".*/\1/p' pyproject.toml)
# Named after the content of pyproject.toml: while that does not change there is nothing to do.
SUM := $(shell cksum < pyproject.toml | tr ' ' '-')
CORE := $(VENV)/.core-$(SUM)
STAMP := $(VENV)/.setup-$(SUM)
TOOK = echo "make $@ took $$(( $$(date +%s) - $(START) )) s"
START := $(shell date +%s)

.PHONY: help setup demo test goldens nightly-smoke check lint format types bench docs pictures clean
.DEFAULT_GOAL := help

help:
	@echo "make demo     one sentence -> URDF -> verdict, and its joints inferred again, in out/cabinet/"
	@echo "make test     run the tests (ARGS=... for pytest)"
	@echo "make goldens  compare what the code makes with the committed sample"
	@echo "make nightly-smoke  a night of two objects, and nights whose planted faults must show"
	@echo "make check    lint, types and the tests of the packages that differ from BASE=main; for every change"
	@echo "make lint     ruff: rules and format"
	@echo "make format   let ruff fix what it can"
	@echo "make types    mypy --strict"
	@echo "make bench    accuracy table beside the paper's (DATA=FOLDER or pip)"
	@echo "make docs     all pages with a search, and the reference of Python, in out/site/"
	@echo "make pictures redraw docs/demo.png, docs/gallery.md with its pictures and the moving one; takes minutes"
	@echo "make setup    create $(VENV) with everything; quick when nothing changed"
	@echo "make clean    remove what was built, but not $(VENV)"

setup: $(STAMP)

$(VENV)/bin/python:
	@command -v $(PYTHON) > /dev/null || { echo "There is no $(PYTHON) on the path. Kinematify needs Python 3.11, 3.12" \
	  "or 3.13: install one (Debian and Ubuntu: apt-get install python3 python3-venv) or name it:" \
	  "make setup PYTHON=/path/to/python3.11" >&2; exit 2; }
	@$(PYTHON) -c 'import sys; sys.exit(not (3, 11) <= sys.version_info < (3, 14))' || { echo "$(PYTHON) is" \
	  "$$($(PYTHON) --version), but Kinematify needs Python 3.11, 3.12 or 3.13:" \
	  "make setup PYTHON=$(firstword $(FOUND) /path/to/python3.11)" >&2; exit 2; }
	@echo "Creating $(VENV) with $$($(PYTHON) --version)"
	@$(PYTHON) -m venv $(VENV)

$(CORE): | $(VENV)/bin/python
	@[ -e $(STAMP) ] || { echo "Installing Kinematify into $(VENV): 0.9 GB, some minutes the first time" && \
	  $(call install,--editable . --config-settings editable_mode=compat); }
	@rm -f $(VENV)/.core-* && touch $@

$(STAMP): | $(VENV)/bin/python
	@echo "Installing Kinematify, all extras and what tests need into $(VENV): 3 GB, ten minutes the first time"
	@$(call install,$(TORCH))
	@$(call install,--editable '.[dev]' --config-settings editable_mode=compat)
	@rm -f $(VENV)/.setup-* && touch $@

demo: $(CORE)
	@echo "A sentence: $$SENTENCE"
	@$(IN_VENV) kinematify generate "$$SENTENCE" -o out/cabinet --infer --force
	@echo
	@echo "Look at  out/cabinet/preview.png       the cabinet at rest, and with every joint moved"
	@echo "    and  out/cabinet/validation.html   what was checked, in every engine, and what to do about each finding"
	@echo "    and  out/cabinet/model.urdf        what a simulator loads"
	@echo "Now try  $(VENV)/bin/kinematify view out/cabinet"
	@echo "    and  $(VENV)/bin/kinematify generate \"a quadruped with 3 joints per leg\" --seed 7 -o out/dog"
	@echo "    and  $(VENV)/bin/kinematify infer YOUR_FOLDER_OF_PARTS -o out/yours"
	@echo "    and  $(VENV)/bin/kinematify validate YOUR_ROBOT.urdf"
	@$(TOOK)

pictures: setup
	$(IN_VENV) kinematify generate "$$SENTENCE" -o out/cabinet --force --no-validation
	cp out/cabinet/preview.png docs/demo.png
	$(IN_VENV) tools.draw_gallery docs

test: setup
	OMP_NUM_THREADS=1 $(IN_VENV) pytest -n $(JOBS) --dist worksteal --durations=25 $(ARGS)
	@$(TOOK)

goldens: setup
	OMP_NUM_THREADS=1 $(IN_VENV) benchmarks.goldens check --sample --jobs $(JOBS)
	@$(TOOK)

nightly-smoke: setup
	$(IN_VENV) kinematify nightly --smoke
	$(IN_VENV) pytest -q tests/evaluation/test_nightly.py -k planted
	@$(TOOK)

check: lint types
	tests=$$($(IN_VENV) tools.affected_tests $(BASE)) && OMP_NUM_THREADS=1 $(IN_VENV) pytest -q -n $(JOBS) \
	  --dist worksteal tests/test_layering.py tests/test_imports.py $$tests

lint: setup
	$(IN_VENV) ruff check .
	$(IN_VENV) ruff format --check .

format: setup
	$(IN_VENV) ruff check --fix .
	$(IN_VENV) ruff format .

types: setup
	$(IN_VENV) mypy -p kinematify -p benchmarks -p tools

bench: setup
	$(IN_VENV) kinematify bench $(DATA) -o results

docs: setup
	@rm -rf out/pages && mkdir -p out/pages
	@cp -r README.md CONTRIBUTING.md CHANGELOG.md CITATION.cff LICENSE docs results configs examples out/pages/
	@printf 'search:\n  boost: 0.2\n' > out/pages/results/.meta.yml
	NO_MKDOCS_2_WARNING=1 $(IN_VENV) mkdocs build --quiet --strict
	@echo "Look at  out/site/index.html"

clean:
	rm -rf build dist out *.egg-info .mypy_cache .ruff_cache .pytest_cache .hypothesis
	find . -name __pycache__ -not -path './$(VENV)/*' -prune -exec rm -rf {} +
