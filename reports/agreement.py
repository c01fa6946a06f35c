"""Every number that the paper prints and we compute: both, the difference E, and its uncertainty u.

In terms of ASME V&V 20, E is the comparison error of a replication; no experiment enters. u, at 95 %, holds
the sampling of the paper's random surfaces and of ours, the rounding of the printed number, and that of the
printed inputs (case reproduction/input-rounding). |E| > u is a discrepancy.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from reports.findings import number
from reports.results import OTHER_SHAPE, Case
from verification.reproduction.printed import (
    AREA_FLUCTUATION,
    CORRELATION_LENGTH,
    FLAT_RMS,
    FRICTION_FLUCTUATION,
    HERTZ_PRESSURE,
    HERTZ_RADIUS,
    LARGEST_SLOPE,
    LOWEST_FRICTION,
    QUOTED_SLOPES,
)

Cases = Mapping[str, Case]


SCATTER = "Section 8: scatter"
INPUTS = "reproduction/input-rounding"
ROUNDED = "input rounded in print"
"""The verdict on numbers that agree by the rounding of a printed input alone."""


@dataclass(frozen=True)
class Number:
    """A printed number and ours, both in ``unit``; ``half_width`` is the 95 % half width of ours over random
    surfaces, ``sampling`` that of the paper's, ``rounding`` half a unit of the last printed digit, ``inputs``
    the effect of as much of the printed inputs; ``rounded_radius`` is ours with R = 0.143 m.
    """

    part: str
    quantity: str
    label: str
    unit: str
    printed: float
    computed: float
    half_width: float
    rounding: float
    sampling: float = 0.0
    inputs: float = 0.0
    rounded_radius: float | None = None

    @property
    def difference(self) -> float:
        """E: computed less printed."""
        return self.computed - self.printed

    @property
    def uncertainty(self) -> float:
        """u, 95 %."""
        return math.hypot(self.half_width, self.sampling, self.rounding, self.inputs)

    @property
    def within(self) -> bool:
        """True where E is within u."""
        return abs(self.difference) <= self.uncertainty

    @property
    def by_inputs(self) -> bool:
        """True where E is within u by the rounding of printed inputs alone."""
        exact = math.hypot(self.half_width, self.sampling, self.rounding)
        return exact < abs(self.difference) <= self.uncertainty

    @property
    def reading(self) -> bool:
        """True for one of several readings of a number whose roughness the paper does not state."""
        return self.part == SCATTER

    @property
    def ratio(self) -> float:
        """Computed over printed."""
        return self.computed / self.printed


TABLE3 = (  # case, quantity, factor to the unit, unit; each is printed in tenths of its unit
    ("table3-mu", "μ, Table 3", 1.0, ""),
    ("table3-area", "A, Table 3", 1e6, "mm²"),
    ("table3-peak", "p_max, Table 3", 1e-9, "GPa"),
)
FINEST = 512  # elements per side of the paper's fine mesh

# lines longer than E501 allows: one printed number a line, as in a table
SINGLE = (  # part, quantity, label, unit, printed, half a unit, case, key, factor
    ("Table 1", "Hertz, R = 0.14 m", "contact radius a0", "mm", 1e3 * HERTZ_RADIUS, 5e-4, "hertz/radius-corrected", "value", 1e3),  # noqa: E501
    ("Table 1", "Hertz, R = 0.14 m", "peak pressure", "MPa", 1e-6 * HERTZ_PRESSURE, 0.05, "hertz/peak-pressure", "value", 1e-6),  # noqa: E501
    ("Fig. 4", "correlation radius", "autocorrelation 10 %", "µm", 1e6 * CORRELATION_LENGTH, 0.5, "reproduction/fig4-correlation", "radius (um)", 1.0),  # noqa: E501
    ("Fig. 4", "rms slope", "0.084 µm", "deg", QUOTED_SLOPES[FLAT_RMS[0]], 5e-4, "reproduction/fig4-slopes", "rms of a component (deg)#0", 1.0),  # noqa: E501
    ("Fig. 4", "rms slope", "1.680 µm", "deg", QUOTED_SLOPES[FLAT_RMS[1]], 5e-3, "reproduction/fig4-slopes", "rms of a component (deg)#1", 1.0),  # noqa: E501
    ("Fig. 4", "largest slope", "1.680 µm, mean of the largest", "deg", LARGEST_SLOPE, 0.05, "reproduction/largest-slope", "largest gradient (deg)", 1.0),  # noqa: E501
    ("Fig. 8", "τ/H + β, Eq. (11)", "arithmetic of the formula", "", LOWEST_FRICTION, 0.05, "reproduction/eq11", "Eq. (11)", 1.0),  # noqa: E501
    ("Fig. 8", "ψ(0.5 µm), Eq. (12)", "ε = 3.15 µm as printed", "", 1.0, 0.5, "reproduction/fig8-threshold", "psi at 0.5 um as printed", 1.0),  # noqa: E501
    *(
        (SCATTER, quantity, f"{rms} µm", "%", printed, 0.05, f"reproduction/{case}", f"{key}#{k}", 100.0)
        for quantity, printed, case, key in (
            ("scatter of A", 100 * AREA_FLUCTUATION, "section8-scatter", "scatter of A"),
            ("scatter of μ", 100 * FRICTION_FLUCTUATION, "section8-scatter", "scatter of mu"),
            ("scatter of μ, β = 0", 100 * AREA_FLUCTUATION, "section8-beta0", "scatter of mu"),
        )
        for k, rms in enumerate(("0.504", "1.008", "1.680"))
    ),
)  # fmt: skip
SURFACES = 75  # realisations of an ensemble, in the paper and here
FEWEST = 12  # realisations behind a mean of one surface's statistic here
ONE_SURFACE = {  # relative standard deviation between surfaces of Eq. (9): 75, on 128 and 256 elements a side
    "correlation radius": 0.072,
    "rms slope": 0.024,
    "largest slope": 0.080,
}


def numbers(cases: Cases) -> list[Number]:
    """Return the printed numbers that the cases hold, in the paper's order of parts."""
    found = [*_single(cases)]
    inputs = cases[INPUTS]["data"] if INPUTS in cases else {}
    for name, quantity, factor, unit in TABLE3:
        try:
            found += _table3(cases[f"reproduction/{name}"]["data"], quantity, factor, unit, inputs)
        except OTHER_SHAPE:
            continue
    return [n for n in found if n.printed > 0 and math.isfinite(n.computed) and n.computed > 0]


