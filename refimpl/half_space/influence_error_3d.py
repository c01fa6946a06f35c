"""Error of the solver's own influence coefficients on a slope: one square element, three dimensions.

``coefficient_error`` is of strips in plane strain, whose displacements have no datum. Three-dimensional
displacements decay, so here the self coefficient and those across the slope are judged too. The table
(``data/coefficient_error_3d.json``) holds what finite elements found for a square element of half-edge
``a`` on a sinusoidal ridge of wavelength ``20 a``, the shortest computed. What is the largest on crest, flank
and valley exceeds these by 6 % at most on ridges of 50 and 100 a. Where two such waves cross, in an egg-box,
the self coefficient and those across are off by up to twice as much (tests of this module compare).
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from functools import cache
from importlib import resources
from itertools import product

import numpy as np

from refimpl.errors import require_number
from refimpl.grid import Array
from refimpl.model.materials import Material

_POSITIONS = (0.0, 0.25, 0.5)  # crest, flank, valley as the lower body sees them
_MIRRORED = [0, 4, 5, 6, 1, 2, 3, 7, 8, 9]  # +x and -x change places


@dataclass(frozen=True)
class ElementError:
    """Largest relative errors on crest, flank and valley: self; three neighbours in line, and across."""

    self_coefficient: float
    in_line: float
    across: float


def element_error(slope: float, lower: Material, upper: Material | None = None) -> ElementError:
    """Return the errors of flat coefficients on a wave of maximum ``slope`` (rad), up to 30 degrees.

    One body alone when ``upper`` is None; in a pair the first-order parts enter as lower minus upper.
    Raises `InputError` for a slope beyond the table and for a negative Poisson's ratio.

    >>> steel, copper = Material(E=200e9, nu=0.3), Material(E=118e9, nu=0.3)
    >>> largest = math.radians(6.5)
    >>> element_error(largest, copper, steel).in_line < 0.02 < element_error(largest, copper).in_line
    True
    """
    top = steepest_tabulated()
    require_number("slope", slope, f"an angle of 0 to {top:.4g} rad", at_least=0, at_most=top + 1e-12)
    bodies = [(lower, 0)] if upper is None else [(lower, 0), (upper, 2)]
    for body, _ in bodies:
        require_number("nu", body.nu, "a Poisson's ratio of 0 to 0.5", at_least=0)
    flat = sum(body.normal_compliance for body, _ in bodies)
    wavy = np.zeros((len(_POSITIONS), len(_MIRRORED)))
    for body, turn in bodies:  # a crest of one body is a valley of the other, half a wave away
        errors = _errors(slope, body.nu)
        quarters = np.array([*errors, errors[1, _MIRRORED]])  # the other flank is mirrored
        wavy += body.normal_compliance / flat * np.roll(quarters, -turn, axis=0)[: len(_POSITIONS)]
    worst = np.abs(wavy).max(axis=0)
    return ElementError(float(worst[0]), float(worst[1:7].max()), float(worst[7:].max()))


def steepest_tabulated() -> float:
    """Return the table's largest slope (rad)."""
    return math.radians(float(_table()[0][-1]))


def _errors(slope: float, nu: float) -> Array:
    """Return the errors (positions, 10): linear over the slope's tangent, quadratic in nu.

    What is interpolated is the error over the tangent, and times ``1 - nu^2``, as a displacement is: its
    first-order part, ``(1 + nu)(1 - 2 nu)`` times the slope, is met exactly.
    """
    slopes, ratios, errors = _table()
    tangents, tangent = np.tan(np.radians(slopes)), math.tan(slope)
    quotients = errors / tangents[:, None] * (1 - ratios[:, None, None, None] ** 2)
    before = int(np.searchsorted(tangents[1:], tangent, side="right"))
    rises = np.diff(quotients, axis=2, append=quotients[:, :, -1:])[:, :, before]
    rise = rises / np.diff(tangents, append=math.inf)[before]
    by_slope = rise * max(tangent - tangents[before], 0.0) + quotients[:, :, before]
    weights = [math.prod((nu - other) / (own - other) for other in ratios if other != own) for own in ratios]
    return np.asarray(tangent / (1 - nu**2) * np.tensordot(weights, by_slope, axes=1))


@cache
def _table() -> tuple[Array, Array, Array]:
    """Return the slopes (degrees), Poisson's ratios, and errors [ratio, position, slope, coefficient]."""
    file = resources.files("refimpl").joinpath("data", "coefficient_error_3d.json")
    points = json.loads(file.read_text(encoding="utf-8"))["points"]
    found = {
        (point["nu"], point["position"], point["slope_deg"]): point["error"]
        for point in points
        if (point["wavelength"], point["kind"], point["width"]) == (20.0, "ridge", "projected")
    }
    ratios, slopes = (sorted({key[axis] for key in found}) for axis in (0, 2))
    places = list(product(ratios, _POSITIONS))
    slopes = [slope for slope in slopes if all((*place, slope) in found for place in places)]
    errors = [[found[(*place, slope)] for slope in slopes] for place in places]
    return (
        np.array(slopes),
        np.array(ratios),
        np.reshape(errors, (len(ratios), len(_POSITIONS), len(slopes), -1)),
    )
