"""Certified pressures of a problem: solved far beyond the suite's claim, with proven bounds on their errors.

The solver's own proof is `refimpl.bounds.proven_bounds`, at a periodic approach `periodic_bound`. The
residual beside them is recomputed by `reference_solution`, which shares nothing with the solver.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

import refimpl as rf
from refimpl.grid import Array, Mask
from verification.solver_suite import own, reference_solution
from verification.solver_suite.protocol import ContactProblem
from verification.solver_suite.reference.periodic_bound import periodic_bound

TOLERANCE = 1e-12
"""Relative residual required of the solver: below, rounding decides."""
USABLE = 1e-6
"""Bound of a pressure over the peak up to which a problem is exported; 1e-9 is usual."""
SEPARATED, CONTACT, APPARENTLY_SEPARATED, APPARENTLY_CONTACT = range(4)
"""Codes of an element: proven to be out of contact or in contact, or within the bounds of the other."""
AT_FIXED_TAU = "tau's active set is held as exported"


class NotCertified(Exception):
    """A problem whose pressures have no usable bound; the message says why."""


class NoBound(NotCertified):
    """A problem of a kind that no proof covers: a hardness at a periodic approach."""


@dataclass(frozen=True)
class Bounds:
    """Proven bounds on ``|exported - solution|``.

    pressure : of each element (Pa)
    pressure_l2 : root of ``sum (f - f*)^2 dA`` (Pa m)
    energy : ``sum (f - f*) a (f - f*) dA`` (J)
    approach : as the problem counts it (m)
    load : N
    """

    pressure: float
    pressure_l2: float
    energy: float
    approach: float
    load: float


@dataclass(frozen=True, eq=False)
class Certified:
    """Pressures (Pa) of a problem with their bounds; ``contact`` holds the codes of this module.

    ``approach`` (m) and ``load`` (N) belong to the pressures. ``condition`` is what the proof holds fixed, or
    empty.
    """

    problem: ContactProblem
    pressure: Array
    approach: float
    load: float
    residual: reference_solution.Residual | None
    bounds: Bounds
    contact: NDArray[np.uint8] = field(repr=False)
    condition: str


def certified(problem: ContactProblem) -> Certified:
    """Solve and bound a problem. Raises `NotCertified`."""
    solution = own.solved(problem, TOLERANCE)
    pressure = np.asarray(solution.pressure)
    load = float(pressure.sum()) * problem.element_area
    approach, residual = problem.approach, None
    if not pressure.any():
        bounds, inside, outside = _apart(problem), pressure > 0, pressure == 0
    else:
        bounds, inside, outside = _bounded(problem, pressure, solution)
        with suppress(ValueError):  # uniform periodic pressures store no energy to judge by
            residual = reference_solution.residual(problem, pressure)
        if not bounds.pressure <= USABLE * float(pressure.max()):
            raise NotCertified(f"pressures are known to {bounds.pressure:.2g} Pa of {pressure.max():.2g} Pa")
    if approach is None:
        approach = float(solution.approach)
    condition = AT_FIXED_TAU if problem.coupling and problem.coupling.tau else ""
    codes = _codes(pressure > 0, inside, outside)
    return Certified(problem, pressure, approach, load, residual, bounds, codes, condition)


def _apart(problem: ContactProblem) -> Bounds:
    """Return the bounds without contact: pressures are exact, no element penetrates, one solution."""
    touch = problem.approach_from_touch
    if touch is None or touch > 0:
        raise NotCertified("the solver found no contact")
    return Bounds(0.0, 0.0, 0.0, 0.0, 0.0)


def _bounded(problem: ContactProblem, pressure: Array, solution: rf.Solution) -> tuple[Bounds, Mask, Mask]:
    if problem.periodic and problem.approach is not None:
        found = periodic_bound(problem, solution)
        if found is None:
            raise (NoBound if problem.hardness is not None else NotCertified)(
                "no bound is proven at this periodic approach"
            )
        area = math.prod(problem.lengths)
        bounds = Bounds(found.pressure, found.pressure * math.sqrt(area), found.energy, 0.0, found.load)
        return bounds, found.in_contact, found.out_of_contact
    proven = solution.details.bounds
    bounds = Bounds(proven.pressure, proven.pressure_l2, proven.energy, proven.approach, proven.normal_force)
    if not all(map(math.isfinite, vars(bounds).values())):
        raise NotCertified(proven.unproven)
    return bounds, proven.in_contact, proven.out_of_contact


def _codes(touching: Mask, inside: Mask, outside: Mask) -> NDArray[np.uint8]:
    apparent = np.where(touching, APPARENTLY_CONTACT, APPARENTLY_SEPARATED)
    return np.where(inside, CONTACT, np.where(outside, SEPARATED, apparent)).astype(np.uint8)