def _single(cases: Cases) -> Iterator[Number]:
    for part, quantity, label, unit, printed, rounding, case, key, factor in SINGLE:
        value = number(cases[case], key) if case in cases else None
        if value is not None:
            computed, (ours, papers) = value * factor, _sampling(quantity)
            half, sampling = 2 * ours * computed, 2 * papers * computed
            found = Number(part, quantity, label, unit, printed, computed, half, rounding, sampling)
            yield _of_inputs(found, *_smooth(quantity, label, cases))


SLOPES = {"0.084 µm": math.hypot(0.5 / 84, 0.5 / 104), "1.680 µm": math.hypot(0.5 / 1680, 0.5 / 104)}
"""Relative uncertainty of rms slopes, which go with sigma / l, by the last digits of both."""
HERTZ = {"contact radius a0": ("A", 0.5), "peak pressure": ("p_max", 1.0)}  # number, power of it


def _smooth(quantity: str, label: str, cases: Cases) -> tuple[float, float | None]:
    """Return relative effects of inputs and of R = 0.143 m on a number of smooth bodies, or a slope."""
    if quantity == "rms slope":
        return SLOPES[label], None
    if label not in HERTZ or INPUTS not in cases:
        return 0.0, None
    name, power = HERTZ[label]
    u, change = _effects(cases[INPUTS]["data"], name, 0.0)
    return power * u, None if change is None else (1 + change) ** power - 1


def _effects(inputs: Mapping[str, Any], name: str, sigma: float) -> tuple[float, float | None]:
    """Return relative effects of inputs and of R = 0.143 m in a column; none if not recorded."""
    roughness = inputs.get("sigma_e (um)", ())
    columns = [k for k, s in enumerate(roughness) if math.isclose(s, sigma, abs_tol=1e-3)]
    if not columns:
        return 0.0, None
    return inputs[f"{name}: u of inputs"][columns[0]], inputs[f"{name}: change at R = 0.143 m"][columns[0]]


def _of_inputs(found: Number, u: float, change: float | None) -> Number:
    at = None if change is None else found.computed * (1 + change)
    return replace(found, inputs=u * found.computed, rounded_radius=at)


def _sampling(quantity: str) -> tuple[float, float]:
    """Return the relative standard deviations of our number and of the paper's over random surfaces."""
    if quantity.startswith("scatter"):
        return (1 / math.sqrt(2 * (SURFACES - 1)),) * 2
    one = ONE_SURFACE.get(quantity, 0.0)
    return one / math.sqrt(FEWEST), one


