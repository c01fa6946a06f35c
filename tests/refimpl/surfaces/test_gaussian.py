"""The random field of Eq. (9): its sum, its invariances, its statistics."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest

from refimpl.errors import InputError
from refimpl.grid import Grid
from refimpl.surfaces import GaussianRoughness, SurfaceWarning
from refimpl.surfaces.noise_lattice import MAX_NODES
from refimpl.surfaces.statistics import kurtosis, skewness
from refimpl.surfaces.white_noise import white_noise

SIDE, LENGTH = 1.61e-3, 104e-6
GRID = Grid.square(SIDE, 64)


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


@pytest.mark.parametrize("node", [0, 5, -40])
def test_the_kernel_is_cut_off_at_17_nodes(node: int) -> None:
    nodes, smooth = unit(length=3.0).smoothing(np.array([node / 2 + 0.2]))  # a node every 0.5 m
    assert nodes == range(node - 17, node + 18)
    from_point = np.arange(-17, 18) * 0.5 - 0.2
    expected = np.exp(-4.6 * (from_point / 3) ** 2)
    np.testing.assert_allclose(smooth.toarray()[0] / smooth[0, 17], expected / expected[17], rtol=1e-11)


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


@pytest.mark.parametrize(("word", "share"), [(0, "0x1p-54"), (2**64 - 1, "0x1.fffffffffffffp-1")])
def test_the_least_and_the_greatest_random_word_have_normal_quantiles(
    word: int, share: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """53 bits stand for the middle of one of 2^53 equal parts of (0, 1), or the nearest number below 1."""

    class Same:
        def __init__(self, key: np.ndarray, counter: np.ndarray) -> None: ...

        def random_raw(self, size: int) -> np.ndarray:
            return np.full(size, word, dtype=np.uint64)

    monkeypatch.setattr(np.random, "Philox", Same)
    with mp.workdps(30):
        quantile = float(mp.sqrt(2) * mp.erfinv(2 * mp.mpf(float.fromhex(share)) - 1))
    np.testing.assert_allclose(white_noise(1, range(2), range(3)), quantile, rtol=1e-12)


def test_no_other_tiles_are_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Tiles of 64 x 64: only those that hold some of the nodes."""
    drawn, philox = [], np.random.Philox

    def counted(key: np.ndarray, counter: np.ndarray) -> np.random.Philox:
        drawn.append(tuple(counter[2:].astype(np.int64).tolist()))
        return philox(key=key, counter=counter)

    monkeypatch.setattr(np.random, "Philox", counted)
    for rows, columns, tiles in (
        (range(64), range(64, 192), [(0, 1), (0, 2)]),
        (range(-64, 0), range(127, 129), [(-1, 1), (-1, 2)]),
        (range(63, 65), range(-65, -64), [(0, -2), (1, -2)]),
    ):
        drawn.clear()
        assert white_noise(5, rows, columns).shape == (len(rows), len(columns))
        assert drawn == tiles


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


def test_heights_are_gaussian() -> None:
    # points 3 l apart are independent (Eq. 9: 1e-9): 84^2 samples a seed, skewness and kurtosis as above
    z = np.concatenate([quietly(unit(s, 1.0), Grid.square(252.0, 84)).ravel() for s in (1, 2, 3)])
    assert abs(skewness(z)) < 4 * math.sqrt(6 / z.size)
    assert abs(kurtosis(z) - 3) < 4 * math.sqrt(24 / z.size)
    assert abs(z.var() - 1) < 4 * math.sqrt(2 / z.size)


@pytest.mark.parametrize("other", [2, 0, 2**32 + 1, 2**62])
def test_seeds_are_independent(other: int) -> None:
    grid = Grid.square(60.0, 240)
    a, b = unit(1, 1.0).heights(grid), unit(other, 1.0).heights(grid)
    # the mean product of independent fields has the variance int R^2 / area = pi / 4.6 / 60^2
    assert abs(np.mean(a * b)) < 4 * math.sqrt(math.pi / 4.6) / 60


def test_normalised_realisation_has_its_rms_on_every_grid() -> None:
    for seed in range(5):
        fine = GaussianRoughness(0.5e-6, LENGTH, seed, normalise=True).heights(Grid.square(SIDE, 512))
        # the midpoint sum misses the integral by O((h / l)^2) = 1e-3 of the border's share
        assert abs(np.std(fine) / 0.5e-6 - 1) < 1e-5
        ensemble = GaussianRoughness(0.5e-6, LENGTH, seed).heights(Grid.square(SIDE, 512))
        np.testing.assert_allclose(fine * (np.std(ensemble) / np.std(fine)), ensemble, rtol=1e-12, atol=0)
    strip = GaussianRoughness(0.5e-6, LENGTH, 0, normalise=True).heights(Grid((512, 128), (SIDE, SIDE / 4)))
    assert abs(np.std(strip) / 0.5e-6 - 1) < 1e-4  # the border's share is larger
    assert strip[0, 0] != pytest.approx(
        GaussianRoughness(0.5e-6, LENGTH, 0, normalise=True).heights(GRID)[0, 0]
    )


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


