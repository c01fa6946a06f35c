"""Kernels: offsets from nothing to 1e15 elements, aspects 1e-6 ... 1e6, lengths whose squares underflow."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from refimpl.kernels import normal_integral, tangential_integral
from verification.exact import kernel_reference as reference
from verification.stress_tests.judge import tested
from verification.stress_tests.state import Extreme, Judged, number

LIMIT = 1e-13
"""The relative error promised by `refimpl.kernels`."""
OFFSETS = (0.0, 5e-324, 1e-300, 1e-15, 1e-6, 0.25, 0.5, 1.0, 2.5, 3.0, 1e2, 1e4, 1e6, 1e9, 1e12, 1e15)
ASPECTS = [10.0**k for k in (-6, -5, -4, -3, 3, 4, 5, 6)]
LENGTHS = [2.0**k for k in (-1000, -600, -500, -300, 300, 500, 600, 1000)]
INTEGRALS: dict[str, tuple[Callable[..., Any], Callable[..., Any]]] = {
    "normal": (normal_integral, reference.normal),
    "tangential": (tangential_integral, reference.tangential),
}


def against_digits(kind: str, x: float, y: float, dx: float, dy: float) -> Judged:
    """Judge one value against 50 digits; at x = 0 the tangential one is zero exactly."""
    integral, exact = INTEGRALS[kind]
    value = float(tested(integral, x, y, dx, dy))
    expected = exact(x, y, dx, dy)
    if expected == 0:
        return number(abs(value), 0.0, "value", "zero by symmetry")
    # a subnormal result holds its absolute digits only: that is what doubles are
    error = float(abs(value - expected) / max(abs(expected), sys.float_info.min))
    return number(error, LIMIT, "value", "50-digit corner sums")


def kernels() -> Iterator[Extreme]:
    """Yield points along the axis, off it, near the odd kernel's zero; thin elements; extreme units."""
    for kind in INTEGRALS:
        for x in OFFSETS:
            for direction, y in (("on the axis", 0.0), ("off the axis", 0.75)):
                run = partial(against_digits, kind, x, y, 1.0, 1.0)
                yield Extreme(f"{kind} {direction}", f"{x:g} elements", x, run)
        for aspect in ASPECTS:
            for x in (0.25, 2.0, 50.0):
                run = partial(against_digits, kind, x, 0.3 * aspect, 1.0, aspect)
                yield Extreme(f"{kind}, thin element", f"dy/dx = {aspect:.0e}, x = {x:g}", aspect, run)
        for length in LENGTHS:
            run = partial(against_digits, kind, 1.5 * length, 0.25 * length, length, length)
            yield Extreme(f"{kind}, length", f"{length:.1e} m", length, run)
