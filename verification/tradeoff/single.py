"""The production solver with its convolutions in single precision: what that would buy, and where it ends."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from unittest import mock

import numpy as np
from numpy.typing import NDArray

from refimpl.grid import Array
from refimpl.operators import influence
from refimpl.operators.fft import FFTInfluence
from refimpl.operators.transforms import Complex, fourier, threads


class SingleInfluence(FFTInfluence):
    """Convolutions on a window with 24 bits; tractions are scaled to their largest, whatever the unit."""

    def _convolve(self, source: Array, hat: Array | Complex) -> Array:
        N, K = self._padded
        workers = threads(N * K)
        unit = float(np.abs(source).max()) or 1.0
        largest, single = self._rounded(hat)
        columns: NDArray[Any] = np.zeros((N, self.source.shape[1]), dtype=np.float32)
        columns[self._from[0]] = source / unit
        spectrum: NDArray[Any] = np.zeros((N // 2 + 1, K), dtype=np.complex64)
        fourier.columns(columns, spectrum[:, self._from[1]], workers)
        spectrum = fourier.rows(spectrum, workers, forward=True)
        spectrum *= single
        spectrum = fourier.rows(spectrum, workers, forward=False)
        result = fourier.columns_back(spectrum[:, self._to[1]], N, workers)[self._to[0]]
        scaled: Array = unit * largest * result.astype(np.float64)
        return scaled

    def _rounded(self, hat: Array | Complex) -> tuple[float, NDArray[Any]]:
        """A kernel's largest value, and the kernel over it in single precision; made once."""
        found: dict[int, tuple[float, NDArray[Any]]] = self.__dict__.setdefault("_single", {})
        if id(hat) not in found:
            largest = float(np.abs(hat).max())
            kind = np.complex64 if np.iscomplexobj(hat) else np.float32
            found[id(hat)] = largest, (hat / largest).astype(kind)
        return found[id(hat)]


@contextmanager
def single_precision() -> Iterator[None]:
    """Solve with `SingleInfluence`; certificates, periodic scenes and what links grids stay as they are."""
    with mock.patch.object(influence, "FFTInfluence", SingleInfluence):
        yield
