"""Bad input is refused by one clear `InputError`, before anything large is allocated."""

from __future__ import annotations

import math
import tracemalloc
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.scene.parameters import with_parameter

STEEL = rf.Material(200e9, 0.3)
SCENE = rf.read_scene("table1-smooth")
TOML = rf.scene_to_toml(SCENE)
OBLONG = replace(SCENE, side=None, size=(1e-3, 2e-3))
HARD = replace(SCENE, lower=rf.Body(rf.Material(118e9, 0.3, hardness=8e8), rf.Flat()))
METRES_OF_ROUGHNESS = np.random.default_rng(1).normal(0, 0.5, (8, 8))


def on(heights: np.ndarray, **changes: Any) -> rf.Scene:
    return replace(SCENE, lower=rf.Body(STEEL, heights), **changes)


def with_nan() -> np.ndarray:
    heights = np.zeros((8, 8))
    heights[3, 4] = np.nan
    return heights


REFUSED: dict[str, tuple[str, Callable[[], Any]]] = {
    "negative load": ("load", lambda: replace(SCENE, load=-1.0)),
    "load not finite": ("load", lambda: replace(SCENE, load=math.inf)),
    "load as text": ("load", lambda: replace(SCENE, load="70")),
    "load as truth value": ("load", lambda: replace(SCENE, load=True)),
    "direction not finite": ("sliding_direction", lambda: replace(SCENE, sliding_direction=math.nan)),
    "periodic as number": ("periodic", lambda: replace(SCENE, periodic=1)),
    "body missing": ("upper", lambda: replace(SCENE, upper=None)),
    "friction as number": ("friction", lambda: replace(SCENE, friction=0.1)),
    "infinite modulus": ("E", lambda: rf.Material(-math.inf, 0.3)),
    "nu above a half": ("nu", lambda: rf.Material(1e9, 0.500001)),
    "nu of minus one": ("nu", lambda: rf.Material(1e9, -1.0)),
    "material missing": ("material", lambda: rf.Body(200e9, rf.Flat())),
    "surface as list": ("surface", lambda: rf.Body(STEEL, [[0.0, 1.0]])),
    "NaN heights": ("heights", lambda: rf.Body(STEEL, with_nan())),
    "array too small to resample": ("lower.surface[0].heights", lambda: rf.solve(on(np.zeros((3, 3))), 8)),
    "roughness in metres": ("lower.surface", lambda: rf.solve(on(METRES_OF_ROUGHNESS), 8)),
    "unknown method": ("method", lambda: rf.solve(SCENE, 8, method="magic")),
    "tolerance of zero": ("tolerance", lambda: rf.solve(SCENE, 8, tolerance=0.0)),
    "approach NaN": ("approach", lambda: rf.solve(SCENE, 8, approach=math.nan)),
    "approach beyond the mean planes": (
        "approach",
        lambda: rf.solve(replace(SCENE, periodic=True), 8, approach=1e-9),
    ),
    "correction without slopes": (
        "oblique",
        lambda: rf.solve(SCENE, 8, oblique=False, slope_correction=True),
    ),
    "side beyond arithmetic": ("side", lambda: replace(SCENE, side=1e200)),
    "modulus beyond arithmetic": ("E", lambda: rf.Material(1e300, 0.3)),
    "hardness beyond arithmetic": ("hardness", lambda: rf.Material(1e9, 0.3, hardness=1e300)),
    "tau below zero": ("friction.tau", lambda: rf.Friction(tau=-1.0)),
    "beta NaN": ("friction.beta", lambda: rf.Friction(beta=math.nan)),
    "beta beyond arithmetic": ("friction.beta", lambda: rf.Friction(beta=1e300)),
    "slide beyond arithmetic": ("sliding_offset", lambda: replace(SCENE, sliding_offset=-1e300)),
    "rms beyond arithmetic": ("rms", lambda: rf.GaussianRoughness(1e300, 1e-4, 1)),
    "pixel of nothing": ("pixel_size", lambda: rf.MeasuredSurface("a.npy", pixel_size=1e-300)),
    "scene as its name": ("scene", lambda: rf.solve("hertz", 16)),
    "oblique as text": ("oblique", lambda: rf.solve(SCENE, 8, oblique="no")),
    "slope correction of None": ("slope_correction", lambda: rf.solve(SCENE, 8, slope_correction=None)),
    "unknown quantity on a grid": ("quantity", lambda: rf.solve(SCENE, 8, quantity="approach")),
    "method as list": ("method", lambda: rf.solve(SCENE, 8, method=["fft"])),
    "quantity as array": ("quantity", lambda: rf.solve(SCENE, accuracy=0.1, quantity=np.zeros(9))),
    "error of a list": ("error", lambda: rf.solve(SCENE, 8).error([])),
    "parameter as list": ("parameter", lambda: with_parameter(SCENE, [], 1.0)),
    "grid beyond doubles": ("grid", lambda: rf.solve(SCENE, 10**400)),
    "grid of a rectangle beyond doubles": ("grid", lambda: OBLONG.grid(10**400)),
    "wavelength beyond arithmetic": ("low_pass", lambda: rf.MeasuredSurface("a.npy", low_pass=1e308)),
    "turn beyond a turn": ("rotate_deg", lambda: rf.MeasuredSurface("a.npy", rotate_deg=400)),
    "start as number": ("start", lambda: rf.solve(SCENE, 8, start=3)),
    "start on a grid as text": ("grid", lambda: rf.solve(SCENE, "16", start=rf.solve(SCENE, 8))),
    "progress as number": ("progress", lambda: rf.solve(SCENE, 8, progress=3)),
    "scene file as number": ("scene", lambda: rf.read_scene(3)),
    "cap without a hardness": ("plastic", lambda: rf.solve(SCENE, 8, plastic=True)),
    "cap by the paper's scheme": ("method", lambda: rf.solve(HARD, 8, plastic=True, method="paper")),
    "cap on facets": ("plastic", lambda: rf.solve(HARD, 8, plastic=True, slope_correction=True)),
    "cap as text": ("plastic", lambda: rf.solve(HARD, 8, plastic="on")),
    "text of no scene": ("scene", lambda: rf.scene_to_toml("hertz")),
    "side of a grid as text": ("side", lambda: rf.Grid.square("1", 8)),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused_by_one_line_that_names_the_field(name: str) -> None:
    field, act = REFUSED[name]
    with pytest.raises(rf.InputError) as caught:
        act()
    assert caught.value.field == field
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 400


@pytest.mark.parametrize(
    ("method", "grid", "reason"), [("dense", 3000, "4096 elements"), ("fft", 3_000_000, r"estimated .* GB")]
)
def test_a_grid_out_of_reach_is_refused_before_anything_is_allocated(
    method: str, grid: int, reason: str
) -> None:
    """One field of that grid would take 72 MB, or 72 TB; the refusal takes less than one."""
    tracemalloc.start()
    try:
        with pytest.raises(rf.InputError, match=reason):
            rf.solve(SCENE, grid, method=method)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 1e6


@pytest.mark.parametrize("M", [64])
def test_the_estimate_holds_what_a_solve_allocates(M: int) -> None:
    """Measured by tracemalloc, which sees numpy's arrays; the estimate is not to be many times too large."""
    rf.solve(SCENE, M)  # imports and tables are not this solve's
    tracemalloc.start()
    try:
        solution = rf.solve(SCENE, M)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert 0.1 * solution.plan.memory <= peak <= solution.plan.memory


FLAT = '{ kind = "flat" },'


def on_lower(surface: str) -> str:
    """The scene's file with a second surface on the lower body."""
    return TOML.replace(FLAT, f"{FLAT} {{ {surface} }},", 1)


def rough(**changed: float) -> str:
    keys = {"rms": 1e-7, "correlation_length": 1e-4, "seed": 1} | changed
    return on_lower('kind = "gaussian", ' + ", ".join(f"{key} = {value}" for key, value in keys.items()))


BAD_FILES = {
    "unknown key": ("scene.laod", TOML.replace("load =", "laod =", 1)),
    "unknown body key": ("upper.colour", TOML.replace("[upper]", '[upper]\ncolour = "red"', 1)),
    "unknown surface": ("upper.surface[0].kind", TOML.replace('"sphere"', '"cube"', 1)),
    "no load": ("load", TOML.replace("load = 70.0\n", "", 1)),
    "no body": ("upper", TOML[: TOML.index("[upper")]),
    "load as text": ("load", TOML.replace("70.0", '"70 N"', 1)),
    "body as number": ("upper", "load = 1.0\nside = 1.0\nlower = 3\nupper = 4\n"),
    "no TOML": ("scene", "load 70"),
    "hardness of zero": ("upper.material.hardness", TOML.replace("nu = 0.3", "nu = 0.3\nhardness = 0", 1)),
    "a word for a modulus": ("upper.material.E", TOML.replace("200000000000.0", '"stiff"', 1)),
    "neither side nor size": ("side", TOML.replace("side = 0.00161\n", "", 1)),
    "no radius": ("upper.surface[0].radius", TOML.replace(", radius = 0.14", "", 1)),
    "unknown key of a surface": ("upper.surface[0].rms", TOML.replace("radius", "rms", 1)),
    "noise too fine for the square": ("lower.surface[1].correlation_length", rough(correlation_length=1e-9)),
    "term of a sum": (
        "lower.surface[1].terms[1].radius",
        on_lower('kind = "sum", terms = [{ kind = "flat" }, { kind = "sphere", radius = 0 }]'),
    ),
    "missing measured file": ("lower.surface[1].path", on_lower('kind = "measured", path = "nowhere.x3p"')),
}


@pytest.mark.parametrize("name", BAD_FILES)
def test_a_bad_scene_file_is_refused(name: str, tmp_path: Path) -> None:
    field, text = BAD_FILES[name]
    assert text != TOML
    path = tmp_path / "scene.toml"
    path.write_text(text)
    with pytest.raises(rf.InputError) as caught:
        rf.solve(rf.read_scene(path), 8)
    assert caught.value.field == field
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("size", "modulus"), [(1e-30, 1e-30), (1e-30, 1e30), (1e30, 1e30)])
@pytest.mark.parametrize(("strain", "method"), [(1e-29, "fft"), (1e2, "fft"), (1e-29, "dense")])
def test_sizes_at_the_ends_of_what_is_allowed(
    size: float, modulus: float, strain: float, method: Any
) -> None:
    """No overflow, no division by zero (RuntimeWarnings are errors); the smallest forces are still found."""
    material = rf.Material(modulus, 0.3)
    scene = rf.Scene(
        upper=rf.Body(material, rf.Sphere(100 * size)),
        lower=rf.Body(material, rf.Flat()),
        friction=rf.Friction(0.0, 0.1),
        load=strain * modulus * size**2,
        side=size,
    )
    s = rf.solve(scene, 8, method=method)
    assert math.isfinite(s.friction_coefficient)


@pytest.mark.parametrize("surface", [np.zeros((8, 8)), rf.GaussianRoughness(1e-7, 1e-4, seed=1)])
def test_a_slide_too_far_names_the_field_of_the_scene(surface: Any) -> None:
    scene = on(surface, sliding_offset=1e3, sliding_direction=1.0)
    with pytest.raises(rf.InputError, match=r"sliding_offset = 1000\.0: expected") as caught:
        rf.solve(scene, 8)
    assert caught.value.field == "sliding_offset"


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(rf.InputError, match="a TOML file, or one of"):
        rf.read_scene(tmp_path / "nowhere.toml")


def test_a_file_too_large_for_a_scene_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text("#" * 2_000_000)
    with pytest.raises(rf.InputError, match="at most"):
        rf.read_scene(path)


def test_binary_and_deeply_nested_files_are_refused(tmp_path: Path) -> None:
    for content in (b"\xff\xfe\x00", b"a = " + b"[" * 5000):
        path = tmp_path / "scene.toml"
        path.write_bytes(content)
        with pytest.raises(rf.InputError, match="valid TOML"):
            rf.read_scene(path)
