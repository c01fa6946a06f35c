"""Result of an identification: values with intervals, parts of the uncertainty, predictions, laws."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from refimpl.grid import Array
from refimpl.identification.data_table import Row
from refimpl.identification.design import Proposal
from refimpl.identification.fit import Fit
from refimpl.identification.laws import Law

WIDE = 0.2  # relative half-width of tau's interval from which the warning appears

OUTLIER = 3.0  # deviation from the fit to the other rows, in standard uncertainties

MEGA = 1e6


def scaled(name: str) -> tuple[str, float]:
    """Label with a unit at the object's scale, and the unit.

    >>> scaled("lower.material.hardness")
    ('lower.material.hardness (MPa)', 1000000.0)
    """
    return (f"{name} (MPa)", MEGA) if name == "tau" or name.endswith("hardness") else (name, 1.0)


@dataclass(frozen=True)
class Interval:
    """A value and its 95 % interval."""

    value: float
    low: float
    high: float

    @property
    def relative(self) -> float:
        """Half of the interval over the value; infinite for a value of zero."""
        return 0.5 * (self.high - self.low) / self.value if self.value > 0 else math.inf


@dataclass(frozen=True)
class Prediction:
    """Predicted mu at a load (N), with its 95 % interval."""

    load: float
    mu: Interval


@dataclass(frozen=True, eq=False, repr=False)
class Identification:
    """Result of `identify`.

    values : "tau" (Pa), "beta" and further fitted parameters (SI) with their intervals
    covariance : of these, in their order, without bounds
    shares : standard uncertainties of these by source
    method : "ellipse", or "profile likelihood" where a bound cuts the interval
    combination : ``k tau + beta``, what the data determine best; ``factor`` is k (1/Pa), near A / P
    predictions : at the measured loads, then at the new ones
    chi_square, degrees, probability : of the residuals; ``residuals`` in standard uncertainties
    deleted : each row's deviation from the fit to the others, in standard uncertainties
    laws : compared by AIC; proposal : further loads, where tau is not determined
    solves, passes : forward solves, and how often all rows were linearised
    """

    rows: tuple[Row, ...]
    values: Mapping[str, Interval]
    covariance: Array
    shares: Mapping[str, tuple[float, ...]]
    method: str
    factor: float
    combination: Interval
    residuals: tuple[float, ...]
    deleted: tuple[float, ...]
    chi_square: float
    degrees: int
    probability: float
    laws: tuple[Law, ...]
    passes: int
    fitted: Fit = field(repr=False)
    predictions: tuple[Prediction, ...] = ()
    proposal: Proposal | None = None
    warnings: tuple[str, ...] = ()
    solves: int = 0

    def __repr__(self) -> str:
        rows = [(*scaled(name), one) for name, one in self.values.items()]
        rows.append((f"{self.factor * MEGA:.3g} tau/MPa + beta", 1.0, self.combination))
        wide = max(len(label) for label, _, _ in rows)
        cells = ((label, one.value / unit, one.low / unit, one.high / unit) for label, unit, one in rows)
        lines = [
            f"{label:<{wide}}  {value:.4g}  ({low:.4g} to {high:.4g})" for label, value, low, high in cells
        ]
        lines += [f"load {p.load:.4g} N: mu {p.mu.value:.4g} ({p.mu.low:.4g} to {p.mu.high:.4g})"
                  for p in self.predictions]  # fmt: skip
        lines.append(f"chi-square {self.chi_square:.3g} of {self.degrees}; 95 % intervals by {self.method}")
        return "\n".join(lines + [f"warning: {text}" for text in self.warnings])

    @property
    def outliers(self) -> tuple[int, ...]:
        """Indices of rows far from the fit to the others."""
        return tuple(k for k, deviation in enumerate(self.deleted) if abs(deviation) > OUTLIER)

    @property
    def is_identified(self) -> bool:
        """False where tau's interval is too wide to be used apart from beta's."""
        return self.values["tau"].relative <= WIDE
