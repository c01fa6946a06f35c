"""A throw-away package of cases, for the registry and the runner."""

from __future__ import annotations

import itertools
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from verification.framework import registry

HEAD = """
import os, time
import numpy as np
from verification.framework.case import Measured, Unavailable
from verification.framework.registry import case, family
from functools import partial
case = partial(case, title="t", claim="c", source="s", tolerance_reason="exact")
"""

_numbers = itertools.count()

Make = Callable[..., str]


@pytest.fixture
def make_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Make]:
    """Function that writes modules given as name=source into a new package and returns the package's name."""
    monkeypatch.setattr(registry, "_declared", dict(registry._declared))
    monkeypatch.syspath_prepend(tmp_path)
    made: list[str] = []

    def make(**modules: str) -> str:
        name = f"sample_cases_{next(_numbers)}"
        made.append(name)
        (tmp_path / name).mkdir()
        (tmp_path / name / "__init__.py").touch()
        for module, source in modules.items():
            (tmp_path / name / f"{module}.py").write_text(HEAD + source)
        return name

    yield make
    for name in [m for m in sys.modules if m.split(".")[0] in made]:
        del sys.modules[name]
