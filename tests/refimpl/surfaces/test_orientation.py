"""Which way up measured surfaces lie: every step against a map whose heights are known functions of x, y."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Grid
from refimpl.surfaces.surface import SurfaceWarning

DX, DY, NX, NY = 2e-6, 1e-6, 12, 20  # the area is 24 x 20 um
GRID = Grid((12, 8), (12e-6, 8e-6))
pytestmark = pytest.mark.filterwarnings("ignore::refimpl.surfaces.surface.SurfaceWarning")


def height(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """A cubic of the distances from the middle (m), without any symmetry: bicubic splines have it exactly."""
    x, y = x / 1e-5, y / 1e-5
    return np.asarray(1e-8 * (x + 0.3 * y + 0.7 * x**2 * y - 0.4 * y**3 + 0.2 * x))


def written(folder: Path, **options: object) -> rf.MeasuredSurface:
    x = (np.arange(NX)[:, None] + 0.5 - NX / 2) * DX
    y = (np.arange(NY)[None, :] + 0.5 - NY / 2) * DY
    np.save(folder / "map.npy", height(x, y))
    return rf.MeasuredSurface(
        folder / "map.npy",
        unit="m",
        pixel_size=(DX, DY),
        level="none",
        **options,  # type: ignore[arg-type]
    )


def from_middle(grid: Grid, offset: tuple[float, float] = (0.0, 0.0)) -> tuple[np.ndarray, np.ndarray]:
    x = grid.x - grid.lengths[0] / 2 + offset[0]
    y = grid.y - grid.lengths[1] / 2 + offset[1]
    return x[:, None], y[None, :]


@pytest.mark.parametrize(
    ("replica", "mirror", "rotate", "over"),
    list(itertools.product((False, True), (None, "x", "y"), (0, 90.0, 180, 270), (False, True))),
)
def test_every_way_up_is_the_function_of_the_turned_place(
    tmp_path: Path, replica: bool, mirror: str | None, rotate: float, over: bool
) -> None:
    """The chain backwards: a place in the domain is turned over, turned back, mirrored, then looked up."""
    centre, offset = (13e-6, 9e-6), (4e-7, -3e-7)
    surface = written(
        tmp_path, replica=replica, mirror=mirror, rotate_deg=rotate, turn_over=over, centre=centre
    )
    x, y = from_middle(GRID, offset)
    sign = -1.0 if replica != over else 1.0
    if over:
        y = -y
    turn = math.radians(-rotate)
    x, y = (
        round(math.cos(turn)) * x - round(math.sin(turn)) * y,
        round(math.sin(turn)) * x + round(math.cos(turn)) * y,
    )
    x, y = {"x": -x, None: x, "y": x}[mirror], {"y": -y, None: y, "x": y}[mirror]
    expected = sign * height(x + centre[0] - NX * DX / 2, y + centre[1] - NY * DY / 2)
    np.testing.assert_allclose(surface.heights(GRID, offset), expected, rtol=0, atol=1e-12 * np.ptp(expected))


def test_a_bad_way_up_is_refused(tmp_path: Path) -> None:
    for name, value in (
        ("mirror", "z"), ("rotate_deg", 361), ("rotate_deg", True), ("turn_over", "yes"), ("replica", 1),
        ("centre", 3.0), ("centre", (1.0,)), ("centre", (math.nan, 0.0)), ("repeats", "no"),
    ):  # fmt: skip
        with pytest.raises(rf.InputError, match=f"^{name} = "):
            rf.MeasuredSurface(tmp_path / "map.npy", **{name: value})  # type: ignore[arg-type]
    with pytest.raises(rf.InputError, match=r"level = 'plane': expected one of none, mean"):
        rf.MeasuredSurface(tmp_path / "map.npy", repeats=True, level="plane")
    with pytest.raises(
        rf.InputError, match=r"at most the measured 6e-06 x 6e-06 m of map\.npy about the centre"
    ):
        written(tmp_path, centre=(3e-6, 3e-6)).heights(GRID)


def body(modulus: float, surface: object) -> rf.Body:
    return rf.Body(rf.Material(E=modulus, nu=0.3), surface)


def test_a_bump_measured_on_the_upper_body_touches_at_its_peak(tmp_path: Path) -> None:
    """Its valleys would, if the file were used as it lies on the table: what the software did before."""
    x, y = (np.arange(32)[:, None] - 15.5) / 16, (np.arange(32)[None, :] - 15.5) / 16
    bump = 1e-6 * np.exp(-4 * ((x - 0.25) ** 2 + (y - 0.125) ** 2))
    np.save(tmp_path / "bump.npy", bump)
    surface = rf.MeasuredSurface(tmp_path / "bump.npy", unit="m", pixel_size=1e-5, level="mean")
    scene = rf.Scene(
        upper=body(200e9, surface), lower=body(118e9, rf.Flat()), friction=rf.Friction(beta=0.1), load=0.01
    )
    found = rf.solve(scene, 32)
    i, j = np.unravel_index(np.argmax(found.pressure), found.pressure.shape)
    # the peak lies at x = +0.25, and at y = -0.125 after turning over about the x axis
    assert abs(x[i, 0] - 0.25) <= 1 / 32
    assert abs(y[0, j] + 0.125) <= 1 / 32
    assert found.contact.mean() < 0.05
    assert any("bump.npy: on the upper body, so turned over about the x axis" in w for w in found.warnings)
    forced = rf.MeasuredSurface(
        tmp_path / "bump.npy", unit="m", pixel_size=1e-5, level="mean", turn_over=True
    )
    same = rf.solve(rf.Scene(body(200e9, forced), scene.lower, scene.friction, 0.01), 32)
    assert np.array_equal(same.pressure, found.pressure)
    assert not any("turned over" in w for w in same.warnings)
    below = rf.solve(rf.Scene(scene.lower, body(118e9, surface), scene.friction, 0.01), 32)
    assert not any("turned over" in w for w in below.warnings)


def test_arrays_on_the_upper_body_are_used_as_given() -> None:
    z = np.zeros((8, 8))
    z[5, 2] = -1e-6
    scene = rf.Scene(body(1e9, z), body(1e9, rf.Flat()), rf.Friction(), load=1e-3, side=1e-3)
    assert np.argwhere(rf.solve(scene, 8).contact).tolist() == [[5, 2]]


# --- turned by any angle ---


def ripple(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Smooth heights (m) without any symmetry: waves of 10 and 13 pixels."""
    return np.asarray(1e-8 * (np.sin(0.6 * x / DY) + 0.5 * np.cos(0.4 * (x + y) / DY) + 0.1 * y / DY))


