"""Influence integrals against 50-digit values, rigorous enclosures and closed values; textbook forms fail."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import product
from typing import Any

import mpmath as mp
import numpy as np

from refimpl.grid import Array
from refimpl.kernels import normal_integral, normal_table, tangential_integral, tangential_table
from refimpl.kernels.cerruti import CERRUTI
from refimpl.kernels.love import LOVE
from refimpl.kernels.quadrature import ORDERS, across, relative_error_bound
from verification.cases import Measured, case, family
from verification.exact import kernel_reference as reference
from verification.exact import textbook
from verification.exact.kernel_points import (
    ASPECTS,
    FARTHEST,
    Point,
    awkward_points,
    boundary_points,
    random_points,
)

LOVE_SOURCE = "Love 1929; Johnson 1985, Eq. (3.25); paper section 3"
CERRUTI_SOURCE = "Cerruti 1882; Johnson 1985, section 3.6; paper section 3"
TOLERANCE = 1e-14
REASON = (
    "ten times below the required 1e-13. Closed form: at most q_x + q_y + 2 = 14 times the rounding of one "
    "edge, about 5 eps/2, or 8e-15; quadrature: 1e-15 by its bound, and as much rounding. Measured 2e-15"
)


def worst(
    kernel: Callable[..., Any], error: Callable[[float, Point], float], groups: dict[str, Iterable[Point]]
) -> Measured:
    """Return the largest error over groups of points; ``data`` has it group by group."""
    errors = {name: [error(float(kernel(*p)), p) for p in points] for name, points in groups.items()}
    largest = {name: max(found) for name, found in errors.items()}
    note = f"{sum(map(len, errors.values()))} points"
    return Measured(value=max(largest.values()), data={"worst": largest}, note=note)


def all_points() -> dict[str, Iterable[Point]]:
    """Return the points at which both integrals are judged."""
    return {
        "random": random_points(seed=2001, count=800),
        "centre, edges, corners, far ends": awkward_points(),
        "changes of formula, both sides": boundary_points(),
    }


@family(
    "kernel, exact, name, symbol, extent, source",
    {
        "kernels/normal-50-digits": (
            normal_integral, reference.normal, "Normal", "I[1/rho]",
            " and aspects 1e-3 ... 1e3", LOVE_SOURCE),
        "kernels/tangential-50-digits": (
            tangential_integral, reference.tangential, "Tangential", "I[s/rho^2]",
            ", aspects 1e-3 ... 1e3, and close to its zero at x = 0", CERRUTI_SOURCE),
    },
    metric="at_most", tolerance=TOLERANCE,
)  # fmt: skip
def accuracy(kernel: Callable[..., Any], exact: Callable[..., Any]) -> Measured:
    """{name} influence integral against 50-digit values.

    Claim: {symbol} has a relative error below 1e-14 for offsets 0 ... 1e6 elements{extent}
    Tolerance: {REASON}
    """
    return worst(kernel, lambda value, p: reference.relative_error(value, exact(*p)), all_points())


def enclosed_points() -> dict[str, Iterable[Point]]:
    """Return a smaller set, in the first quadrant and off the axis, as the enclosures ask."""
    random = [(abs(x), abs(y), dx, dy) for x, y, dx, dy in random_points(seed=2002, count=120) if x != 0]
    return {"random": random, "centre, edges, corners": [p for p in awkward_points() if 1e-8 < p[0] < 3][::4]}


@family(
    "kernel, ball, name, symbol, printed",
    {
        "kernels/normal-enclosed": (
            normal_integral, reference.normal_enclosure, "Normal", "I[1/rho]", LOVE_SOURCE),
        "kernels/tangential-enclosed": (
            tangential_integral, reference.tangential_enclosure, "Tangential", "I[s/rho^2]", CERRUTI_SOURCE),
    },
    metric="at_most", tolerance=TOLERANCE,
)  # fmt: skip
def enclosed(kernel: Callable[..., Any], ball: Callable[..., Any]) -> Measured:
    """{name} influence integral against rigorous enclosures.

    Claim: {symbol} is within 1e-14 of every number in a ball proved to contain the exact integral
    Source: {printed}; Johansson 2017 (ball arithmetic)
    Tolerance: {REASON}
    """
    return worst(kernel, lambda value, p: reference.relative_distance(value, ball(*p)), enclosed_points())


@case("kernels/references-agree", metric="at_most", tolerance=1e-17)
def references_agree() -> Measured:
    """The 50-digit values against values without any antiderivative.

    Claim: corner sums and the Gaussian-transform integrals agree to 17 digits, for both kernels
    Source: 1/rho = 2/sqrt(pi) int exp(-rho^2 u^2) du
    Tolerance: the trapezoidal rule is run for 20 digits; its bound has a constant that is not kept
    """
    points: tuple[Point, ...] = (
        (0.3, 0.2, 1.0, 1.0),
        (1e-5, 0.7, 1.0, 1e-3),
        (3e3, 2.0, 1.0, 1e-2),
        (5.0, 0.0, 1.0, 1e3),
    )
    with mp.workdps(reference.DIGITS):
        normal = [abs(reference.normal_by_transform(*p) / reference.normal(*p) - 1) for p in points]
        tangential = [
            abs(reference.tangential_by_transform(*p) / reference.tangential(*p) - 1) for p in points
        ]
    errors = {"normal": [float(e) for e in normal], "tangential": [float(e) for e in tangential]}
    return Measured(value=max(*errors["normal"], *errors["tangential"]), data={"points": points, **errors})


@case("kernels/tables-50-digits", metric="at_most", tolerance=TOLERANCE)
def table_accuracy() -> Measured:
    """Tables for the convolution against 50-digit values.

    Claim: sampled entries of 1024-wide tables, for square and oblong elements, err by less than 1e-14
    Source: {LOVE_SOURCE}; {CERRUTI_SOURCE}
    Tolerance: {REASON}
    """
    rng = np.random.default_rng(2003)
    n, m, dx = 1024, 600, 2.0**-20
    far = np.column_stack([rng.integers(0, n, 60), rng.integers(0, m, 60)])
    indices = [*product((0, 1, 2, 3, 4, 8, 9), repeat=2), *map(tuple, far.tolist())]
    errors: dict[str, float] = {}
    for aspect in (1.0, 1 / 3, 1e3):
        dy = float(aspect * dx)
        normal, tangential = normal_table(n, m, dx, dy), tangential_table(n, m, dx, dy)
        for name, table, exact in (
            ("normal", normal, reference.normal),
            ("tangential", tangential, reference.tangential),
        ):
            # The offset i dx is exact here, j dy to half an eps: a relative error of that size or less.
            errors[f"{name}, dy/dx = {aspect:.4g}"] = max(
                reference.relative_error(table[i, j], exact(i * dx, j * dy, dx, dy)) for i, j in indices
            )
    return Measured(value=max(errors.values()), data=errors, note=f"{len(indices)} entries of each")


EPS = float(np.finfo(np.float64).eps)


@family(
    "printed, kernel, exact, author, symbol, source",
    {
        "kernels/textbook-normal-fails": (
            textbook.normal, normal_integral, reference.normal, "Love", "1/rho", LOVE_SOURCE),
        "kernels/textbook-tangential-fails": (
            textbook.tangential, tangential_integral, reference.tangential, "Cerruti", "s/rho^2",
            CERRUTI_SOURCE),
    },
    metric="at_least", tolerance=11.0,
)  # fmt: skip
def digits_lost(
    printed: Callable[..., Array], kernel: Callable[..., Array], exact: Callable[..., Any]
) -> Measured:
    """{author}'s corner sum loses its digits far from the load.

    Claim: at 1e6 elements the textbook form of I[{symbol}] has lost at least 11 of a double's 16 digits
    Tolerance: terms of about n rounded to eps, a sum of about 1/n: n^2 eps, 12 digits; 1 for spread

    The value is log10(error / eps), the median over directions; data by distance.
    """
    distances = np.logspace(0, np.log10(FARTHEST), 13)
    tangents = np.linspace(0, 1, 9)
    errors: dict[str, list[float]] = {"offset": [], "textbook": [], "production": []}
    for distance in np.round(distances):
        x, y = np.full(tangents.shape, distance), np.round(distance * tangents)
        true = [exact(a, b, 1.0, 1.0) for a, b in zip(x.tolist(), y.tolist(), strict=True)]
        summed, made = printed(x, y, 1.0, 1.0), kernel(x, y, 1.0, 1.0)
        errors["offset"].append(float(distance))
        errors["textbook"].append(float(np.median([*map(reference.relative_error, summed, true)])))
        errors["production"].append(max(map(reference.relative_error, made, true)))
    lost = float(np.log10(errors["textbook"][-1] / EPS))
    printed_error, made_error = errors["textbook"][-1], errors["production"][-1]
    note = f"error at 1e6 elements: textbook {printed_error:.1e}, production {made_error:.1e}"
    return Measured(value=lost, unit="digits", data=errors, note=note)


@case("kernels/quadrature-bound", metric="at_most", tolerance=1.0)
def quadrature_bound() -> Measured:
    """The error bound that chooses the quadrature order holds.

    Claim: truncation errors of 2 ... 9 points stay below the Bernstein-ellipse bound wherever tried
    Source: refimpl/kernels/quadrature.py; Trefethen 2008 for the method
    Tolerance: error over bound; a bound is a bound
    """
    ratios: dict[str, float] = {}
    kernels = (("normal", LOVE, reference.normal), ("tangential", CERRUTI, reference.tangential))
    for order, q, aspect, other in product(ORDERS, (2.0, 3.0, 6.0, 20.0, 100.0), ASPECTS, (1e-3, 0.5, 3.0)):
        bound = relative_error_bound(order, q)
        if not 1e-11 < bound < 1:  # below, rounding would be judged; above, nothing
            continue
        offset, beside = q / 2, other * aspect
        for name, kernel, exact in kernels:
            over_x = across(kernel.over_x, np.array(offset), np.array(beside), 1.0, aspect, order)
            over_y = across(kernel.over_y, np.array(offset), np.array(beside), 1.0, aspect, order)
            error = max(
                reference.relative_error(float(over_x), exact(offset, beside, 1.0, aspect)),
                reference.relative_error(float(over_y), exact(beside, offset, aspect, 1.0)),
            )
            key = f"{name}, {order} points"
            ratios[key] = max(ratios.get(key, 0.0), error / bound)
    return Measured(
        value=max(ratios.values()), data=ratios, note="largest error over bound, by kernel and order"
    )


@case("kernels/love-at-centre", metric="relative", tolerance=4 * EPS)
def love_at_centre() -> Measured:
    """Deflection at the centre of a uniformly loaded square.

    Claim: I[1/rho] at the centre of a unit square is 4 ln(1 + sqrt 2)
    Source: Love 1929; Johnson 1985, Eq. (3.26)
    Tolerance: four equal terms of a few roundings each
    """
    return Measured(
        value=float(normal_integral(0.0, 0.0, 1.0, 1.0)),
        reference=3.525494348078172,  # 4 ln(1 + sqrt 2) = 3.52549434807817210093...
        reference_uncertainty=2.3e-16,
        note="a side of unit length",
    )


@case("kernels/cerruti-at-edge", metric="relative", tolerance=4 * EPS)
def cerruti_at_edge() -> Measured:
    """Deflection at the edge of a uniformly sheared square.

    Claim: I[s/rho^2] at the middle of the leading edge of a unit square is ln(5)/2 + 2 atan(1/2)
    Source: integral of 2 atan(1 / 2s) over 0 < s < 1, by parts
    Tolerance: four terms of a few roundings each
    """
    return Measured(
        value=float(tangential_integral(0.5, 0.0, 1.0, 1.0)),
        reference=1.7320141742186624,  # ... = 1.732014174218662420...
        reference_uncertainty=2.3e-16,
    )