def test_what_cannot_be_had_is_refused() -> None:
    with pytest.raises(InputError, match="correlation_length"):
        unit(length=SIDE / 5000).heights(GRID)
    with pytest.raises(InputError, match="correlation_length"):
        unit(length=1e-300).heights(GRID)
    with pytest.raises(InputError, match="period"):
        unit(length=1.1 * SIDE).heights(replace(GRID, periodic=True))
    with pytest.raises(InputError, match="normalise"):
        unit(length=1.1 * SIDE, normalise=True).heights(GRID)
    with pytest.raises(InputError, match="offset"):
        unit().heights(GRID, (1e7 * LENGTH, 0.0))


@pytest.mark.parametrize(("length", "said"), [(1.00495, "1"), (1.00505, "1.01"), (2.00995, "2.01")])
def test_the_shortest_length_is_as_many_nodes_as_may_be(length: float, said: str) -> None:
    """The kernel reaches over 34 nodes and rounding over 2: 8156 / 6 lengths fit on an axis of 8192."""
    x = np.array([0.3, 0.3 + length * 8156 / 6])
    nodes, _ = unit(length=length * (1 + 1e-9)).smoothing(x)
    assert MAX_NODES - 2 <= len(nodes) <= MAX_NODES
    with pytest.raises(InputError) as refusal:
        unit(length=length * (1 - 1e-9)).smoothing(x)
    assert refusal.value.field == "correlation_length"
    assert refusal.value.value == length * (1 - 1e-9)
    assert refusal.value.allowed == f"at least {said} m on this domain (8192 noise nodes an axis)"


def test_a_million_lattice_spacings_from_the_origin_digits_are_lost() -> None:
    surface = unit(length=3.0)  # nodes every 0.5 m
    for sign in (-1.0, 1.0):
        surface.smoothing(np.array([sign * 499_999.9]))
        with pytest.raises(InputError) as refusal:
            surface.smoothing(np.array([sign * 500_000.1, sign * 499_999.0]))
        allowed = "within 1e+06 x 0.5 m: beyond, digits are lost"
        assert (refusal.value.field, refusal.value.allowed) == ("offset", allowed)
        assert refusal.value.value == 500_000.1


@pytest.mark.parametrize(
    ("shape", "lengths"), [((8, 8), (1.0, 1.0)), ((24, 8), (3.0, 1.0)), ((8, 24), (1.0, 3.0))]
)
def test_the_longest_periodic_length_is_the_period_and_the_shortest_normalised_side_the_length(
    shape: tuple[int, int], lengths: tuple[float, float]
) -> None:
    """Of a rectangle the shorter length counts, along either axis."""
    free, periodic = (Grid(shape, lengths, repeats) for repeats in (False, True))
    assert np.isfinite(unit(length=1.0).heights(periodic)).all()
    with pytest.raises(InputError) as refusal:
        unit(length=1.0 + 1e-9).heights(periodic)
    assert refusal.value.allowed == "at most the period, 1 m"
    assert np.isfinite(unit(length=1.0, normalise=True).heights(free)).all()
    with pytest.raises(InputError) as refusal:
        unit(length=1.25, normalise=True).heights(free)
    assert refusal.value.value is True
    assert refusal.value.allowed == "false, or a side of at least one correlation length, 1.25 m"


def test_unresolved_roughness_warns() -> None:
    with pytest.warns(SurfaceWarning, match="not resolved"):
        unit().heights(Grid.square(SIDE, 48))
    assert unit().notes(Grid.square(SIDE, 64)) == ()
    assert unit(length=1.0).notes(Grid.square(4.0, 16)) == ()  # just a quarter
    (said,) = unit(length=2.0).notes(Grid.square(1.25, 2))
    assert "the element, 0.625 m, exceeds a quarter of the roughness's correlation length, 2 m" in said


def test_the_greatest_and_the_least_seed() -> None:
    assert GaussianRoughness(1.0, 1.0, 2**63 - 1).seed == 2**63 - 1
    assert GaussianRoughness(1.0, 1.0, 0).seed == 0
    with pytest.raises(InputError, match=r"seed = 9223372036854775808: expected a whole number, 0 <= seed"):
        GaussianRoughness(1.0, 1.0, 2**63)


@pytest.mark.parametrize("lengths", [(3e-4, 1e-4), (1e-4, 3e-4)])
def test_the_shorter_correlation_length_is_what_a_grid_must_resolve(lengths: tuple[float, float]) -> None:
    assert GaussianRoughness(1e-6, lengths, seed=1).detail(1e-5).length == pytest.approx(1e-4)
