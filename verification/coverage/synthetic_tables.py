"""Synthetic tables of friction: scenes whose tau and beta are known, with noise on mu at several loads.

Surfaces, materials, friction, loads and noise of a table follow from its seed alone. Its friction is the
corrected mu on 512 elements, extrapolated: a fit on a coarser grid has that grid's error beside the noise.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

import refimpl as rf
from refimpl.accuracy.discretisation_error import estimates
from refimpl.identification import Row
from refimpl.identification.forward import COVERAGE
from verification.coverage.drawing import SIDE, Ball, Dice

KINDS = "rough ball", "capped rough ball", "self-affine ball", "rough planes"
ERRORS = "noise", "drift", "outlier", "unit slip", "noise"
GRIDS = 64, 128, 256  # elements along a side, of the fits of a drawn table
DRIFT = 1.0  # standard uncertainties from the first row to the last, upwards or downwards
OUTLIER = 8.0, 15.0  # standard uncertainties, least and most
SLIP = 1000.0  # kN in place of N, in a load or a friction force
SHARP_NOISE = 0.005
ROUGHNESS_TOLERANCE = 0.3  # relative half-width (95 %) of a measured rms height
SHARP_GRID, FINER_GRID = 192, 64  # where the contact at the least load is a tenth as wide as at the largest
TRUE_GRIDS = 256, 512


@dataclass(frozen=True, eq=False)
class SyntheticTable:
    """A scene with its true friction, rows with noise, a new load (N) and its true mu; the grid of a fit.

    ``further`` is the true value of a parameter that is fitted too: then the scene's is a first guess.
    ``error`` is one of `ERRORS`, ``wrong`` the index of the row that it changed. ``deviates`` are the rows'
    noise in standard uncertainties.
    """

    kind: str
    scene: rf.Scene
    rows: tuple[Row, ...]
    new_load: float
    new_mu: float
    noise: float
    grid: int
    deviates: tuple[float, ...]
    error: str = "noise"
    wrong: int | None = None
    further: float | None = None


class _Draw(Dice):
    """The random choices of a table, in the order in which they are made."""

    def materials(self) -> float:
        """Draw the materials of the lower and the upper body; return E* (Pa)."""
        self.lower, self.upper = (
            rf.Material(E=self.log(2e9, 400e9), nu=self.log(0.15, 0.45)) for _ in range(2)
        )
        return 1 / (1 / self.lower.plane_strain_modulus + 1 / self.upper.plane_strain_modulus)

    def ball(self, low: float, high: float) -> Ball:
        """Return a ball of these materials with a contact radius between two shares of the side."""
        return Ball(self.materials(), SIDE * self.log(5, 100), SIDE * self.log(low, high))

    def friction(self, pressure: float, least_tau: float, most_beta: float) -> rf.Friction:
        """Return friction with tau up to 0.3 of a pressure (Pa) and beta from 0.02."""
        return rf.Friction(tau=pressure * self.log(least_tau, 0.3), beta=self.log(0.02, most_beta))

    def scene(
        self, shape: rf.Surface, rough: rf.Surface, hardness: float | None, friction: rf.Friction, load: float
    ) -> rf.Scene:
        """Return a shape above roughness; it repeats where the shape is flat."""
        return rf.Scene(
            upper=rf.Body(self.upper, shape),
            lower=rf.Body(replace(self.lower, hardness=hardness), rough),
            friction=friction,
            load=load,
            side=SIDE,
            periodic=isinstance(shape, rf.Flat),
        )

    def table(
        self, kind: str, scene: rf.Scene, span: float, count: int, noise: float, most: float, grid: int
    ) -> SyntheticTable:
        """Return friction, with normal relative noise, at loads over ``span`` and one up to ``most``."""
        loads = map(float, np.geomspace(scene.load / span, scene.load, count))
        new_load = scene.load * self.log(1 / span, most)
        rows, deviates = [], []
        for load in loads:
            mu = true_friction(scene, load)
            u = noise * mu
            deviates.append(float(self.rng.standard_normal()))
            rows.append(Row(load, max(mu + u * deviates[-1], 0.0), u))
        new_mu = true_friction(scene, new_load)
        return SyntheticTable(kind, scene, tuple(rows), new_load, new_mu, noise, grid, tuple(deviates))

    def erroneous(self, table: SyntheticTable, error: str) -> SyntheticTable:
        """Return a table with one of `ERRORS` beside its noise; a drift is in the order of loads."""
        rows, sign = list(table.rows), float(self.rng.choice([-1, 1]))
        wrong, size = int(self.rng.integers(len(rows))), self.log(*OUTLIER)
        if error == "drift":
            steps = DRIFT * sign * np.linspace(-0.5, 0.5, len(rows))
            rows = [replace(row, mu=row.mu + step * row.u_mu) for row, step in zip(rows, steps, strict=True)]
        elif error == "outlier":
            row = rows[wrong]
            rows[wrong] = replace(row, mu=max(row.mu + sign * size * row.u_mu, 0.0))
        elif error == "unit slip":
            row = rows[wrong]
            rows[wrong] = (
                replace(row, load=row.load / SLIP)
                if sign > 0
                else replace(row, mu=row.mu / SLIP, u_mu=row.u_mu / SLIP)
            )
        found = wrong if error in ("outlier", "unit slip") else None
        return replace(table, rows=tuple(rows), error=error, wrong=found)


def drawn_table(seed: int) -> SyntheticTable:
    """Return a table of six to eight loads over a factor of 5 to 50, noise of 0.5 to 3 %.

    Neighbouring seeds share a table and differ in the grid of the fit.
    """
    return replace(_table_of_grids(seed // len(GRIDS)), grid=GRIDS[seed % len(GRIDS)])


@lru_cache(maxsize=1)
def _table_of_grids(number: int) -> SyntheticTable:
    draw, kind = _Draw(46, number), KINDS[number % len(KINDS)]
    shape: rf.Surface = rf.Flat()
    if kind == "rough planes":
        modulus = draw.materials()
        length, slope = SIDE * draw.log(0.06, 0.12), draw.log(0.01, 0.05)
        rough: rf.Surface = rf.GaussianRoughness(slope * length, length, 2 * number)
        pressure = 0.3 * modulus * slope
        load = 0.2 * pressure * SIDE**2
    else:
        ball = draw.ball(0.2, 0.35)
        load, pressure, shape = ball.load, ball.pressure, rf.Sphere(ball.R)
        rms, length = ball.approach * draw.log(0.02, 0.2), SIDE * draw.log(0.1, 0.3)
        rough = rf.GaussianRoughness(rms, length, 2 * number)
        if kind == "self-affine ball":
            short = min(SIDE / draw.log(8, 32), 0.99 * length)  # below the roll-off
            cuts = {"long_cut": length, "roll_off": length, "short_cut": short}
            rough = rf.SelfAffineRoughness(
                hurst=float(draw.rng.uniform(0.6, 0.9)), rms=0.5 * rms, seed=2 * number, **cuts
            )
    hardness = pressure * draw.log(0.8, 2.0) if kind.startswith("capped") else None
    scene = draw.scene(shape, rough, hardness, draw.friction(pressure, 0.03, 0.3), load)
    count, span, noise = int(draw.rng.integers(6, 9)), draw.log(5, 50), draw.log(0.005, 0.03)
    found = draw.table(kind, scene, span, count, noise, 1.2, GRIDS[-1])
    return draw.erroneous(found, ERRORS[number // len(KINDS) % len(ERRORS)])


def sharp_table(seed: int) -> SyntheticTable:
    """Return a table whose tau is well determined: a rough ball, 10 to 12 loads over two to three decades.

    Noise is 0.5 %. A/P of a ball falls with the load by a factor of 5 to 10 over such loads.
    """
    draw, kind = _Draw(43, seed), ("rough ball", "capped rough ball")[seed % 2]
    ball = draw.ball(0.3, 0.38)
    rough = rf.GaussianRoughness(ball.approach * draw.log(0.005, 0.03), SIDE * draw.log(0.1, 0.3), 2 * seed)
    hardness = ball.pressure * draw.log(1.2, 2.0) if kind.startswith("capped") else None
    scene = draw.scene(rf.Sphere(ball.R), rough, hardness, draw.friction(ball.pressure, 0.03, 0.2), ball.load)
    span, count = draw.log(100, 1000), int(draw.rng.integers(10, 13))
    return draw.table(kind, scene, span, count, SHARP_NOISE, 1.0, SHARP_GRID)


def yielding_table(seed: int) -> SyntheticTable:
    """Return a table whose hardness is fitted too: a ball, smooth or rough, that yields at its larger loads.

    Seven to twelve loads over a factor of 30 to 200, noise 0.3 to 1 %. The scene's hardness, the first guess
    of a fit, is off by up to 40 %.
    """
    draw, kind = _Draw(44, seed), ("yielding ball", "yielding rough ball")[seed % 2]
    ball = draw.ball(0.2, 0.25)
    rms, length = ball.approach * draw.log(0.005, 0.03), SIDE * draw.log(0.1, 0.3)
    rough = rf.GaussianRoughness(rms, length, 2 * seed) if "rough" in kind else rf.Flat()
    hardness = ball.pressure * draw.log(0.6, 1.0)
    scene = draw.scene(rf.Sphere(ball.R), rough, hardness, draw.friction(ball.pressure, 0.05, 0.2), ball.load)
    span, count, noise = draw.log(30, 200), int(draw.rng.integers(7, 13)), draw.log(0.003, 0.01)
    found = draw.table(kind, scene, span, count, noise, 1.1, FINER_GRID)
    guess = replace(scene.lower.material, hardness=hardness * draw.log(0.7, 1.4))
    return replace(found, scene=replace(scene, lower=rf.Body(guess, rough)), further=hardness)


def ensemble_table(seed: int) -> SyntheticTable:
    """Return a table whose rough ball is known by statistics alone, its rms height within 30 % (95 %).

    Its friction is of one realisation that no fit draws. Eight to twelve loads over a factor of 100 to 300,
    noise 0.5 to 2 %. The logarithm of the scene's rms is off by a normal deviate. A correlation length is six
    elements of the fit or more: of shorter ones contact patches are too small for the grid's error bars.
    """
    draw = _Draw(45, seed)
    ball = draw.ball(0.3, 0.35)
    rms, length = ball.approach * draw.log(0.03, 0.1), SIDE * draw.log(0.1, 0.2)
    rough = rf.GaussianRoughness(rms, length, 2 * seed)
    scene = draw.scene(rf.Sphere(ball.R), rough, None, draw.friction(ball.pressure, 0.05, 0.2), ball.load)
    span, count, noise = draw.log(100, 300), int(draw.rng.integers(8, 13)), draw.log(0.005, 0.02)
    found = draw.table("rough ball, drawn anew", scene, span, count, noise, 1.1, FINER_GRID)
    error = ROUGHNESS_TOLERANCE / COVERAGE * float(draw.rng.standard_normal())
    stated = rf.GaussianRoughness(rms * math.exp(error), length, 2 * seed + 1)
    return replace(found, scene=replace(scene, lower=rf.Body(scene.lower.material, stated)))


def true_friction(scene: rf.Scene, load: float) -> float:
    """Return the corrected mu, extrapolated from `TRUE_GRIDS`. ArithmeticError where one is unsolved."""
    features = []
    for grid in TRUE_GRIDS:
        solution = rf.solve(replace(scene, load=load), grid)
        if not solution.converged:
            raise ArithmeticError(f"the solve at {load:.4g} N ended as {solution.status.value}")
        features.append(solution.details.features)
    return estimates(features)["friction_coefficient_corrected"].value


def without_friction(scene: rf.Scene) -> rf.Scene:
    """Return the scene without its friction: a fit starts from its own guess."""
    return replace(scene, friction=rf.Friction())
