"""How well a state satisfies the problem, recomputed from its pressure and traction alone (SPEC 1)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from refimpl.contact.projected_cg import relative_gap
from refimpl.forces import Forces, resultants
from refimpl.friction import Mask, local_friction
from refimpl.grid import Array
from refimpl.operators.base import Influence
from refimpl.problem import Problem
from refimpl.slopes import Slopes


@dataclass(frozen=True)
class Certificate:
    """Residuals of contact, all dimensionless; zero for an exact discrete solution.

    gap : ``sum f (v - min v) dA`` over the elastic energy ``1/2 sum f (a f) dA``
    penetration : ``max(0, approach - min v) / approach``
    negative_pressure : largest negative pressure over the peak
    balance : ``|N - P| / P`` under a load; ``|mean v - approach| / approach`` at an approach
    slope : change of the slopes' tangents that the state's own displacements ask for
    unlawful : number of elements whose traction is not ``tau + beta f`` in contact and 0 outside (as a
        settled cycle leaves)
    """

    gap: float
    penetration: float
    negative_pressure: float
    balance: float
    slope: float
    unlawful: int

    @property
    def worst(self) -> float:
        """The largest of the residuals that must meet the tolerance; NaN counts as infinite."""
        values = np.array([self.gap, self.penetration, self.negative_pressure, self.balance, self.slope])
        return float(np.where(np.isnan(values), np.inf, values).max())

    def meets(self, tolerance: float) -> bool:
        """Whether every residual is within the tolerance."""
        return self.worst <= tolerance


@dataclass(frozen=True, eq=False)
class State:
    """A solved state with what follows from it: displacements, slopes, approach (m, from first touch)."""

    pressure: Array
    traction: Array
    displacement_lower: Array
    displacement_upper: Array
    slopes: Slopes
    approach: float
    forces: Forces
    certificate: Certificate

    def clearance(self, gap: Array) -> Array:
        """``v - approach`` of Eq. (6) from the undeformed gap (m): zero in contact, not negative outside."""
        u = self.displacement_lower + self.displacement_upper
        return u / self.slopes.obliqueness + gap - self.approach


def certify(problem: Problem, operator: Influence, pressure: Array, traction: Array, slopes: Slopes) -> State:
    """Recompute displacements, slopes, approach and every residual from the returned arrays.

    ``slopes`` enter only through the facet tractions of the slope correction and through the
    residual ``slope``; the cosines are those of the recomputed displacements.
    """
    normal = problem.pair.normal_compliance * operator.normal(pressure)
    known = None if problem.terms.slope_correction else normal
    lower, upper = problem.displacements(operator, pressure, traction, slopes, normal_displacement=known)
    found = problem.slopes(lower, upper)
    dA = problem.grid.element_area
    v = (lower + upper) / found.obliqueness + problem.gap
    total = float(pressure.sum())
    in_contact: Mask = pressure > 0
    mean_v = float(np.sum(pressure * v)) / total if total > 0 else float(v.min())
    approach = mean_v if problem.approach is None else problem.approach
    forces = resultants(pressure, traction, found, dA)
    if problem.load is not None:
        balance = abs(forces.normal - problem.load) / problem.load
    else:
        balance = abs(mean_v - approach) / approach if total > 0 else 0.0
    energy = 0.5 * float(np.sum(pressure * normal)) * dA
    duality = float(np.sum(pressure * (v - v.min()))) * dA
    peak = max(float(pressure.max()), np.finfo(float).tiny)
    lawful = local_friction(problem.friction, pressure, in_contact)
    return State(
        pressure=pressure,
        traction=traction,
        displacement_lower=lower,
        displacement_upper=upper,
        slopes=found,
        approach=approach,
        forces=forces,
        certificate=Certificate(
            gap=relative_gap(duality, energy),
            penetration=max(0.0, approach - float(v.min())) / (abs(approach) or 1.0),
            negative_pressure=max(0.0, -float(pressure.min())) / peak,
            balance=balance,
            slope=found.distance(slopes, in_contact),
            unlawful=int(np.count_nonzero(traction != lawful)),
        ),
    )
