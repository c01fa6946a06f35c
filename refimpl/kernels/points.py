"""The two integrals at arbitrary points: choice of formula, symmetry, scale."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from refimpl.errors import InputError, require_number
from refimpl.kernels.cerruti import CERRUTI
from refimpl.kernels.love import LOVE
from refimpl.kernels.quadrature import NEAR, Kernel, across, shells

Array = NDArray[np.float64]


def normal_integral(x: ArrayLike, y: ArrayLike, dx: float, dy: float) -> Array:
    """Return the integral of 1/rho over the centred ``dx`` by ``dy`` rectangle, seen from ``(x, y)``.

    ``x`` and ``y`` broadcast; the result has their common shape and the unit of length. Even in x and in y.
    Relative error at most 1e-13. Raises ``InputError`` unless edges are positive and everything finite.

    >>> bool(np.isclose(normal_integral(0.0, 0.0, 1.0, 1.0), 4 * np.arcsinh(1.0), rtol=1e-15))  # its centre
    True
    >>> bool(np.isclose(normal_integral(3e6, 4e6, 1.0, 1.0), 1 / 5e6, rtol=1e-13))  # a point load
    True
    """
    x, y = _points(x, y)
    unit = scale(dx, dy)
    return unit * _evaluate(LOVE, np.abs(x) / unit, np.abs(y) / unit, dx / unit, dy / unit)


def tangential_integral(x: ArrayLike, y: ArrayLike, dx: float, dy: float) -> Array:
    """Return the integral of s/rho^2, ``s = x - xi``, over the centred ``dx`` by ``dy`` rectangle.

    ``x`` and ``y`` broadcast; the result has their common shape and the unit of length. Odd in x, exactly 0
    at x = 0, even in y. Relative error at most 1e-13, close to x = 0 too. Raises ``InputError`` as
    ``normal_integral``.

    >>> tangential_integral([-1.0, 0.0, 1.0], 0.0, 1.0, 1.0)
    array([-0.98457246,  0.        ,  0.98457246])
    """
    x, y = _points(x, y)
    unit = scale(dx, dy)
    return np.copysign(unit, x) * _evaluate(CERRUTI, np.abs(x) / unit, np.abs(y) / unit, dx / unit, dy / unit)


def scale(dx: float, dy: float) -> float:
    """Return the power of two above the larger edge; `InputError` unless both are positive and finite."""
    edges: dict[str, Any] = {"dx": dx, "dy": dy}
    for name, edge in edges.items():
        one = edge.item() if isinstance(edge, np.ndarray) and edge.ndim == 0 else edge
        require_number(name, one, "a positive finite length, one number", above=0)
    return float(np.ldexp(1.0, np.frexp(float(max(dx, dy)))[1]))


def _points(x: ArrayLike, y: ArrayLike) -> tuple[Array, Array]:
    x, y = _lengths("x", x), _lengths("y", y)
    try:
        x, y = np.broadcast_arrays(x, y)
    except ValueError as refused:
        raise InputError("y", np.shape(y), f"a shape that goes with that of x, {np.shape(x)}") from refused
    return x, y


def _lengths(name: str, given: ArrayLike) -> Array:
    try:
        lengths = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError) as refused:
        raise InputError(name, given, "finite lengths") from refused
    if not np.isfinite(lengths).all():
        raise InputError(name, lengths[~np.isfinite(lengths)][0], "finite lengths")
    return lengths


def _evaluate(kernel: Kernel, x: Array, y: Array, dx: float, dy: float) -> Array:
    """Return the kernel at ``x, y >= 0``: near in closed form, farther by the fewest points that suffice."""
    q_x, q_y = 2 * x / dx, 2 * y / dy
    q = np.maximum(q_x, q_y)
    integral = np.empty(q.shape)
    near = q < NEAR
    integral[near] = kernel.closed_form(x[near], y[near], dx, dy)
    for start, end, order in shells():
        in_shell = (start <= q) & (q < end)
        if not in_shell.any():
            continue
        outer_x, outer_y = in_shell & (q_x >= q_y), in_shell & (q_x < q_y)
        integral[outer_x] = across(kernel.over_x, x[outer_x], y[outer_x], dx, dy, order)
        integral[outer_y] = across(kernel.over_y, y[outer_y], x[outer_y], dy, dx, order)
    return integral
