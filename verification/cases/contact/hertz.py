"""Table 1 without friction against Hertz: peak, approach, profile, orders, and radius over grid shifts."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from verification.cases import Measured, case, certified, family
from verification.exact.hertz import UNCERTAINTY, Sphere
from verification.framework.rates import fit_order

SOURCE = "Hertz 1882; Johnson 1985, section 4.2; paper Table 1, P = 70 N"
SCENE = rf.read_scene("hertz")
RADIUS = 0.14
EXACT = Sphere(load=SCENE.load, radius=RADIUS, modulus=SCENE.materials.reduced_modulus)
GRIDS = (32, 64, 128, 256, 512)
FINE = 256


@cache
def solved(M: int, x: float = 0.0, y: float = 0.0) -> rf.Solution:
    """Return the scene, its axis ``x``, ``y`` shares of an element from the middle."""
    h = SCENE.lengths[0] / M
    offset = (2 * np.arange(M) + 1 - M) * (h / 2)
    ball = ((offset - x * h)[:, None] ** 2 + (offset - y * h)[None, :] ** 2) / (2 * RADIUS)
    scene = replace(SCENE, upper=rf.Body(SCENE.upper.material, ball))
    return certified(rf.solve(scene, M), cycled=False)


def distance(M: int) -> Array:
    """Return the distance of the element centres from the axis in the middle (m)."""
    offset = (2 * np.arange(M) + 1 - M) * (SCENE.lengths[0] / M / 2)
    apart: Array = np.hypot(offset[:, None], offset[None, :])
    return apart


def spacings() -> list[float]:
    """Return the element edges (m), coarse to fine."""
    return [SCENE.lengths[0] / M for M in GRIDS]


@case("hertz/peak-pressure", metric="relative", tolerance=1e-4, source=SOURCE)
def peak_pressure() -> Measured:
    """Peak pressure of the Hertz contact at 256 x 256.

    Claim: the peak pressure is p0 = (6 P E*^2 / (pi^3 R^2))^(1/3)
    Tolerance: the innermost centres lie h/sqrt(2) off the axis, which costs (h/a)^2/4 = 5e-5; the rest is the
    elements' own second order, of the other sign. Measured 3.7e-5
    """
    solution, r = solved(FINE), distance(FINE)
    middle = FINE // 2
    data = {
        "x": (np.arange(FINE) + 0.5 - middle) * solution.grid.spacings[0] * 1e3,
        "computed": solution.pressure[:, middle] / 1e6,
        "hertz": EXACT.pressure(r[:, middle]) / 1e6,
    }
    return Measured(
        value=solution.max_pressure,
        reference=EXACT.peak_pressure,
        reference_uncertainty=UNCERTAINTY * EXACT.peak_pressure,
        unit="Pa",
        data=data,
    )


@family(
    "number, exact, name, tolerance, tolerance_reason",
    {
        "hertz/peak-order": (
            "max_pressure", EXACT.peak_pressure, "peak pressure", 0.25,
            "the contact's fit to the grid scatters single errors by some 20 %, which over a factor of 16 in "
            "h moves a fitted order by 0.1; twice that. Measured 2.04"),
        "hertz/approach-order": (
            "approach", EXACT.approach, "approach", 0.15,
            "counted from the lowest centres it lacks h^2/(4 R), which dominates and is exactly of second "
            "order; the solver's own part is 10 % of it and of order 2.0 to 2.9. Measured 2.03"),
    },
    metric="absolute", source=SOURCE,
)  # fmt: skip
def order(number: str, exact: float) -> Measured:
    """Order of the {name} over 32 ... 512.

    Claim: the error of the {name} falls with the square of the element
    """
    errors = [abs(getattr(solved(M), number) / exact - 1) for M in GRIDS]
    found = fit_order(spacings(), errors)
    return Measured(
        value=found.order,
        reference=2.0,
        note=f"local orders {', '.join(f'{p:.2f}' for p in found.local)}",
    )


@case("hertz/approach", metric="relative", tolerance=2e-5, source=SOURCE)
def approach() -> Measured:
    """Approach of the Hertz contact at 256 x 256.

    Claim: the approach from the sphere's lowest point is a^2 / R
    Tolerance: an integral of the pressure, so (h/a)^2 / 10 = 2e-5; measured 6e-6. From the elements' first
    contact, h^2/(4 R) higher, it is 5e-5 short
    """
    # the sphere's lowest point lies between the four innermost centres
    found = solved(FINE).approach + float(distance(FINE).min()) ** 2 / (2 * RADIUS)
    return Measured(found, EXACT.approach, UNCERTAINTY * EXACT.approach, unit="m")


@case("hertz/profile", metric="at_most", tolerance=1e-4, source=SOURCE)
def profile() -> Measured:
    """Pressure within 0.8 radii at 256 x 256.

    Claim: the pressure is p0 sqrt(1 - r^2/a^2)
    Tolerance: second order away from the edge: p'' h^2/24 at 0.8 a is 4e-5 of p0, and twice that for the
    smoothing by the collocation. Over p0; measured 3.4e-5
    """
    errors = []
    for M in GRIDS:
        r = distance(M)
        off = np.abs(solved(M).pressure - EXACT.pressure(r))[r < 0.8 * EXACT.contact_radius]
        errors.append(float(off.max()) / EXACT.peak_pressure)
    fitted = fit_order(spacings(), errors).order
    return Measured(value=errors[GRIDS.index(FINE)], note=f"order {fitted:.2f} over 32 ... 512")


@cache
def mean_radii(M: int, shifts: int) -> tuple[float, float]:
    """Return the mean area's radii (m), raw and perimeter-corrected, over ``shifts^2`` axes.

    Positions fill one element evenly. Mirror images have the same area, so that only an eighth of them is
    solved and counted with its multiplicity.
    """
    places = [abs((k + 0.5) / shifts - 0.5) for k in range(shifts)]
    raw = corrected = 0.0
    for x in places:
        for y in places:
            solution = solved(M, *sorted((x, y)))
            raw += solution.contact_area
            corrected += solution.contact_area_corrected
    count = shifts**2
    return math.sqrt(raw / count / math.pi), math.sqrt(corrected / count / math.pi)


def _radius_note(shifts: int, M: int) -> str:
    raw, corrected = (r / EXACT.contact_radius - 1 for r in mean_radii(M, shifts))
    return f"{shifts**2} shifts at {M}: raw {raw:+.2e}, perimeter-corrected {corrected:+.2e}"


@case("hertz/radius-corrected", metric="relative", tolerance=1e-3)
def radius_corrected() -> Measured:
    """Contact radius from the perimeter-corrected area, 64 shifts at 256 x 256.

    Claim: averaged over the sphere's position in an element, the corrected area has the radius (3 P R / 4
    E*)^(1/3)
    Source: {SOURCE}; Yastrebov et al. 2017 for the correction
    Tolerance: first order in h/a = 0.014: the correction subtracts the mean excess of whole elements and a
    third more, so 5e-4 too small as measured, 2.5e-4 on half the element
    """
    note = f"{_radius_note(8, 256)}; {_radius_note(4, 512)}"
    return Measured(value=mean_radii(256, 8)[1], reference=EXACT.contact_radius, unit="m", note=note)


@case("hertz/radius-raw", metric="relative", tolerance=1e-3, source=SOURCE)
def radius_raw() -> Measured:
    """Contact radius from the raw area, 16 shifts at 512 x 512.

    Claim: averaged over the sphere's position in an element, the counted area tends to the radius (3 P R / 4
    E*)^(1/3)
    Tolerance: an element counts as soon as it is loaded at all, which adds about 0.12 h to the radius: 1.6e-3
    at 256 x 256, half of it at 512 x 512
    """
    note = f"{_radius_note(4, 512)}; {_radius_note(8, 256)}"
    return Measured(value=mean_radii(512, 4)[0], reference=EXACT.contact_radius, unit="m", note=note)


@case("hertz/small-slope", metric="absolute", tolerance=0.005)
def small_slope() -> Measured:
    """The classical small-slope theory against the slope terms.

    Claim: a rigid ball pressed to a / R = 0.33 into a soft flat has a 6 % larger maximum pressure with the
    slope terms of Eqs (2) and (6) than by the classical theory that other codes solve (oblique=False)
    Source: Eqs (2) and (6) as printed; Hertz 1882
    Tolerance: the quoted per cent is rounded; 6.45 % on 128 x 128 elements, 6.41 % on 64 x 64
    """
    radius, share, soft = 1e-3, 0.33, rf.Material(E=1e9, nu=0.3)
    a = share * radius
    load = 4 * soft.plane_strain_modulus * a**3 / (3 * radius)
    ball = rf.Body(rf.Material(E=math.inf, nu=0.3), rf.Sphere(radius))
    scene = rf.Scene(ball, rf.Body(soft, rf.Flat()), rf.Friction(), load, side=3 * a)
    steep, flat = (rf.solve(scene, 128, oblique=oblique) for oblique in (True, False))
    return Measured(steep.max_pressure / flat.max_pressure - 1, 0.0645)
