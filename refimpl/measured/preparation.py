"""Preparation of a measured map as a whole, before a window is cut: outliers, lines, filters, scars."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np
import scipy

from refimpl.errors import InputError, require_one_of, require_size
from refimpl.grid import Array, Mask
from refimpl.measured.detrending import fit
from refimpl.measured.instrument_files import library_for
from refimpl.measured.missing_points import fill
from refimpl.measured.reading import RawHeights

NEIGHBOURHOOD = 5  # points an axis
_RANK = 20  # rank among 25 points: the 80th percentile; four or five of them may be outliers
PERCENTILE_TO_RMS = 1.2816  # factor from the 80th percentile of absolute Gaussian distances to their rms
MAD_TO_RMS = 1.4826  # from the median of absolute Gaussian distances to their rms
_ROUNDING = 1e-9  # share of the rms height
REACH = 1.5  # cut-off wavelengths of padding: the weight there is exp(-1.5^2 pi^2 / ln 2) = 1e-14
FAR = 8.0  # spreads: of Gaussian distances one in 10^15 is farther
_LEAST_LINES = 16  # lines from which their steps have a spread


def check_preparation(
    channel: object, outliers: object, scan_lines: object, low_pass: object, high_pass: object
) -> None:
    """Raise InputError for keys of a measured surface that are out of range; None is not set."""
    if not isinstance(channel, str | int | None) or isinstance(channel, bool):
        raise InputError("channel", channel, "a channel's name or number")
    if outliers is not None:
        require_size("outliers", outliers, "a number of spreads, say 6")
    if scan_lines is not None:
        require_one_of("scan_lines", scan_lines, ("x", "y"))
    wavelengths = {
        name: value for name, value in (("low_pass", low_pass), ("high_pass", high_pass)) if value is not None
    }
    lengths = [require_size(name, value, "a wavelength in m") for name, value in wavelengths.items()]
    if len(lengths) == 2 and lengths[0] >= lengths[1]:
        raise InputError("low_pass", low_pass, f"less than high_pass, {lengths[1]:g} m")


def prepare(
    reading: RawHeights,
    outliers: float | None = None,
    low_pass: float | None = None,
    high_pass: float | None = None,
    repeats: bool = False,
    scan_lines: str | None = None,
) -> RawHeights:
    """Return the map with outliers missing and wavelengths filtered, a note for each step.

    ``data/scene_keys.toml`` has units and meanings of the keys. Filters are those of ISO 16610-61, with
    weights normalised at the border (ISO 16610-28) after the plane of the whole map is set aside.
    """
    if outliers is not None:
        reading = _without_outliers(reading, outliers, repeats)
    if scan_lines is not None:
        reading = _aligned(reading, scan_lines, repeats)
    if low_pass is not None or high_pass is not None:
        reading = _filtered(reading, low_pass, high_pass, repeats)
    return reading


def _without_outliers(reading: RawHeights, times: float, repeats: bool) -> RawHeights:
    out, spread = outlying(_filled(reading), np.isfinite(reading.heights), times, repeats)
    note = (
        f"{np.count_nonzero(out)} outliers, more than {times:g} spreads off their neighbours (over the map "
        f"one spread is {spread:.3g} m), are taken as missing"
    )
    return replace(reading, heights=np.where(out, np.nan, reading.heights), notes=(*reading.notes, note))


def outlying(z: Array, known: Mask, times: float, repeats: bool = False) -> tuple[Mask, float]:
    """Return which ``known`` points are outliers, and the spread (m) over the map.

    A spread is a robust rms of `off_neighbours`: over the map by the median, and over the 5 x 5 points around
    by the 80th percentile. The larger one counts.
    """
    away = off_neighbours(z, repeats)
    spread = max(MAD_TO_RMS * float(np.median(away[known])), _ROUNDING * float(z[known].std()))
    out = known & (away > times * spread)
    i, j = np.nonzero(out)
    reach = np.arange(NEIGHBOURHOOD) - NEIGHBOURHOOD // 2
    mode: Literal["wrap", "clip"] = "wrap" if repeats else "clip"
    near = [away.take(np.ravel_multi_index((i + k, j + m), z.shape, mode=mode)) for k in reach for m in reach]
    around = np.partition(near, _RANK, axis=0)[_RANK]
    out[i, j] = away[i, j] > times * around / PERCENTILE_TO_RMS
    return out, spread


def off_neighbours(z: Array, repeats: bool) -> Array:
    """Return the median distance of each point from the means of neighbours on the four lines through it.

    Lines that leave the map count as straight.
    """
    padded = np.pad(z, 1, mode="wrap") if repeats else np.pad(z, 1, mode="reflect", reflect_type="odd")
    nx, ny = z.shape
    total, low, high = np.zeros_like(z), np.full_like(z, np.inf), np.full_like(z, -np.inf)
    for i, j in ((1, 0), (0, 1), (1, 1), (1, -1)):
        before = padded[1 - i : 1 - i + nx, 1 - j : 1 - j + ny]
        after = padded[1 + i : 1 + i + nx, 1 + j : 1 + j + ny]
        off = before + after
        off /= 2.0
        np.subtract(z, off, out=off)
        total += off
        np.minimum(low, off, out=low)
        np.maximum(high, off, out=high)
    total -= low
    total -= high
    np.abs(total, out=total)
    total /= 2.0
    return total


def _aligned(reading: RawHeights, axis: str, repeats: bool) -> RawHeights:
    if repeats:
        raise InputError("scan_lines", axis, "none of a map that repeats, whose lines have no slope")
    topography = library_for(Path(reading.name)).Topography
    z = np.ma.masked_invalid(reading.heights)
    found = topography(z, reading.area).scan_line_align(direction=axis).heights()
    note = f"scan lines along {axis}: each lost its slope and its median, and what the map has across them"
    return replace(reading, heights=np.ma.filled(found, np.nan), notes=(*reading.notes, note))


def _filtered(
    reading: RawHeights, low_pass: float | None, high_pass: float | None, repeats: bool
) -> RawHeights:
    x, y = (np.arange(n, dtype=float) for n in reading.heights.shape)
    plane = fit(x, y, reading.heights, 0 if repeats else 1)(x, y)
    z, notes = _filled(replace(reading, heights=reading.heights - plane)), list(reading.notes)
    for name, wavelength in (("low_pass", low_pass), ("high_pass", high_pass)):
        if wavelength is None:
            continue
        longest = max(reading.area)
        if not 2 * max(reading.pixel) <= wavelength <= longest:
            own = f"{max(reading.pixel):.4g} m, and at most its longer side, {longest:.4g} m"
            raise InputError(name, wavelength, f"at least two pixels of {reading.name}, each {own}")
        smooth = gaussian_filter(z, reading.pixel, wavelength, repeats)
        z = smooth if name == "low_pass" else z - smooth
        said = f"wavelengths {'below' if name == 'low_pass' else 'above'} {wavelength:.4g} m were damped "
        said += "(Gaussian filter of ISO 16610, by half at that wavelength)"
        if not repeats:
            said += f"; within half of it, {wavelength / 2:.4g} m, of the border heights are biased: "
            said += "a smaller size leaves that zone out"
        notes.append(said)
    z = z if high_pass is not None else z + plane
    return replace(reading, heights=np.where(np.isnan(reading.heights), np.nan, z), notes=tuple(notes))


def gaussian_filter(z: Array, pixel: tuple[float, float], wavelength: float, repeats: bool = False) -> Array:
    """Return ``z`` by Gaussian weights, transmission 2^-(wavelength f)^2, of sum one at a border."""
    pads = [
        0 if repeats else min(round(REACH * wavelength / edge), n)
        for edge, n in zip(pixel, z.shape, strict=True)
    ]
    shape = tuple(
        n if repeats else scipy.fft.next_fast_len(n + pad, real=True)
        for n, pad in zip(z.shape, pads, strict=True)
    )
    fx, fy = scipy.fft.fftfreq(shape[0], pixel[0]), scipy.fft.rfftfreq(shape[1], pixel[1])
    transmission = [np.exp2(-((wavelength * f) ** 2)) for f in (fx, scipy.fft.fftfreq(shape[1], pixel[1]))]
    spectrum = scipy.fft.rfft2(z, s=shape)
    spectrum *= transmission[0][:, None]
    spectrum *= np.exp2(-((wavelength * fy) ** 2))[None, :]
    mean = scipy.fft.irfft2(spectrum, s=shape)[: z.shape[0], : z.shape[1]]
    weights = [
        scipy.fft.ifft(t * scipy.fft.fft(np.ones(n), size)).real[:n]
        for t, n, size in zip(transmission, z.shape, shape, strict=True)
    ]
    return np.asarray(mean / weights[0][:, None] / weights[1][None, :])


def _filled(reading: RawHeights) -> Array:
    if np.isnan(reading.heights).all():
        raise InputError("missing", f"all points of {reading.name}", "a measured point at least")
    return fill(reading.heights, reading.pixel)


def standing_out(z: Array, known: Mask) -> tuple[str, ...]:
    """Return notes on ``known`` points and on lines along each axis that stand out; empty for none."""
    if not known.any():
        return ()
    points, notes = int(np.count_nonzero(outlying(z, known, FAR)[0])), []
    if points:
        notes.append(
            f"{points} points stand out by more than {FAR:g} local spreads: outliers = {FAR:g} (--outliers "
            f"{FAR:g}) removes them"
        )
    for axis, values in (("x", z.T), ("y", z)):
        if lines := scars(values):
            notes.append(
                f"{lines} of {len(values)} lines along {axis} stand out as a whole (scars of a scan): "
                f'scan_lines = "{axis}" (--scan-lines {axis}) levels each; contact would run along them'
            )
    return tuple(notes)


def scars(z: Array) -> int:
    """Return how many rows lie above, or below, both neighbours by `FAR` spreads of median steps."""
    if len(z) < _LEAST_LINES:
        return 0
    steps = np.median(np.diff(z, axis=0), axis=1)
    steps = steps - np.median(steps)
    spread = max(MAD_TO_RMS * float(np.median(np.abs(steps))), _ROUNDING * float(z.std()))
    up, down = steps[:-1], -steps[1:]
    out = (up * down > 0) & (np.minimum(np.abs(up), np.abs(down)) > FAR * spread)
    return int(np.count_nonzero(out))
