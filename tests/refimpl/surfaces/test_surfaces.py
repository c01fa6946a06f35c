"""Shapes, arrays, sums, bicubic resampling and tables."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from refimpl.errors import LEAST, InputError
from refimpl.grid import Grid
from refimpl.measured import MeasuredSurface
from refimpl.surfaces import (
    ArraySurface,
    Flat,
    GaussianRoughness,
    Sphere,
    Surface,
    SurfaceSum,
    SurfaceWarning,
    as_surface,
    surface_from_dict,
)
from refimpl.surfaces.arrays import resample_periodic
from tests.refimpl.surfaces.measured import quietly

GRID = Grid.square(2e-3, 16)
EPS = np.finfo(float).eps


def centres(grid: Grid, offset: tuple[float, float] = (0.0, 0.0)) -> tuple[np.ndarray, np.ndarray]:
    return np.meshgrid(grid.x + offset[0], grid.y + offset[1], indexing="ij")


def test_sphere_is_the_paraboloid_about_the_centre_and_moves_with_the_offset() -> None:
    offset = (3e-4, -1e-4)
    x, y = centres(GRID, offset)
    expected = ((x - 1e-3) ** 2 + (y - 1e-3) ** 2) / (2 * 0.14)
    np.testing.assert_allclose(
        Sphere(0.14).heights(GRID, offset), expected, rtol=0, atol=8 * EPS * expected.max()
    )
    np.testing.assert_array_equal(Sphere(-0.14).heights(GRID), -Sphere(0.14).heights(GRID))
    assert [Sphere(radius).radius for radius in (LEAST, -LEAST)] == [LEAST, -LEAST]
    x, y = np.meshgrid([-1.5, -0.5, 0.5, 1.5], [-2.0, 0.0, 2.0], indexing="ij")  # about a rectangle's centre
    np.testing.assert_array_equal(Sphere(0.5).heights(Grid((4, 3), (4.0, 6.0))), x**2 + y**2)


@given(st.floats(1e-6, 1e3), st.floats(0.1, 10.0), st.integers(1, 40), st.integers(1, 40), st.booleans())
def test_sphere_is_symmetric_about_the_middle_to_the_last_bit(
    side: float, ratio: float, M: int, N: int, periodic: bool
) -> None:
    z = Sphere(0.1).heights(Grid((M, N), (side, ratio * side), periodic))
    np.testing.assert_array_equal(z, z[::-1])
    np.testing.assert_array_equal(z, z[:, ::-1])
    square = Sphere(0.1).heights(Grid.square(side, M, periodic=periodic))
    np.testing.assert_array_equal(square, square.T)


def test_sums_are_flat_and_add_up() -> None:
    array = np.arange(256.0).reshape(16, 16) * 1e-9
    left, right = array + Sphere(0.14), Sphere(0.14) + array + (Flat() + GaussianRoughness(1e-6, 1e-4, 1))
    assert [type(p) for p in left.parts] == [ArraySurface, Sphere]
    assert [type(p) for p in right.parts] == [Sphere, ArraySurface, Flat, GaussianRoughness]
    np.testing.assert_array_equal(left.heights(GRID), array + Sphere(0.14).heights(GRID))
    assert len(right.describe(GRID)) == 3  # the array, the roughness, and the caution about its resolution


def test_array_of_the_grids_shape_is_used_as_it_is_and_never_shared() -> None:
    array = np.random.default_rng(1).normal(size=(16, 16))
    kept, surface = array.copy(), as_surface(array)
    array[:] = 0.0
    z = surface.heights(GRID)
    np.testing.assert_array_equal(z, kept)
    z[:] = 1.0
    np.testing.assert_array_equal(surface.heights(GRID), kept)
    assert surface == ArraySurface(kept)
    assert hash(surface) == hash(ArraySurface(kept))


@pytest.mark.parametrize("shape", [(7, 7), (40, 40), (9, 30)])
def test_resampling_reproduces_bicubics_up_to_the_border(shape: tuple[int, int]) -> None:
    def bicubic(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.asarray((1 + 2 * x - 3 * x**2 + x**3) * (2 - y + y**2 + 4 * y**3))

    x, y = ((np.arange(n) + 0.5) / n for n in shape)
    grid = Grid((16, 12), (1.0, 1.0))
    z = quietly(ArraySurface(bicubic(x[:, None], y[None, :]), (1 / shape[0], 1 / shape[1])), grid)
    # not-a-knot splines contain all cubics; extrapolation by half a cell amplifies rounding by < 4 an axis
    np.testing.assert_allclose(z, bicubic(*centres(grid)), rtol=0, atol=200 * EPS * 12)


def test_periodic_resampling_wraps_and_keeps_the_data() -> None:
    data = np.random.default_rng(3).normal(size=(6, 11))
    at = (np.arange(6.0), np.arange(11.0))
    np.testing.assert_allclose(resample_periodic(data, *at), data, rtol=0, atol=1e-14)
    x, y = np.array([-0.3, 2.7]), np.array([4.4, 10.9])
    np.testing.assert_allclose(
        resample_periodic(data, x + 6, y - 22), resample_periodic(data, x, y), rtol=0, atol=1e-12
    )
    shift = ArraySurface(data, (3.0, 2.0)).heights(Grid((6, 11), (18.0, 22.0), periodic=True), (9.0, -8.0))
    np.testing.assert_allclose(shift, np.roll(data, (-3, 4), (0, 1)), rtol=0, atol=1e-13)


@pytest.mark.parametrize(
    ("surface", "pitch"),
    [
        (ArraySurface(np.zeros((20, 12))), 0.1),
        (Flat(), None),
        (GaussianRoughness(1e-6, 1e-4, 1), None),
    ],
    ids=str,
)
def test_an_arrays_pitch_is_the_finer_of_both_axes(surface: Surface, pitch: float | None) -> None:
    assert surface.pitch((2.0, 3.0)) == (None if pitch is None else pytest.approx(pitch))


def test_finer_than_the_data_warns_and_coarser_does_not() -> None:
    array, side = np.zeros((20, 12)), GRID.lengths[0]
    oblong = ArraySurface(array, pixel=(side / 20, side / 12))
    with pytest.warns(SurfaceWarning, match="16 x 16 is finer than the array of 20 x 12"):
        oblong.heights(GRID)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        oblong.heights(Grid.square(side, 12))
        ArraySurface(array[:12]).heights(Grid.square(1.0, 12))
        oblong.heights(Grid((20, 12), (side, side)))
        ArraySurface(array).heights(Grid((5, 3), (2.0, 1.2)))
    with pytest.warns(SurfaceWarning, match="5 x 13 is finer than the array of 20 x 12"):
        ArraySurface(array).heights(Grid((5, 13), (2.0, 1.2)))
    assert "resampled bicubically to 16 x 16" in ArraySurface(array).describe(GRID)[0]
    assert "as it is" in ArraySurface(array).describe(Grid((20, 12), (1.0, 1.0)))[0]
    assert "as it is" in ArraySurface(np.zeros((16, 16))).describe(GRID)[0]


def test_arrays_end_with_the_domain() -> None:
    array = np.zeros((16, 16))
    for grid in (GRID, Grid((8, 16), (2e-3, 1e-3))):
        dx, dy = grid.spacings
        surface = ArraySurface(array, pixel=(grid.lengths[0] / 16, grid.lengths[1] / 16))
        surface.heights(grid, (dx / 2, -dy / 2))
        for offset in ((0.51 * dx, 0.0), (0.0, 0.51 * dy)):
            with pytest.raises(InputError, match="offset"):
                surface.heights(grid, offset)


@pytest.mark.parametrize(
    ("array", "said"),
    [
        (np.full((4, 4), np.nan), "16 of 16 not finite, the first at \\(0, 0\\)"),
        (np.array([[0.0, np.inf]]), "1 of 2 not finite, the first at \\(0, 1\\)"),
        (np.zeros(5), "2-D"),
        (np.zeros((3, 3), dtype=complex), "complex128"),
        (np.array([["a"]]), "<U1"),
        (np.ma.masked_equal(np.array([[0.0, 9.0]]), 9.0), "1 of 2 not finite"),
    ],
)
def test_bad_arrays_are_refused(array: np.ndarray, said: str) -> None:
    with pytest.raises(InputError, match=said):
        as_surface(array)


def test_what_is_no_surface_is_refused() -> None:
    with pytest.raises(InputError, match=r"surface = 3\.0"):
        as_surface(3.0)  # type: ignore[arg-type]  # the point of the test
    with pytest.raises(InputError, match="surface = None"):
        Flat() + None  # type: ignore[operator]  # likewise
    with pytest.raises(InputError, match="at least 4 points"):
        ArraySurface(np.zeros((3, 3))).heights(GRID)
    with pytest.raises(InputError, match="offset"):
        Flat().heights(GRID, (math.nan, 0.0))


@pytest.mark.parametrize("radius", [0.0, math.nan, math.inf, "0.14", None, True])
def test_bad_radii_are_refused(radius: object) -> None:
    with pytest.raises(InputError, match="radius"):
        Sphere(radius)  # type: ignore[arg-type]  # the point of the test


SELF_AFFINE = {
    "kind": "self_affine", "hurst": 0.8, "roll_off": 2e-4, "long_cut": 5e-4, "short_cut": 2e-5, "seed": 1
}  # fmt: skip


def test_relative_paths_start_at_the_folder() -> None:
    surface = surface_from_dict({"kind": "measured", "path": "a.x3p"}, Path("/scenes"))
    assert isinstance(surface, MeasuredSurface)
    assert surface.path == Path("/scenes/a.x3p")


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ({"kind": "sphere", "radius": 1.0, "radios": 2.0}, "surface.radios = 2.0"),
        ({"kind": "sphere"}, "surface.radius"),
        ({"kind": "sphare"}, "expected one of flat, sphere, gaussian, self_affine, measured, sum"),
        ({"kind": "flat", "height": 1}, "surface.height"),
        ({"kind": "measured", "path": 3}, "path = 3"),
        ({"kind": "measured", "path": "a", "unit": "inch"}, "unit = 'inch'"),
        ({"kind": "measured", "path": "a", "pixel_size": [1e-6] * 3}, "pixel_size = [1e-06, 1e-06, 1e-06]"),
        ({"kind": "measured", "path": "a", "pixel_size": -1e-6}, "pixel_size"),
        ({"kind": "measured", "path": "a", "missing": "zero"}, "missing"),
        ({"kind": "gaussian", "rms": -1e-6, "correlation_length": 1e-4, "seed": 1}, "rms = -1e-06"),
        ({"kind": "gaussian", "rms": 1e-6, "correlation_length": "l", "seed": 1}, "correlation_length"),
        ({"kind": "gaussian", "rms": 1e-6, "correlation_length": 1e-4, "seed": 1.0}, "seed = 1.0"),
        (
            {"kind": "gaussian", "rms": 1e-6, "correlation_length": 1e-4, "seed": 1, "normalise": 1},
            "normalise",
        ),
        (SELF_AFFINE | {"colour": 1}, "surface.colour"),
        (SELF_AFFINE | {"given": "rms"}, "surface.given"),
        (SELF_AFFINE | {"rms": 1e-6, "rms_gradient": 0.1}, "surface.rms, rms_gradient = 'both'"),
        (SELF_AFFINE, "surface.rms, rms_gradient = 'neither'"),
        ({"kind": "sum", "terms": []}, "surface.terms"),
        ("sphere", "surface = 'sphere'"),
    ],
)
def test_bad_tables_are_refused_by_name(table: dict[str, object], said: str) -> None:
    with pytest.raises(InputError) as refusal:
        surface_from_dict(table)
    assert said in str(refusal.value)


def test_arrays_have_no_table() -> None:
    with pytest.raises(InputError, match=r"\.npy"):
        (Flat() + np.zeros((4, 4))).to_dict()
    assert isinstance(Flat() + np.zeros((4, 4)), SurfaceSum)
