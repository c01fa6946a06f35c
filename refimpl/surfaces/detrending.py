"""Form removal: the least-squares polynomial of a rectangle of heights, to be subtracted anywhere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from refimpl.grid import Array

DEGREES = {"none": -1, "mean": 0, "plane": 1, "paraboloid": 2}


@dataclass(frozen=True)
class Form:
    """A polynomial in x, y of total degree <= ``degree``; ``coefficients[a, b]`` belongs to X^a Y^b,
    X = (x - x0) / s_x, Y = (y - y0) / s_y."""

    coefficients: Array
    centre: tuple[float, float]
    scale: tuple[float, float]

    def __call__(self, x: Array, y: Array) -> Array:
        """Heights at all pairs of ``x``, ``y``, shape ``(len(x), len(y))``."""
        X, Y = (self._powers(at, axis) for axis, at in enumerate((x, y)))
        return np.asarray(X @ self.coefficients @ Y.T)

    @property
    def slopes(self) -> tuple[float, float]:
        """dz/dx, dz/dy at the centre."""
        c = self.coefficients
        return (c[1, 0] / self.scale[0], c[0, 1] / self.scale[1]) if len(c) > 1 else (0.0, 0.0)

    def _powers(self, at: Array, axis: int) -> Array:
        return np.vander((at - self.centre[axis]) / self.scale[axis], len(self.coefficients), increasing=True)


def fit(x: Array, y: Array, z: Array, degree: int) -> Form:
    """The least-squares polynomial of total degree <= ``degree`` of ``z[i, j]`` at ``(x_i, y_j)``; -1: zero.

    With Q_x, Q_y orthonormal polynomials on the points of each axis, the products Q_x^a Q_y^b are orthonormal
    on the rectangle, so the best fit is the projection on those with a + b <= degree.
    """
    if degree < 0:
        return Form(np.zeros((1, 1)), (0.0, 0.0), (1.0, 1.0))
    count = degree + 1
    centre = (float(x[0] + x[-1]) / 2.0, float(y[0] + y[-1]) / 2.0)
    scale = (float(x[-1] - x[0]) / 2.0, float(y[-1] - y[0]) / 2.0)
    qx, rx = np.linalg.qr(np.vander((x - centre[0]) / scale[0], count, increasing=True))
    qy, ry = np.linalg.qr(np.vander((y - centre[1]) / scale[1], count, increasing=True))
    order = np.arange(count)
    projection = np.where(order[:, None] + order[None, :] <= degree, qx.T @ z @ qy, 0.0)
    return Form(np.linalg.solve(rx, np.linalg.solve(ry, projection.T).T), centre, scale)
