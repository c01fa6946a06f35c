"""Transforms of real fields: by ducc0 where it is installed (the extra ``fast``), by SciPy otherwise.

Forward unnormalised, backward ``1/n``; real fields have half a spectrum along their first axis, so that the
complex transforms find their numbers side by side: a tenth of an application quicker than the other way
about. ducc0 goes on from the library that SciPy uses: it writes into a given array, and to rounding both
find the same.

Kernels that are even or odd around both circles are transformed from a quarter of them, by cosines and sines:
quarters hold the offsets from 0 to half a circle, and no kernel is spread over its circles first.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from refimpl.grid import Array
from refimpl.operators.threads import allowed_threads, plain_number_of_threads

Complex = NDArray[np.complex128]


class SciPy:
    """Transforms by scipy.fft; ``workers`` are threads.

    A second thread pays for its start from ``worthwhile`` points on, as measured on two cores.
    """

    worthwhile = 300_000

    def columns(self, values: Array, spectrum: Complex, workers: int) -> None:
        """Transform forward along each column of real ``values``, into ``spectrum``."""
        spectrum[...] = scipy.fft.rfft(values, axis=0, workers=workers)

    def rows(self, spectrum: Complex, workers: int, *, forward: bool) -> Complex:
        """Transform along each row, best in place."""
        transform = scipy.fft.fft if forward else scipy.fft.ifft
        return np.asarray(transform(spectrum, axis=1, overwrite_x=True, workers=workers))

    def columns_back(self, spectrum: Complex, length: int, workers: int) -> Array:
        """Transform backward into real columns of that length."""
        return np.asarray(scipy.fft.irfft(spectrum, n=length, axis=0, workers=workers))

    def plane(self, values: Array, shape: tuple[int, ...], workers: int) -> Complex:
        """Transform forward along both axes of real ``values``, padded with zeros to the shape."""
        return np.asarray(scipy.fft.rfft2(values, s=shape[::-1], axes=(1, 0), workers=workers))

    def plane_back(self, spectrum: Complex, shape: tuple[int, ...], workers: int) -> Array:
        """Transform backward into real values of the shape; the spectrum may be overwritten."""
        return np.asarray(
            scipy.fft.irfft2(spectrum, s=shape[::-1], axes=(1, 0), overwrite_x=True, workers=workers)
        )

    def even_plane(self, quarter: Array, workers: int) -> Array:
        """Return an even field's transform, by quarters with both ends; that given may be overwritten."""
        return np.asarray(scipy.fft.dctn(quarter, type=1, overwrite_x=True, workers=workers))

    def odd_plane(self, quarter: Array, workers: int) -> Array:
        """Return ``i`` times that of a field odd along the first axis, both ends taken to be zero."""
        found = np.zeros(quarter.shape)
        if len(found) > 2:
            cosines = scipy.fft.dct(quarter[1:-1], type=1, axis=1, workers=workers)
            found[1:-1] = scipy.fft.dst(cosines, type=1, axis=0, overwrite_x=True, workers=workers)
        return found


class Ducc:
    """Transforms of `SciPy` by ducc0. Raises ImportError where it is not installed."""

    worthwhile = 100_000

    def __init__(self) -> None:
        self._fft: Any = import_module("ducc0").fft
        with plain_number_of_threads():
            self._fft.r2c(np.zeros(1), nthreads=0)  # reads the number once and for all

    def columns(self, values: Array, spectrum: Complex, workers: int) -> None:
        self._fft.r2c(values, axes=(0,), out=spectrum, nthreads=workers)

    def rows(self, spectrum: Complex, workers: int, *, forward: bool) -> Complex:
        inorm = 0 if forward else 2
        self._fft.c2c(spectrum, axes=(1,), forward=forward, inorm=inorm, out=spectrum, nthreads=workers)
        return spectrum

    def columns_back(self, spectrum: Complex, length: int, workers: int) -> Array:
        return np.asarray(
            self._fft.c2r(spectrum, axes=(0,), lastsize=length, forward=False, inorm=2, nthreads=workers)
        )

    def plane(self, values: Array, shape: tuple[int, ...], workers: int) -> Complex:
        if values.shape != shape:
            n, m = values.shape
            padded = np.zeros(shape, dtype=values.dtype)
            padded[:n, :m] = values
            values = padded
        return np.asarray(self._fft.r2c(values, axes=(1, 0), nthreads=workers))

    def plane_back(self, spectrum: Complex, shape: tuple[int, ...], workers: int) -> Array:
        return np.asarray(
            self._fft.c2r(
                spectrum,
                axes=(1, 0),
                lastsize=shape[0],
                forward=False,
                inorm=2,
                nthreads=workers,
                allow_overwriting_input=True,
            )
        )

    def even_plane(self, quarter: Array, workers: int) -> Array:
        self._fft.dct(quarter, type=1, axes=(0, 1), out=quarter, nthreads=workers)
        return quarter

    def odd_plane(self, quarter: Array, workers: int) -> Array:
        found = np.zeros(quarter.shape)
        if len(found) > 2:
            inner = found[1:-1]
            self._fft.dct(quarter[1:-1], type=1, axes=(1,), out=inner, nthreads=workers)
            self._fft.dst(inner, type=1, axes=(0,), out=inner, nthreads=workers)
        return found


Library = SciPy | Ducc


def best_installed() -> Library:
    """Return ducc0 if there is one."""
    try:
        return Ducc()
    except ImportError:
        return SciPy()


fourier = best_installed()


def threads(points: int) -> int:
    """Return the threads for a transform of that many points: one where it is soon over."""
    return allowed_threads() if points >= fourier.worthwhile else 1


def even_hat(quarter: Array, workers: int) -> Array:
    """Return the real symbols of a kernel even along both axes. The quarter may be overwritten."""
    return _mirrored(fourier.even_plane(quarter, workers), 1.0)


def odd_hat(along_x: Array, along_y: Array | None, workers: int) -> Complex:
    """Return the symbols of a sum of kernels, odd along the first axis and the second, even along the other.

    Where they are odd they are taken to be zero opposite 0: `_is_odd` of the caller makes sure that nobody
    needs that offset.
    """
    sines = _mirrored(fourier.odd_plane(along_x, workers), 1.0)
    if along_y is not None:
        sines += _mirrored(fourier.odd_plane(along_y.T, workers).T, -1.0)
    hat = np.zeros(sines.shape, dtype=np.complex128)
    np.negative(sines, out=hat.imag)
    return hat


def _mirrored(half: Array, sign: float) -> Array:
    """Continue around the second axis' circle, with that sign beyond its half."""
    return np.concatenate([half, sign * half[:, -2:0:-1]], axis=1)
