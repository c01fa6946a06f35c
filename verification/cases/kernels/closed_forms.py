"""Forms of the influence integrals: the textbook ones fail, the quadrature bound holds, closed values."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from refimpl.kernels import normal_integral, tangential_integral
from refimpl.kernels.cerruti import CERRUTI
from refimpl.kernels.love import LOVE
from refimpl.kernels.quadrature import ORDERS, across, relative_error_bound
from verification.cases.kernels.kernels import CERRUTI_SOURCE, LOVE_SOURCE
from verification.exact import kernel_reference as reference
from verification.exact.kernel_points import ASPECTS, FARTHEST
from verification.framework.case import Measured
from verification.framework.registry import case, family

Array = NDArray[np.float64]

EPS = float(np.finfo(np.float64).eps)


@family(
    "textbook, kernel, exact, author, symbol, source",
    {
        "kernels/textbook-normal-fails": (
            reference.textbook_normal, normal_integral, reference.normal, "Love", "1/rho", LOVE_SOURCE),
        "kernels/textbook-tangential-fails": (
            reference.textbook_tangential, tangential_integral, reference.tangential, "Cerruti", "s/rho^2",
            CERRUTI_SOURCE),
    },
    metric="at_least", tolerance=11.0,
)  # fmt: skip
def digits_lost(
    textbook: Callable[..., Array], kernel: Callable[..., Array], exact: Callable[..., Any]
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
        printed, made = textbook(x, y, 1.0, 1.0), kernel(x, y, 1.0, 1.0)
        errors["offset"].append(float(distance))
        errors["textbook"].append(float(np.median([*map(reference.relative_error, printed, true)])))
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
