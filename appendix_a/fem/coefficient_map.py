"""Table of the error of neighbour coefficients in line with a slope: reading it, for one body and for a pair.

Axes: slope, wavelength, position; every nu, since 2 mu u is linear in kappa = 3 - 4 nu.  The first-order
part is known (`leading_order`).  What is tabulated is the rest, from the second order on:

    rough - flat = first order + tan(slope)^2 (1 + nu) [(3 - 4 nu) A + B],

A and B per slope, wavelength, position and offset; smooth enough to interpolate.
"""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from appendix_a.errors import InputError, real
from appendix_a.fem.halfplane import pressed_strip
from appendix_a.leading_order import coupling

Array = NDArray[np.float64]
VERSION = 1
CUBIC = 4  # nodes that a cubic spline needs
DECIMALS = 5  # rounding in the file, 0.001 percentage points at 30 degrees
COMMAND = "rough-friction appendix-a map"
AXES = ("slope_deg", "wavelength", "position", "offset")
ARRAYS = ("kappa_part", "constant_part", "error_percentage_points")


@dataclass(frozen=True)
class CoefficientMap:
    """The table: axes (lengths in units of the strip's half-width a) and what stands there.

    `kappa_part` A and `constant_part` B are [slope, wavelength, position, offset].  `error_percentage_points`
    [slope, wavelength, position] is the estimated error (three meshes, three outer radii) as a percentage of
    the flat coefficient, the largest over offsets and nu.
    """

    slope_deg: tuple[float, ...]
    wavelength: tuple[float, ...]
    position: tuple[float, ...]
    offset: tuple[float, ...]
    kappa_part: Array
    constant_part: Array
    error_percentage_points: Array

    def departure(self, slope_deg: float, wavelength: float, position: float, nu: float) -> Array:
        """Return rough minus flat u(x) - u(0) (m,) at the table's offsets, one body, in units of p a / E.

        slope_deg: 0 to the largest tabulated; wavelength: at least the smallest (beyond the largest the
        rest is taken from there); position: any.  Raises InputError, also for axes too short to interpolate.
        """
        check_complete(self.slope_deg, self.wavelength, self.position)
        if not 0.0 <= real(slope_deg) <= self.slope_deg[-1]:
            raise InputError("slope_deg", slope_deg, f"0 to {self.slope_deg[-1]:g} degrees")
        if not self.wavelength[0] <= real(wavelength) < math.inf:
            raise InputError("wavelength", wavelength, f"at least {self.wavelength[0]:g} half-widths, finite")
        if not math.isfinite(real(position)):
            raise InputError("position", position, "a finite fraction of the wavelength")
        if not -1.0 < real(nu) <= 0.5:
            raise InputError("nu", nu, "a Poisson ratio, -1 < nu <= 0.5")
        position %= 1.0  # large products with it would overflow
        tangent = math.tan(math.radians(slope_deg))
        smallest = math.tan(math.radians(self.slope_deg[0]))
        where = max(tangent, smallest), 1.0 / min(wavelength, self.wavelength[-1])
        rest_a, rest_b = (self._rest(part, where, position) for part in (self.kappa_part, self.constant_part))
        rest = tangent**2 * (1.0 + nu) * ((3.0 - 4.0 * nu) * rest_a + rest_b)
        climb = height_change(slope_deg, wavelength, position, np.array(self.offset))
        return rest - coupling(nu) * climb

    def _rest(self, part: Array, where: tuple[float, float], position: float) -> Array:
        """Return splines over slope and wavenumber, then the trigonometric polynomial in position (m,).

        An offset x sees the waves at the phase 2 pi x / wavelength: over 1 / wavelength all repeat evenly.
        """
        along_slope = make_interp_spline(np.tan(np.radians(self.slope_deg)), part)(where[0])
        rising = slice(None, None, -1)
        values = make_interp_spline(1.0 / np.array(self.wavelength)[rising], along_slope[rising])(where[1])
        # 1 - position reverses the offsets: the other half of the turn
        turn = np.concatenate([values, values[-2:0:-1, ::-1]])
        order = len(turn) // 2
        harmonics = np.fft.rfft(turn, axis=0) / len(turn)
        weight = np.full(order + 1, 2.0)
        weight[[0, -1]] = 1.0
        phase = np.exp(2j * np.pi * position * np.arange(order + 1))
        mixed: Array = np.real((weight * phase) @ harmonics)
        return mixed

    def percent(self, slope_deg: float, wavelength: float, position: float, nu: float) -> Array:
        """Return (rough - flat) / flat of one body (m,), in percent."""
        flat = pressed_strip(np.array(self.offset), nu)
        return 100.0 * self.departure(slope_deg, wavelength, position, nu) / flat

    def pair_percent(
        self,
        slope_deg: float,
        wavelength: float,
        position: float,
        lower: tuple[float, float],
        upper: tuple[float, float],
    ) -> Array:
        """Return `percent` for two bodies (E, nu) on one wave; `position` as the lower sees it.

        What is a crest to one is a valley to the other: half a wavelength apart.  The first-order parts
        enter as lower minus upper, and cancel for equal materials.
        """
        (modulus, nu), (modulus_upper, nu_upper) = lower, upper
        below = self.departure(slope_deg, wavelength, position, nu)
        above = self.departure(slope_deg, wavelength, position + 0.5, nu_upper)
        offset = np.array(self.offset)
        flat = pressed_strip(offset, nu) / modulus + pressed_strip(offset, nu_upper) / modulus_upper
        return 100.0 * (below / modulus + above / modulus_upper) / flat

    def document(self) -> dict[str, Any]:
        """Return the table for JSON, with what it means and how it was made."""
        document = {
            "version": VERSION,
            "what": (
                "Vertical displacement u(x) - u(0) of a sinusoidal boundary, rough minus flat, under "
                "pressure p along the normal on a strip of arc length 2 a; plane strain, p a / E, inwards"
            ),
            "formula": (
                "rough - flat = -(1 + nu)(1 - 2 nu) [s(clip(x, -1, 1)) - s(0)] "
                "+ tan(slope)^2 (1 + nu) [(3 - 4 nu) kappa_part + constant_part], "
                "s(x) = -tan(slope) wavelength / (2 pi) cos(2 pi (x / wavelength + position)), into the body"
            ),
            "axes": "arrays are [slope_deg][wavelength][position][offset]; lengths in units of a",
            "symmetry": "position -> 1 - position reverses the offsets",
            "pair": "lower at position / E_lower plus upper at position + 1/2 / E_upper",
            "provenance": COMMAND,
            "stated_error_percentage_points": float(self.error_percentage_points.max()),
        }
        arrays = {
            key: np.round(value, DECIMALS).tolist() if isinstance(value, np.ndarray) else value
            for key, value in asdict(self).items()
        }
        return document | arrays

    def write(self, path: Path) -> None:
        """Write the table as JSON."""
        path.write_text(json.dumps(self.document(), separators=(",", ": ")) + "\n", encoding="utf-8")

    @classmethod
    def read(cls, path: Path) -> CoefficientMap:
        """Return the table that `write` wrote.

        Raises InputError for another version, and for axes that do not rise or are incomplete.
        """
        document = json.loads(path.read_text(encoding="utf-8"))
        if document["version"] != VERSION:
            raise InputError("version", document["version"], f"{VERSION}")
        slope, wavelength, position, offset = (tuple(document[name]) for name in AXES)
        check_ascending(slope_deg=slope, wavelength=wavelength, position=position, offset=offset)
        check_complete(slope, wavelength, position)
        kappa, constant, error = (np.array(document[name]) for name in ARRAYS)
        shape = len(slope), len(wavelength), len(position), len(offset)
        for name, found, expected in zip(
            ARRAYS, (kappa, constant, error), (shape, shape, shape[:3]), strict=True
        ):
            if found.shape != expected:
                raise InputError(name, found.shape, f"the shape of its axes, {expected}")
        return cls(slope, wavelength, position, offset, kappa, constant, error)


