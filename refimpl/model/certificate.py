"""Residuals of a solver's result, recomputed from its pressure and traction alone."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from refimpl.grid import Array, Mask, Window, inner, read_only
from refimpl.model.elasticity import Influence
from refimpl.model.forces import (
    Forces,
    contact_area,
    friction_coefficient,
    normal_terms,
    perimeter_corrected_area,
    resultants,
)
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.model.state import Status

_EPS = float(np.finfo(float).eps)
# rounding of Eq. (7) on n elements, over sqrt(n) eps times the displacement by the peak pressure on the whole
# domain; measured on flat periodic planes, 2 to 32 elements a side, dense sums: 0.3 to 0.7
_ROUNDING = 2.0
# rounding of Eq. (7) beside other gaps, over eps times that displacement; measured on rough periodic planes
# at 1 and 100 times the modulus: 0.1 to 2.6 by FFT (3 to 256 elements a side), 0.6 to 1.9 by dense sums
_MEAN_ROUNDING = 4.0
_SHEAR_ROUNDING = 4.0  # rounding of a shear product over eps times that of single elements
_MOST_ROUNDING = 1e-6  # over the displacement by an element's peak pressure: spoilt by as much it must fail
# rounding of Eq. (2) over eps times the sum of its terms' sizes; measured on a ball with tau of 1e8 to 1e13
# times the pressure (`verification.stress_tests`): 0.04 to 1.2
_LOAD_ROUNDING = 4.0


@dataclass(frozen=True)
class Certificate:
    """Residuals of contact, all dimensionless; zero for an exact discrete solution.

    gap : complementarity gap ``sum f (v - min v) dA`` over the elastic energy ``1/2 sum f (a f) dA``; with a
        cap ``sum [f (v - approach)+ + (H - f) (approach - v)+] dA`` over the energy
    penetration : ``max(0, approach - min v) / approach``, of elements with ``f < H``
    negative_pressure : largest negative pressure, or excess over H, over the peak
    load_error : ``|N - P| / P`` under a load; ``|sum f (v - approach)| dA`` over the energy at an approach,
        to which one unit in the last place of the approach is added
    slope : change of the slopes' tangents between the given ones and those of the recomputed displacements
    law_violations : number of elements whose traction is not the friction law's in contact and 0 outside (as
        an alternating contact edge leaves)
    reference : largest relative difference of the plain reference's own N, F, Q, mu, A and approach from the
        sums here; 0 for other methods
    gap_rounding, penetration_rounding : what rounding of Eq. (7) leaves of gap and penetration: tau and a
        mean pressure may move surfaces by many times what counts in the energy and the approach
    load_rounding : what rounding of the terms of Eq. (2) leaves of ``load_error``: tau on slopes may carry
        many times the load. At an approach the same as ``gap_rounding``
    """

    gap: float
    penetration: float
    negative_pressure: float
    load_error: float
    slope: float
    law_violations: int
    reference: float = 0.0
    gap_rounding: float = 0.0
    penetration_rounding: float = 0.0
    load_rounding: float = 0.0

    @property
    def largest(self) -> float:
        """The largest of the residuals that must meet the tolerance; NaN counts as infinite."""
        contact = self.gap, self.penetration, self.negative_pressure, self.load_error, self.slope
        values = np.array([*contact, self.reference])
        return float(np.where(np.isnan(values), np.inf, values).max())

    def satisfies(self, tolerance: float) -> bool:
        """Return whether every residual is within the tolerance, or within its rounding."""
        judged = replace(
            self,
            gap=0.0 if self.gap <= self.gap_rounding else self.gap,
            penetration=0.0 if self.penetration <= self.penetration_rounding else self.penetration,
            load_error=0.0 if self.load_error <= self.load_rounding else self.load_error,
        )
        return judged.largest <= tolerance


@dataclass(frozen=True, eq=False)
class State:
    """A solver's arrays, how it ended, and everything that follows from them; arrays of the problem's shape.

    pressure, traction : f and r (Pa)
    displacement_lower, displacement_upper : normal displacements into each body (m)
    indentation : plastic indentation w_p of the softer body (m), None without a cap
    slopes : of the common surface
    v : ``u / (cos theta_x cos theta_y) + h`` of Eq. (6) (m): the approach where there is contact
    approach : from first contact (m)
    forces : N, F and Q (N)
    friction_coefficient : mu, Eq. (4)
    contact_area, contact_area_corrected : real contact area, and less the excess along its edge (m^2)
    plastic, plastic_area : elements at the hardness, and their area (m^2)
    certificate : residuals
    excluded : elements that the rule for tau's active set leaves without adhesive shear
    status : how the solver's loops ended
    iterations : counts by loop
    """

    pressure: Array
    traction: Array
    displacement_lower: Array
    displacement_upper: Array
    indentation: Array | None
    slopes: Slopes
    v: Array
    approach: float
    forces: Forces
    friction_coefficient: float
    contact_area: float
    contact_area_corrected: float
    plastic: Mask
    plastic_area: float
    certificate: Certificate
    excluded: Mask
    status: Status = Status.CONVERGED
    iterations: Mapping[str, int] = field(default_factory=dict)

    def freeze(self) -> None:
        """Make the arrays read-only, without copies."""
        own = (value for value in vars(self).values() if isinstance(value, np.ndarray))
        for array in (*own, self.slopes.tan_x, self.slopes.tan_y):
            read_only(array)

    @property
    def contact(self) -> Mask:
        """Elements with ``f > 0``."""
        return self.pressure > 0

    @property
    def max_pressure(self) -> float:
        """Maximum contact pressure p_max (Pa)."""
        return float(self.pressure.max())

    @property
    def gap(self) -> Array:
        """Deformed gap (m): zero in contact, not negative outside.

        It is ``v - approach``, and ``w_p / (cos theta_x cos theta_y)`` more where the softer body yields.
        """
        gap = self.clearance
        if self.indentation is not None:
            gap += self.indentation / self.slopes.cosine_product
        return gap

    @property
    def clearance(self) -> Array:
        """``v - approach`` (m): zero in contact, not negative outside."""
        return self.v - self.approach


def relative_gap(gap: float, energy: float) -> float:
    """Return the complementarity gap over the elastic energy; 0 for an exact state without energy."""
    if gap == 0:
        return 0.0
    return gap / energy if energy > 0 else math.inf


def contact_residuals(
    gap: float, energy: float, approach: float, lowest: float, rounding: float = 0.0
) -> tuple[float, float]:
    """Return gap over energy, per total pressure, and penetration over approach; 0 within rounding (m)."""
    gap, depth = (x if x > rounding else 0.0 for x in (gap, max(0.0, approach - lowest)))
    return relative_gap(gap, energy), depth / (abs(approach) or 1.0)


def flat_rounding(problem: Problem) -> float:
    """Return the rounding of Eq. (7) over the peak pressure (m/Pa), where nothing else is left of the gap."""
    compliance = problem.elasticity.mean_compliance(problem.grid)
    return _ROUNDING * math.sqrt(problem.grid.elements) * _EPS * compliance


def mean_rounding(problem: Problem, operator: Influence) -> float:
    """Return what rounding leaves of a mean displacement that is 0, over the peak pressure (m/Pa)."""
    if operator.displaces_mean:
        return 0.0
    return _MEAN_ROUNDING * _EPS * problem.elasticity.mean_compliance(problem.grid)


def displacement_rounding(problem: Problem, operator: Influence, peak: float, traction: Array) -> float:
    """Return what rounding leaves of the gap (m): of the peak's mean, of shear on single elements."""
    product = np.asarray(problem.grid.element_size * math.sqrt(inner(traction, traction)))
    shear = _SHEAR_ROUNDING * _EPS * abs(float(problem.elasticity.gap_by_shear(product)))
    most = _MOST_ROUNDING * problem.elasticity.element_compliance(problem.grid)
    return min(mean_rounding(problem, operator) * peak + shear, most * peak)


