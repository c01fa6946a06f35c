"""Surface displacement of a half-space under axisymmetric pressure, by quadrature over rings.

Source: Johnson 1985, Eq. (3.96a).
"""

from __future__ import annotations

from collections.abc import Callable

import mpmath as mp

DIGITS = 25
"""Working digits: tanh-sinh loses half of them at an inverse-root edge, so 12 true digits remain."""


def displacement(
    pressure: Callable[[mp.mpf], mp.mpf], radius: float, r: float, modulus: float
) -> tuple[float, float]:
    """Return the normal displacement u(r) (m) and the quadrature's own error estimate (m).

    ``pressure(s)`` (Pa) acts on ``0 < s < radius`` (m) and may be singular at either end; ``modulus`` is E*
    (Pa). u(r) = 4/(pi E*) * integral of p(s) s/(s + r) K(m) ds, m = 4 s r/(s + r)^2.

    >>> u, error = displacement(lambda s: mp.mpf(1), 1.0, 0.0, 1.0)   # uniform: 2 p a/E* at the centre
    >>> abs(u - 2.0) < 1e-12 and error < 1e-12
    True
    """
    with mp.workdps(DIGITS):
        at = mp.mpf(r)

        def ring(s: mp.mpf) -> mp.mpf:
            if s == at:
                # The outermost node rounds onto the logarithmic singularity, where its weight is nil.
                return mp.mpf(0)
            # K(m) by the arithmetic-geometric mean of 1 and sqrt(1 - m) = |s - r|/(s + r): no cancellation
            return pressure(s) * s / (s + at) * mp.pi / (2 * mp.agm(1, abs(s - at) / (s + at)))

        ends = [0, at, radius] if 0 < r < radius else [0, radius]
        value, error = mp.quad(ring, ends, error=True)
        scale = 4 / (mp.pi * modulus)
        return float(scale * value), float(scale * error)
