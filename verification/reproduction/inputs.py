"""Uncertainty of A, mu, p_max, a0 and f0 by the rounding of the paper's printed inputs.

Each input has half a unit of its last printed digit, or less where other printed numbers bound it: the load
by P = 2/3 pi a0^2 f0, tau and beta by the pairs of A and mu on Table 3's fine mesh.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cache

import numpy as np
from scipy.optimize import linprog

import refimpl as rf
from verification.reproduction.printed import HERTZ_PRESSURE, HERTZ_RADIUS, TABLE3, Column
from verification.reproduction.table1 import RADIUS, SMOOTH, rough

ROUNDED_RADIUS = 0.1430  # m: printed as 0.14; found from the printed f0
INPUTS = (
    "R",
    "E, ball",
    "E, flat",
    "nu, ball",
    "nu, flat",
    "sigma, flat",
    "sigma, ball",
    "l",
    "load",
    "side",
)
"""Printed inputs, without tau and beta, which have a joint effect on mu."""
HALF_UNITS = {  # relative; that of the flat's sigma is in `half_widths`
    "R": 0.005 / 0.14,
    "E, ball": 0.5 / 200,
    "E, flat": 0.5 / 118,
    "nu, ball": 0.005 / 0.30,
    "nu, flat": 0.005 / 0.30,
    "sigma, ball": 0.0005 / 0.084,
    "l": 0.5 / 104,
    "load": 0.5 / 70,
    "side": 0.005 / 1.61,
}
HALF_DIGIT = {"A": 5e-10, "mu": 5e-4, "a0": 5e-7, "f0": 5e4}  # m^2, 1, m, Pa: of the printed results
EQ10_MEAN_ERROR = 0.002  # relative: largest mean error of Eq. (10), case reproduction/eq10-full
LOADS = (63.0, 77.0)  # N, of two solves
RADII = (0.135, 0.145)  # m, of two solves


def half_widths(column: Column) -> dict[str, float]:
    """Return the relative half widths of the printed inputs in a column of Table 3."""
    found = dict(HALF_UNITS)
    found["sigma, flat"] = 0.5e-9 / column.flat_rms if column.flat_rms else 0.0
    found["load"] = min(found["load"], _load_bound())
    return found


def _load_bound() -> float:
    """Return the largest relative distance from 70 N of a load that the printed a0 and f0 allow."""
    loads = [
        2 * math.pi / 3 * (HERTZ_RADIUS + s * HALF_DIGIT["a0"]) ** 2 * (HERTZ_PRESSURE + s * HALF_DIGIT["f0"])
        for s in (-1, 1)
    ]
    return max(abs(load / SMOOTH.load - 1) for load in loads)


@cache
def differences(column: Column, parameter: str, mesh: int, realisations: int) -> tuple[float, float]:
    """Return the mean relative sensitivities of A and p_max to "load" or "R", by pairs of solves."""
    rms, found = (column.flat_rms, column.sphere_rms), []
    steps = LOADS if parameter == "load" else RADII
    for k in range(realisations if column.flat_rms else 1):
        scenes = [
            rough(*rms, k, load=step) if parameter == "load" else rough(*rms, k, radius=step)
            for step in steps
        ]
        pair = [rf.solve(scene, mesh) for scene in scenes]
        numbers = np.array([(s.contact_area_corrected, s.max_pressure) for s in pair])
        found.append(np.log(numbers[1] / numbers[0]) / math.log(steps[1] / steps[0]))
    area, peak = np.mean(found, axis=0)
    return float(area), float(peak)


def sensitivities(column: Column, mesh: int, realisations: int) -> dict[str, dict[str, float]]:
    """Return the relative sensitivities of A and p_max to every input of `INPUTS`.

    Those to the load and R are differences of solves. The others follow from scaling: areas are unchanged
    where all heights and the load scale together, or go with all lengths squared, as the load does; pressures
    scale with E*. The side only sets the element length.
    """
    load, radius = (differences(column, name, mesh, realisations) for name in ("load", "R"))
    return {
        "A": _scaled(column, load[0], radius[0], pressure=0, area=1),
        "p_max": _scaled(column, load[1], radius[1], pressure=1, area=0),
    }


def _scaled(column: Column, load: float, radius: float, *, pressure: int, area: int) -> dict[str, float]:
    smooth = column.flat_rms == 0
    rms = 0.0 if smooth else pressure + radius - load
    length = 0.0 if smooth else 2 * area - 2 * load - radius - rms
    flat = 0.0 if smooth else (column.flat_rms / column.equivalent_rms) ** 2
    found = {"R": radius, "load": load, "side": 0.0, "l": length}
    found |= {"sigma, flat": rms * flat, "sigma, ball": rms * (1 - flat)}
    for body, name in ((SMOOTH.upper, "ball"), (SMOOTH.lower, "flat")):
        m = body.material
        modulus = (pressure - load) * (1 - m.nu**2) / m.E * SMOOTH.materials.reduced_modulus
        found[f"E, {name}"] = modulus
        found[f"nu, {name}"] = modulus * 2 * m.nu**2 / (1 - m.nu**2)
    return found


def of_friction(area: Mapping[str, float], column: Column) -> dict[str, float]:
    """Return the relative sensitivities of mu by Eq. (10) from those of A."""
    share = 1 - SMOOTH.friction.beta / column.friction_coefficient[-1]  # tau A / (P mu)
    return {name: share * (s - (name == "load")) for name, s in area.items()}


def law_bounds() -> list[float]:
    """Return the largest relative effects on mu of a tau and beta that Table 3's fine mesh allows, by column.

    Allowed is what Eq. (10), with its mean error, makes of the printed A and mu within their last digits.
    """
    tau, beta = SMOOTH.friction.tau, SMOOTH.friction.beta
    pressure = np.array([column.contact_area[-1] for column in TABLE3]) / SMOOTH.load  # 1 / f_m
    mu = np.array([column.friction_coefficient[-1] for column in TABLE3])
    slack = HALF_DIGIT["mu"] + tau * HALF_DIGIT["A"] / SMOOTH.load + EQ10_MEAN_ERROR * mu
    form = np.column_stack([tau * pressure, np.ones_like(mu)])  # unknowns: tau / 15 MPa, beta
    rows, bounds = np.vstack([form, -form]), np.concatenate([mu + slack, slack - mu])
    ends = [
        abs(sign * linprog(sign * row, rows, bounds).fun - exact)
        for row, exact in zip(form, form @ [1.0, beta], strict=True)
        for sign in (1, -1)
    ]
    return [float(max(pair)) for pair in np.reshape(ends, (-1, 2)) / mu[:, None]]


def table(mesh: int, realisations: int) -> dict[str, list[float]]:
    """Return sensitivities, uncertainties and the effect of `ROUNDED_RADIUS` by column of Table 3."""
    data = {"sigma_e (um)": [column.equivalent_rms * 1e6 for column in TABLE3]}
    data["mu: u of tau and beta"] = law_bounds()
    for column, law in zip(TABLE3, law_bounds(), strict=True):
        half, found = half_widths(column), sensitivities(column, mesh, realisations)
        found["mu"] = of_friction(found["A"], column)
        for quantity, of in found.items():
            add = {f"{quantity}: {name}": of[name] for name in INPUTS}
            u = [of[name] * half[name] for name in INPUTS]
            add[f"{quantity}: u of inputs"] = math.hypot(*u, law if quantity == "mu" else 0.0)
            change = of["R"] * math.log(ROUNDED_RADIUS / RADIUS)
            add[f"{quantity}: change at R = 0.143 m"] = math.expm1(change)
            for name, value in add.items():
                data.setdefault(name, []).append(value)
    return data


def hertz_misfit(data: Mapping[str, Sequence[float]]) -> float:
    """Return the largest difference of the smooth column's sensitivities from Hertz' exponents."""
    exact = {"A: load": 2 / 3, "A: R": 2 / 3, "p_max: load": 1 / 3, "p_max: R": -2 / 3}
    return max(abs(data[name][0] - value) for name, value in exact.items())
