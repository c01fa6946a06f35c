"""A sphere whose pressure is capped at the hardness: rings, plastic limits, a published law."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

import refimpl as rf
from refimpl.model.materials import Pair
from verification.cases import Measured, case, certified
from verification.cases.contact.capped import rough_scene, with_hardness
from verification.exact.capped_sphere import Capped, capped_sphere, plastic_limit
from verification.exact.hertz import Sphere
from verification.exact.sphere_plasticity import KOGUT_ETSION_LARGEST, hardness_factor, kogut_etsion

RADIUS, LOAD = 5e-3, 20.0
MATERIAL = rf.Material(118e9, 0.34)
SPHERE = Sphere(LOAD, RADIUS, Pair(MATERIAL, MATERIAL).reduced_modulus)
SHARES = (0.95, 0.85, 0.75, 0.65, 0.55)
"""Hardnesses over Hertz' maximum pressure: the plastic core has 0.38 to 0.98 of the contact's radius."""
RINGS = 1600
NU, STEPS = 0.3, 24


def sphere_scene(hardness: float, load: float = LOAD) -> rf.Scene:
    """Return the frictionless sphere on a flat of that hardness (Pa), 2.6 largest radii a side."""
    sphere = replace(SPHERE, load=load)
    radius = max(sphere.contact_radius, plastic_limit(sphere, hardness)[0])
    flat = rf.Body(replace(MATERIAL, hardness=hardness), rf.Flat())
    return rf.Scene(rf.Body(MATERIAL, rf.Sphere(RADIUS)), flat, rf.Friction(), load, side=2.6 * radius)


@cache
def pair(share: float, grid: int) -> tuple[rf.Solution, Capped]:
    """Return our solution and that of rings at a hardness of this share of Hertz' maximum pressure."""
    hardness = share * SPHERE.peak_pressure
    found = certified(rf.solve(sphere_scene(hardness), grid, plastic=True))
    return found, capped_sphere(SPHERE, hardness, RINGS)


