"""Preparation of a measured map as a whole, before a window is cut: outliers, Gaussian filters."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy import fft
from scipy.ndimage import median_filter

from refimpl.errors import InputError
from refimpl.grid import Array
from refimpl.surfaces.detrending import fit
from refimpl.surfaces.missing_points import fill
from refimpl.surfaces.reading import Reading

NEIGHBOURHOOD = 5  # points an axis of the median
MAD_TO_RMS = 1.4826  # from the median of absolute Gaussian differences to their rms
REACH = (
    1.5  # cut-off wavelengths that a map is padded by; the weight there is exp(-1.5^2 pi^2 / ln 2) = 1e-14
)


def prepare(
    reading: Reading,
    outliers: float | None = None,
    low_pass: float | None = None,
    high_pass: float | None = None,
    repeats: bool = False,
) -> Reading:
    """Return the map with outliers missing and wavelengths filtered, a note for each step.

    outliers   points further from the median of the 5 x 5 points around them than that many spreads become
               missing (Hampel's identifier); a spread is 1.4826 times the median of such distances, of the
               5 x 5 points around or over the map, whichever is larger: smooth peaks stay
    low_pass   wavelengths (m) below are damped, ``high_pass``: above; by half at that wavelength (Gaussian
               filter of ISO 16610-61). At the border the weights are normalised (ISO 16610-28), after the
               plane of the whole map is set aside; missing points are filled for the filter alone.
    """
    if outliers is not None:
        reading = _without_outliers(reading, outliers, repeats)
    if low_pass is not None or high_pass is not None:
        reading = _filtered(reading, low_pass, high_pass, repeats)
    return reading


def _without_outliers(reading: Reading, times: float, repeats: bool) -> Reading:
    missing = np.isnan(reading.heights)
    filled = _filled(reading)
    mode = "wrap" if repeats else "nearest"
    away = np.abs(filled - median_filter(filled, NEIGHBOURHOOD, mode=mode))
    typical = float(np.median(away[~missing])) or float(np.sqrt(np.mean(away[~missing] ** 2))) / MAD_TO_RMS
    spread = MAD_TO_RMS * np.maximum(median_filter(away, NEIGHBOURHOOD, mode=mode), typical)
    out = ~missing & (away > times * spread)
    note = (
        f"{np.count_nonzero(out)} outliers, more than {times:g} spreads off the median of the {NEIGHBOURHOOD} x "
        f"{NEIGHBOURHOOD} points around (over the map one spread is {MAD_TO_RMS * typical:.3g} m), are missing"
    )
    return replace(reading, heights=np.where(out, np.nan, reading.heights), notes=(*reading.notes, note))


def _filtered(reading: Reading, low_pass: float | None, high_pass: float | None, repeats: bool) -> Reading:
    x, y = (np.arange(n, dtype=float) for n in reading.heights.shape)
    plane = fit(x, y, reading.heights, 0 if repeats else 1)(x, y)
    z, notes = _filled(replace(reading, heights=reading.heights - plane)), list(reading.notes)
    for name, wavelength in (("low_pass", low_pass), ("high_pass", high_pass)):
        if wavelength is None:
            continue
        if wavelength < 2 * max(reading.pixel):
            raise InputError(
                name, wavelength, f"at least two pixels of {reading.name}, each {reading.pixel} m"
            )
        smooth = gaussian_filter(z, reading.pixel, wavelength, repeats)
        z = smooth if name == "low_pass" else z - smooth
        notes.append(
            f"wavelengths {'below' if name == 'low_pass' else 'above'} {wavelength:.4g} m were damped "
            "(Gaussian filter of ISO 16610, by half at that wavelength)"
        )
    z = z if high_pass is not None else z + plane
    return replace(reading, heights=np.where(np.isnan(reading.heights), np.nan, z), notes=tuple(notes))


def gaussian_filter(z: Array, pixel: tuple[float, float], wavelength: float, repeats: bool = False) -> Array:
    """Mean of ``z`` with Gaussian weights, transmission 2^-(wavelength f)^2 at the spatial frequency f.

    Beyond the border there is nothing: the weights inside are scaled to a sum of one. ``repeats``: periodic.
    """
    pads = [
        0 if repeats else min(round(REACH * wavelength / edge), n)
        for edge, n in zip(pixel, z.shape, strict=True)
    ]
    shape = tuple(
        n if repeats else fft.next_fast_len(n + pad, real=True) for n, pad in zip(z.shape, pads, strict=True)
    )
    fx, fy = fft.fftfreq(shape[0], pixel[0]), fft.rfftfreq(shape[1], pixel[1])
    transmission = [np.exp2(-((wavelength * f) ** 2)) for f in (fx, fft.fftfreq(shape[1], pixel[1]))]
    spectrum = fft.rfft2(z, s=shape)
    spectrum *= transmission[0][:, None]
    spectrum *= np.exp2(-((wavelength * fy) ** 2))[None, :]
    mean = fft.irfft2(spectrum, s=shape)[: z.shape[0], : z.shape[1]]
    weights = [
        fft.ifft(t * fft.fft(np.ones(n), size)).real[:n]
        for t, n, size in zip(transmission, z.shape, shape, strict=True)
    ]
    return np.asarray(mean / weights[0][:, None] / weights[1][None, :])


def _filled(reading: Reading) -> Array:
    if np.isnan(reading.heights).all():
        raise InputError("missing", f"all points of {reading.name}", "a measured point at least")
    return fill(reading.heights, reading.pixel)
