"""Fig. 8: friction, contact area and their rates of change over roughness and plasticity index."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.optimize import curve_fit

import refimpl as rf
from refimpl.grid import Array
from refimpl.model.forces import plasticity_index
from verification.reproduction.ensemble import QUICK_MESH, column, estimate, rows_at
from verification.reproduction.printed import CORRELATION_LENGTH, HARDNESS, LOADS, SPHERE_RMS
from verification.reproduction.table1 import SMOOTH, rough
from verification.sweep.run import Row


@dataclass(frozen=True)
class Curve:
    """One load's curves over ``rms`` = sigma_e (m), the smooth contact first: means and 95 % half widths.

    ``error`` is the standard error of mu.
    """

    load: float
    rms: Array
    friction: Array
    friction_half: Array
    error: Array
    area: Array
    area_half: Array

    @property
    def middle(self) -> Array:
        """sigma_e (m) of the rates: between neighbouring roughnesses."""
        return (self.rms[1:] + self.rms[:-1]) / 2

    def rate(self, values: Array) -> Array:
        """Return the slope of a curve over sigma_e between neighbours, over its first one."""
        slope = np.diff(values) / np.diff(self.rms)
        return np.asarray(slope / slope[0])


def plasticity(rms: Array, length: float = CORRELATION_LENGTH) -> Array:
    """Return Eq. (12) with the given length (m) for its epsilon."""
    modulus = SMOOTH.materials.reduced_modulus
    return np.array([plasticity_index(modulus, HARDNESS, s, length) for s in rms])


@cache
def curves(tier: str) -> tuple[Curve, ...]:
    """Return one curve per load, of the shipped study or its quick part."""
    mesh = 256 if tier == "full" else QUICK_MESH
    return tuple(_curve(rows_at(tier, "fig8"), load, mesh) for load in LOADS)


def _curve(found: Sequence[Row], load: float, mesh: int) -> Curve:
    flats = sorted({row["lower_rms"] for row in found})
    smooth = rf.solve(rough(0.0, load=load), mesh)
    points = [(0.0, smooth.friction_coefficient, 0.0, 0.0, smooth.contact_area, 0.0)]
    for flat in flats:
        where = {"load": load, "lower_rms": flat}
        mu = estimate(column(found, "friction_coefficient", **where))
        area = estimate(column(found, "contact_area", **where))
        rms = float(np.hypot(flat, SPHERE_RMS))
        error = mu.scatter * mu.mean / np.sqrt(mu.n)
        points.append((rms, mu.mean, mu.half_width, error, area.mean, area.half_width))
    return Curve(load, *np.array(points).T)


@dataclass(frozen=True)
class Decay:
    """Misfits (rms, relative to the fall over the range) of ``mu - limit`` falling as an exponential and as
    ``1 / (1 + (sigma / scale)^1.5)``; limit and scale (m) of the exponential, and the largest distance of
    the means from it, in standard errors.
    """

    exponential: float
    algebraic: float
    limit: float
    scale: float
    standard_errors: float


def decay(curve: Curve) -> Decay:
    """Return the least-squares fits of three parameters each to mu over sigma_e."""
    x, fall = curve.rms * 1e6, float(np.ptp(curve.friction))

    def exponential(s: Array, limit: float, height: float, scale: float) -> Array:
        return np.asarray(limit + height * np.exp(-s / scale))

    def algebraic(s: Array, limit: float, height: float, scale: float) -> Array:
        return np.asarray(limit + height / (1 + (s / scale) ** 1.5))

    start = (float(curve.friction[-1]), fall, 0.2)
    bounds = ((0.0, 0.0, 1e-3), (1.0, 10.0, 10.0))
    laws = (exponential, algebraic)
    fits = {law: curve_fit(law, x, curve.friction, start, bounds=bounds)[0] for law in laws}
    misfits = {law: float(np.sqrt(np.mean((law(x, *p) - curve.friction) ** 2))) for law, p in fits.items()}
    limit, _, scale = fits[exponential]
    rough = curve.friction_half > 0
    missed = np.abs(exponential(x, *fits[exponential]) - curve.friction)[rough]
    return Decay(
        exponential=misfits[exponential] / fall,
        algebraic=misfits[algebraic] / fall,
        limit=float(limit),
        scale=float(scale) * 1e-6,
        standard_errors=float((missed / curve.error[rough]).max()),
    )