@case("capped/sphere-rings", metric="at_most", tolerance=3e-6)
def rings() -> Measured:
    """The rings' own convergence.

    Claim: rings of uniform pressure return Hertz above his maximum pressure, and their approach settles
    Source: Hertz 1882; Johnson 1985, section 3.4
    Tolerance: approach against Hertz, and change from 800 to 1600 rings: four times the largest
    """
    hertz = capped_sphere(SPHERE, 2 * SPHERE.peak_pressure, RINGS)
    off = {"against Hertz": abs(hertz.approach / SPHERE.approach - 1)}
    for share in SHARES:
        coarse, fine = (capped_sphere(SPHERE, share * SPHERE.peak_pressure, n) for n in (RINGS // 2, RINGS))
        off[f"at {share:g} p0"] = abs(coarse.approach / fine.approach - 1)
    return Measured(value=max(off.values()), data={"off": off})


@case("capped/sphere-approach", metric="at_most", tolerance=1.5e-4)
def approach() -> Measured:
    """Capped sphere: approach against rings.

    Claim: the approach under a load is that of the axisymmetric problem, at hardnesses of 0.55 to 0.95 p0
    Source: rings of uniform pressure (verification.exact.capped_sphere), 1600 of them, to 3e-6
    Tolerance: 128 elements a side: the error falls as the element's square; measured 1e-4 or less
    """
    pairs = {f"{share:g}": pair(share, 128) for share in SHARES}
    off = {share: abs(found.approach / exact.approach - 1) for share, (found, exact) in pairs.items()}
    return Measured(value=max(off.values()), data={"off": off})


@case("capped/sphere-pressure", metric="at_most", tolerance=0.02)
def pressure() -> Measured:
    """Capped sphere: pressure against rings.

    Claim: the pressure is that of the axisymmetric problem, and the hardness within the plastic core
    Source: rings of uniform pressure (verification.exact.capped_sphere)
    Tolerance: 128 elements, rms over the contact relative to H: elements at the edge hold means of a square
    root; the error falls by 2^(3/2) or so a grid
    """
    off = {}
    for share in SHARES:
        found, exact = pair(share, 128)
        x = found.grid.x - found.grid.lengths[0] / 2
        r = np.hypot(x[:, None], x)
        inside = r < exact.radius
        error = (found.pressure - np.interp(r, exact.r, exact.pressure))[inside] / found.details.problem.cap
        off[f"{share:g}"] = float(np.sqrt(np.mean(error**2)))
    return Measured(value=max(off.values()), data={"off": off})


@case("capped/sphere-areas", metric="at_most", tolerance=0.03)
def areas() -> Measured:
    """Capped sphere: contact and plastic core against rings.

    Claim: the corrected contact area and the plastic area are those of the axisymmetric problem
    Source: rings of uniform pressure (verification.exact.capped_sphere): edges by extrapolated squares
    Tolerance: 256 elements a side: the plastic area counts whole elements, and the hardness is reached as a
    root is; the smallest core is 77 elements wide
    """
    off = {}
    for share in SHARES:
        found, exact = pair(share, 256)
        off[f"contact, {share:g}"] = abs(found.contact_area_corrected / (np.pi * exact.radius**2) - 1)
        off[f"core, {share:g}"] = abs(found.plastic_area / (np.pi * exact.core**2) - 1)
    return Measured(value=max(off.values()), data={"off": off})


@case("capped/sphere-plastic-limit", metric="at_most", tolerance=0.01)
def limit() -> Measured:
    """Capped sphere: the fully plastic limit.

    Claim: far beyond yield the sphere sinks in as a uniformly loaded circle, with A = P / H
    Source: Johnson 1985, Eq. (3.29): d = a^2 / 2R + 4 H a / (pi E*), a = sqrt(P / (pi H))
    Tolerance: 128 elements a side: the circle's edge is staggered by half an element of its 49 to its radius
    """
    off = {}
    for share in (0.3, 0.1, 0.03):
        hardness = share * SPHERE.peak_pressure
        found = rf.solve(sphere_scene(hardness), 128)
        _, expected = plastic_limit(SPHERE, hardness)
        bearing = found.contact_area * hardness / LOAD - 1
        if not found.converged or bearing < -1e-8:
            raise RuntimeError(f"at {share:g} p0: {found.status.value}, A H / P - 1 = {bearing:.2g}")
        off[f"{share:g}"] = max(abs(found.approach / expected - 1), bearing)
    return Measured(value=max(off.values()), data={"off": off})


@case("capped/rough-plastic-limit", metric="at_most", tolerance=1e-7)
def rough_limit() -> Measured:
    """Rough surfaces: the fully plastic limit.

    Claim: as the hardness falls, A nears P / H from above by what elements below the hardness leave
    Source: load balance: A H - P = sum (H - f) dA over the contact
    Tolerance: the balance to 1e-8 of the load; and A H / P - 1 falls to 3 % or less, else no number
    """
    worst, near = 0.0, {}
    for seed in (1, 2, 4, 5):
        scene = replace(rough_scene(seed), friction=rf.Friction(15e6, 0.1))
        least = scene.load / (scene.lengths[0] * scene.lengths[1])
        excesses = []
        for factor in (200.0, 40.0, 8.0, 2.0):
            found = rf.solve(with_hardness(scene, factor * least), 64, plastic=True, oblique=False)
            H, dA = found.details.problem.cap, found.grid.element_area
            room = float(np.sum(H - found.pressure, where=found.contact)) * dA / scene.load
            excess = found.contact_area * H / scene.load - 1
            worst = max(worst, abs(excess - room), -excess)
            excesses.append(excess)
        near[str(seed)] = excesses
        if not excesses[-1] <= 0.03:
            raise RuntimeError(f"seed {seed}: A H / P - 1 = {excesses[-1]:.2g} at 2 P / A0")
    return Measured(value=worst, data={"A H / P - 1 at 200, 40, 8, 2 P / A0": near})


HARDNESS = 0.8e9


@case("capped/sphere-kogut-etsion", metric="at_most", tolerance=0.25)
def against_kogut_etsion() -> Measured:
    """Model form: the cap against Kogut and Etsion's sphere.

    Claim: a cap yields at 5.2 times the load of first yield, and its contact area stays within a quarter of
    the finite-element law's up to full plasticity
    Source: Kogut and Etsion 2002: fits up to 110 critical interferences, H = 2.8 Y, nu = 0.3
    Tolerance: largest relative difference of A at equal load: model form, no numerical error
    """
    laws = [kogut_etsion(float(w)) for w in np.geomspace(0.5, KOGUT_ETSION_LARGEST, STEPS)]
    peak = hardness_factor(NU) * HARDNESS  # maximum pressure at first yield
    a = np.pi * peak * RADIUS / (2 * SPHERE.modulus)
    loads = [law.load * (2 / 3 * np.pi * a**2 * peak) for law in laws]
    theirs = np.array([law.area * (np.pi * a**2) for law in laws])
    found = (rf.solve(sphere_scene(HARDNESS, load), 96, plastic=True) for load in loads)
    ours = np.array([s.contact_area_corrected for s in found])
    data = {
        "load / load of first yield": [law.load for law in laws],
        "mean pressure / H, cap": loads / ours / HARDNESS,
        "mean pressure / H, law": loads / theirs / HARDNESS,
    }
    return Measured(value=float(np.abs(ours / theirs - 1).max()), data=data)
