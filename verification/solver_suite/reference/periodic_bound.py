"""Proven bounds at a prescribed periodic approach, where the mean pressure displaces nothing.

Pressures f of the load ``P = dA sum f`` are near the solution f1 under that load, by
`refimpl.bounds.proven_bounds`, which bounds its approach too: it differs from the prescribed one by ``d`` at
most. Let f2 be the solution at the prescribed approach, ``e`` the difference of f1 and f2 in the order of
their approaches, ``e0`` its part without the mean m, and N the number of elements. Each pressure meets only
separations that are not negative, and c is skew, so ``||e0||^2 = e.a e <= d sum e = d N m``. Displacements
have mean zero; with the mean planes apart (a negative approach) some element of the more compressed state is
separated and carries nothing. There ``e <= 0``, so that ``0 <= m <= max |e0| <= g ||e0||`` with ``g^2 = sum
1/a / N`` over the symbol of a. Hence ``||e0|| <= d N g``. An element's displacement changes by ``||e0||
sqrt(sum |A|^2 / a / N)`` at most, A the symbol of ``a + beta c``: what is separated by more, and carries
nothing, is out of contact in f1 and f2 alike. On the set S of these elements ``m = -e0``, so that m is at
most ``s ||e0||``, s being the dual norm of the mean over S, which is far below g:

    ||e0|| <= d N s,      |e| <= (g + s) ||e0||.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import refimpl as rf
from refimpl.bounds.proven_bounds import proven_bounds
from refimpl.grid import Array, Mask
from verification.solver_suite import reference_solution
from verification.solver_suite.protocol import ContactProblem

ROUNDING = 8.0
"""Rounding of a pair of transforms over ``eps log2 N`` and the result's Euclidean norm: a wide margin."""


class PeriodicBound(NamedTuple):
    """``sum e0 a e0 dA`` (J), largest errors of pressure (Pa) and load (N), elements in and out."""

    energy: float
    pressure: float
    load: float
    in_contact: Mask
    out_of_contact: Mask


def periodic_bound(problem: ContactProblem, solution: rf.Solution) -> PeriodicBound | None:
    """Return the bounds at a periodic approach, at its active set of tau; None if not proven."""
    f, touch = np.asarray(solution.pressure), problem.approach_from_touch
    if touch is None or problem.approach is None or not problem.periodic or problem.hardness is not None:
        return None
    if f.min() < 0 or not f.max() > 0:
        return None
    load = float(f.sum()) * problem.element_area
    by_load = replace(solution.details.problem, load=load, approach=None)
    near = proven_bounds(by_load, f, solution.traction, solution.slopes)
    v = reference_solution.displacement(problem, f) + problem.gap
    noise = _rounding(v, touch)
    d = abs(float(np.vdot(f, v) / f.sum()) - touch) + near.approach + noise
    if not problem.approach + d < 0:
        return None
    symbols = _Symbols(*reference_solution.symbols(problem))
    g, apart = symbols.of_an_element, v - touch
    near_size = math.sqrt(near.energy / problem.element_area)
    out = (apart > symbols.moved(near_size + d * f.size * g) + d + noise) & (f == 0)
    s = min(g, symbols.of_the_mean(out)) if out.any() else g
    between = d * f.size * s
    pressure = near.pressure + (g + s) * between
    out = (apart > symbols.moved(near_size + between) + noise) & (f == 0)
    energy = (near_size + between) ** 2 * problem.element_area
    return PeriodicBound(energy, pressure, s * between * math.prod(problem.lengths), f > pressure, out)


class _Symbols:
    """Norms by the symbols of ``a`` and ``a + beta c`` (m/Pa)."""

    def __init__(self, normal: Array, both: NDArray[np.complex128]) -> None:
        self.waves, self.count = normal > 0, normal.size
        self.normal = normal[self.waves]
        self.of_an_element = math.sqrt(float(np.sum(1 / self.normal)) / self.count)
        """Bound of ``|e0|`` over ``||e0||``."""
        self._row = math.sqrt(float(np.sum(np.abs(both[self.waves]) ** 2 / self.normal)) / self.count)

    def moved(self, size: float) -> float:
        """Bound of an element's displacement (m) by pressures of this norm."""
        return size * self._row

    def of_the_mean(self, where: Mask) -> float:
        """Bound of the mean of e0 over these elements, over ``||e0||``."""
        spectrum = np.abs(np.fft.fft2(where / np.count_nonzero(where))[self.waves]) ** 2
        return math.sqrt(float(np.sum(spectrum / self.normal)) / self.count)


def _rounding(v: Array, touch: float) -> float:
    return ROUNDING * float(np.finfo(float).eps) * (math.log2(v.size) * float(np.linalg.norm(v)) + abs(touch))
