"""The random field of Eq. (9), isotropic and with a lay: its sum, its invariances, its statistics."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from refimpl.errors import InputError
from refimpl.grid import Grid
from refimpl.surfaces import GaussianRoughness, SurfaceWarning, gaussian
from refimpl.surfaces.noise_lattice import white_noise
from tests.refimpl.surfaces.measured import quietly

SIDE, LENGTH = 1.61e-3, 104e-6
GRID = Grid.square(SIDE, 64)
PERIODIC = replace(GRID, periodic=True)


def unit(seed: int = 1, length: float = LENGTH, normalise: bool = False) -> GaussianRoughness:
    return GaussianRoughness(1.0, length, seed, normalise=normalise)


def test_deterministic_and_pinned() -> None:
    """The stream is part of the interface: a scene file must mean the same surface in every version."""
    corner = white_noise(1, range(-1, 1), range(-1, 1))
    # four tiles; 1e-12 leaves room for another library's normal quantile, none for other random words
    pinned = [[1.286807986953587, 0.01082817098087742], [0.7851003480687619, 0.4214897034318442]]
    np.testing.assert_allclose(corner, pinned, rtol=1e-12, atol=0)
    np.testing.assert_array_equal(unit().heights(GRID), unit().heights(GRID))


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
    assert unit().notes(Grid.square(SIDE, 64)) == ()
    assert unit(length=1.0).notes(Grid.square(4.0, 16)) == ()  # just a quarter
    (said,) = unit(length=2.0).notes(Grid.square(1.25, 2))
    assert "the element, 0.625 m, exceeds a quarter of the roughness's correlation length, 2 m" in said


@pytest.mark.parametrize("lengths", [(3e-4, 1e-4), (1e-4, 3e-4)])
def test_the_shorter_correlation_length_is_what_a_grid_must_resolve(lengths: tuple[float, float]) -> None:
    assert GaussianRoughness(1e-6, lengths, seed=1).detail(1e-5).length == pytest.approx(1e-4)


@pytest.mark.parametrize(
    ("changes", "grid", "offset", "refusal"),
    [
        ({"correlation_length": SIDE / 5000}, GRID, 0.0, r"correlation_length = .*: expected at least"),
        (
            {"correlation_length": (LENGTH, 1e-9)},
            PERIODIC,
            0.0,
            r"correlation_length = .*: expected at least",
        ),
        ({"correlation_length": SIDE * (1 + 1e-9)}, PERIODIC, 0.0, r"at most the period, 0\.00161 m"),
        (
            {"correlation_length": 1.01 * SIDE, "normalise": True},
            GRID,
            0.0,
            "normalise = True: expected false",
        ),
        (
            {"correlation_length": SIDE / 600, "normalise": True},
            GRID,
            0.0,
            r"correlation_length = .*: expected at least 3\.22e-06 m .*500 x 500 lengths",
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


@pytest.mark.parametrize("changes", [{}, {"correlation_length": (LENGTH, LENGTH / 3), "lay": 0.4}], ids=str)
@pytest.mark.parametrize("grid", [GRID, PERIODIC], ids=["free", "periodic"])
def test_the_rms_of_a_realisation_is_that_of_its_blocks(
    changes: dict[str, Any], grid: Grid, monkeypatch: pytest.MonkeyPatch
) -> None:
    surface = replace(unit(normalise=True), **changes)
    whole = surface._realised_rms(grid)
    monkeypatch.setattr(gaussian, "_BLOCK", 20_000)
    assert surface._realised_rms(grid) == pytest.approx(whole, rel=1e-12)


@pytest.mark.filterwarnings("ignore::refimpl.SurfaceWarning")
def test_a_whole_period_and_a_side_of_one_length_are_held() -> None:
    assert np.isfinite(unit(length=SIDE).heights(PERIODIC)).all()
    assert np.isfinite(unit(length=SIDE, normalise=True).heights(GRID)).all()


SETTINGS = [
    ((2.0, 1.0), 0.0),
    ((3.0, 1.0), 0.6),
    ((1.0, 2.5), -1.1),
    ((4.0, 1.0), math.pi / 2),
    ((1.3, 1.0), 2.5),
]


def test_heights_are_the_plain_double_sum() -> None:
    """Over a wider rectangle of nodes, in the coordinates along and across the lay's quadratic form."""
    surface, lay, (lx, ly) = GaussianRoughness(2.0, (1.7, 0.8), seed=9, lay=0.7), 0.7, (1.7, 0.8)
    grid, offset = Grid((3, 4), (3.0, 2.0)), (-4.7, 1.3)
    c, s = math.cos(lay), math.sin(lay)
    A, B, C = (c / lx) ** 2 + (s / ly) ** 2, c * s * (lx**-2 - ly**-2), (s / lx) ** 2 + (c / ly) ** 2
    a, b = A**-0.5, (C - B * B / A) ** -0.5
    x, y = grid.x[:, None] + offset[0], grid.y[None, :] + offset[1]
    X = x + B / A * y
    m, n = np.arange(-90, 60), np.arange(-60, 90)
    w = white_noise(9, range(-90, 60), range(-60, 90))
    kx = np.exp(-4.6 * (X[..., None] / a - m / 6) ** 2)
    ky = np.exp(-4.6 * (y[..., None] / b - n / 6) ** 2)
    expected = 2.0 / 6 * math.sqrt(9.2 / math.pi) * np.einsum("ijm,ijn,mn->ij", kx, ky, w)
    np.testing.assert_allclose(surface.sample(grid, offset), expected, rtol=0, atol=1e-13)


