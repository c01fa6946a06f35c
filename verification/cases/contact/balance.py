"""Balance, work and reciprocity: what holds for every elastic contact, whatever its shape."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

import refimpl as rf
from refimpl.grid import Array, Grid
from refimpl.model.forces import facet_resultants, plasticity_index
from refimpl.model.friction import friction_coefficient_at
from refimpl.model.slopes import Slopes
from refimpl.operators.fft import FFTInfluence
from verification.cases import Measured, case, certified

SCENES = ("table1-smooth", "table1-rough", "metal-polymer", "rough-planes")


@cache
def solved(name: str, M: int) -> rf.Solution:
    """Return a shipped scene's solution."""
    return certified(rf.solve(rf.read_scene(name), M))


def normal_force(solution: rf.Solution) -> float:
    """Return Eq. (2), exactly summed, by trigonometry of angles measured on the returned surfaces."""
    common = np.add(*solution.surfaces) / 2
    border = 1 if solution.grid.periodic else 0
    wide, inner = np.pad(common, border, mode="wrap"), slice(border, len(common) + border)
    along_i, along_j = (
        np.gradient(wide, edge, axis=k)[inner, inner] for k, edge in enumerate(solution.grid.spacings)
    )
    phi = solution.details.sliding_direction
    theta_x = np.arctan(math.cos(phi) * along_i + math.sin(phi) * along_j)
    theta_y = np.arctan(math.cos(phi) * along_j - math.sin(phi) * along_i)
    terms = (solution.pressure * np.cos(theta_x) - solution.traction * np.sin(theta_x)) * np.cos(theta_y)
    return math.fsum(terms.ravel()) * solution.grid.element_area


@case("balance/normal-force", metric="at_most", tolerance=1e-8)
def carries_the_load() -> Measured:
    """The contact carries the load.

    Claim: the sum of Eq. (2) over the contact, from the returned arrays, equals the load on four scenes
    Source: paper Eq. (2)
    Tolerance: the solver's default tolerance, which the sum's own rounding does not reach
    """
    misfit = {name: abs(normal_force(solved(name, 128)) / rf.read_scene(name).load - 1) for name in SCENES}
    return Measured(value=max(misfit.values()), data={"worst": misfit})


@case("balance/prescribed-approach", metric="at_most", tolerance=1e-9)
def prescribed_approach() -> Measured:
    """Prescribed approach against prescribed load.

    Claim: pressing to the approach that a load gave gives that load's pressure back, on every shipped scene
    Source: paper section 5: the second iteration
    Tolerance: both are solved to 1e-12; a load follows its approach with an exponent of 3/2 to 2
    """
    off = {}
    for name in SCENES:
        scene = rf.read_scene(name)
        by_load = rf.solve(scene, 64, tolerance=1e-12)
        back = rf.solve(scene, 64, approach=by_load.approach, tolerance=1e-12)
        off[name] = float(np.abs(back.pressure - by_load.pressure).max()) / by_load.max_pressure
    return Measured(value=max(off.values()), data={"worst": off}, note="over the peak")


@cache
def loading_curve(nodes: int) -> tuple[Array, Array, float]:
    """Return Gauss's weights dDelta (m) on the Hertz scene, loads (N), final elastic energy (J).

    With delta = delta_end t^2 the load goes as t^3, which Gauss's rule in t integrates exactly but for the
    kinks where elements join the contact.
    """
    scene, M = rf.read_scene("hertz"), 64
    end = rf.solve(scene, M, oblique=False, tolerance=1e-12)
    t, weight = np.polynomial.legendre.leggauss(nodes)
    t, weight = (t + 1) / 2, weight / 2
    loads = np.array(
        [
            rf.solve(scene, M, oblique=False, approach=end.approach * s**2, tolerance=1e-12).normal_force
            for s in t
        ]
    )
    lower, upper = scene.heights(end.grid)
    gap = upper - lower
    displacement = end.details.separation - (gap - gap.min()) + end.approach
    energy = 0.5 * float(np.vdot(end.pressure, displacement)) * end.grid.element_area
    return 2 * end.approach * t * weight, loads, energy


@case("balance/energy-is-work", metric="relative", tolerance=1e-5)
def energy_is_work() -> Measured:
    """Elastic energy against the work of the load.

    Claim: the integral of the load over the approach equals half the sum of pressure times displacement
    Source: Clapeyron's theorem; frictionless Hertz scene
    Tolerance: the load has a kink wherever elements join the contact, which slows the quadrature: 1.3e-5
    measured with 48 points, 2.9e-6 with 96, 8e-7 with 192, 1.2e-8 with 400
    """
    steps, loads, energy = loading_curve(96)
    coarse_steps, coarse_loads, _ = loading_curve(24)
    work, coarse = float(steps @ loads), float(coarse_steps @ coarse_loads)
    note = f"24 points differ by {abs(coarse / work - 1):.1e}"
    return Measured(value=work, reference=energy, unit="J", note=note)


