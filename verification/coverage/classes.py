"""Error bars by class of scene: ``python -m verification.coverage.classes --scenes 100 --json FILE``.

A scene is solved on a grid of 48 to 128 elements along its longer side, and judged against one of four to ten
times as many. Half of the scenes are free, half periodic; half are squares, half rectangles; maps are free
and square. Each number's bar is that of the single grid, as ``solve(scene, grid=M)`` states it.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy import stats

import refimpl as rf
from refimpl.accuracy.digits import LARGEST_SHARE
from refimpl.accuracy.grid_features import GridFeatures
from refimpl.errors import InputError
from refimpl.grid import Array
from refimpl.model.forces import EDGE_SHARE
from refimpl.model.materials import Pair
from verification.cli.output import columns
from verification.coverage.judge import EDGE_SIZE, EDGE_SIZE_BOUND
from verification.framework.case import jsonable
from verification.framework.files import Progress, write_result
from verification.framework.provenance import provenance

SIDE, RMS = 1e-3, 1e-7  # m
GRIDS = (48, 64, 96, 128)
REFERENCE = 512  # along the longer side
NUMBERS = ("contact_area", "contact_area_corrected", "friction_coefficient", "max_pressure", "approach")
LEVEL = 0.92
STRAIGHT_SIZE = 0.21  # mean excess of straight edges along the grid over an element: Westergaard's strips


@dataclass(frozen=True)
class Wave(rf.Surface):
    """``amplitude cos(2 pi n c / length + phase)`` along one axis: grooves (m)."""

    amplitude: float
    number: int
    phase: float
    axis: int
    kind = "wave"

    def _sample(self, grid: rf.Grid, offset: tuple[float, float]) -> Array:
        c, length = (grid.x, grid.y)[self.axis] + offset[self.axis], grid.lengths[self.axis]
        z = self.amplitude * np.cos(2 * math.pi * self.number * c / length + self.phase)
        return np.broadcast_to(z[:, None] if self.axis == 0 else z[None, :], grid.shape).copy()


class _Draw:
    """The random choices of a scene that its class does not make."""

    def __init__(self, kind: str, seed: int) -> None:
        self.rng = np.random.default_rng([38, *kind.encode(), seed])
        self.seed = int(self.rng.integers(2**31))
        self.periodic, ratio = bool(self.rng.integers(2)), self.rng.choice([1.0, self.log(1.0, 3.0)])
        self.size = (SIDE, SIDE / ratio) if self.rng.integers(2) else (SIDE / ratio, SIDE)
        self.lower, self.upper = (
            rf.Material(E=self.log(2e9, 400e9), nu=float(self.rng.uniform(0.1, 0.49))) for _ in range(2)
        )
        self.modulus = Pair(lower=self.lower, upper=self.upper).reduced_modulus
        self.direction = float(self.rng.uniform(0, 2 * math.pi))

    def log(self, low: float, high: float) -> float:
        return math.exp(self.rng.uniform(math.log(low), math.log(high)))

    def lengths(self) -> tuple[float, float]:
        """Correlation lengths of a lay, three to ten to one within the shorter side."""
        side = min(self.size)
        across = side * self.log(0.05, 0.15)
        return min(across * self.log(3, 10), 0.9 * side), across


Kind = Callable[[_Draw], rf.Surface]


def _isotropic(draw: _Draw) -> rf.Surface:
    return rf.GaussianRoughness(RMS, min(draw.size) * draw.log(0.05, 0.25), draw.seed)


def _along(draw: _Draw) -> rf.Surface:
    draw.direction = float(draw.rng.integers(4)) * math.pi / 2
    return rf.GaussianRoughness(RMS, draw.lengths(), draw.seed, lay=draw.direction % math.pi)


def _across(draw: _Draw) -> rf.Surface:
    draw.direction = float(draw.rng.integers(4)) * math.pi / 2
    return rf.GaussianRoughness(RMS, draw.lengths(), draw.seed, lay=(draw.direction + math.pi / 2) % math.pi)


def _oblique(draw: _Draw) -> rf.Surface:
    return rf.GaussianRoughness(
        RMS, draw.lengths(), draw.seed, lay=math.radians(float(draw.rng.uniform(12, 78)))
    )


def _grooves(draw: _Draw) -> rf.Surface:
    phase = float(draw.rng.uniform(0, 2 * math.pi))
    return Wave(RMS, int(draw.rng.integers(1, 5)), phase, int(draw.rng.integers(2)))


def _self_affine(draw: _Draw) -> rf.Surface:
    roll_off = min(draw.size) * draw.log(0.15, 0.4)
    return rf.SelfAffineRoughness(
        hurst=float(draw.rng.uniform(0.5, 1.0)),
        rms=RMS,
        roll_off=roll_off,
        long_cut=roll_off * draw.log(1.0, 2.0),
        short_cut=roll_off / draw.log(4, 10),
        seed=draw.seed,
    )


CLASSES: dict[str, Kind] = {
    "isotropic": _isotropic,
    "lay along sliding": _along,
    "lay across sliding": _across,
    "lay oblique to the grid": _oblique,
    "grooves": _grooves,
    "self-affine": _self_affine,
    "capped": _isotropic,
}


MEASURED = "windows of a measured map"
WHOLE = 256  # points of a window that is decimated


def read_heights(path: Path) -> Array:
    """Return the heights of a measured surface at its own points (m)."""
    surface = rf.MeasuredSurface(path)
    lengths = surface.extent((0.0, 0.0))
    pitch = surface.pitch(lengths) if lengths else None
    if lengths is None or pitch is None:
        raise InputError("--map", str(path), "a measured surface with an end")
    shape = round(lengths[0] / pitch), round(lengths[1] / pitch)
    return surface.sample(rf.Grid(shape, lengths))


def windows_of(heights: Array, *, whole: bool = False) -> Kind:
    """Return the class of random square windows of a measured map, at one rms height: 100 to 300 points, or
    `WHOLE`."""

    def window(draw: _Draw) -> rf.Surface:
        points = WHOLE if whole else min(int(draw.rng.integers(100, 301)), *heights.shape)
        i, j = (int(draw.rng.integers(length - points + 1)) for length in heights.shape)
        z = heights[i : i + points, j : j + points]
        draw.size, draw.periodic = (SIDE, SIDE), False
        return rf.ArraySurface(RMS * (z - z.mean()) / z.std())

    return window


DECIMATED = "decimated maps"


def decimated(one: rf.Scene, seed: int) -> tuple[rf.Scene, int]:
    """Return the scene with every second or fourth point of its map, and a grid of two elements a point."""
    step = (2, 4)[seed % 2]
    z = one.lower.surface.parts[0].sample(one.grid(WHOLE))[::step, ::step]
    return replace(one, lower=rf.Body(one.lower.material, rf.ArraySurface(z))), 2 * len(z)


def scene(kind: str, seed: int, classes: Mapping[str, Kind] = CLASSES) -> rf.Scene:
    """Return the scene of a seed: its class's roughness on a flat, or under a ball where it is free."""
    draw = _Draw(kind, seed)
    surface = classes[kind](draw)
    probe = rf.Scene(
        upper=rf.Body(draw.upper, rf.Flat()),
        lower=rf.Body(draw.lower, surface),
        friction=rf.Friction(),
        load=1.0,
        size=draw.size,
        periodic=draw.periodic,
    )
    grid = probe.grid(128)
    slope = math.sqrt(sum(float(np.mean(g**2)) for g in grid.gradient(surface.sample(grid))))
    height = float(np.std(surface.sample(grid)))
    if draw.periodic:
        pressed = 0.5 * draw.modulus * slope  # in contact, by Bush et al. 1975
        share = draw.log(0.05, 0.6)
        return _with_friction(draw, kind, probe, share * pressed * SIDE * min(draw.size), pressed)
    a = min(draw.size) * draw.log(0.1, 0.3)
    R = a**2 / (height * draw.log(1.5, 30))
    load = 4 * draw.modulus * a**3 / (3 * R)
    pressed = max(load / (math.pi * a**2), 0.5 * draw.modulus * slope)
    ball = replace(probe, upper=rf.Body(draw.upper, rf.Sphere(R)))
    return _with_friction(draw, kind, ball, load, pressed)


