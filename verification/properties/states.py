"""Invariants of one state: Eqs (1), (2), (6) and (7) recomputed from the returned arrays by other means."""

from __future__ import annotations

import math

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from verification.exact.textbook import normal_matrix, shear_matrix
from verification.properties.registry import Solver, invariant, require
from verification.properties.samples import SIDE, Sample, samples

RESIDUAL = 1e-9
"""Relative; solvers have the tolerance 1e-12, and a thousand times that covers the difference of a state's
residual from its error on grids this small (condition number of the flexibility: below 100)."""


def solved(solver: Solver, sample: Sample, *, oblique: bool | None = None) -> rf.Solution:
    """Return the sample's solution; fails when the solver does not claim to have solved it."""
    solution = solver(sample.scene, sample.shape, oblique=oblique)
    require(solution.converged, f"ended {solution.status.value}")
    return solution


def from_first_contact(sample: Sample, solution: rf.Solution) -> float:
    """Return the approach from first contact (m); a periodic one is reported from the mean planes."""
    return solution.approach + (float(sample.gap.mean()) if sample.periodic else 0.0)


def displacement(sample: Sample, solution: rf.Solution) -> Array:
    """Return the normal displacement of both bodies (m), from the returned surfaces."""
    return solution.details.separation - sample.gap + from_first_contact(sample, solution)


def compliances(scene: rf.Scene) -> tuple[float, float]:
    """Return the factors of ``I[1/rho]`` and ``I[s/rho^2]`` (1/Pa), anew; c is lower minus upper."""
    lower, upper = scene.lower.material, scene.upper.material
    a = (1 - lower.nu**2) / (math.pi * lower.E) + (1 - upper.nu**2) / (math.pi * upper.E)
    c_lower = (1 + lower.nu) * (1 - 2 * lower.nu) / (2 * math.pi * lower.E)
    c_upper = (1 + upper.nu) * (1 - 2 * upper.nu) / (2 * math.pi * upper.E)
    return a, c_lower - c_upper


def slope_along_and_across(sample: Sample, solution: rf.Solution) -> tuple[Array, Array]:
    """Return tan theta_x, theta_y of the mean returned surface, by differences written out."""
    z = np.add(*solution.surfaces) / 2
    (n, m), (dx, dy) = sample.shape, sample.grid.spacings
    d = np.zeros((2, n, m))
    for i, j in np.ndindex(n, m):
        if sample.periodic:
            d[0, i, j] = (z[(i + 1) % n, j] - z[i - 1, j]) / (2 * dx)
            d[1, i, j] = (z[i, (j + 1) % m] - z[i, j - 1]) / (2 * dy)
        else:
            i0, i1, j0, j1 = max(i - 1, 0), min(i + 1, n - 1), max(j - 1, 0), min(j + 1, m - 1)
            d[0, i, j] = (z[i1, j] - z[i0, j]) / ((i1 - i0) * dx)
            d[1, i, j] = (z[i, j1] - z[i, j0]) / ((j1 - j0) * dy)
    cos, sin = math.cos(solution.details.sliding_direction), math.sin(solution.details.sliding_direction)
    return cos * d[0] + sin * d[1], cos * d[1] - sin * d[0]


@invariant("pressure is never negative, and somewhere positive", samples())
def positivity(solver: Solver, sample: Sample) -> None:
    """No adhesion: f >= 0."""
    pressure = solved(solver, sample).pressure
    require(pressure.min() >= 0)
    require(pressure.max() > 0)


@invariant("r = tau + beta f in contact and 0 outside, but for elements excluded from tau", samples())
def local_friction_law(solver: Solver, sample: Sample) -> None:
    """Eq. (1), to the last bit but one."""
    solution, friction = solved(solver, sample), sample.scene.friction
    expected = np.where(solution.pressure > 0, friction.tau + friction.beta * solution.pressure, 0.0)
    expected[solution.details.excluded] -= np.where(solution.pressure > 0, friction.tau, 0.0)[
        solution.details.excluded
    ]
    np.testing.assert_allclose(solution.traction, expected, rtol=4e-16, atol=1e-15 * friction.tau)


@invariant("surfaces do not interpenetrate, and touch where there is pressure", samples())
def complementarity(solver: Solver, sample: Sample) -> None:
    """Both inequalities (6), with the cosines of the returned surfaces."""
    solution = solved(solver, sample)
    tan_x, tan_y = slope_along_and_across(sample, solution)
    v = displacement(sample, solution) * np.sqrt((1 + tan_x**2) * (1 + tan_y**2)) + sample.gap
    excess = v - from_first_contact(sample, solution)
    scale = np.abs(v).max()
    require(excess.min() >= -RESIDUAL * scale)
    require(np.abs(excess[solution.pressure > 0]).max() <= RESIDUAL * scale)


