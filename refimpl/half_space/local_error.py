"""Map of the coefficient error over a surface: every element at the slope of its own undeformed bodies."""

from __future__ import annotations

import math

import numpy as np

from refimpl.errors import InputError
from refimpl.grid import Array
from refimpl.half_space.influence_error import coefficient_error, constant_along_an_axis
from refimpl.half_space.influence_error_3d import element_error, steepest_tabulated
from refimpl.model.materials import Material
from refimpl.model.problem import Problem

_NODES = 61  # slopes from 0 to 30 degrees, half a degree apart
SHORTEST = 10.0  # elements: the table of square elements has no shorter wavelength


def local_error(problem: Problem) -> Array:
    """Return the relative coefficient error at every element's undeformed slopes, the grid's shape.

    The larger of both neighbours in line, of the element itself and of those across, for each body at its own
    slope, weighted by the bodies' compliances: a bound, for in a pair the first orders subtract. Surfaces
    that are constant along an axis, and negative Poisson's ratios, have the errors of strips in plane strain.
    Infinite beyond the tables' 30 degrees.
    """
    found = problem.grid.zeros
    shares = 1 - problem.pair.upper_share, problem.pair.upper_share
    bodies = problem.pair.lower, problem.pair.upper
    plane = constant_along_an_axis(*problem.heights)
    angles = np.linspace(0.0, steepest_tabulated(), _NODES)
    for share, body, heights in zip(shares, bodies, problem.heights, strict=True):
        if share == 0:
            continue
        along_x, along_y = problem.grid.gradient(heights)
        slope = np.arctan(np.hypot(along_x, along_y))
        errors = [_largest(float(angle), body, plane or body.nu < 0) for angle in angles]
        found += share * np.interp(slope, angles, errors, right=np.inf)
    return found


def _largest(angle: float, body: Material, plane: bool) -> float:
    if plane:
        return coefficient_error(angle, body)
    error = element_error(angle, body)
    return max(error.self_coefficient, error.in_line, error.across)


def share_above(local: Array, allowed: float) -> float:
    """Return the share of the area where the error of ``local`` exceeds ``allowed``."""
    if not allowed > 0:
        raise InputError("allowed", allowed, "a positive relative error")
    return float(np.mean(local > allowed))


def short_wave_share(problem: Problem) -> float:
    """Return the share of the mean square gradient at wavelengths below ten elements, 0 to 1.

    Both bodies weighted by their compliances; means and a window's jumps are reduced by a cosine taper on
    free grids. There the tables of coefficient errors, whose shortest wave has ten elements, do not reach.
    """
    grid = problem.grid
    dx, dy = grid.spacings
    k_x = 2 * math.pi * np.fft.fftfreq(grid.shape[0], dx)[:, None]
    k_y = 2 * math.pi * np.fft.rfftfreq(grid.shape[1], dy)[None, :]
    square = k_x**2 + k_y**2
    short = square > (2 * math.pi / (SHORTEST * math.sqrt(dx * dy))) ** 2
    weight = np.full(square.shape, 2.0)  # a column of a real transform stands for two
    weight[:, 0] = 1.0
    if grid.shape[1] % 2 == 0:
        weight[:, -1] = 1.0
    total = above = 0.0
    shares = 1 - problem.pair.upper_share, problem.pair.upper_share
    for share, heights in zip(shares, problem.heights, strict=True):
        power = share * weight * square * np.abs(np.fft.rfft2((heights - heights.mean()) * grid.taper)) ** 2
        total += float(power.sum())
        above += float(power[short].sum())
    return above / total if total > 0 else 0.0