def _with_friction(draw: _Draw, kind: str, base: rf.Scene, load: float, pressed: float) -> rf.Scene:
    friction = rf.Friction(tau=pressed * draw.log(0.01, 0.3), beta=draw.log(0.01, 0.3))
    lower = base.lower
    if kind == "capped":
        H = max(pressed * draw.log(0.7, 3), 2 * load / (base.lengths[0] * base.lengths[1]))
        lower = rf.Body(replace(lower.material, hardness=H), lower.surface)
    return replace(base, lower=lower, friction=friction, load=load, sliding_direction=draw.direction)


def judged(one: rf.Scene, M: int, known: rf.Scene | None = None) -> list[dict[str, Any]] | None:
    """Return bar, error and the reference's bound, over each number; None where a solve did not end well.

    ``known`` replaces the scene on the coarse grid.
    """
    finest = rf.solve(one, grid=REFERENCE)
    coarse = rf.solve(known or one, grid=M)
    if not (coarse.converged and finest.converged) or coarse.contact_area == 0:
        return None
    rows = []
    for name in NUMBERS:
        exact, bound = reference(finest, name)
        found = float(getattr(coarse, name))
        lengths = coarse.error(name), abs(found - exact), bound
        shares = (length / abs(found) if length else 0.0 for length in lengths)
        rows.append(dict(zip(("bar", "error", "reference_bound"), shares, strict=True)) | {"number": name})
    return rows


