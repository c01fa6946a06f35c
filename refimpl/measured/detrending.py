"""Form removal: the least-squares polynomial, cylinder or sphere of the measured points of a rectangle.

Heights are fitted along z, to measured points alone (NaN are excluded).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy

from refimpl.errors import InputError, require_one_of
from refimpl.grid import Array

DEGREES = {"none": -1, "mean": 0, "plane": 1, "paraboloid": 2}
CURVED = ("cylinder", "sphere")
MAX_DEGREE = 10
_FITTED = 250_000  # points of a curved form: more are thinned out evenly


@dataclass(frozen=True)
class Polynomial:
    """A polynomial in x, y (pixels) of total degree <= ``degree``; ``coefficients[a, b]`` belongs to X^a Y^b,
    X = (x - x0) / s_x, Y = (y - y0) / s_y."""

    coefficients: Array
    centre: tuple[float, float]
    scale: tuple[float, float]
    radius: float | None = None

    def __call__(self, x: Array, y: Array) -> Array:
        """Return the heights at all pairs of ``x``, ``y``, shape ``(len(x), len(y))``."""
        X, Y = (self._powers(at, axis) for axis, at in enumerate((x, y)))
        return np.asarray(X @ self.coefficients @ Y.T)

    @property
    def slopes(self) -> tuple[float, float]:
        """dz/dx, dz/dy at the centre, per pixel."""
        c = self.coefficients
        return (c[1, 0] / self.scale[0], c[0, 1] / self.scale[1]) if len(c) > 1 else (0.0, 0.0)

    def _powers(self, at: Array, axis: int) -> Array:
        return np.vander((at - self.centre[axis]) / self.scale[axis], len(self.coefficients), increasing=True)


@dataclass(frozen=True)
class Curved:
    """A sphere, or a cylinder whose axis lies at ``axis`` to x, through (0, 0, z0) of the centre.

    numbers  z0 (m), slope along and across the axis, curvature (1/m, positive for a hollow)
    axis     of a cylinder (rad); None for a sphere, whose slopes are along x and y
    """

    numbers: tuple[float, float, float, float]
    axis: float | None
    centre: tuple[float, float]
    pixel: tuple[float, float]

    def __call__(self, x: Array, y: Array) -> Array:
        s, t = self._turned((x - self.centre[0])[:, None], (y - self.centre[1])[None, :])
        z0, along, across, curvature = self.numbers
        if self.axis is None:
            return np.asarray(
                z0 + _cap(along * s + across * t, s**2 + t**2, math.hypot(along, across), curvature)
            )
        return np.asarray(z0 + along * s + _cap(across * t, t**2, across, curvature))

    def _turned(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Return the distances (m) along and across the axis."""
        x, y = x * self.pixel[0], y * self.pixel[1]
        cos, sin = math.cos(self.axis or 0.0), math.sin(self.axis or 0.0)
        return cos * x + sin * y, cos * y - sin * x

    @property
    def slopes(self) -> tuple[float, float]:
        _, along, across, _ = self.numbers
        cos, sin = math.cos(self.axis or 0.0), math.sin(self.axis or 0.0)
        return (cos * along - sin * across) * self.pixel[0], (sin * along + cos * across) * self.pixel[1]

    @property
    def radius(self) -> float | None:
        """Radius of curvature (m), negative for a hollow."""
        return -1.0 / self.numbers[3] if self.numbers[3] else None


Form = Polynomial | Curved


def _cap(tilted: Array, squared: Array, slope: float, curvature: float) -> Array:
    """Return a sphere's height w: ``k (r^2 + w^2) = 2 (w - g.x) / sqrt(1 + g^2)``; g.x where k = 0."""
    inverse = 1.0 / math.sqrt(1.0 + slope**2)
    known = curvature * squared + 2.0 * inverse * tilted
    return np.asarray(known / (inverse + np.sqrt(np.maximum(inverse**2 - curvature * known, 0.0))))


def check_level(level: object, repeats: bool) -> None:
    """Raise InputError unless ``level`` names a form; of a map that repeats only the mean can be."""
    if repeats:
        require_one_of("level", level, ("none", "mean"))
        return
    degree = isinstance(level, int) and not isinstance(level, bool) and 0 <= level <= MAX_DEGREE
    if not degree and not (isinstance(level, str) and level in (*DEGREES, *CURVED)):
        words = ", ".join((*DEGREES, *CURVED))
        raise InputError("level", level, f"one of {words}, or a polynomial's total degree, 0 to {MAX_DEGREE}")


