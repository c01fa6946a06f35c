"""Inspect a measured surface: what its file holds, and the roughness parameters of its levelled map."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from refimpl.grid import Array
from refimpl.measured.areal_parameters import (
    Autocorrelation,
    core_parameters,
    developed_area,
    height_parameters,
    implausible_slope,
    material_ratio,
    mean_square_slopes,
    nayak,
)
from refimpl.measured.measured_surface import MeasuredSurface
from refimpl.measured.missing_points import fill
from refimpl.measured.preparation import standing_out
from refimpl.measured.reading import PLAIN
from refimpl.measured.roughness_fit import RoughnessFit, fit_roughness
from refimpl.measured.spectrum import NORMALISATION, Spectrum, fill_error, texture_direction
from refimpl.surfaces.surface import pixel_edges

SAL_LEVEL = 0.2  # ISO 25178-2

# parameter, what it is, its unit (m, or none)
PARAMETERS = {
    "Sq": ("rms height", "m"),
    "Sa": ("mean height deviation", "m"),
    "Sz": ("highest to lowest point", "m"),
    "Ssk": ("skewness", ""),
    "Sku": ("kurtosis (Gaussian: 3)", ""),
    "Sdq": ("rms gradient, of neighbouring points", ""),
    "Sal": ("shortest distance to an autocorrelation of 0.2", "m"),
    "Str": ("texture aspect ratio (isotropic: 1)", ""),
    "Sp": ("highest point above the mean", "m"),
    "Sv": ("lowest point below the mean", "m"),
    "Sdr": ("developed area over the projected one, less one", ""),
    "Sk": ("depth of the core of the bearing curve", "m"),
    "Spk": ("reduced peaks above it", "m"),
    "Svk": ("reduced dales below it", "m"),
    "Std": ("direction of the waves with most power, across the lay", "deg"),
    "l10_across": ("shortest distance to an autocorrelation of 10 %", "m"),
    "l10_along": ("longest", "m"),
    "le_across": ("shortest distance to an autocorrelation of 1/e", "m"),
    "le_along": ("longest", "m"),
    "lay_deg": ("direction of slowest decay from x, anticlockwise", "deg"),
    "psd_slope": ("d ln C / d ln q below pi times the 1/e length", ""),
    "hurst": ("from that slope, -(slope + 2) / 2", ""),
    "nayak": ("m0 m4 / m2^2 (Gaussian autocorrelation: 3)", ""),
}


@dataclass(frozen=True)
class Inspection:
    """A measured surface and its levelled map ``z[i, j]`` (m; missing points NaN), as it lies on its body.

    ``parameters`` are of that map, by the names of PARAMETERS, SI; NaN where the map does not tell: an
    autocorrelation that does not fall far enough within half the map or is isotropic, a spectrum of too few
    rings or that holes decide. ``deviations`` has standard deviations of some.
    """

    surface: MeasuredSurface
    z: Array
    pixel: tuple[float, float]
    slopes: tuple[float, float]
    radius: float | None

    @cached_property
    def autocorrelation(self) -> Autocorrelation:
        """Autocorrelation of the levelled map."""
        return Autocorrelation.of(self.z, self.pixel)

    @cached_property
    def spectrum(self) -> Spectrum:
        """Spectrum of the levelled map, averaged over circles; missing points are filled."""
        return Spectrum.of(self._filled, self.pixel)

    @cached_property
    def _filled(self) -> Array:
        return fill(self.z, self.pixel)

    @cached_property
    def parameters(self) -> dict[str, float]:
        """Roughness parameters by the names of PARAMETERS."""
        found = height_parameters(self.z)
        found["Sdq"] = math.sqrt(sum(mean_square_slopes(self.z, self.pixel)))
        found["Sdr"] = developed_area(self.z, self.pixel)
        found |= core_parameters(self.z)
        fall = self.autocorrelation.distances(SAL_LEVEL)
        complete = bool(np.isfinite(fall).all())
        found["Sal"] = float(np.nanmin(fall)) if np.isfinite(fall).any() else math.nan
        found["Str"] = found["Sal"] / float(fall.max()) if complete else math.nan
        for name, level in (("l10", 0.1), ("le", math.exp(-1.0))):
            away = self.autocorrelation.distances(level)
            found[f"{name}_across"] = float(np.nanmin(away)) if np.isfinite(away).any() else math.nan
            found[f"{name}_along"] = float(away.max())  # NaN where one direction does not fall so far
        long, short, lay = self.autocorrelation.lay()
        found["lay_deg"] = round(math.degrees(lay), 1) % 180.0 if long > short else math.nan
        direction = texture_direction(self.z, self.pixel) if long > short else math.nan
        found["Std"] = math.degrees(direction)
        slope = self._psd_slope[0]
        found |= {"psd_slope": slope, "hurst": -(slope + 2.0) / 2.0, "nayak": nayak(self.z, self.pixel)}
        return found

    @cached_property
    def deviations(self) -> dict[str, float]:
        """Standard deviations of the parameters of the spectrum's slope, by its scatter about the line."""
        slope = self._psd_slope[1]
        return {"psd_slope": slope, "hurst": slope / 2.0}

    @cached_property
    def _psd_slope(self) -> tuple[float, float]:
        """Slope below the shortest 1/e length, its deviation; NaN where `fill_error` moves it by more."""
        away = self.autocorrelation.distances(math.exp(-1.0))
        if not np.isfinite(away).any():
            return math.nan, math.nan
        length = float(np.nanmin(away))
        slope, deviation = self.spectrum.slope(math.pi * length)  # clear of the roll-off
        if np.isnan(self.z).any():
            error = Spectrum.of(fill_error(self._filled, np.isnan(self.z), self.pixel), self.pixel).C
            rest = replace(self.spectrum, C=np.maximum(self.spectrum.C - error, np.finfo(float).tiny))
            again = rest.slope(math.pi * length)[0]
            if not abs(again - slope) <= deviation:
                return math.nan, math.nan
        return slope, deviation

    def fit(self, kind: str, draws: int = 16) -> RoughnessFit:
        """Fit a ``"gaussian"`` or ``"self-affine"`` roughness to the levelled map."""
        return fit_roughness(self.z, self.pixel, kind, draws)

    def curves(self) -> dict[str, Any]:
        """Return the spectrum, autocorrelation along x and y, and bearing curve as numbers, SI."""
        spectrum, correlation = self.spectrum, self.autocorrelation
        lags, values = correlation.lags, correlation.values
        i, j = (n // 2 for n in values.shape)
        ratio, heights = material_ratio(self.z, 100)
        along = {"lag_x": lags[0][i:], "x": values[i:, j], "lag_y": lags[1][j:], "y": values[i, j:]}
        return {
            "spectrum": {"q": spectrum.q, "C": spectrum.C, "units": ["rad/m", "m^4"],
                         "normalisation": NORMALISATION},
            "autocorrelation": along | {"units": ["m", "1"], "normalisation": "1 at lag 0"},
            "bearing_curve": {"material_ratio": ratio, "height": heights, "units": ["1", "m"],
                              "normalisation": "share of the points at least that high above the mean"},
        }  # fmt: skip

    def document(self) -> dict[str, Any]:
        """Return all of this as plain numbers and texts, SI."""
        reading = self.surface.reading
        return {
            "file": reading.name,
            "format": reading.source,
            "channel": reading.channel,
            "channels": list(reading.channels),
            "points": list(reading.heights.shape),
            "pixel": list(reading.pixel),
            "size": list(reading.area),
            "unit": reading.unit,
            "missing": int(np.isnan(reading.heights).sum()),
            "orientation": reading.orientation,
            "level": self.surface.level,
            "slopes": list(self.slopes),
            "radius": self.radius,
            "window": {"points": list(self.z.shape), "missing": int(np.isnan(self.z).sum())},
            "parameters": self.parameters,
            "deviations": self.deviations,
            "curves": _listed(self.curves()),
            "notes": [
                *self.surface.prepared.notes,
                *_unstated_axes(self.surface),
                *standing_out(self._filled, np.isfinite(self.z)),
                *(text for *_, text in implausible_slope(self.z, self.pixel)),
            ],
        }


def _unstated_axes(surface: MeasuredSurface) -> tuple[str, ...]:
    """Name the assumed axes of a text without a header, unless the surface is rotated or mirrored."""
    assumed = surface.reading.source == PLAIN and surface.mirror is None and surface.rotate_deg == 0.0
    text = "no header: each line is taken along y; if lines run along x from the top, set rotate_deg = -90"
    return (text,) if assumed else ()


def _listed(values: Any) -> Any:
    if isinstance(values, dict):
        return {key: _listed(value) for key, value in values.items()}
    return values.tolist() if isinstance(values, np.ndarray) else values


def inspect_surface(
    path: str | Path | MeasuredSurface, *, size: tuple[float, float] | None = None, **keys: Any
) -> Inspection:
    """Read a file of heights as a scene would, and return what it holds and its roughness parameters.

    Parameters
    ----------
    path : a file, or a MeasuredSurface
    size : edges (m) of the window about ``centre``; by default all that is measured around it
    **keys : of `MeasuredSurface`: unit, pixel_size, channel, level, outliers, low_pass, high_pass, ...

    Raises
    ------
    InputError
        a file or a key that cannot be used
    """
    if isinstance(path, MeasuredSurface):
        surface = path
    else:
        surface = MeasuredSurface(path, **{"max_missing": 1.0 - 1e-9} | keys)
    lengths = surface.extent((0.0, 0.0)) if size is None else pixel_edges("size", size)
    form, z, pixel = surface.levelled(lengths)
    slopes = tuple(float(slope / edge) for slope, edge in zip(form.slopes, pixel, strict=True))
    return Inspection(surface, z, pixel, (slopes[0], slopes[1]), form.radius)