def reference(finest: rf.Solution, name: str) -> tuple[float, float]:
    """Return a number of the finest grid without its edges' mean excess, and a bound of what is left."""
    features: GridFeatures = finest.features
    value = float(getattr(finest, name))
    straight = features.straight.faces * features.grid.element_area
    excess = EDGE_SIZE * features.edge + (STRAIGHT_SIZE - EDGE_SIZE * EDGE_SHARE) * straight
    bound = (
        EDGE_SIZE_BOUND * features.edge
        + 0.5 * math.sqrt(features.straight.squares) * features.grid.element_area
    )
    if name == "contact_area":
        return value - excess, bound
    if name == "contact_area_corrected":
        return finest.contact_area - excess, bound
    if name == "friction_coefficient":
        return value - features.dmu_dA * excess, features.dmu_dA * bound
    if name == "max_pressure" and not features.yields:
        return features.peak.height, sum(finest.uncertainty[name].values())
    return value, sum(finest.uncertainty[name].values())


def summary(rows: Iterable[dict[str, Any]]) -> dict[str, Any]:
    """Return the shares of bars that hold and are usable, a binomial test against `LEVEL`, and the length.

    A bar without an end always holds: of those that are ``usable``, at most half of their number, the share
    that holds stands by itself.
    """
    rows = list(rows)
    held = sum(row["error"] <= row["bar"] for row in rows)
    short = [row for row in rows if row["bar"] <= LARGEST_SHARE]
    finite = [row["bar"] / row["error"] for row in rows if row["error"] > 0]
    test = stats.binomtest(held, len(rows), LEVEL, alternative="less")
    return {
        "scenes": len(rows),
        "held": held / len(rows),
        "held_at_worst": sum(row["error"] + row["reference_bound"] <= row["bar"] for row in rows) / len(rows),
        "usable": len(short) / len(rows),
        "held_of_usable": sum(row["error"] <= row["bar"] for row in short) / len(short) if short else None,
        "p": test.pvalue,
        "median_bar_over_error": float(np.median(finite)) if finite else None,
    }


def main(arguments: Sequence[str] | None = None) -> None:
    """Judge the scenes of all classes, write the document and print its table."""
    parser = argparse.ArgumentParser(prog="python -m verification.coverage.classes", description=__doc__)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--scenes", type=int, default=100, help="of each class")
    parser.add_argument("--map", type=Path, help="a measured surface, of which windows are a class more")
    parser.add_argument("--only", help="one class")
    parser.add_argument("--json", type=Path, required=True)
    options = parser.parse_args(arguments)
    classes = dict(CLASSES)
    if options.map is not None:
        heights = read_heights(options.map)
        classes |= {MEASURED: windows_of(heights), DECIMATED: windows_of(heights, whole=True)}
    if options.only:
        classes = {name: kind for name, kind in classes.items() if name == options.only}
    progress = Progress(len(classes) * options.scenes)
    found: list[dict[str, Any]] = []
    lost: dict[str, int] = dict.fromkeys(classes, 0)
    for kind in classes:
        for seed in range(options.first, options.first + options.scenes):
            M = GRIDS[seed % len(GRIDS)]
            one, known = scene(kind, seed, classes), None
            if kind == DECIMATED:
                known, M = decimated(one, seed)
            rows = judged(one, M, known)
            if rows is None:
                lost[kind] += 1
            else:
                found += [{"class": kind, "seed": seed, **row} for row in rows]
            progress.tick(f"{kind}, {seed}")
    progress.close()
    table = tables(found)
    document = {
        "provenance": provenance(),
        "first": options.first,
        "not_converged": lost,
        "table": table,
        "rows": [{name: _short(value) for name, value in row.items()} for row in found],
    }
    write_result(jsonable(document), options.json)
    print(columns(lines(table), indent=""))


def _short(value: Any) -> Any:
    """Numbers with two digits: the table is made of all of them."""
    return float(f"{value:.2g}") if isinstance(value, float) else value


def tables(found: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the summary of each class and number, of each class, and of each number."""
    rows = []
    for kind in (*dict.fromkeys(row["class"] for row in found), None):
        for number in (*NUMBERS, None):
            some = [row for row in found if kind in (None, row["class"]) and number in (None, row["number"])]
            if some:
                rows.append({"class": kind, "number": number, **summary(some)})
    return rows


def lines(table: Sequence[dict[str, Any]]) -> list[list[str]]:
    """Return the lines of the printed table."""
    head = ["class", "number", "scenes", "held", "with the reference's bound", "usable", "of these", "p"]
    head.append("bar/error")
    return [head] + [
        [
            row["class"] or "all",
            row["number"] or "all",
            str(row["scenes"]),
            f"{row['held']:.3f}",
            f"{row['held_at_worst']:.3f}",
            f"{row['usable']:.2f}",
            "" if row["held_of_usable"] is None else f"{row['held_of_usable']:.3f}",
            f"{row['p']:.2g}",
            "" if row["median_bar_over_error"] is None else f"{row['median_bar_over_error']:.2f}",
        ]
        for row in table
    ]


if __name__ == "__main__":
    main()