def written_ripple(
    folder: Path, shape: tuple[int, int], hole: bool = False, **options: Any
) -> rf.MeasuredSurface:
    x, y = ((np.arange(n) + 0.5 - n / 2) * DY for n in shape)
    z = ripple(x[:, None], y[None, :])
    if hole:
        z[shape[0] // 2, shape[1] // 2] = np.nan
    np.save(folder / "ripple.npy", z)
    return rf.MeasuredSurface(folder / "ripple.npy", unit="m", pixel_size=DY, level="none", **options)


def turned_ripple(
    grid: Grid, degrees: float, middle: tuple[float, float] = (0.0, 0.0), over: bool = False
) -> np.ndarray:
    """The function itself on a grid about that place of the map."""
    x, y = from_middle(grid)
    x, y = (x, -y) if over else (x, y)
    cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return (-1.0 if over else 1.0) * ripple(cos * x + sin * y + middle[0], cos * y - sin * x + middle[1])


@pytest.mark.parametrize("angle", [45, 30, -17.5, 120.25, 200.0])
@pytest.mark.parametrize("over", [False, True])
def test_a_map_turned_by_any_angle_is_the_turned_function(tmp_path: Path, angle: float, over: bool) -> None:
    """Two cubic interpolations of a wave of ten points err by less than 0.2 % of its range."""
    shape, centre = (60, 80), (33e-6, 38e-6)
    surface = written_ripple(tmp_path, shape, rotate_deg=angle, turn_over=over, centre=centre)
    grid = Grid((40, 32), (20e-6, 16e-6))
    expected = turned_ripple(grid, angle, (centre[0] - 30e-6, centre[1] - 40e-6), over)
    np.testing.assert_allclose(surface.heights(grid), expected, rtol=0, atol=2e-3 * np.ptp(expected))


def test_the_largest_domain_of_a_turned_map(tmp_path: Path) -> None:
    surface = written_ripple(tmp_path, (100, 100), rotate_deg=45)
    assert surface.extent((0.0, 0.0)) == pytest.approx((70e-6, 70e-6))  # 100 / sqrt(2), in whole pixels
    with pytest.raises(rf.InputError, match=r"at most the measured 7e-05 x 7e-05 m of ripple\.npy"):
        surface.heights(Grid((8, 8), (71e-6, 71e-6)))
    notes = surface.notes(Grid((8, 8), (40e-6, 40e-6)))
    assert "turned by 45 degrees, besides quarter turns: interpolated by cubics" in notes[0]
    long = written_ripple(tmp_path, (40, 120), rotate_deg=30)
    assert long.extent((0.0, 0.0)) == pytest.approx((23e-6, 40e-6))  # 20 / cos, 20 / sin


def test_a_square_that_fits_a_turned_oblong_map_is_used(tmp_path: Path) -> None:
    """The largest rectangle is 112 x 74 um; squares fit up to 80 um, and are the turned function."""
    surface = written_ripple(tmp_path, (125, 95), rotate_deg=12)
    assert min(surface.extent((0.0, 0.0))) < 75e-6
    grid = Grid((40, 40), (79e-6, 79e-6))
    expected = turned_ripple(grid, 12)
    np.testing.assert_allclose(surface.heights(grid), expected, rtol=0, atol=2e-3 * np.ptp(expected))
    with pytest.raises(rf.InputError, match=r"at most the measured 8e-05 x 8e-05 m of ripple\.npy"):
        surface.heights(Grid((8, 8), (82e-6, 82e-6)))


def test_missing_points_stay_missing_in_a_turned_map(tmp_path: Path) -> None:
    surface = written_ripple(tmp_path, (100, 100), hole=True, rotate_deg=45)
    notes = surface.notes(Grid((8, 8), (40e-6, 40e-6)))
    assert any("of 1600 points in the window are missing" in note for note in notes)


def test_a_map_that_repeats_is_turned_by_quarters_alone(tmp_path: Path) -> None:
    with pytest.raises(
        rf.InputError, match=r"^rotate_deg = 45: expected a multiple of 90 for a map that rep"
    ):
        written_ripple(tmp_path, (20, 20), rotate_deg=45, repeats=True)


def test_a_map_of_few_points_is_not_turned(tmp_path: Path) -> None:
    with pytest.raises(rf.InputError, match=r"^rotate_deg = 45\.0: expected .*, or a map of more points"):
        written_ripple(tmp_path, (5, 5), rotate_deg=45).heights(Grid((2, 2), (1e-6, 1e-6)))


# --- sizes from files ---


def flat_map(path: Path, nx: int, ny: int, pixel: float = 1e-6) -> rf.MeasuredSurface:
    np.save(path, 1e-8 * np.random.default_rng(nx).normal(size=(nx, ny)))
    return rf.MeasuredSurface(path, unit="m", pixel_size=pixel)


def test_the_size_is_the_largest_rectangle_that_all_maps_cover(tmp_path: Path) -> None:
    low, up = flat_map(tmp_path / "low.npy", 83, 204), flat_map(tmp_path / "up.npy", 100, 150)
    scene = rf.Scene(body(2e11, up), body(2e11, low), rf.Friction(), load=1.0)
    assert scene.lengths == pytest.approx((83e-6, 150e-6))
    moved = rf.Scene(
        body(2e11, up),
        body(2e11, low),
        rf.Friction(),
        1.0,
        sliding_offset=10e-6,
        sliding_direction=math.pi / 2,
    )
    assert moved.lengths == pytest.approx((83e-6, 150e-6))  # 204 - 20 are still more than 150
    moved = rf.Scene(body(2e11, up), body(2e11, low), rf.Friction(), 1.0, sliding_offset=-10e-6)
    assert moved.lengths == pytest.approx((63e-6, 150e-6))
    with pytest.warns(SurfaceWarning, match=r"no size given: 8\.3e-05 x 0\.00015 m, the largest rectangle"):
        scene.heights(scene.grid(30))
    found = rf.solve(scene, 30)
    assert found.grid.shape == (17, 30)
    assert any("no size given" in w for w in found.warnings)


def test_the_refusal_of_an_offset_names_the_size_that_fits(tmp_path: Path) -> None:
    scene = rf.Scene(
        body(2e11, rf.Flat()), body(2e11, flat_map(tmp_path / "a.npy", 83, 204)), rf.Friction(), 1.0,
        size=(80e-6, 200e-6), sliding_offset=10e-6,
    )  # fmt: skip
    with pytest.raises(rf.InputError, match=r"sliding_offset = 1e-05.*a size of 6\.3e-05 x 0\.000204 m fits"):
        rf.solve(scene, 16)
    fitting = rf.Scene(
        scene.upper, scene.lower, rf.Friction(), 1.0, size=(63e-6, 204e-6), sliding_offset=10e-6
    )
    assert rf.solve(fitting, 16).status.name == "CONVERGED"
    with pytest.raises(rf.InputError, match=r"sliding_offset = 0\.001: expected an offset at which"):
        rf.Scene(scene.upper, scene.lower, rf.Friction(), 1.0, sliding_offset=1e-3)


def test_maps_that_repeat(tmp_path: Path) -> None:
    n, m = 16, 24
    x, y = 2 * np.pi * np.arange(n)[:, None] / n, 2 * np.pi * np.arange(m)[None, :] / m
    z = 1e-8 * (np.cos(x) + np.sin(2 * y + x))
    np.save(tmp_path / "wave.npy", z)
    wave = rf.MeasuredSurface(tmp_path / "wave.npy", unit="m", pixel_size=1e-6, repeats=True)
    assert wave.level == "mean"
    scene = rf.Scene(body(2e11, rf.Flat()), body(2e11, wave), rf.Friction(), 1e-3, periodic=True)
    assert scene.lengths == pytest.approx((16e-6, 24e-6))
    lower, _ = scene.sampled(scene.grid((n, m)))
    np.testing.assert_allclose(lower, z - 0.5 * (z.max() + z.min()), rtol=0, atol=1e-20)
    slid = wave.heights(scene.grid((n, m)), (3e-6, -40e-6))
    np.testing.assert_allclose(slid, np.roll(z, (-3, 40), (0, 1)), rtol=0, atol=1e-20)
    double = rf.Scene(scene.upper, scene.lower, rf.Friction(), 1e-3, size=(32e-6, 24e-6), periodic=True)
    np.testing.assert_allclose(
        double.sampled(double.grid((2 * n, m)))[0],
        np.roll(np.tile(lower, (2, 1)), n // 2, 0),
        rtol=0,
        atol=1e-20,
    )  # the map's middle at the domain's
    free = rf.Scene(scene.upper, scene.lower, rf.Friction(), 1e-3, size=(20e-6, 30e-6), sliding_offset=1e-4)
    assert rf.solve(free, 30).status.name == "CONVERGED"
    refused = rf.Scene(scene.upper, scene.lower, rf.Friction(), 1e-3, size=(20e-6, 24e-6), periodic=True)
    with pytest.raises(
        rf.InputError, match=r"whole multiples of the 1\.6e-05 x 2\.4e-05 m with which wave\.npy"
    ):
        rf.solve(refused, 24)
