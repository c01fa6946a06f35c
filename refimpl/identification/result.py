"""Result of an identification: values with intervals, parts of the uncertainty, laws, warnings."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from refimpl.accuracy.digits import usable
from refimpl.grid import Array
from refimpl.identification.data_table import Row
from refimpl.identification.design import MAX_BORDER, Proposal
from refimpl.identification.fit import UNLIKELY, Fit
from refimpl.identification.forward import COVERAGE, Response
from refimpl.identification.laws import DECISIVE, Law
from refimpl.identification.profile import BOUNDED
from refimpl.solution.model_warning import Limit

WIDE = 0.2  # relative half-width of tau's interval from which the warning appears

OUTLIER = 3.0  # deviation from the fit to the other rows, in standard uncertainties
_SETTLED = 0.5  # standard uncertainties by which the last solves may differ from their prediction
_UNITS = (9.81, *(10.0**n for n in range(1, 7)), 25.4, 180 / math.pi)  # kgf, powers of ten, inches, degrees
_NEAR = 0.1  # relative, from such a factor: a wrong load changes the fit's mu as well
_LEAST, _FULL = 0.005, 0.99  # A/A0 at every load; a ball's contact of 0.005 is 0.08 of the side wide

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


def notes(result: Identification) -> tuple[str, ...]:
    """Return the warnings, the most important first."""
    responses = result.fitted.responses
    return (
        *_scale(responses),
        *_determined(result),
        *_further(result),
        *_settled(result),
        *_residuals(result),
        *_model(result),
        *_law(result),
        *_limits(responses),
    )


def _scale(responses: Sequence[Response]) -> Iterator[str]:
    """Yield warnings of loads out of the scene's scale: A/P of a ball, a power of P, shows no unit."""
    most = max(response.contact_fraction for response in responses)
    if most < _LEAST:
        yield (
            f"less than {100 * most:.1g} % of the domain is in contact at every load: loads are too small "
            "for the scene; check their unit (kN taken for N?), or take a smaller domain"
        )
    if all(one.border > MAX_BORDER or one.contact_fraction > _FULL for one in responses):
        yield (
            "contact fills the domain or reaches its border at every load: loads are too large for the "
            "scene; check their unit, or take a larger domain"
        )
    elif any(one.border > MAX_BORDER for one in responses):
        yield "contact reaches the domain's border: mu of a larger domain differs"


def _determined(result: Identification) -> Iterator[str]:
    tau, combination = result.values["tau"], result.combination
    if result.is_identified:
        return
    width = f"+-{100 * tau.relative:.0f} %" if math.isfinite(tau.relative) else "unbounded"
    text = (
        f"tau is not determined apart from beta (95 % interval {width}): A/P hardly changes; "
        f"the data determine {result.factor:.3g}/Pa tau + beta = {combination.value:.4g} "
        f"({combination.low:.4g} to {combination.high:.4g})"
    )
    if result.proposal is not None and result.proposal.widths[0] < tau.relative:
        loads = " and ".join(f"{load:.3g} N" for load in result.proposal.loads)
        text += f"; measure at {loads}: tau's interval falls to +-{100 * result.proposal.widths[0]:.0f} %"
    yield text + "; a curved surface changes A/P more than flat rough planes do"


def _further(result: Identification) -> Iterator[str]:
    for name, one in list(result.values.items())[BOUNDED:]:
        if not one.relative <= WIDE:
            yield (
                f"{name} is hardly determined (95 % interval {one.low:.3g} to {one.high:.3g}): mu changes "
                "little with it at the measured loads, or as it does with tau or beta"
            )


def _settled(result: Identification) -> Iterator[str]:
    fitted = result.fitted
    if fitted.limited or fitted.nonlinearity > _SETTLED:
        away = f"{fitted.nonlinearity:.1g} standard uncertainties"
        yield (
            f"the fit did not settle: the last solves differ by up to {away} from their prediction; take "
            "a finer grid or another first guess"
        )


def _residuals(result: Identification) -> Iterator[str]:
    if result.degrees and result.probability < UNLIKELY:
        yield (
            f"chi-square {result.chi_square:.3g} of {result.degrees} degrees of freedom has probability "
            f"{result.probability:.1g}: surfaces, law or uncertainties are wrong, intervals too short"
        )
    for k in result.outliers:
        load, deviation = result.rows[k].load, result.deleted[k]
        away = f"{deviation:+.1f} standard uncertainties"
        text = f"row {k + 1} ({load:.4g} N) is off by {away} from the fit to the other rows"
        if k == result.fitted.dropped:
            text += f", and dropped from it: {_off_by(result.rows[k].mu, result.fitted.predicted[k])}"
        yield text


def _off_by(mu: float, predicted: float) -> str:
    """Return how far a row is off, and whether units may be why."""
    if not mu * predicted > 0:
        return f"its mu is {mu:.3g}, the fit's {predicted:.3g}"
    factor = max(mu / predicted, predicted / mu)
    units = any(abs(factor / unit - 1) < _NEAR for unit in _UNITS)
    return f"its mu is {mu / predicted:.3g} times the fit's" + "; check its units" * units


def _model(result: Identification) -> Iterator[str]:
    responses, measured = result.fitted.responses, np.array([row.u_mu for row in result.rows])
    bars = np.array([math.hypot(r.numerical, r.contact_edge) / COVERAGE for r in responses])
    if (wide := int(np.sum(bars > measured))) > 0:
        yield f"error bars of the model exceed the data's uncertainty in {wide} rows: take a finer grid"
    blind = [k for k, one in enumerate(responses) if one.mu > 0 and not usable(one.numerical, one.mu)]
    if 0 < len(blind) < len(responses):
        named = ", ".join(f"{k + 1} ({result.rows[k].load:.4g} N)" for k in blind)
        yield f"the model's error bar exceeds half of mu in row {named}: check the units, or refine"
    if (most := max(response.plastic for response in responses)) > 0:
        yield f"up to {100 * most:.0f} % of the contact is at the hardness: A/P changes little there"


def _law(result: Identification) -> Iterator[str]:
    best = result.laws[0]
    linear = next(law for law in result.laws if law.name == "tau + beta f")
    if linear.aic - best.aic > DECISIVE:
        yield f"the law {best.name} describes the data better (AIC lower by {linear.aic - best.aic:.1f})"


def _limits(responses: Sequence[Response]) -> list[str]:
    """Return the solves' warnings, texts that differ in numbers once; no index beside contact at H."""
    kinds = {re.sub(r"[\d.]+", "", text): text for response in responses for text in response.warnings}
    plastic = any(response.plastic for response in responses)
    return [text for text in kinds.values() if not (plastic and text.startswith(Limit.PLASTICITY))]
