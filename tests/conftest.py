"""Runs in a random order, with a log that shows whether any test flips.

``pytest --order-seed=3`` shuffles the files and the tests within each, and seeds every hypothesis search
with 3, derandomised or not; ``--order-share=0.3`` takes each test with that probability, so that any subset
is tried as well; ``--order-log=FILE`` adds the run to a JSON log. (With its equals sign: a file
that exists and stands alone is taken for tests, and then these options are unknown.) pytest-randomly
shuffles as well, but in every run where it is installed, and it leaves derandomised searches as they are.
"""

from __future__ import annotations

import hashlib
import importlib
import json
import random
import time
from collections import defaultdict
from contextlib import suppress
from pathlib import Path

import hypothesis
import pytest
from _pytest.approx import ApproxScalar

from reports.result_files import read_result
from verification.framework.files import write_result
from verification.framework.provenance import provenance

# A property holds or does not, however busy the machine is: the limit of 200 ms for one example failed
# tests at random under load.
hypothesis.settings.register_profile("unhurried", hypothesis.settings(), deadline=None)
hypothesis.settings.load_profile("unhurried")

# `pytest.approx` allows 1e-12 beside every relative tolerance: in SI units lengths, areas and compliances are
# that small, and compared to nothing. A number that should be zero states its own tolerance, by ``abs``.
ApproxScalar.DEFAULT_ABSOLUTE_TOLERANCE = 0.0

PACKAGES = ("refimpl", "appendix_a", "verification", "reports")


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("random order")
    group.addoption("--order-seed", type=int, help="shuffle tests, and seed hypothesis, with this number")
    group.addoption("--order-share", type=float, default=1.0, help="take this share of the tests, at random")
    group.addoption("--order-log", type=Path, help="JSON log to add the run to")


def pytest_configure(config: pytest.Config) -> None:
    config.pluginmanager.register(ImportedOnce(config.rootpath))
    if config.getoption("--order-log"):
        config.pluginmanager.register(Log(config))


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    seed = config.getoption("--order-seed")
    if seed is None:
        return
    chance, files = random.Random(seed), defaultdict(list)
    share = config.getoption("--order-share")
    for item in items:
        if chance.random() >= share:
            continue
        files[item.path].append(item)
        test = getattr(item, "obj", None)
        if test is not None and hypothesis.is_hypothesis_test(test):
            hypothesis.seed(seed)(test)
    shuffled = list(files.values())
    chance.shuffle(shuffled)
    for tests in shuffled:
        chance.shuffle(tests)
    items[:] = [item for tests in shuffled for item in tests]


@pytest.fixture
def order_seed(request: pytest.FixtureRequest) -> int | None:
    """The run's ``--order-seed``, for searches that are not declared with ``given``."""
    return request.config.getoption("--order-seed")


class ImportedOnce:
    """Imports a module by its name before its doctests are collected.

    pytest would import its package first, which may import the module, and then the module again: two classes
    of one name, and tests of the one fail on the other. A plugin of its own, as hooks of this file are for
    ``tests/`` alone.
    """

    def __init__(self, root: Path) -> None:
        self.root = root

    def pytest_collect_file(self, file_path: Path) -> None:
        inside = file_path.relative_to(self.root) if file_path.is_relative_to(self.root) else Path()
        if inside.suffix == ".py" and inside.parts[0] in PACKAGES and inside.name != "__main__.py":
            with suppress(Exception):  # the import for the doctests reports it
                importlib.import_module(".".join(inside.with_suffix("").parts).removesuffix(".__init__"))


class Log:
    """Outcome of every test, summed up when the session ends."""

    def __init__(self, config: pytest.Config) -> None:
        self.config, self.begun = config, time.process_time()
        self.order: list[str] = []
        self.outcomes: dict[str, str] = {}

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.when == "call" or report.outcome != "passed":
            self.order.append(report.nodeid)
            self.outcomes[report.nodeid] = report.outcome

    def pytest_sessionfinish(self) -> None:
        if hasattr(self.config, "workerinput"):  # the controller of several processes has all reports
            return
        path = self.config.getoption("--order-log")
        runs = read_result(path)["runs"] if path.exists() else []
        run = {
            "seed": self.config.getoption("--order-seed"),
            "share": self.config.getoption("--order-share"),
            "tests": len(self.outcomes),
            "not_passed": {name: end for name, end in sorted(self.outcomes.items()) if end != "passed"},
            "outcomes_sha256": _digest(sorted(self.outcomes.items())),
            "order_sha256": _digest(self.order),
            "processor_seconds": round(time.process_time() - self.begun, 1),
            "provenance": provenance(),
        }
        runs.append(run)
        whole = {run["outcomes_sha256"] for run in runs if run.get("share", 1) == 1}
        same = len(whole) <= 1 and all(end == "skipped" for run in runs for end in run["not_passed"].values())
        write_result({"no_test_flips": same, "runs": runs}, path)


def _digest(value: object) -> str:
    return hashlib.sha256(json.dumps(value).encode()).hexdigest()