def _table3(
    data: Mapping[str, Any], quantity: str, factor: float, unit: str, inputs: Mapping[str, Any]
) -> list[Number]:
    names = ("sigma_e (um)", "mesh", "printed", "ours", "half width 95 %")
    rows = zip(*(data[name] for name in names), strict=True)
    found, name = [], quantity.partition(",")[0].replace("μ", "mu")
    for sigma, mesh, printed, ours, half in rows:
        n = Number(
            "Table 3",
            quantity,
            f"{column_of(sigma)}, {mesh:.0f}²",
            unit,
            factor * printed,
            factor * ours,
            factor * half,
            _half_digit(factor * printed),
            sampling=factor * half,  # as many surfaces
        )
        found.append(_of_inputs(n, *_effects(inputs, name, sigma)))
    return found


BALL = 0.084
"""Rms roughness of the ball in the rough columns of Table 3 (um)."""


def column_of(sigma_e: float) -> str:
    """Return the name of Table 3's column: the half-space's rms roughness, of an equivalent one (um).

    >>> column_of(0.0), column_of(0.510952)
    ('smooth', '0.504 µm')
    """
    return f"{math.sqrt(sigma_e**2 - BALL**2):.3f} µm" if sigma_e > 0 else "smooth"


def _half_digit(value: float) -> float:
    """Return half a unit of Table 3's last digit: printed are tenths, with two decimals below 10, else one.

    >>> _half_digit(0.164), _half_digit(1.91)
    (0.0005, 0.005)
    """
    return 0.0005 if value < 1.0 else 0.005


def compared(found: Iterable[Number]) -> list[Number]:
    """Return all numbers, of Table 3 those on the fine mesh."""
    return [n for n in found if n.part != "Table 3" or n.label.endswith(f"{FINEST}²")]


def fine(found: Iterable[Number]) -> list[Number]:
    """Return Table 3's numbers on the fine mesh."""
    return [n for n in compared(found) if n.part == "Table 3"]


def by_quantity(found: Iterable[Number]) -> dict[str, list[Number]]:
    """Return the numbers by quantity, in order of first appearance; Table 3's on the fine mesh alone."""
    groups: dict[str, list[Number]] = {}
    for n in compared(found):
        groups.setdefault(n.quantity, []).append(n)
    return groups


def ratio_and_scatter(group: Sequence[Number]) -> tuple[float, float | None]:
    """Return the geometric mean and deviation of computed / printed; no deviation of one.

    >>> ratio_and_scatter([Number("", "", "", "", 1.0, value, 0.0, 0.0) for value in (2.0, 8.0)])
    (4.0, 2.665...)
    """
    logs = np.log([n.ratio for n in group])
    scatter = math.exp(np.std(logs, ddof=1)) if len(group) > 1 else None
    return float(np.round(math.exp(np.mean(logs)), 12)), scatter


def verdict_of(group: Sequence[Number]) -> str:
    """Return the verdict on a statement of these numbers: not confirmed where any has |E| > u. A number with
    several readings is confirmed with conditions where only some of them agree.
    """
    within = [n.within for n in group]
    if not within:
        return "not established"
    if all(within):
        return ROUNDED if any(n.by_inputs for n in group) else "confirmed"
    return "confirmed with conditions" if any(within) and group[0].reading else "not confirmed"


def printed(found: Iterable[Number]) -> dict[tuple[str, ...], bool]:
    """Return whether each printed number agrees within u, by quantity and place; readings are one number."""
    agree: dict[tuple[str, ...], bool] = {}
    for n in found:
        key = (n.quantity,) if n.reading else (n.part, n.quantity, n.label)
        agree[key] = agree.get(key, False) or n.within
    return agree


def as_cases(groups: Mapping[str, Sequence[Number]]) -> dict[str, dict[str, Any]]:
    """Return the numbers by quantity in the shape of cases, "numbers/QUANTITY" of findings."""
    return {
        f"numbers/{quantity}": {
            "data": {
                "computed": [n.computed for n in group],
                "u": [n.uncertainty for n in group],
                "numbers": len(group),
                "beyond u": sum(not n.within for n in group),
                "largest difference": max(abs(n.difference) / n.printed for n in group),
            }
        }
        for quantity, group in groups.items()
    }


def series(found: Sequence[Number]) -> dict[str, list[Any]]:
    """Return the columns of all numbers, for the figure and its CSV."""
    columns = {name: name for name in ("part", "quantity", "label", "unit", "printed", "computed")}
    columns |= {"uncertainty 95 %": "uncertainty", "computed / printed": "ratio"}
    return {column: [getattr(n, field) for n in found] for column, field in columns.items()}
