"""Manufactured states, demanded back from both solvers to rounding."""

from __future__ import annotations

import numpy as np

import refimpl as rf
from refimpl.planning.plan import Method
from verification.cases import Measured, family
from verification.exact.manufactured import Manufactured, manufacture

SOURCE = "method of manufactured solutions (Roache 2002); sums of 50-digit integrals"
M, SEEDS, ANGLE = 12, (1, 2, 3), 0.7
METHODS: tuple[Method, ...] = ("dense", "fft")
ROUNDING = (
    "the heights are rounded to 1e-16 of some 2e-6 m against displacements of 1e-6 m, and the flexibility's "
    "condition number on 12 x 12 elements is about 30: 1e-14 per element at random, ten times that at worst"
)


def misfit(state: Manufactured, method: Method) -> float:
    """Return the largest difference of p and traction over the peak, of approach; infinite off the set."""
    oblique, exact = state.oblique, state.slope_correction
    found = rf.solve(
        state.scene, state.M, method=method, tolerance=1e-13, oblique=oblique, slope_correction=exact
    )
    if not np.array_equal(found.contact, state.pressure > 0):
        raise RuntimeError(f"{method} finds another contact set than the manufactured one")
    peak = state.pressure.max()
    return max(
        float(np.abs(found.pressure - state.pressure).max() / peak),
        float(np.abs(found.traction - state.traction).max() / peak),
        abs(found.approach / state.approach - 1),
    )


@family(
    "oblique, slope_correction, title, claim",
    {
        "manufactured/friction": (
            False, False, "Manufactured states with friction, without slopes",
            "both solvers return the chosen pressure, traction and approach: a, c, tau, beta at 0.7 rad"),
        "manufactured/oblique": (
            True, False, "Manufactured states with friction on a wavy common surface",
            "both solvers return the chosen state where the cosines of Eqs (2) and (6) differ from 1"),
        "manufactured/slope-correction": (
            True, True, "Manufactured states with exact facet tractions",
            "both solvers return the chosen state with exact facet tractions in Eq. (7)"),
    },
    source=SOURCE, metric="at_most", tolerance=1e-12, tolerance_reason=ROUNDING,
)  # fmt: skip
def states(oblique: bool, slope_correction: bool) -> Measured:
    off = {
        f"{method}, state {seed}": misfit(manufacture(M, seed, ANGLE, oblique, slope_correction), method)
        for method in METHODS
        for seed in SEEDS
    }
    return Measured(value=max(off.values()), data={"worst": off})
