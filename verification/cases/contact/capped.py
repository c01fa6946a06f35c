"""Pressures capped at the hardness: both solvers, manufactured states and limits."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np

import refimpl as rf
from verification.cases import Measured, case, certified
from verification.cases.contact.manufactured import METHODS, ROUNDING, misfit
from verification.exact.manufactured import PEAK, manufacture

SCENES, M, SIDE = 20, 16, 1e-3
AGREE = 1e-9
"""Share of the hardness within which pressures of two solvers agree."""


def rough_scene(seed: int) -> rf.Scene:
    """Return rough bodies without a hardness, free or periodic; tau is up to a fifth of the mean pressure."""
    random = np.random.default_rng(seed)
    periodic = seed % 3 == 0
    copper, steel = rf.Material(118e9, random.uniform(0.0, 0.45)), rf.Material(200e9, 0.3)
    scene = rf.Scene(
        upper=rf.Body(steel, rf.Flat() if periodic else rf.Sphere(5e-3)),
        lower=rf.Body(copper, rf.GaussianRoughness(10 ** random.uniform(-7, -6.3), 150e-6, seed=seed)),
        friction=rf.Friction(),
        load=10 ** random.uniform(0.5, 2),
        side=SIDE,
        sliding_direction=random.uniform(-3, 3),
        periodic=periodic,
    )
    elastic = rf.solve(scene, M, oblique=False)
    tau = (0.0, 0.05, 0.2)[seed % 3] * elastic.normal_force / elastic.contact_area
    return replace(scene, friction=rf.Friction(tau, (0.1, 0.0, 0.3, 0.1)[seed % 4]))


def with_hardness(scene: rf.Scene, hardness: float, *, upper: bool = False) -> rf.Scene:
    """Return the scene with a hardness (Pa) of the lower body, or of the upper one."""
    name = "upper" if upper else "lower"
    body: rf.Body = getattr(scene, name)
    changed = rf.Body(replace(body.material, hardness=hardness), body.surface)
    return replace(scene, upper=changed) if upper else replace(scene, lower=changed)


def peak_of(scene: rf.Scene, grid: int | tuple[int, int]) -> float:
    """Return the maximum pressure of the elastic contact of flat slopes (Pa)."""
    return rf.solve(scene, grid, plastic=False, oblique=False).max_pressure


def apart(dense: rf.Solution, fft: rf.Solution) -> float:
    """Return the largest difference of pressures over H, of F and Q over the load; infinite on other sets."""
    if not np.array_equal(dense.contact, fft.contact) or dense.plastic_area != fft.plastic_area:
        return float("inf")
    forces = (getattr(dense, name) - getattr(fft, name) for name in ("friction_force", "binormal_force"))
    pressures = np.abs(dense.pressure - fft.pressure).max() / dense.details.problem.cap
    return max(float(pressures), *(abs(float(force)) / dense.normal_force for force in forces))


@case("capped/dense-fft", metric="at_most", tolerance=AGREE)
def dense_and_fft() -> Measured:
    """Capped contact: production against plain solver.

    Claim: the same sets, pressures to 1e-9 of H, F and Q to 1e-9 of the load: 20 squares and rectangles
    Source: dense matrices and pivoting between two bounds (Judice and Pires 1994)
    Tolerance: certificate of 1e-11, and a condition number of some 30 to 100
    """
    off = {}
    for seed, share in enumerate(np.geomspace(0.9, 0.02, SCENES)):
        bare, grid, oblique = rough_scene(seed), (M, M), seed % 2 == 0
        if seed % 5 == 4:
            bare, grid = replace(bare, side=None, size=(SIDE, 0.75 * SIDE)), (M, 3 * M // 4)
        least = bare.load / (bare.lengths[0] * bare.lengths[1])
        scene = with_hardness(bare, max(share * peak_of(bare, grid), 1.02 * least), upper=seed % 4 == 0)
        dense = rf.solve(scene, grid, method="dense", oblique=oblique, plastic=True)
        fft = rf.solve(scene, grid, tolerance=1e-11, oblique=oblique, plastic=True)
        off[str(seed)] = apart(dense, fft)
    return Measured(value=max(off.values()), data={"apart": off})


@case("capped/manufactured", metric="at_most", tolerance=1e-12, tolerance_reason=ROUNDING)
def manufactured() -> Measured:
    """Manufactured states with elements at both bounds.

    Claim: both solvers return pressure, traction and approach where part of the contact yields
    Source: method of manufactured solutions (Roache 2002); sums of 50-digit integrals
    """
    states = {
        f"state {seed}, oblique {oblique}": manufacture(12, seed, 0.7, oblique, False, 0.6 * PEAK)
        for seed, oblique in product((1, 2), (False, True))
    }
    off = {f"{m}, {name}": misfit(state, m) for m, (name, state) in product(METHODS, states.items())}
    return Measured(value=max(off.values()), data={"worst": off})


@case("capped/full", metric="at_most", tolerance=2e-4)
def full() -> Measured:
    """Fully plastic limit.

    Claim: just below P = H A0 mu is tau / H + beta and pressures are H, free and periodic, by both solvers
    Source: Eq. (1) at f = H
    Tolerance: the load is 1e-4 below the limit, which elements of the least pressure share
    """
    off = {}
    for periodic, method in product((False, True), METHODS):
        bare = replace(rough_scene(1), periodic=periodic, friction=rf.Friction(15e6, 0.1))
        hardness = (1 + 1e-4) * bare.load / SIDE**2
        s = certified(rf.solve(with_hardness(bare, hardness), M, method=method, oblique=False))
        missing = 1 - float(s.pressure.min() / hardness)
        off_limit = abs(s.friction_coefficient / (15e6 / hardness + 0.1) - 1)
        off[f"{method}, periodic {periodic}"] = max(off_limit, M**-2 * missing)
    return Measured(value=max(off.values()), data={"off": off})


@case("capped/infinite-hardness", metric="at_most", tolerance=AGREE)
def infinite() -> Measured:
    """A hardness beyond all pressures.

    Claim: the capped solver returns the elastic solution
    Source: the problem itself
    Tolerance: two certificates of 1e-12, and the condition number of some 30 to 100
    """
    off = {}
    for seed in range(1, 6):
        scene = rough_scene(seed)
        elastic = rf.solve(scene, 32, tolerance=1e-12)
        capped = rf.solve(with_hardness(scene, 1e3 * elastic.max_pressure), 32, plastic=True, tolerance=1e-12)
        off[str(seed)] = float(np.abs(capped.pressure - elastic.pressure).max() / elastic.max_pressure)
    return Measured(value=max(off.values()), data={"apart": off})
