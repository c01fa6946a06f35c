"""Comparison of predictions with measurements, after ASME V&V 20 (2009); every U is a half-width of 95 %.

E = S - D is predicted less measured, U_val^2 = U_num^2 + U_input^2 + U_D^2. |E| <= U_val: the model's error
is not larger than what is unknown of solver, inputs and measurement together.
"""

from __future__ import annotations

import math
import tomllib
from dataclasses import asdict, dataclass
from importlib import resources
from typing import Any

import numpy as np
from scipy.stats import t as student

NAMES = ("tungsten", "rubber", "film", "mica")
"""The experiments, in the order of the report."""


@dataclass(frozen=True)
class Point:
    """One measured number beside its prediction, in the experiment's unit."""

    at: float | str
    measured: float
    measured_half_width: float
    predicted: float
    numerical: float
    input: float

    @property
    def error(self) -> float:
        """E = S - D."""
        return self.predicted - self.measured

    @property
    def uncertainty(self) -> float:
        """U_val."""
        return math.hypot(self.numerical, self.input, self.measured_half_width)

    @property
    def within(self) -> bool:
        """True where |E| <= U_val."""
        return abs(self.error) <= self.uncertainty

    def row(self) -> dict[str, Any]:
        """Return the point as a result file has it."""
        return {**asdict(self), "error": self.error, "uncertainty": self.uncertainty, "within": self.within}


def measured(name: str) -> dict[str, Any]:
    """Return the measured data of an experiment, with its texts, from ``measured/NAME.toml``."""
    file = resources.files("verification.experiments").joinpath(f"measured/{name}.toml")
    return tomllib.loads(file.read_text(encoding="utf-8"))


def mean(values: list[float]) -> tuple[float, float]:
    """Return the mean of repeated measurements and its half-width by Student's t at 95 %.

    >>> mean([1.0, 2.0, 3.0])
    (2.0, 2.484...)
    """
    spread = np.std(values, ddof=1) / math.sqrt(len(values))
    return float(np.mean(values)), float(student.ppf(0.975, len(values) - 1) * spread)


def repeated(increments: list[list[float]]) -> list[tuple[float, float]]:
    """Return mean and half-width at each load; an indentation that ends earlier lacks the last loads."""
    most = max(map(len, increments))
    return [mean([one[k] for one in increments if len(one) > k]) for k in range(most)]
