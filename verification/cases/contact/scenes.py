"""Scenes for the reference cases: a gap between two half-spaces of given moduli, pressed by the solver.

The gap is the upper body's surface; without friction both bodies are of one material, so that nothing
couples; with friction the upper body is (nearly) rigid and the lower one soft.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from verification.cases import Measured, certified
from verification.exact.sliding_plane import dundurs
from verification.framework.rates import fit_order

Gap = Callable[[Array, Array], Array]

SOFT = (1e9, 0.2)
"""E (Pa) and nu of the lower body where friction couples: Dundurs' constant 0.375 against a rigid body."""
RIGID = (1e21, 0.2)
MODULUS, COUPLING = dundurs(lower=SOFT, upper=RIGID)
"""E* (Pa) and d of the pair."""


def centres(side: float, M: int) -> tuple[Array, Array]:
    """Return the element centres from the middle of the square: x ``(M, 1)`` and y ``(1, M)`` (m)."""
    x = (np.arange(M) + 0.5) / M * side - side / 2
    return x[:, None], x[None, :]


def press(
    gap: Gap,
    side: float,
    M: int,
    *,
    load: float = 1.0,
    approach: float | None = None,
    friction: rf.Friction | None = None,
    direction: float = 0.0,
    periodic: bool = False,
    cycled: bool = False,
) -> rf.Solution:
    """Solve the gap (m) of ``(x, y)`` (m, from the middle) on ``M x M`` elements without slope terms.

    Without ``friction`` the two bodies share the reduced modulus `MODULUS` evenly. What ends badly raises
    RuntimeError, and without ``cycled`` what ends with an alternating edge of tau (`certified`).
    """
    surface = gap(*centres(side, M)) * np.ones((M, M))
    upper, lower = (RIGID, SOFT) if friction else ((2 * MODULUS, 0.0),) * 2
    scene = rf.Scene(
        upper=rf.Body(rf.Material(*upper), surface),
        lower=rf.Body(rf.Material(*lower), rf.Flat()),
        friction=friction or rf.Friction(),
        load=load,
        side=side,
        sliding_direction=direction,
        periodic=periodic,
    )
    return certified(rf.solve(scene, grid=M, oblique=False, approach=approach), cycled=cycled)


def measured_order(grids: Sequence[int], errors: Sequence[float], expected: float) -> Measured:
    """Order of convergence of errors on grids of M x M elements, as `rates.fit_order` fits it."""
    fit = fit_order([1 / M for M in grids], errors)
    return Measured(fit.order, expected, data={"M": list(grids), "error": list(errors)})


def first_contact_approach(solution: rf.Solution, gap: Array) -> float:
    """Return a periodic approach from first contact (m); solvers count from mean planes."""
    return solution.approach + float(np.mean(gap) - np.min(gap))