def load_rounding(terms: float, load: float) -> float:
    """Return the rounding of Eq. (2), a sum whose terms' sizes add up to ``terms`` (N), over the load."""
    return min(_MOST_ROUNDING, _LOAD_ROUNDING * _EPS * terms / load)


# Long as one list of what a state holds: parts of it would pass a dozen arrays to each other.
def certify(
    problem: Problem,
    operator: Influence,
    pressure: Array,
    traction: Array,
    slopes: Slopes,
    indentation: Array | None = None,
    *,
    excluded: Mask | None = None,
    status: Status = Status.CONVERGED,
    iterations: Mapping[str, int] | None = None,
) -> State:
    """Recompute displacements, slopes, approach, forces and every residual from the returned arrays.

    Arguments after the first two are fields of a `SolverResult`, of which ``slopes`` and ``indentation`` (m)
    enter through facet tractions, the common surface and the residual ``slope`` alone.
    """
    cap = problem.cap
    normal = problem.elasticity.normal(operator, pressure)
    lower, upper = problem.displacements(operator, pressure, traction, slopes, normal=normal)
    box = Window.around((pressure != 0) | (traction != 0), margin=0)  # elsewhere the summands vanish
    normal = normal[box.slices].copy()  # every array of a large grid counts
    found = problem.slopes(lower, upper, indentation)
    v = found.per_cosine_product(lower + upper)
    v += problem.gap
    f, r, on_slopes = pressure[box.slices], traction[box.slices], found.windowed(box)
    lowest = float(np.min(v, where=pressure < cap, initial=np.inf))
    contact: Mask = f > 0
    total = float(f.sum())
    pressed, shares = total > 0, f / total if total > 0 else f  # products of small pressures underflow
    mean_v = approach_from(pressure, v, cap)
    approach = mean_v if problem.approach is None else problem.approach
    forces = resultants(f, r, on_slopes, problem.grid.element_area)
    energy = 0.5 * inner(shares, normal)
    capped = pressed and not math.isinf(cap)
    gap = _capped_gap(pressure, v, cap, approach) if capped else inner(shares, v[box.slices] - lowest)
    of_flats = flat_rounding(problem) * float(f.max())
    relative, penetration = contact_residuals(
        gap, energy, approach, lowest, of_flats if energy <= of_flats else 0.0
    )
    rounding = displacement_rounding(problem, operator, float(f.max()), r)
    of_gap = of_load = relative_gap(rounding, energy)
    if problem.load is not None:
        load_error = abs(forces.normal - problem.load) / problem.load
        of_load = load_rounding(normal_terms(f, r, on_slopes, problem.grid.element_area), problem.load)
    else:
        missed = missed_approach(pressure, v, cap, approach)
        missed += math.ulp(approach)  # the least approaches have no digits to agree in
        load_error = relative_gap(missed, energy) if pressed else 0.0
    plastic, requested = None, on_slopes
    if not math.isinf(cap):
        plastic = problem.indentation(pressure, lower + upper, found.cosine_product, approach)
        requested = problem.slopes(lower, upper, plastic).windowed(box)
    everywhere, at_cap = pressure > 0, pressure >= cap
    beyond = max(0.0, -float(f.min()), float(f.max()) - cap)
    return State(
        pressure=pressure,
        traction=traction,
        displacement_lower=lower,
        displacement_upper=upper,
        indentation=plastic,
        slopes=found,
        v=v,
        approach=approach,
        forces=forces,
        friction_coefficient=friction_coefficient(forces.friction, problem.nominal_load(forces.normal)),
        contact_area=contact_area(everywhere, problem.grid),
        contact_area_corrected=perimeter_corrected_area(everywhere, problem.grid),
        plastic=at_cap,
        plastic_area=contact_area(at_cap, problem.grid),
        certificate=Certificate(
            gap=relative,
            penetration=penetration,
            negative_pressure=beyond / max(float(f.max()), float(np.finfo(float).tiny)),
            load_error=load_error,
            slope=max(on_slopes.distance(other, contact) for other in (slopes.windowed(box), requested)),
            law_violations=int(np.count_nonzero(r != problem.friction.traction(f, contact))),
            gap_rounding=of_gap,
            penetration_rounding=rounding / (abs(approach) or 1.0),
            load_rounding=of_load,
        ),
        excluded=np.zeros(pressure.shape, dtype=bool) if excluded is None else excluded,
        status=status,
        iterations=iterations or {},
    )


