"""Settings of all tests."""

from __future__ import annotations

import gc
import importlib
import os
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

# One BLAS thread as in the Makefile: two round otherwise, and the dense solver misses 1e-12 by a half then.
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(name, "1")

PACKAGES = ("refimpl", "appendix_a", "verification", "reports")

# Python's garbage collector goes through all objects of the collected tests again and again: 15 % of the time
# of tests that parse or copy much. It runs less often here, and leaves out those objects.
gc.set_threshold(20_000)


def pytest_collection_finish() -> None:
    gc.freeze()


def pytest_configure(config: pytest.Config) -> None:
    config.pluginmanager.register(ImportedOnce(config.rootpath))


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


@pytest.fixture
def in_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sweeps without workers, whatever their command says: each would import everything again."""
    from verification.sweep import engine

    sweep = engine.sweep
    monkeypatch.setattr(engine, "sweep", lambda *given, **named: sweep(*given, **(named | {"workers": 0})))