def _fields(M: int) -> tuple[Array, Array]:
    random = np.random.default_rng(20010715)
    one, two = random.standard_normal((2, M, M))
    return one, two


@case("balance/reciprocity", metric="at_most", tolerance=1e-14)
def reciprocity() -> Measured:
    """Betti's reciprocity of the normal influence.

    Claim: f1 . (A f2) = f2 . (A f1) for random tractions on 200 x 200 elements
    Source: Maxwell 1864; Betti 1872
    Tolerance: over |f1| |A f2|: an FFT of n points is accurate to eps log2(n) = 4e-15 in that norm
    """
    one, two = _fields(200)
    operator = FFTInfluence(Grid.square(1e-3, 200), 0.0)
    there, back = operator.normal(two), operator.normal(one)
    scale = float(np.linalg.norm(one) * np.linalg.norm(there))
    return Measured(value=abs(float(np.vdot(one, there) - np.vdot(two, back))) / scale)


@case("balance/skew-coupling", metric="at_most", tolerance=1e-14)
def skew_coupling() -> Measured:
    """Shear does no work on the pressure it goes with.

    Claim: f . (C f) = 0 in any sliding direction, for random tractions on 200 x 200 elements
    Source: c is odd in the offset, so its matrix is skew
    Tolerance: over |f| |C f|: an FFT of n points is accurate to eps log2(n) = 4e-15 in that norm
    """
    one, _ = _fields(200)
    worst = 0.0
    for angle in (0.0, 0.7, 2.0):
        moved = FFTInfluence(Grid.square(1e-3, 200), angle).shear(one)
        share = abs(float(np.vdot(one, moved))) / float(np.linalg.norm(one) * np.linalg.norm(moved))
        worst = max(worst, share)
    return Measured(value=worst)


@case("balance/flat-tips", metric="relative", tolerance=2e-14)
def flat_tips() -> Measured:
    """Friction of contact without slopes.

    Claim: with every cosine 1 and every sine 0 a solved contact's F / N is Eq. (10)'s tau / f_m + beta
    Source: paper Eq. (10): Eqs (1)-(3) at theta = 0, an identity
    Tolerance: three sums of 4096 positive terms, in numpy's blocks of 128: 25 roundings each at most, 75 eps
    in all; one measured
    """
    scene = rf.read_scene("table1-smooth")
    solution = rf.solve(scene, 64, oblique=False)
    # sum over the elements that carry tau: an alternating contact edge excludes some, and Eq. (1) none
    area = np.count_nonzero(solution.contact & ~solution.details.excluded) * solution.grid.element_area
    return Measured(
        value=friction_coefficient_at(scene.friction, solution.normal_force / area),
        reference=solution.friction_force / solution.normal_force,
        note=f"{solution.status.value}, {int(solution.details.excluded.sum())} elements excluded from tau",
    )


@case("balance/plasticity-index", metric="relative", tolerance=1e-15)
def plasticity_threshold() -> Measured:
    """Plasticity index as printed.

    Claim: E' = 100 H and 50 nm of roughness over 11 um give psi = 2.2 x 100 x 0.05 / 11 = 1, the threshold
    Source: paper Eq. (12)
    Tolerance: four factors in double precision, each wrong by eps = 2e-16 at most
    """
    return Measured(plasticity_index(80e9, 0.8e9, 50e-9, 11e-6), 1.0)


@case("balance/facet-vectors", metric="at_most", tolerance=4e-15)
def facet_vectors() -> Measured:
    """Resultants of facets, added as vectors.

    Claim: N, F and Q of tilted facets are the sums of pressure times the facet's area vector (the cross
    product of its edges) and of friction times its edge along the sliding direction
    Source: exact tractions of a facet per projected area (refimpl.model.forces); statics
    Tolerance: over the sum of magnitudes: 400 terms in numpy's blocks of 128 meet 18 roundings at most; 5e-17
    measured
    """
    random, edge = np.random.default_rng(12), 3e-6
    pressure, traction = random.uniform(0.0, 1e9, (2, 20, 20))
    tan_x, tan_y = random.uniform(-1.0, 1.0, (2, 20, 20))
    zero, one = np.zeros_like(tan_x), np.ones_like(tan_x)
    along, across = edge * np.stack((one, zero, tan_x), -1), edge * np.stack((zero, one, tan_y), -1)
    # onto the lower body, whose area vector points up and out of it
    terms = edge * traction[..., None] * along - pressure[..., None] * np.cross(along, across)
    F, Q, up = (math.fsum(terms[..., k].ravel()) for k in range(3))
    found = facet_resultants(pressure, traction, Slopes(tan_x, tan_y), edge**2)
    off = np.abs([found.normal + up, found.friction - F, found.binormal - Q])
    return Measured(float(off.max() / np.abs(terms).sum()))
