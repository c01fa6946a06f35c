"""A map of coefficient errors made up of random numbers."""

from __future__ import annotations

import numpy as np

from appendix_a.fem.coefficient_map import CoefficientMap


def invented(seed: int = 4) -> CoefficientMap:
    """Random numbers on axes that are long enough to interpolate; crest and valley are symmetric."""
    slopes, wavelengths = (5.0, 10.0, 20.0, 30.0), (8.0, 16.0, 32.0, 64.0)
    axes = slopes, wavelengths, (0.0, 0.125, 0.25, 0.375, 0.5), (-4.0, -2.0, 2.0, 4.0)
    shape = tuple(map(len, axes))
    rng = np.random.default_rng(seed)
    parts = rng.uniform(-1, 1, (2, *shape))
    for end in (0, -1):
        parts[..., end, :] += parts[..., end, ::-1].copy()
    return CoefficientMap(*axes, *parts, rng.uniform(0, 0.02, shape[:3]))
