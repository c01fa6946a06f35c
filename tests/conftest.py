"""Settings of all tests, and runs in a random order.

``pytest --order-seed=3`` shuffles the files and the tests within each, and seeds every hypothesis search
with 3, derandomised or not; ``--order-share=0.3`` takes each test with that probability, so that any subset
is tried as well. pytest-randomly shuffles as well, but in every run where it is installed, and it leaves
derandomised searches as they are.
"""

from __future__ import annotations

import importlib
import random
from collections import defaultdict
from contextlib import suppress
from pathlib import Path

import hypothesis
import pytest
from _pytest.approx import ApproxScalar

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


def pytest_configure(config: pytest.Config) -> None:
    config.pluginmanager.register(ImportedOnce(config.rootpath))


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