def fit_form(x: Array, y: Array, z: Array, level: str | int, pixel: tuple[float, float] = (1.0, 1.0)) -> Form:
    """Return the form called ``level``: a name of DEGREES or CURVED, or a polynomial's total degree."""
    if isinstance(level, str) and level in CURVED:
        return _fit_curved(x, y, z, level, pixel)
    return fit(x, y, z, DEGREES[level] if isinstance(level, str) else level)


def fit(x: Array, y: Array, z: Array, degree: int) -> Polynomial:
    """Return the least-squares polynomial of total degree <= ``degree``, at points (x_i, y_j); -1: zero.

    With Q_x, Q_y orthonormal polynomials on the points of each axis, the products Q_x^a Q_y^b are orthonormal
    on the rectangle, so the best fit is the projection on those with a + b <= degree; where points are
    missing, the projection is divided by the products' Gram matrix over the measured points.
    """
    if degree < 0:
        return Polynomial(np.zeros((1, 1)), (0.0, 0.0), (1.0, 1.0))
    count = degree + 1
    centre = (float(x[0] + x[-1]) / 2.0, float(y[0] + y[-1]) / 2.0)
    scale = (float(x[-1] - x[0]) / 2.0, float(y[-1] - y[0]) / 2.0)
    qx, rx = np.linalg.qr(np.vander((x - centre[0]) / scale[0], count, increasing=True))
    qy, ry = np.linalg.qr(np.vander((y - centre[1]) / scale[1], count, increasing=True))
    order = np.arange(count)
    a, b = np.nonzero(order[:, None] + order[None, :] <= degree)
    missing = np.isnan(z)
    known = np.where(missing, 0.0, z)
    projection = np.zeros((count, count))
    projection[a, b] = (qx.T @ known @ qy)[a, b]
    if missing.any():
        pairs_x, pairs_y = ((q[:, :, None] * q[:, None, :]).reshape(len(q), -1) for q in (qx, qy))
        gram = (pairs_x.T @ (~missing).astype(float) @ pairs_y).reshape(count, count, count, count)
        projection[a, b] = np.linalg.lstsq(
            gram[a[:, None], a[None, :], b[:, None], b[None, :]], projection[a, b], rcond=1e-12
        )[0]
    return Polynomial(np.linalg.solve(rx, np.linalg.solve(ry, projection.T).T), centre, scale)


def _fit_curved(x: Array, y: Array, z: Array, level: str, pixel: tuple[float, float]) -> Curved:
    """Return the least-squares form along z, starting from the paraboloid's values."""
    thin = max(1, math.ceil(math.sqrt(z.size / _FITTED)))
    at_x, at_y, part = x[::thin], y[::thin], z[::thin, ::thin]
    start = fit(at_x, at_y, part, 2)
    c, (sx, sy) = start.coefficients, (start.scale[0] * pixel[0], start.scale[1] * pixel[1])
    hessian = np.array(
        [[2 * c[2, 0] / sx**2, c[1, 1] / (sx * sy)], [c[1, 1] / (sx * sy), 2 * c[0, 2] / sy**2]]
    )
    bent, directions = np.linalg.eigh(hessian)
    gradient = np.array([c[1, 0] / sx, c[0, 1] / sy])
    strongest = int(np.argmax(np.abs(bent)))
    across = directions[:, strongest]
    axis = None if level == "sphere" else math.atan2(-across[0], across[1])
    if axis is None:
        guess = [c[0, 0], *gradient, bent.mean()]
    else:
        along = np.array([math.cos(axis), math.sin(axis)])
        guess = [c[0, 0], along @ gradient, across @ gradient,
                 bent[strongest], axis]  # fmt: skip
    known = np.isfinite(part)

    def curved(numbers: Array) -> Curved:
        z0, along, across, curvature = (float(n) for n in numbers[:4])
        turned = None if axis is None else float(numbers[4])
        return Curved((z0, along, across, curvature), turned, start.centre, pixel)

    size = math.hypot(sx, sy)
    spread = float(np.nanstd(part)) or 1.0
    scale = np.array([spread, spread / size, spread / size, spread / size**2, 1.0][: len(guess)])
    found = scipy.optimize.least_squares(
        lambda numbers: ((curved(numbers * scale)(at_x, at_y) - part)[known]) / spread,
        np.array(guess) / scale, method="lm", xtol=1e-14, ftol=1e-14, gtol=1e-14,
    )  # fmt: skip
    return curved(found.x * scale)
