"""How well a state satisfies the problem, recomputed from its pressure and traction alone."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from refimpl.grid import Array, inner
from refimpl.grid.window import Window
from refimpl.model.forces import Forces, resultants
from refimpl.model.friction import Mask, local_friction
from refimpl.model.gap import relative_gap
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.operators.base import Influence


@dataclass(frozen=True)
class Certificate:
    """Residuals of contact, all dimensionless; zero for an exact discrete solution.

    gap : ``sum f (v - min v) dA`` over the elastic energy ``1/2 sum f (a f) dA``
    penetration : ``max(0, approach - min v) / approach``
    negative_pressure : largest negative pressure over the peak
    balance : ``|N - P| / P`` under a load; ``|sum f (v - approach)| dA`` over the energy at an approach, of
        which a unit in its last place is always missed
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
    """A solved state with what follows from it: displacements, slopes, approach (m, from first touch).

    ``separation`` is ``v`` of Eq. (6) from the undeformed gap (m): the approach where there is contact.
    """

    pressure: Array
    traction: Array
    displacement_lower: Array
    displacement_upper: Array
    slopes: Slopes
    separation: Array
    approach: float
    forces: Forces
    certificate: Certificate

    @property
    def clearance(self) -> Array:
        """``v - approach`` (m): zero in contact, not negative outside."""
        return self.separation - self.approach


def certify(problem: Problem, operator: Influence, pressure: Array, traction: Array, slopes: Slopes) -> State:
    """Recompute displacements, slopes, approach and every residual from the returned arrays.

    ``slopes`` enter only through the facet tractions of the slope correction and through the
    residual ``slope``; the cosines are those of the recomputed displacements.
    """
    product = operator.normal(pressure)
    down = None if problem.terms.slope_correction else product
    lower, upper = problem.displacements(operator, pressure, traction, slopes, product=down)
    found = problem.slopes(lower, upper)
    v = found.per_obliqueness(lower + upper)
    v += problem.gap
    box = Window.around((pressure != 0) | (traction != 0), margin=0)  # sums need look no further
    f, r, on_slopes = pressure[box.slices], traction[box.slices], found.windowed(box)
    dA, total, lowest = problem.grid.element_area, float(f.sum()), float(v.min())
    in_contact: Mask = f > 0
    shares = f / total if total > 0 else f  # with faint pressures themselves products would vanish
    mean_v = inner(shares, v[box.slices]) if total > 0 else lowest
    approach = mean_v if problem.approach is None else problem.approach
    forces = resultants(f, r, on_slopes, dA)
    energy = 0.5 * inner(shares, problem.pair.normal_compliance * product[box.slices])
    duality = inner(shares, v[box.slices] - lowest)
    if problem.load is not None:
        balance = abs(forces.normal - problem.load) / problem.load
    else:
        missed = abs(mean_v - approach) + math.ulp(approach)  # least numbers have no digits to agree in
        balance = relative_gap(missed, energy) if total > 0 else 0.0
    peak = max(float(f.max()), float(np.finfo(float).tiny))
    return State(
        pressure=pressure,
        traction=traction,
        displacement_lower=lower,
        displacement_upper=upper,
        slopes=found,
        separation=v,
        approach=approach,
        forces=forces,
        certificate=Certificate(
            gap=relative_gap(duality, energy),
            penetration=max(0.0, approach - lowest) / (abs(approach) or 1.0),
            negative_pressure=max(0.0, -float(f.min())) / peak,
            balance=balance,
            slope=on_slopes.distance(slopes.windowed(box), in_contact),
            unlawful=int(np.count_nonzero(r != local_friction(problem.friction, f, in_contact))),
        ),
    )
