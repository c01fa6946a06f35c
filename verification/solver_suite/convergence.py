"""Other discretisations (nodes, bilinear or Galerkin elements): judged by limit and order, not by equality.

Problems with a closed form p are posed on seven grids; a solver returns pressures f at the element centres
as ever. Edges, where any uniform grid errs with the root of its spacing, are weighted down: with ``w =
min(1, p / 0.6 max p)^4``, the load within is ``v = sum w f / sum w p`` and the field's error ``e = |w^1/2
(f - p)| / |w^1/2 p|``. The limit v0 of ``v0 + C h^q``, by least squares with the expected order q, is in
error by what no grid removes: ``|v0 - 1|`` makes the verdict. The order is the slope of ln e over ln h.
Expected is 2, and 1 for a cone with its logarithmic tip; below `NONE` of it there is no convergence, and
the finest grid's e is judged.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from refimpl.grid import Array
from verification.framework.case import Measured, Result
from verification.solver_suite.check import Check, Entrant, Judge
from verification.solver_suite.checks.periodic import STAR, ridge_load, ridge_pressures
from verification.solver_suite.checks.sliding import coupled_hertz
from verification.solver_suite.checks.smooth import cone, ellipse, hertz, load_at_approach, off_centre

GRIDS = (12, 16, 20, 26, 32, 40, 48)
"""Elements a side; even numbers, so that no centre lies on a cone's tip."""
LIMIT = 0.003
"""Largest error in the limit: element-wise pressures leave up to 0.0024, a modulus off by 1 % 0.0036."""
SHARE, NONE = 0.6, 0.3
"""Least order over the expected one, and none at all: element-wise pressures have 0.80 to 1.08."""
WRONG, SLOW = 1, 3
"""Exit statuses: a limit that is wrong or cannot be judged; right limits, one of them reached too slowly."""


def fitted_limit(h: Array, values: Array, order: int) -> float:
    """Return the constant of ``v0 + C h^order`` by least squares.

    >>> round(fitted_limit(np.array([1.0, 0.5, 0.25]), np.array([1.4, 1.1, 1.025]), 2), 9)
    1.0
    """
    v0, _ = np.linalg.lstsq(np.column_stack([h**0.0, h**order]), values)[0]
    return float(v0)


def slope(h: Array, errors: Array) -> float:
    """Return the least-squares order of errors.

    >>> round(slope(np.array([1.0, 0.5, 0.25]), np.array([0.16, 0.04, 0.01])), 9)
    2.0
    """
    return float(np.polyfit(np.log(h), np.log(np.maximum(errors, 1e-300)), 1)[0])


SPACINGS = 1 / np.array(GRIDS, dtype=np.float64)


def of_field(pose: Callable[[Entrant, int], tuple[Array, Array]], order: int = 2) -> Judge:
    """Return the judge of pressures on all grids, found and exact, with their expected order."""

    def judge(entrant: Entrant) -> Measured:
        pairs = [weighted(*pose(entrant, n)) for n in GRIDS]
        loads, errors = (np.array(numbers) for numbers in zip(*pairs, strict=True))
        limit, found = abs(fitted_limit(SPACINGS, loads, order) - 1), slope(SPACINGS, errors)
        if not found >= NONE * order:
            limit = max(limit, float(errors[-1]))
        note = f"order {found:.2f} of {order}; errors " + ", ".join(f"{e:.2g}" for e in errors)
        return Measured(
            limit, unit="relative", data={"order": found, "expected": order, "errors": errors}, note=note
        )

    return judge


def of_value(pose: Callable[[Entrant, int], float], exact: float) -> Judge:
    """Return the judge of a number on all grids, of order 2."""

    def judge(entrant: Entrant) -> Measured:
        values = np.array([pose(entrant, n) for n in GRIDS]) / exact
        note = "over the exact load: " + ", ".join(f"{v:.4f}" for v in values)
        limit = abs(fitted_limit(SPACINGS, values, 2) - 1)
        return Measured(limit, unit="relative", data={"values": values}, note=note)

    return judge


def weighted(found: Array, exact: Array) -> tuple[float, float]:
    """Return v and e of a field against the exact one."""
    w = np.minimum(1.0, exact / (0.6 * exact.max())) ** 4
    load = float((w * found).sum() / (w * exact).sum())
    return load, float(np.sqrt((w * (found - exact) ** 2).sum() / (w * exact**2).sum()))


def _check(slug: str, title: str, source: str, judge: Judge) -> Check:
    claim = f"{title}: on {GRIDS[0]} to {GRIDS[-1]} elements a side the answers tend to the closed form"
    reason = "element-wise pressures leave up to 0.0024, a modulus off by 1 % 0.0036 or more (measured)"
    return Check(f"other-{slug}", title, claim, source, LIMIT, reason, (), judge)


CASES = (
    _check("hertz", "Hertz under a load", "Hertz 1882; Johnson 1985, section 4.2", of_field(hertz)),
    _check("corner", "Hertz near a corner", "Johnson 1985, Eq. (3.39)", of_field(
        lambda entrant, n: off_centre(entrant, n, 0.17, -0.11))),
    _check("ellipse", "Elliptical Hertz contact", "Johnson 1985, section 4.2", of_field(ellipse)),
    _check("cone", "Cone under a load", "Sneddon 1965; Johnson 1985, section 5.2", of_field(cone, 1)),
    _check("wave", "Westergaard's wave under a load", "Johnson 1985, Eq. (13.7)", of_field(ridge_pressures)),
    _check("sliding", "Sliding where the state is Hertz'", "Gauss' law for s/rho^2", of_field(
        # tau is small: at 0.1 and 0.3 of the peak, elements at the edge alternate on some of the grids
        lambda entrant, n: coupled_hertz(entrant, n, 0.05))),
    _check("load", "Hertz at an approach: load", "Johnson 1985, Eq. (4.23)", of_value(load_at_approach, 1.0)),
    _check("wave-load", "Westergaard's wave at an approach", "Johnson 1985, Eq. (13.7)",
           of_value(ridge_load, 0.5 * STAR)),
)  # fmt: skip
"""Run by ``verify --solver ... --discretisation other`` in the place of the suite."""


def exit_status(results: Sequence[Result]) -> int:
    """Return 0 if a limit was judged, all those are right and all orders hold; else `WRONG`, `SLOW`."""
    statuses = [result.status for result in results]
    if "pass" not in statuses or "fail" in statuses or "error" in statuses:
        return WRONG
    return SLOW if slow(results) else 0


def slow(results: Sequence[Result]) -> list[str]:
    """Return the ids of the cases with a right limit whose order is below its least."""
    passed = [r for r in results if r.status == "pass" and "order" in r.data]
    return [r.id for r in passed if not _number(r, "order") >= SHARE * _number(r, "expected")]


def _number(result: Result, name: str) -> float:
    value = result.data[name]
    return float(value) if isinstance(value, int | float) else float("nan")
