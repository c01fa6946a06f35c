"""Spectral preconditioner: the influence of a window on itself, inverted on a circle without padding."""

from __future__ import annotations

import math

from refimpl.grid import Array
from refimpl.operators.fft import FFTInfluence
from refimpl.operators.periodic import PeriodicInfluence
from refimpl.operators.transforms import factors, fourier, threads


class SpectralPreconditioner:
    """Approximates the inverse of ``compliance * I[1/rho]`` between elements, by one over its symbol.

    Restricted to a contact set on both sides it stays symmetric positive definite; the mean pressure, which
    displaces nothing in a periodic scene, gets half of the longest wave's stiffness.
    """

    def __init__(self, operator: FFTInfluence | PeriodicInfluence, compliance: float) -> None:
        self._circle, self._counter = operator.circle, operator.counter
        flexibility = compliance * operator.symbol
        if flexibility[0, 0] == 0:
            flexibility[0, 0] = 2 * flexibility.max() or 1.0
        self._symbol = factors(1 / flexibility)

    def __call__(self, residual: Array) -> Array:
        """The preconditioned residual, same shape; the caller masks argument and result."""
        points = math.prod(self._circle)
        self._counter.add("preconditioner", points)
        workers = threads(points)
        spectrum = fourier.plane(residual, self._circle, workers)
        spectrum *= self._symbol
        n, m = residual.shape
        return fourier.plane_back(spectrum, self._circle, workers)[:n, :m]
