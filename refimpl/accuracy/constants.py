"""Fitted constants of the error bars and of the edge rule: data, made by `verification.coverage.fit`."""

from __future__ import annotations

import json
from functools import cache
from importlib import resources
from typing import Any

import numpy as np

from refimpl.grid import Array


@cache
def _constants() -> dict[str, dict[str, Any]]:
    text = resources.files("refimpl.data").joinpath("error_bars.json").read_text(encoding="utf-8")
    constants: dict[str, dict[str, Any]] = json.loads(text)["constants"]
    return constants


def constant(name: str) -> float:
    """Return the fitted constant of that name."""
    return float(_constants()[name]["value"])


def table(name: str) -> Array:
    """Return the fitted constants of that name, an array."""
    return np.array(_constants()[name]["value"])