@pytest.mark.parametrize("lay", [0.0, 0.3, math.pi / 2])
def test_equal_lengths_are_the_isotropic_surface_to_the_last_bit(lay: float) -> None:
    for periodic in (False, True):
        grid = Grid((40, 31), (1.0, 0.8), periodic)
        one = GaussianRoughness(0.5, 0.1, seed=3).sample(grid)
        np.testing.assert_array_equal(GaussianRoughness(0.5, (0.1, 0.1), seed=3, lay=lay).sample(grid), one)


@pytest.mark.parametrize(("lengths", "lay"), SETTINGS)
def test_slopes_are_the_curvature_of_equation_9(lengths: tuple[float, float], lay: float) -> None:
    surface, step = GaussianRoughness(3.0, lengths, seed=1, lay=lay), 1e-4
    far = [np.array([step, 0.0]), np.array([0.0, step])]
    drop = [2 * (9.0 - float(surface.autocorrelation(x[:1], x[1:])[0])) / step**2 for x in far]
    assert surface.rms_slope == pytest.approx(math.sqrt(drop[0]), rel=1e-6)
    assert surface.rms_gradient == pytest.approx(math.sqrt(sum(drop)), rel=1e-6)


def test_levels_of_the_autocorrelation() -> None:
    """Lengths at another level than 0.1 are those of the same Eq. (9)."""
    grid = Grid((40, 31), (1.0, 0.8))
    paper = GaussianRoughness(1.0, 0.1, 3)
    for level, factor in ((0.2, 0.836), (1 / math.e, 0.659), (5e-324, 17.98)):
        length = 0.1 * math.sqrt(-math.log(level) / math.log(10))
        assert length == pytest.approx(0.1 * factor, rel=5e-4)
        same = GaussianRoughness(1.0, length, 3, acf_level=level)
        np.testing.assert_allclose(same.sample(grid), paper.sample(grid), rtol=0, atol=1e-12)
        assert same.rms_slope == pytest.approx(paper.rms_slope, rel=1e-14)
    pair = GaussianRoughness(1.0, (0.2, 0.1), 3, acf_level=0.5).ellipse
    assert pair.along / pair.across == pytest.approx(2.0)
    assert pair.across == pytest.approx(0.1 * math.sqrt(math.log(10) / math.log(2)))


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"correlation_length": (1.0,)}, "correlation_length"),
        ({"correlation_length": (1.0, math.nan)}, "correlation_length"),
        ({"acf_level": 0.0}, "acf_level"),
        ({"acf_level": "a"}, "acf_level"),
        ({"lay": math.inf}, "lay"),
        ({"seed": 2**63}, "seed"),
    ],
)
def test_bad_parameters_are_refused(changes: dict[str, Any], field: str) -> None:
    with pytest.raises(InputError, match=field):
        GaussianRoughness(**{"rms": 1.0, "correlation_length": 1.0, "seed": 2**63 - 1} | changes)


def test_a_period_has_six_nodes_a_length_at_least() -> None:
    """Of 18.2 nodes there are 19, which divide the period."""
    nodes, _ = GaussianRoughness(rms=1e-6, correlation_length=0.33, seed=1).smoothing(
        np.linspace(0, 1, 200), 1.0
    )
    assert nodes == range(19)


def test_waves_of_a_period_beyond_the_last_add_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Noise belongs to wave numbers: half as many again leave the heights as they are."""
    surface = GaussianRoughness(rms=1.0, correlation_length=(0.2, 0.1), seed=3, lay=0.4)
    grid = Grid.square(1.0, 48, periodic=True)
    z = surface.sample(grid)
    monkeypatch.setattr(gaussian, "_REACH", 1.5 * gaussian._REACH)
    np.testing.assert_allclose(surface.sample(grid), z, rtol=0, atol=1e-12)
