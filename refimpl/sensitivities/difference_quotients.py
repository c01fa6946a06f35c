"""Difference quotients of a solution's numbers over two full solves, and the scatter of counted areas.

The step of these solves is where the scatter of counted elements and the third derivative cost as much:
``h^3 = sigma / (2 sqrt(2) C)`` for a relative scatter sigma and a cubic term ``C h^3``.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from typing import TypeVar

import numpy as np

from refimpl.accuracy.discretisation_error import AREA
from refimpl.accuracy.scatter import area_scatter
from refimpl.driver.solve import solve
from refimpl.errors import InputError, NotConverged
from refimpl.scene.parameters import with_parameter
from refimpl.scene.scene import Scene
from refimpl.solution.solution import Solution

NUMBERS = ("friction_coefficient_corrected", "contact_area_corrected", "max_pressure", "binormal_force")
_STRIDES = 0.01, 0.1  # relative steps of parameters in full solves, least and most
_CUBIC, _MOST_CUBIC = 2.0, 4.0  # C of areas over the logarithm of a parameter: typical, 95 % (5 fits on 512)
_SHIFT = 0.1  # correlation lengths by which a change of the length may move the surface at the far border
_Found = TypeVar("_Found")


def difference_quotients(
    scene: Scene, solution: Solution, name: str, value: float
) -> tuple[dict[str, float], float]:
    """Return each number's derivative by two solves, and how far apart their values are.

    Raises `NotConverged` where a solve does not converge, `InputError` where neither side is allowed.
    """
    step, plastic = _stride(scene, solution, name, value), solution.details.problem.terms.plastic
    (low, below), (high, above) = both_sides(
        name, value, step, lambda at: solved_again(with_parameter(scene, name, at), solution, plastic=plastic)
    )
    for ended in (below, above):
        if not ended.converged:
            raise NotConverged(f"a solve with {name} changed by {step:.2g} ended as {ended.status.value}")
    span = high - low
    ends = _numbers(above), _numbers(below)
    return {number: (ends[0][number] - ends[1][number]) / span for number in ends[0]}, span


def _numbers(solution: Solution) -> dict[str, float]:
    found = {number: float(getattr(solution, number)) for number in NUMBERS}
    # a count of faces, as the published correction has it, scatters more
    return found | {NUMBERS[1]: solution.contact_area - solution.details.features.excess}


def solved_again(
    scene: Scene,
    solution: Solution,
    *,
    plastic: bool | None,
    approach: float | None = None,
    grid: tuple[int, int] | None = None,
) -> Solution:
    """Solve a scene on a solution's grid, or on another one, with its terms and its tolerance."""
    terms = solution.details.problem.terms
    corrected = terms.slope_correction and not plastic
    return solve(
        scene,
        grid or solution.grid.shape,
        approach=approach,
        oblique=terms.oblique,
        slope_correction=corrected,
        coupled=None if terms.slope_correction else terms.coupled,  # facet tractions include shear
        tilted=terms.tilted,
        plastic=plastic,
        tolerance=solution.details.tolerance,
    )


def _stride(scene: Scene, solution: Solution, name: str, value: float) -> float:
    """Return the relative step of full solves; it moves a far border by a share of a finest length."""
    sigma = _count_scatter(solution) / solution.contact_area
    stride = float(np.clip((sigma / (2 * math.sqrt(2) * _CUBIC)) ** (1 / 3), *_STRIDES))
    head, _, key = name.rpartition(".")
    if key.startswith("correlation_length"):
        return min(stride, _SHIFT * value / max(scene.lengths))
    if key in ("lay", "anisotropy"):
        which, _, place = head.partition(".")
        part = getattr(scene, which).surface.parts[int(place[len("surface[") : -1])]
        finest: float = part.detail(max(scene.lengths)).length
        turn = abs(value) if key == "lay" else 1.0
        return min(stride, _SHIFT * finest / max(scene.lengths) / turn)
    return stride


def _count_scatter(solution: Solution) -> float:
    """Return the standard deviation of a counted area (m^2)."""
    return AREA.scatter * area_scatter(solution.details.features)


def area_bound(solution: Solution, value: float, span: float) -> float:
    """Return the 95 % bound of an area's derivative by two solves: counts, and the cubic term."""
    cubic = _MOST_CUBIC * (0.5 * span / value) ** 2 * solution.contact_area / abs(value)
    return math.hypot(2 * math.sqrt(2) * _count_scatter(solution) / span, cubic)


def both_sides(
    name: str, value: float, step: float, make: Callable[[float], _Found]
) -> tuple[tuple[float, _Found], tuple[float, _Found]]:
    """Return the values a step below and above a parameter, or the value itself, with what is made.

    Raises `InputError` where both sides are refused, or are one double.
    """
    found: dict[float, _Found] = {}
    for at in (value * (1 - step), value * (1 + step)):
        with suppress(InputError):
            found[at] = make(at)
    if len(found) == 1:
        found[value] = make(value)
    if len(found) < 2:
        raise InputError(name, value, f"a value with another allowed one {step:.2g} of it below or above")
    low, high = sorted(found)
    return (low, found[low]), (high, found[high])