def _capped_gap(f: Array, v: Array, cap: float, approach: float) -> float:
    """Return pressure times gap and reserve times penetration, per total pressure (m)."""
    excess = v - approach
    products = f * np.maximum(excess, 0) + (cap - f) * np.maximum(-excess, 0)
    return float(products.sum()) / float(f.sum())


def missed_approach(f: Array, v: Array, cap: float, approach: float) -> float:
    """Return the distance of a prescribed approach from the state's interval of approaches (m)."""
    if np.any((f > 0) & (f < cap)) or not np.any(f >= cap):
        return abs(approach_from(f, v, cap) - approach)
    lowest = float(np.min(v, where=f < cap, initial=np.inf))
    deepest = float(np.max(v, where=f >= cap, initial=-np.inf))
    return max(0.0, deepest - approach, approach - lowest)


def approach_from(f: Array, v: Array, cap: float) -> float:
    """Return the approach of a state (m): the mean of ``v`` weighted by pressure over ``0 < f < H``.

    Where no element is free it is the middle of the interval between the capped and the unloaded ones;
    without any pressure it is the lowest v.
    """
    box = Window.around(f != 0, margin=0).slices
    free = f[box] * (f[box] < cap)
    total = float(free.sum())
    if total > 0:
        return inner(free / total, v[box])
    lowest = float(np.min(v, where=f < cap, initial=np.inf))
    deepest = float(np.max(v, where=f >= cap, initial=-np.inf))
    if not math.isfinite(deepest):
        return lowest
    return 0.5 * (deepest + lowest) if math.isfinite(lowest) else deepest
