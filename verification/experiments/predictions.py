"""Predictions of the experiments: scenes solved with their tolerances, each number with U_num and U_input."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache, partial
from importlib import resources
from typing import Any

import numpy as np

import refimpl as rf
from refimpl.model.materials import Pair
from refimpl.scene.parameters import parameters, with_parameter
from refimpl.scene.scene_file import read_tolerances
from refimpl.solution.quantities import error_bound
from verification.exact.hertz import Sphere
from verification.experiments.comparison import Point, measured, repeated
from verification.framework.certified import certified

GRID = 128
ROOM = 2.6
"""Side of the domain over the radius of Hertz' contact."""

Stated = tuple[float, float]
"""A computed number and the bound of its numerical error."""
Quantity = Callable[[rf.Scene], Stated]


def scene_and_tolerances(name: str) -> tuple[rf.Scene, dict[str, float]]:
    """Return an experiment's scene and the relative half-widths of its inputs (95 %)."""
    with resources.as_file(resources.files("verification.experiments") / f"scenes/{name}.toml") as path:
        return rf.read_scene(path), read_tolerances(path)


def press(scene: rf.Scene, load: float) -> rf.Solution:
    """Solve a ball on a flat under a load (N) in a fitting domain; RuntimeError if it does not converge."""
    radius = parameters(scene)["upper.surface[0].radius"]
    hertz = Sphere(load, radius, Pair(scene.lower.material, scene.upper.material).reduced_modulus)
    return certified(rf.solve(replace(scene, load=load, side=ROOM * hertz.contact_radius), GRID))


def increment(scene: rf.Scene, first: float, load: float) -> Stated:
    """Return the approach under a load beyond that under the first one (m)."""
    low, high = press(scene, first), press(scene, load)
    return high.approach - low.approach, error_bound(high, "approach") + error_bound(low, "approach")


def ratio(scene: rf.Scene, first: float, loads: tuple[float, float]) -> Stated:
    """Return the increment at the second load over that at the first one."""
    (small, off), (large, more) = (increment(scene, first, load) for load in loads)
    return large / small, large / small * (off / small + more / large)


def exponent(scene: rf.Scene, loads: Sequence[float]) -> Stated:
    """Return the slope of log mu over log load, by least squares."""
    name = "friction_coefficient_corrected"
    found = [press(scene, load) for load in loads]
    x = np.log(loads) - np.mean(np.log(loads))
    weights = x / np.sum(x**2)
    mu = np.array([getattr(one, name) for one in found])
    off = np.array([error_bound(one, name) for one in found]) / mu
    return float(weights @ np.log(mu)), float(np.abs(weights) @ off)


def predict(name: str, quantity: Quantity) -> tuple[float, float, float]:
    """Return the quantity of an experiment's scene, U_num and U_input.

    U_input: root of the sum of squares of half the changes between both ends of each tolerance.
    """
    scene, tolerances = scene_and_tolerances(name)
    given = parameters(scene)
    shares = []
    for key, tolerance in tolerances.items():
        ends = [quantity(with_parameter(scene, key, given[key] * (1 + s * tolerance)))[0] for s in (-1, 1)]
        shares.append((ends[1] - ends[0]) / 2)
    value, numerical = quantity(scene)
    return value, numerical, math.hypot(*shares)


def tungsten(data: dict[str, Any]) -> list[Point]:
    """Compare increments of approach (nm) of the indentations with even numbers."""
    even = [values for number, values in data["increments"].items() if int(number) % 2 == 0]
    points = []
    for load, (value, scatter) in zip(data["loads"], repeated(even), strict=True):
        found = predict("tungsten", partial(increment, first=1e-3 * data["reference"], load=1e-3 * load))
        frame = data["frame"] * (load - data["reference"])
        points.append(Point(load, value, math.hypot(scatter, frame), *(1e9 * x for x in found)))
    return points


def rubber(data: dict[str, Any]) -> list[Point]:
    """Compare increments of approach (nm), and the ratio of the last one to the first one."""
    first, loads = 1e-6 * data["reference"], [1e-6 * load for load in data["loads"]]
    increments = list(data["increments"].values())
    points = [
        Point(load, *one, *(1e9 * x for x in predict("rubber", partial(increment, first=first, load=newton))))
        for load, newton, one in zip(data["loads"], loads, repeated(increments), strict=True)
    ]
    whole = [[one[-1] / one[0]] for one in increments if len(one) == len(loads)]
    quantity = partial(ratio, first=first, loads=(loads[0], loads[-1]))
    label = f"{data['loads'][-1]:g} over {data['loads'][0]:g} uN"
    return [*points, Point(label, *repeated(whole)[0], *predict("rubber", quantity))]


def film(data: dict[str, Any]) -> list[Point]:
    """Compare the exponent of mu over the load."""
    found = predict("film", partial(exponent, loads=data["loads"]))
    return [Point("1 to 50 N", data["exponent"], data["half_width"], *found)]


def mica(data: dict[str, Any]) -> list[Point]:
    """Compare the mean friction stress (MPa) with Eq. (1) on a smooth contact, whatever its shape."""
    stress = data["tau"] + data["beta"] * data["hardness"] / 2
    unknown = data["beta"] * data["hardness"] / 2
    return [Point("rough, of 1 um", data["stress"], data["half_width"], stress, 0.0, unknown)]


@cache
def points(name: str) -> tuple[Point, ...]:
    """Return the compared points of an experiment."""
    return tuple({"tungsten": tungsten, "rubber": rubber, "film": film, "mica": mica}[name](measured(name)))


def adhesive(load: float, radius: float, modulus: float, pull_off: float) -> tuple[float, float]:
    """Return approach (m) and contact area (m^2) of an adhesive ball by Johnson, Kendall and Roberts 1971.

    ``modulus`` is E* (Pa), ``pull_off`` the force (N) at which the ball leaves.
    """
    a = np.cbrt(
        3 * radius / (4 * modulus) * (load + 2 * pull_off + 2 * math.sqrt(pull_off * (load + pull_off)))
    )
    adhesion = 2 * pull_off / (3 * np.pi * radius)
    return float(a**2 / radius - np.sqrt(2 * np.pi * a * adhesion / modulus)), float(np.pi * a**2)