def interpolation_error(slope_deg: float) -> tuple[float, float]:
    """Return by how much the shipped map may be off between its nodes, in percentage points.

    The first number is for the next elements (offsets -2 and 2), the second for all offsets, on waves of 8 to
    300 half-widths. Bounds ``0.01 + c tan^2(slope)``, c a good half above the largest of 60 random points;
    case appendix-fem/map-between-nodes judges them on 60 others. The 0.01 are the finite elements' own error.
    """
    square = math.tan(math.radians(slope_deg)) ** 2
    return 0.01 + 0.05 * square, 0.01 + 0.25 * square


def check_ascending(**axes: tuple[float, ...]) -> None:
    """Raise InputError for an axis that is empty or does not rise throughout."""
    for name, values in axes.items():
        if not values or not np.all(np.diff(values) > 0):
            raise InputError(name, values, "at least one value, each above the one before")


def check_complete(
    slope_deg: tuple[float, ...], wavelength: tuple[float, ...], position: tuple[float, ...]
) -> None:
    """Raise InputError unless cubic splines and the positions' harmonics have what they need."""
    for name, values in (("slope_deg", slope_deg), ("wavelength", wavelength)):
        if len(values) < CUBIC:
            raise InputError(name, values, f"{CUBIC} values at least, to interpolate")
    steps = np.linspace(0.0, 0.5, len(position))
    if len(position) < 2 or not np.allclose(position, steps, rtol=0, atol=1e-12):
        raise InputError("position", position, "equal steps from 0 (crest) to 0.5 (valley)")


def height_change(slope_deg: float, wavelength: float, position: float, offsets: Array) -> Array:
    """Return s(clip(x, -1, 1)) - s(0) of the sinusoid."""
    amplitude = math.tan(math.radians(slope_deg)) * wavelength / (2 * math.pi)
    phase = 2 * math.pi * (np.clip(offsets, -1.0, 1.0) / wavelength + position)
    return amplitude * (math.cos(2 * math.pi * position) - np.cos(phase))
