"""Proven bounds of capped states against the plain solver's solution, at tolerances from lax to strict."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import refimpl as rf
from verification.cases import Measured, case
from verification.cases.contact.capped import SIDE, peak_of, rough_scene, with_hardness

GRID, SCENES, TOLERANCES = 16, 16, (1e-4, 1e-8, 1e-11)
SHARES = (0.8, 0.4, 0.2, 0.1)
ROUNDING = 1e-12
"""Relative error of the plain solver's numbers."""


def shares_of_bounds(seed: int) -> dict[str, list[float]]:
    """Return error over bound of pressure, approach and mu by tolerance; infinite on a wrong set."""
    bare = rough_scene(seed)
    bare = replace(bare, friction=rf.Friction(0.0, bare.friction.beta))  # tau's active set is held by bounds
    hardness = max(SHARES[seed % 4] * peak_of(bare, GRID), 1.02 * bare.load / SIDE**2)
    scene = with_hardness(bare, hardness)
    exact = rf.solve(scene, GRID, method="dense", plastic=True, oblique=False)
    at_approach = seed % 5 == 1 and not scene.periodic
    found: dict[str, list[float]] = {"sets": [], "pressure": [], "approach": [], "mu": []}
    for tolerance in TOLERANCES:
        approach = exact.approach if at_approach else None
        s = rf.solve(scene, GRID, plastic=True, oblique=False, tolerance=tolerance, approach=approach)
        b = s.details.bounds
        if not np.isfinite(b.energy):
            raise RuntimeError(f"scene {seed}: {b.unproven}")
        wrong = (b.plastic & (exact.pressure < hardness)) | (b.in_contact & (exact.pressure == 0))
        wrong |= b.out_of_contact & (exact.pressure > 0)
        found["sets"].append(np.inf if wrong.any() else 0.0)
        for name, error, bound, size in (
            ("pressure", np.abs(s.pressure - exact.pressure).max(), b.pressure, exact.max_pressure),
            ("approach", abs(s.approach - exact.approach), b.approach, abs(exact.approach)),
            ("mu", abs(s.friction_coefficient - exact.friction_coefficient), b.friction_coefficient, 1.0),
        ):
            found[name].append(float(error) / (bound + ROUNDING * size))
    return found


@case("capped/bounds", metric="at_most", tolerance=1.0)
def bounds() -> Measured:
    """Proven bounds of capped states.

    Claim: no error of pressure, approach or mu exceeds its bound, and no element is marked wrongly as
    plastic, in contact or apart: 16 scenes at three tolerances
    Source: refimpl.bounds.proven_bounds, from the variational inequality with two bounds; dense matrices
    Tolerance: proven; a bound that is met to rounding would be 1
    """
    found = {str(seed): shares_of_bounds(seed) for seed in range(SCENES)}
    worst = max(max(values) for numbers in found.values() for values in numbers.values())
    return Measured(value=worst, data={"error over bound": found})