@invariant("N = P, recomputed term by term from Eq. (2); F and mu from Eq. (3); Q", samples())
def load_balance(solver: Solver, sample: Sample) -> None:
    """Force sums with trigonometric functions of the angles, in exactly rounded sums."""
    solution = solved(solver, sample)
    x, y = (np.arctan(t).ravel() for t in slope_along_and_across(sample, solution))
    f, r = solution.pressure.ravel(), solution.traction.ravel()
    dA, load = sample.grid.element_area, sample.scene.load
    terms = {
        "normal_force": (f * np.cos(x) - r * np.sin(x)) * np.cos(y),
        "friction_force": (f * np.sin(x) + r * np.cos(x)) * np.cos(y),
        "binormal_force": (f * np.cos(x) - r * np.sin(x)) * np.sin(y),
    }
    for name, term in terms.items():
        require(abs(getattr(solution, name) - math.fsum(term) * dA) <= RESIDUAL * load)
    require(abs(solution.normal_force - load) <= RESIDUAL * load)
    require(abs(solution.friction_coefficient - solution.friction_force / load) <= RESIDUAL)


@invariant("the surfaces are where Eq. (7) puts them", samples(periodic=False))
def displacements(solver: Solver, sample: Sample) -> None:
    """u = [a] f + [c] r with matrices from the textbook's formulas; c is lower minus upper."""
    solution = solved(solver, sample)
    a, c = compliances(sample.scene)
    u = a * normal_matrix(sample.grid) @ solution.pressure.ravel()
    u += c * shear_matrix(sample.grid, sample.scene.sliding_direction) @ solution.traction.ravel()
    found = displacement(sample, solution).ravel()
    # the surfaces also carry the heights' own rounding, which is 1e-16 of SIDE at most
    require(np.abs(found - u).max() <= 1e-11 * np.abs(u).max() + 1e-16 * SIDE)


@invariant("the contact area is the number of loaded elements; p_max is the pressures' maximum", samples())
def area_and_peak(solver: Solver, sample: Sample) -> None:
    """Counted one by one."""
    solution = solved(solver, sample)
    count = sum(1 for f in solution.pressure.ravel() if f > 0)
    require(math.isclose(solution.contact_area, count * sample.grid.element_area, rel_tol=1e-14))
    require(solution.max_pressure == max(solution.pressure.ravel()))
    require(solution.contact_area_corrected <= solution.contact_area)


@invariant("the same scene gives the same bits", samples())
def determinism(solver: Solver, sample: Sample) -> None:
    """Nothing depends on the time, on memory or on what was solved before."""
    first, second = solved(solver, sample), solved(solver, sample)
    require(first.pressure.tobytes() == second.pressure.tobytes())
    require(first.traction.tobytes() == second.traction.tobytes())
    require((first.approach, first.friction_coefficient) == (second.approach, second.friction_coefficient))


ONE_SPOT = Sample(
    bumps=((0, 0, 0, 0, 0), (15, 0, 0, 0, 14), (4, 0, 2, 7, 0), (4, 7, 2, 7, 0), (0, 0, 0, 0, 0)),
    upper=5,
    E=(71, 73),
    nu=(15, 0),
    pressure=3,
    beta=33,
    angle=96,
    periodic=True,
)
"""A neighbour that left the contact kept 1e-16 of its pressure, and with it its place in the area."""


@invariant(
    "pressing to the approach that a load gave gives that load's state back",
    samples(tau=False),
    found=(ONE_SPOT,),
)
def load_and_approach(solver: Solver, sample: Sample) -> None:
    """Load to approach and back; not near full periodic contact, where an approach fixes no load."""
    by_load = solved(solver, sample)
    if sample.periodic and by_load.contact.mean() > 0.9:
        return
    back = solver(sample.scene, sample.shape, approach=by_load.approach)
    require(back.converged)
    same_pressure(back, by_load, sample)
    require(abs(back.normal_force - sample.scene.load) <= 1e-7 * sample.scene.load)


@invariant("dense reference and production solver agree", samples())
def agrees_with_the_dense_reference(solver: Solver, sample: Sample) -> None:
    """The reference of `refimpl`: principal pivoting on dense matrices."""
    reference = rf.solve(sample.scene, sample.shape, method="dense", tolerance=1e-12)
    solution = solved(solver, sample)
    same_pressure(solution, reference, sample)
    require(np.array_equal(solution.details.excluded, reference.details.excluded))


def same_pressure(one: rf.Solution, other: rf.Solution, sample: Sample) -> None:
    """Require equal sets, pressures to `RESIDUAL` of the peak; approaches to it from contact."""
    require(np.array_equal(one.contact, other.contact))
    require(np.abs(one.pressure - other.pressure).max() <= RESIDUAL * other.max_pressure)
    require(abs(one.approach - other.approach) <= RESIDUAL * abs(from_first_contact(sample, other)))
