"""Friction: tau far beyond the pressure, beta far beyond 1, with and without the slope correction."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import refimpl as rf
from verification.extremes.judge import SOLVERS, by_oracle
from verification.extremes.state import Extreme, axis
from verification.scenes.cross_checks import POLYMER, STEEL, pressed

M = 5
TAUS = [10.0**k for k in (-12, -6, -3, -2, -1, -0.5, 0, 0.25, 0.5, 0.75, 1, 1.5, 2, 3, 6)]
"""tau over the peak pressure without it."""
BETAS = (1e-12, 1e-3, 0.1, 0.5, 1.0, 2.0, 5.0, 10.0, 100.0, 1e3, 1e6)


def rubbed(tau: float, beta: float, *, soft_below: bool = True) -> rf.Scene:
    """A ball on a rough flat; tau in units of 40 MPa, about the peak pressure."""
    bodies = (STEEL, POLYMER) if soft_below else (POLYMER, STEEL)
    return pressed(
        upper=bodies[0], lower=bodies[1], rms=0.5e-6, load=30.0, direction=0.7,
        friction=rf.Friction(40e6 * tau, beta),
    )  # fmt: skip


@axis("friction")
def friction() -> Iterator[Extreme]:
    """Either sign of the coupling, half-space and periodic, slope terms kept, dropped and corrected."""
    for method in SOLVERS:
        for tau in TAUS:
            for series, scene, options in (
                ("tau", rubbed(tau, 0.0), {}),
                ("tau, soft ball", rubbed(tau, 0.0, soft_below=False), {}),
                ("tau without slopes", rubbed(tau, 0.0), {"oblique": False}),
            ):
                yield Extreme(
                    "friction", f"{series}, {method}", f"tau/f = {tau:.3g}", tau,
                    partial(by_oracle, scene, M, method, **options),
                )  # fmt: skip
        for beta in BETAS:
            for series, scene, options in (
                ("beta", rubbed(0.0, beta), {}),
                ("beta without slopes", rubbed(0.0, beta), {"oblique": False}),
                ("beta, periodic", replace(rubbed(0.0, beta), periodic=True), {"oblique": False}),
                ("beta, slope correction", rubbed(0.0, beta), {"slope_correction": True}),
            ):
                yield Extreme(
                    "friction", f"{series}, {method}", f"beta = {beta:g}", beta,
                    partial(by_oracle, scene, M, method, **options),
                )  # fmt: skip
