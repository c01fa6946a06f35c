"""The random field of Eq. (9): its sum, its invariances, its statistics."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from refimpl.errors import InputError
from refimpl.grid import Grid
from refimpl.surfaces import GaussianRoughness, SurfaceWarning
from refimpl.surfaces.statistics import kurtosis, skewness
from refimpl.surfaces.white_noise import white_noise

SIDE, LENGTH = 1.61e-3, 104e-6
GRID = Grid.square(SIDE, 64)
PERIODIC = replace(GRID, periodic=True)


def unit(seed: int = 1, length: float = LENGTH, normalise: bool = False) -> GaussianRoughness:
    return GaussianRoughness(1.0, length, seed, normalise=normalise)


def quietly(surface: GaussianRoughness, grid: Grid, offset: tuple[float, float] = (0.0, 0.0)) -> np.ndarray:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SurfaceWarning)
        return surface.heights(grid, offset)


@pytest.mark.parametrize("per_length", [4.0, 6.0, 0.7])
def test_covariance_is_equation_9_wherever_the_points_lie(per_length: float) -> None:
    x = np.arange(0.0, 4.0, 1.0 / per_length) + 0.013
    _, smooth = unit(length=1.0).smoothing(x)
    exact = np.exp(-2.3 * (x[:, None] - x[None, :]) ** 2)
    np.testing.assert_allclose((smooth @ smooth.T).toarray(), exact, rtol=0, atol=3e-15)


def test_equation_9_falls_to_a_tenth_at_its_length_and_bends_by_the_rms_slope() -> None:
    surface = GaussianRoughness(3.0, 2.0, seed=1)
    # in units of l = 2: exp(-2.3 (r / l)^2) by powers of exp(-2.3) = 0.100259
    tenth = 0.10025884372280375
    expected = 9 * np.array([1.0, tenth, tenth**4, tenth**0.25])
    np.testing.assert_allclose(surface.autocorrelation(np.array([0.0, 2.0, -4.0, 1.0])), expected, rtol=1e-14)
    # slopes between points a step apart have the mean square 2 (R(0) - R(step)) / step^2 -> -R''(0)
    step = 1e-4
    near = surface.autocorrelation(np.array([0.0, step]))
    assert surface.rms_slope == pytest.approx(math.sqrt(2 * (near[0] - near[1])) / step, rel=1e-6)


def test_rms_and_length_only_scale() -> None:
    z = unit(7).heights(GRID)
    np.testing.assert_array_equal(GaussianRoughness(4.0, LENGTH, 7).heights(GRID), 4.0 * z)
    np.testing.assert_allclose(unit(7, 2 * LENGTH).heights(Grid.square(2 * SIDE, 64)), z, rtol=0, atol=1e-13)


def test_deterministic_and_pinned() -> None:
    """The stream is part of the interface: a scene file must mean the same surface in every version."""
    corner = white_noise(1, range(-1, 1), range(-1, 1))
    # four tiles; 1e-12 leaves room for another library's normal quantile, none for other random words
    pinned = [[1.286807986953587, 0.01082817098087742], [0.7851003480687619, 0.4214897034318442]]
    np.testing.assert_allclose(corner, pinned, rtol=1e-12, atol=0)
    np.testing.assert_array_equal(unit().heights(GRID), unit().heights(GRID))


def test_noise_is_standard_normal_and_white() -> None:
    w = white_noise(3, range(-500, 500), range(-500, 500))
    n = w.size
    # four standard errors of the moments of n independent normal numbers
    assert abs(w.mean()) < 4 / math.sqrt(n)
    assert abs(w.var() - 1) < 4 * math.sqrt(2 / n)
    assert abs(skewness(w)) < 4 * math.sqrt(6 / n)
    assert abs(kurtosis(w) - 3) < 4 * math.sqrt(24 / n)
    for shift in ((0, 1), (1, 0), (1, 1), (64, 0), (0, 64)):  # 64: the same place in the next tile
        product = w[shift[0] :, shift[1] :] * w[: 1000 - shift[0], : 1000 - shift[1]]
        assert abs(product.mean()) < 4 / math.sqrt(product.size)


@pytest.mark.parametrize("other", [2, 2**32 + 1, 2**62])
def test_seeds_are_independent(other: int) -> None:
    grid = Grid.square(60.0, 240)
    a, b = unit(1, 1.0).heights(grid), unit(other, 1.0).heights(grid)
    # the mean product of independent fields has the variance int R^2 / area = pi / 4.6 / 60^2
    assert abs(np.mean(a * b)) < 4 * math.sqrt(math.pi / 4.6) / 60


def test_normalised_realisation_has_its_rms_on_every_grid() -> None:
    for seed in range(2):
        fine = GaussianRoughness(0.5e-6, LENGTH, seed, normalise=True).heights(Grid.square(SIDE, 512))
        # the midpoint sum misses the integral by O((h / l)^2) = 1e-3 of the border's share
        assert abs(np.std(fine) / 0.5e-6 - 1) < 1e-5
        ensemble = GaussianRoughness(0.5e-6, LENGTH, seed).heights(Grid.square(SIDE, 512))
        np.testing.assert_allclose(fine * (np.std(ensemble) / np.std(fine)), ensemble, rtol=1e-12, atol=0)
    strip = GaussianRoughness(0.5e-6, LENGTH, 0, normalise=True).heights(Grid((512, 128), (SIDE, SIDE / 4)))
    assert abs(np.std(strip) / 0.5e-6 - 1) < 1e-4  # the border's share is larger


@pytest.mark.parametrize("periodic", [False, True])
def test_quadrature_of_the_normalisation_has_converged(periodic: bool) -> None:
    """Reference: 40 Gauss points on each of panels at most a third as long as those of the code."""
    grid, surface = Grid((8, 5), (2.7 * LENGTH, 1.4 * LENGTH), periodic), unit(4)
    node, weight = np.polynomial.legendre.leggauss(40)
    panels = 18
    along = ((np.arange(panels)[:, None] + (node + 1) / 2) / panels).ravel()
    w = np.tile(weight / 2 / panels, panels)
    (rows, smooth_x), (columns, smooth_y) = (
        surface.smoothing(along * length, length if periodic else None) for length in grid.lengths
    )
    z = (smooth_y @ (smooth_x @ white_noise(4, rows, columns)).T).T
    exact = math.sqrt(w @ z**2 @ w - (w @ z @ w) ** 2)
    scaled = quietly(unit(4, normalise=True), grid)
    np.testing.assert_allclose(scaled * exact, quietly(surface, grid), rtol=0, atol=1e-12)


def test_unresolved_roughness_warns() -> None:
    with pytest.warns(SurfaceWarning, match="not resolved"):
        unit().heights(Grid.square(SIDE, 48))
    assert unit().cautions(Grid.square(SIDE, 64)) == ()
    assert unit(length=1.0).cautions(Grid.square(4.0, 16)) == ()  # just a quarter
    (said,) = unit(length=2.0).cautions(Grid.square(1.25, 2))
    assert "the element, 0.625 m, exceeds a quarter of the roughness's correlation length, 2 m" in said


@pytest.mark.parametrize("lengths", [(3e-4, 1e-4), (1e-4, 3e-4)])
def test_the_shorter_correlation_length_is_what_a_grid_must_resolve(lengths: tuple[float, float]) -> None:
    assert GaussianRoughness(1e-6, lengths, seed=1).detail(1e-5).length == pytest.approx(1e-4)


@pytest.mark.parametrize(
    ("changes", "grid", "offset", "refusal"),
    [
        ({"correlation_length": SIDE / 5000}, GRID, 0.0, r"correlation_length = .*: expected at least"),
        ({"correlation_length": 1e-25}, GRID, 0.0, r"correlation_length = .*: expected at least"),
        (
            {"correlation_length": (LENGTH, 1e-9)},
            PERIODIC,
            0.0,
            r"correlation_length = .*: expected at least",
        ),
        ({"correlation_length": SIDE * (1 + 1e-9)}, PERIODIC, 0.0, r"at most the period, 0\.00161 m"),
        ({"correlation_length": (1.2 * SIDE, LENGTH), "lay": 0.1}, PERIODIC, 0.0, "at most the period"),
        (
            {"correlation_length": 1.01 * SIDE, "normalise": True},
            GRID,
            0.0,
            "normalise = True: expected false",
        ),
        ({}, GRID, 1e7 * LENGTH, "offset = .*: beyond, digits are lost"),
    ],
)
def test_what_a_grid_cannot_hold_is_refused(
    changes: dict[str, Any], grid: Grid, offset: float, refusal: str
) -> None:
    surface = GaussianRoughness(**{"rms": 1.0, "correlation_length": LENGTH, "seed": 1} | changes)
    with pytest.raises(InputError, match=refusal):
        surface.heights(grid, (offset, 0.0))


@pytest.mark.filterwarnings("ignore::refimpl.SurfaceWarning")
def test_a_whole_period_and_a_side_of_one_length_are_held() -> None:
    assert np.isfinite(unit(length=SIDE).heights(PERIODIC)).all()
    assert np.isfinite(unit(length=SIDE, normalise=True).heights(GRID)).all()
