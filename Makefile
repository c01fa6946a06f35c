# `make report` and `make test` are all that a fresh machine with Python 3.11 or newer needs.
PYTHON ?= python3
BIN := .venv/bin
READY := .venv/.stamp-ready
OUT := out
# One BLAS thread: the runner and pytest use their own processes.
export OMP_NUM_THREADS := 1
export OPENBLAS_NUM_THREADS := 1
# Bytecode is kept: a test that starts the program would compile it again.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: report results test lint setup clean nightly mutation site licences

report: $(READY)
	@mkdir -p $(OUT)
	@status=0; \
	$(BIN)/rough-friction verify --tier quick --json $(OUT)/results.json || status=$$?; \
	$(BIN)/rough-friction report --results $(OUT)/results.json --output $(OUT)/report; \
	exit $$status

# The committed results of cases: one run of the full tier, divided by the rows of reports/results/README.md, and one
# of the quick tier. The commands of the other files, which are no cases, stand there too. Cases that fail are results,
# and the status of `make`.
results: $(READY)
	@mkdir -p $(OUT)
	@rm -f $(OUT)/full.json; status=0; \
	$(BIN)/rough-friction verify --tier full --jobs 2 --json $(OUT)/full.json || status=$$?; \
	$(BIN)/python -m verification.framework.divided $(OUT)/full.json || exit $$?; \
	$(BIN)/rough-friction verify --tier quick --jobs 2 --json reports/results/quick.json || status=$$?; \
	$(BIN)/python -m verification.output.result_files reports/results/quick.json || status=$$?; \
	$(BIN)/python -m reports.results_page || status=$$?; \
	exit $$status

# Ruff and mypy beside the tests; the verdicts of both count.
test: $(READY)
	@$(MAKE) --no-print-directory lint & lint=$$!; \
	$(BIN)/python -m pytest -n 2 --dist worksteal; tests=$$?; \
	wait $$lint && exit $$tests

lint: $(READY)
	$(BIN)/ruff check .
	$(BIN)/mypy

# The tests that `make test` leaves out. Then hypothesis examples of the solver invariants: other ones every day,
# resumed when interrupted.
nightly: $(READY)
	@mkdir -p $(OUT)
	$(BIN)/python -m pytest -n 2 --dist worksteal -m nightly
	$(BIN)/python -m verification.properties --examples 10000 --seed $$(date +%Y%m%d) --json $(OUT)/hypothesis.json

# Small faults that the tests must notice, N of them drawn at random, in a copy of the committed tree.
N := 50
SEED := 1
mutation: $(READY)
	$(BIN)/python -m pip install -qq --disable-pip-version-check -c constraints.txt -e ".[mutation]"
	rm -rf $(OUT)/mutated && git clone -q . $(OUT)/mutated
	cd $(OUT)/mutated && export PATH="$(CURDIR)/$(BIN):$$PATH" && \
		cosmic-ray init tests/mutation.toml ../mutation.sqlite --force && \
		cr-filter-operators ../mutation.sqlite tests/mutation.toml && \
		python tests/mutation_sample.py ../mutation.sqlite $(N) $(SEED) && \
		cosmic-ray exec tests/mutation.toml ../mutation.sqlite && \
		cr-report --surviving-only --show-diff ../mutation.sqlite

# Pages with search, keys, options, functions, notebooks and the report of the committed results; a warning is an error.
site: $(READY)
	$(BIN)/python -m pip install -qq --disable-pip-version-check -c constraints.txt -e ".[docs]"
	rm -rf $(OUT)/pages
	$(BIN)/python -m nbconvert --execute --KernelManager.transport_encryption=required \
		--to markdown --output-dir $(OUT)/pages/docs/notebooks docs/notebooks/*.ipynb
	$(BIN)/rough-friction report --results reports/results/quick.json.gz --output $(OUT)/pages
	$(BIN)/python .ci/pages.py
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build

# Every installed package with its version and licence.
licences: $(READY)
	$(BIN)/python -m pip install -qq --disable-pip-version-check -c constraints.txt pip-licenses
	$(BIN)/pip-licenses --from=mixed --order=license

setup: $(READY)

$(READY): pyproject.toml constraints.txt
	test -d .venv || $(PYTHON) -m venv .venv
	$(BIN)/python -m pip install -qq --disable-pip-version-check -c constraints.txt pip setuptools
	$(BIN)/python -m pip install -qq --disable-pip-version-check \
		-c constraints.txt -e ".[instrument,rigorous,dev]"
	@touch $@

clean:
	rm -rf .venv $(OUT) build dist *.egg-info .pytest_cache .mypy_cache .ruff_cache .hypothesis
