"""Influence integrals over their whole range, judged by 50-digit values and by rigorous enclosures."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import product
from typing import Any

import mpmath as mp
import numpy as np

from refimpl.kernels import normal_integral, normal_table, tangential_integral, tangential_table
from verification.exact import kernel_reference as reference
from verification.exact.kernel_points import Point, awkward_points, boundary_points, random_points
from verification.framework.case import Measured
from verification.framework.registry import case, family

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
    """Largest error over groups of points; ``data`` has it group by group, with where and how many."""
    largest, where, count = {}, {}, {}
    for name, points in groups.items():
        errors = [(error(float(kernel(*point)), point), point) for point in points]
        (largest[name], where[name]), count[name] = max(errors), len(errors)
    data = {"group": list(groups), "worst": largest, "where (x, y, dx, dy)": where, "points": count}
    return Measured(value=max(largest.values()), data=data, note=f"{sum(count.values())} points")


def all_points() -> dict[str, Iterable[Point]]:
    """Points at which both integrals are judged."""
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
    """A smaller set, in the first quadrant and off the axis, as the enclosures ask."""
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
