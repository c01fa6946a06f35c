"""Contact of self-affine surfaces: other codes on the same heights."""

from __future__ import annotations

import numpy as np

import refimpl as rf
from refimpl.grid import Grid
from verification.adapters import contactmechanics, tamaas
from verification.adapters.published_code import PublishedCode
from verification.cases import Measured, family
from verification.solver_suite.protocol import ContactProblem

MODULUS, SIDE = 1e9, 1e-3  # E* (Pa), m
SPLIT = rf.Material(E=2 * MODULUS, nu=0.0)  # two of these have E*


def pressed(
    surface: rf.Surface, M: int, load: float, *, periodic: bool, tolerance: float = 1e-8
) -> rf.Solution:
    """Press a flat on the surface, without friction and slope terms."""
    bodies = rf.Body(SPLIT, rf.Flat()), rf.Body(SPLIT, surface)
    scene = rf.Scene(*bodies, rf.Friction(), load, SIDE, periodic=periodic)
    solution = rf.solve(scene, grid=M, oblique=False, tolerance=tolerance)
    if solution.status is not rf.Status.CONVERGED:
        raise RuntimeError(f"the solver ended {solution.status.value} on {M} x {M} elements")
    return solution


@family(
    "code, name, source",
    {
        "reference/self-affine-tamaas": (
            tamaas.solve, "Tamaas",
            "Frerot, Anciaux, Rey, Pham-Ba and Molinari 2020 (J. Open Source Softw. 5, 2121)"),
        "reference/self-affine-contactmechanics": (
            contactmechanics.solve, "ContactMechanics",
            "ContactMechanics 1.8.3 (Pastewka, Sanner and others)"),
    },
    metric="at_most", tolerance=1e-6,
)  # fmt: skip
def agreement(code: PublishedCode) -> Measured:
    """Self-affine surfaces: pressures of {name} on the same heights.

    Claim: On the heights of a self-affine surface, free and periodic, {name} finds the same pressures
    Tolerance: relative to the peak; both solvers have the tolerance 1e-12 of the gap, whose root bounds the
    error in the energy norm. Measured 4e-12 with Tamaas 2.9.0 and ContactMechanics 1.8.3

    Two Hurst exponents on 128 x 128 elements.
    """
    M, differences = 128, {}
    for periodic in (False, True):
        for hurst in (0.3, 0.8):
            surface = rf.SelfAffineRoughness(
                hurst=hurst, rms_gradient=0.05, roll_off=2e-4, long_cut=5e-4, short_cut=4e-5, seed=1
            )
            load = 0.05 * MODULUS * surface.rms_gradient * SIDE**2
            heights = surface.sample(Grid.square(SIDE, M, periodic=periodic))
            gap = heights.max() - heights
            problem = ContactProblem(gap, SIDE / M, MODULUS, load=load, periodic=periodic, tolerance=1e-12)
            answer = code(problem)
            ours = pressed(surface, M, load, periodic=periodic, tolerance=1e-12)
            off = np.abs(np.asarray(answer.pressure) - ours.pressure).max() / ours.max_pressure
            differences[f"H = {hurst}, {'periodic' if periodic else 'free'}"] = float(off)
    return Measured(max(differences.values()), data={"worst": differences}, note=code.version)
