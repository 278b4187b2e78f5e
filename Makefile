# Needs Python 3.11 or newer, make and git; everything else goes into .venv.

# The stamp has the digest of what the environment is made from and where it stands: a changed
# pyproject.toml or a moved folder means a fresh .venv (mujoco does not survive an upgrade in place).
READY := .venv/ready-$(shell (pwd; cat pyproject.toml) | cksum | cut -d ' ' -f 1)
PYTHONS := $(PYTHON) python3.13 python3.12 python3.11 python3

# Nothing of the shell's own Python reaches ours, and compiled components stay in the checkout.
# Python keeps what it compiles: many tests start processes, and each would compile gaitsim again.
unexport PYTHONPATH PYTHONHOME VIRTUAL_ENV PYTHONDONTWRITEBYTECODE
export GAITSIM_CACHE := $(CURDIR)/.cache/gaitsim

.PHONY: help setup run compiled test test-all archive check docs bench bench-page muscles walker clean
help:
	@sed -n 's/^\([a-z-]*\):.*## /make \1	/p' Makefile

setup: $(READY) ## create .venv with gaitsim and its development tools
run: $(READY) ## simulate the hopper of Geyer et al. (2003)
	.venv/bin/gaitsim run specs/hopping_geyer2003.yaml

check: $(READY) ## run ruff and mypy
	.venv/bin/ruff format --check .
	.venv/bin/ruff check .
	.venv/bin/mypy

# Neighbouring tests stay in one process, so that what a file shares is made once.
TESTS := .venv/bin/pytest -n 2 --dist worksteal

# Components are compiled once, by all cores, while mypy has one: tests then find them in the cache.
compiled: $(READY)
	@.venv/bin/gaitsim library check library

test: $(READY) ## run check and the fast tests, as required before a merge
	@$(MAKE) --no-print-directory --jobs 2 check compiled
	$(TESTS) -m "not slow"

test-all: check compiled .venv/docs-ready ## run check and all tests, including long simulations and killed searches, as required before a release
	$(TESTS)

archive: $(READY) ## run every model again and compare it with its record (a minute or two)
	.venv/bin/gaitsim archive check

docs: .venv/docs-ready ## build the documentation in site/ (a broken link is an error)
	NO_MKDOCS_2_WARNING=1 .venv/bin/mkdocs build --quiet

bench: $(READY) ## measure time per step, whole commands, growing models and workers (4 minutes)
	.venv/bin/python bench/bench.py $(BENCH)

bench-page: $(READY) ## run bench and write docs/benchmarks.md
	.venv/bin/python bench/bench.py --page docs/benchmarks.md

muscles: $(READY) ## tune the hopper with every muscle model and compare them (some minutes)
	.venv/bin/python bench/muscle_models.py

walker: $(READY) ## measure the walker: contact models, evaluations to a first walk, re-tuned variants (an hour)
	.venv/bin/python bench/walker.py

clean: ## remove .venv and all caches, but not results/
	rm -rf .venv .cache .mypy_cache .pytest_cache .ruff_cache bench/build site
	find gaitsim library tests bench specs docs -name __pycache__ -prune -exec rm -rf {} +

# The tools that build pages are a third of all files, and the fast tests need none of them.
.venv/docs-ready: $(READY)
	@$(INSTALL) --editable '.[docs]'
	@touch $@

# The stamp is written last. -qq leaves pip's errors visible. An active venv is asked for the
# interpreter behind it, as it may be the very .venv that is to be replaced. Modules that gaitsim
# imports are compiled by all cores afterwards; pip would compile all others too, on one core.
# Packages have some files that this Python cannot compile.
INSTALL := .venv/bin/python -m pip install -qq --disable-pip-version-check --no-compile
$(READY):
	@for name in $(PYTHONS); do \
	  python=$$("$$name" -c 'import sys, venv, ensurepip; assert sys.version_info >= (3, 11); print(sys._base_executable)' 2>/dev/null) && break; \
	done; \
	if [ -z "$$python" ]; then \
	  echo "gaitsim needs Python 3.11 or newer with its venv module; none of these is one: $(PYTHONS)." >&2; \
	  echo "Install one (Debian, Ubuntu: apt install python3 python3-venv), or name it: make PYTHON=/path/to/python3" >&2; \
	  exit 1; \
	fi; \
	echo "Making .venv with $$("$$python" --version), $$python (a minute or so)" >&2; \
	rm -rf .venv && "$$python" -m venv .venv
	@mkdir -p .cache && echo '*' > .cache/.gitignore
	@$(INSTALL) --editable '.[dev]'
	@.venv/bin/python -m compileall -q -q -j 0 -x '/(tests|pip|scipy|OpenGL|mypy)/' .venv/lib || :
	@touch $@
