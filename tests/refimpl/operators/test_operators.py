"""Influence operators against plain double loops over the integrals, and against each other."""

from __future__ import annotations

import itertools
import math
import sys

import numpy as np
import pytest

from refimpl.grid import Grid
from refimpl.grid.window import Window
from refimpl.kernels import normal_integral, tangential_integral
from refimpl.operators.dense import DenseInfluence
from refimpl.operators.fft import Counter, FFTInfluence, WholeGridInfluence
from refimpl.operators.kernel_tables import signed_table, unit_table
from refimpl.operators.periodic import PeriodicInfluence

KINDS = ("normal", "shear", "shear_across")
ANGLES = (0.0, 0.7, 2.0, -2.5)
ROUNDING = 2e-15
"""Over sum |kernel| |traction|: an FFT of a hundred points is accurate to a few eps log2(n)."""


def traction(M, seed=1):
    return np.random.default_rng(seed).standard_normal((M, M))


def by_double_loop(grid, angle, kind, source):
    """Sum over all sources, one field point at a time; and the same of absolute values."""
    result, scale = np.zeros((2, grid.M, grid.M))
    h = grid.spacing
    turned = angle + (math.pi / 2 if kind == "shear_across" else 0.0)
    for i, j, k, m in itertools.product(range(grid.M), repeat=4):
        x, y = (i - k) * h, (j - m) * h
        if kind == "normal":
            value = normal_integral(x, y, h, h)
        else:
            along_x, along_y = tangential_integral(x, y, h, h), tangential_integral(y, x, h, h)
            value = math.cos(turned) * along_x + math.sin(turned) * along_y
        result[i, j] += value * source[k, m]
        scale[i, j] += abs(value * source[k, m])
    return result, scale


@pytest.mark.parametrize("angle", ANGLES[:3])
@pytest.mark.parametrize("kind", KINDS)
def test_dense_and_fft_are_the_double_loop(kind, angle):
    grid, source = Grid(side=0.3, M=5), traction(5)
    expected, scale = by_double_loop(grid, angle, kind, source)
    for operator in (DenseInfluence(grid, angle), FFTInfluence(grid, angle)):
        assert np.all(np.abs(getattr(operator, kind)(source) - expected) <= ROUNDING * scale.max())


@pytest.mark.parametrize("M", [1, 2, 7, 16, 33])
@pytest.mark.parametrize("kind", KINDS)
def test_fft_is_dense(kind, M):
    grid, source = Grid(side=1.7e-3, M=M), traction(M)
    dense, fft = DenseInfluence(grid, 0.7), FFTInfluence(grid, 0.7)
    scale = float((dense.normal_matrix @ np.abs(source).ravel()).max())  # the larger kernel's
    assert np.abs(getattr(fft, kind)(source) - getattr(dense, kind)(source)).max() <= ROUNDING * scale


def windows(M):
    edges = list(itertools.combinations(range(M + 1), 2))
    return [Window(*rows, *columns) for rows in edges for columns in edges]


@pytest.mark.parametrize("kind", KINDS)
def test_every_source_window_reaches_the_whole_grid(kind):
    """A window at the grid's lower border once lost its farthest targets (offset 3 of 4)."""
    M, angle = 5, 0.7
    grid = Grid(side=1.0, M=M)
    dense = DenseInfluence(grid, angle)
    for window in windows(M):
        source = window.spread(traction(M)[window.slices], M)
        found = getattr(WholeGridInfluence(grid, angle, source=window, target=Window.full(M)), kind)(source)
        np.testing.assert_allclose(found, getattr(dense, kind)(source), atol=1e-14, rtol=0)


@pytest.mark.parametrize("kind", KINDS)
def test_any_source_and_target_windows(kind):
    M, angle = 6, 2.0
    grid = Grid(side=1.0, M=M)
    dense = DenseInfluence(grid, angle)
    chosen = windows(M)[::23]
    for source, target in itertools.product(chosen, chosen):
        loaded = traction(M)[source.slices]
        found = getattr(FFTInfluence(grid, angle, source=source, target=target), kind)(loaded)
        expected = getattr(dense, kind)(source.spread(loaded, M))[target.slices]
        np.testing.assert_allclose(found, expected, atol=1e-14, rtol=0)


def test_dense_matrices_are_symmetric_and_skew():
    dense = DenseInfluence(Grid(1.0, 6), 0.7)
    assert np.array_equal(dense.normal_matrix, dense.normal_matrix.T)
    assert np.array_equal(dense.shear_matrix, -dense.shear_matrix.T)
    assert np.linalg.eigvalsh(dense.normal_matrix).min() > 0


@pytest.mark.parametrize("operator", [DenseInfluence, FFTInfluence])
def test_sign_and_axes_of_the_shear(operator):
    """A traction along +x on one element pushes the surface ahead of it in, and lifts the one behind."""
    M = 5
    source = np.zeros((M, M))
    source[2, 2] = 1.0
    along_x = operator(Grid(1.0, M), 0.0)
    ahead = along_x.shear(source)
    assert ahead[4, 2] > 0 > ahead[0, 2]
    assert abs(ahead[2, 4]) < 1e-15
    np.testing.assert_allclose(along_x.shear_across(source), ahead.T, atol=1e-15)
    np.testing.assert_allclose(operator(Grid(1.0, M), math.pi / 2).shear(source), ahead.T, atol=1e-15)


def test_homogeneity_in_length():
    """Integrals are of degree one in length."""
    source = traction(9)
    small, large = (FFTInfluence(Grid(side, 9), 0.7).shear(source) for side in (1.0, 2.0**12))
    assert np.array_equal(large, 2.0**12 * small)


@pytest.mark.parametrize("M", [4, 7, 12])
@pytest.mark.parametrize("kind", KINDS)
def test_periodic_fft_is_the_periodic_matrix(kind, M):
    grid, source = Grid(side=0.3, M=M), traction(M)
    fft = getattr(PeriodicInfluence(grid, 0.7), kind)(source)
    dense = getattr(DenseInfluence(grid, 0.7, periodic=True), kind)(source)
    np.testing.assert_allclose(fft, dense, atol=2e-14 * np.abs(dense).max(), rtol=0)


@pytest.mark.parametrize(("k", "m"), [(1, 0), (0, 2), (3, -1)])
def test_periodic_waves_have_the_half_space_symbols(k, m):
    """``cos(q x)`` gives ``2 pi / |q| cos(q x)`` and, sheared, ``2 pi q_s / q^2 sin(q x)``."""
    side, M, angle = 0.3, 16, 0.7
    grid = Grid(side, M)
    q = 2 * np.pi / side * np.array([k, m])
    phase = q[0] * grid.centres[:, None] + q[1] * grid.centres[None, :]
    operator = PeriodicInfluence(grid, angle)
    length, along = np.hypot(*q), q @ [math.cos(angle), math.sin(angle)]
    np.testing.assert_allclose(operator.normal(np.cos(phase)), 2 * np.pi / length * np.cos(phase), atol=1e-15)
    expected = 2 * np.pi * along / length**2 * np.sin(phase)
    np.testing.assert_allclose(operator.shear(np.cos(phase)), expected, atol=1e-15)


def test_periodic_images_far_apart_are_the_aperiodic_operator():
    """A smooth traction without resultant or moment hardly feels its images.

    Far fields fall as rho^-3, so images a period off an extent of a tenth of it give 1e-3 of the near field.
    Elements against band-limited interpolation differ at second order, (h/w)^2/4 measured for the shear:
    4e-3 for a width of w = 8 h.
    """
    M, width = 256, 8.0
    x = np.arange(M) - M / 2
    r2 = (x[:, None] ** 2 + x[None, :] ** 2) / (2 * width**2)
    source = (1 - r2) * np.exp(-r2)
    grid = Grid(1.0, M)
    wide, alone = PeriodicInfluence(grid, 0.7), FFTInfluence(grid, 0.7)
    for kind in KINDS:
        images, single = getattr(wide, kind)(source), getattr(alone, kind)(source)
        assert np.abs(images - single).max() <= 5e-3 * np.abs(single).max()


def test_tables_have_their_parity():
    rows, columns = np.array([-2, -1, 0, 1, 2]), np.array([0, 1, -3])
    normal, tangential = signed_table("normal", rows, columns), signed_table("tangential", rows, columns)
    assert np.array_equal(normal, normal[::-1])
    assert np.array_equal(tangential, -tangential[::-1])
    assert np.all(tangential[2] == 0)
    assert not unit_table("normal", 3).flags.writeable


def test_counter_counts():
    counter = Counter()
    operator = FFTInfluence(Grid(1.0, 4), 0.0, counter=counter)
    operator.normal(np.zeros((4, 4)))
    operator.shear(np.zeros((4, 4)))
    assert counter.tally == {"normal": 1, "shear": 1, "normal kernel": 1, "shear kernel": 1}
    # kernels: an eighth of an application each by symmetry
    assert counter.point_logs == 2 * 64 * 6 + 2 * 8 * 3
    operator.shear_across(np.zeros((4, 4)))
    assert counter.tally == {"normal": 1, "shear": 2, "normal kernel": 1, "shear kernel": 2}
    assert (
        counter.point_logs == 3 * 64 * 6 + 2 * 8 * 3 + 16 * 4
    )  # of two parts: a right angle's cosine rounds to 6e-17


def test_a_transform_of_a_point_or_two_counts_as_one_logarithm():
    counter = Counter()
    counter.add("normal", 1)
    assert counter.point_logs == 1
    counter.add("normal", 2)
    assert counter.point_logs == 3


def test_window():
    marked = np.zeros((6, 6), dtype=bool)
    assert Window.around(marked, margin=1) == Window.full(6)
    marked[2, 1] = marked[3, 4] = True
    assert Window.around(marked, margin=0) == Window(2, 4, 1, 5)
    assert Window.around(marked, margin=2) == Window(0, 6, 0, 6)
    assert Window.around(np.ones((5, 3), dtype=bool), margin=1) == Window(0, 5, 0, 3)
    assert Window(2, 4, 1, 5).filling(6) == Window(2, 4, 1, 5)  # 3 and 7 elements pad to 4 and 8
    assert Window(20, 37, 60, 64).filling(64) == Window(20, 38, 60, 64)  # 33 pad to 36, room for 18
    assert Window(2, 4, 1, 5).spread(np.ones((2, 4)), 6).sum() == 8
    assert Window(2, 5, 0, 6).interior(6) == Window(3, 4, 0, 6)
    assert Window(0, 6, 2, 5).interior(6) == Window(0, 6, 3, 4)
    assert Window.full(6).interior(6) == Window.full(6)
    assert np.array_equal(np.argwhere(Window(2, 4, 1, 3).mask(6)), [[2, 1], [2, 2], [3, 1], [3, 2]])


@pytest.mark.parametrize(
    ("window", "inside"),
    [
        (Window(2, 5, 1, 5), np.s_[1:2, 1:3]),
        (Window(0, 3, 1, 5), np.s_[0:2, 1:3]),  # the grid's own edge is none of the window
        (Window(3, 6, 2, 6), np.s_[1:3, 1:4]),
        (Window.full(6), np.s_[0:6, 0:6]),
    ],
)
def test_what_lies_on_a_windows_edge(window: Window, inside: tuple[slice, slice]) -> None:
    edge = np.ones(window.shape, dtype=bool)
    edge[inside] = False
    for element in np.ndindex(window.shape):
        alone = np.zeros(window.shape, dtype=bool)
        alone[element] = True
        assert window.on_edge(alone, 6) is bool(edge[element])
        assert alone.sum() == 1  # what is asked about stays as it is


def test_kernels_count_by_their_symmetry():
    def counted(M, source, target):
        counter = Counter()
        operator = FFTInfluence(Grid(1.0, M), 0.0, source=source, target=target, counter=counter)
        operator.normal(np.zeros(operator.source.shape))
        return counter.point_logs

    # 13 offsets an axis, on a circle of 16: even around zero, so an eighth of an application
    assert counted(7, None, None) == 256 * 8 + 32 * 5
    # the offsets 1 to 5, on a circle of 6, are not
    apart = counted(6, Window(0, 2, 0, 2), Window(2, 6, 2, 6))
    assert apart == pytest.approx(36 * math.log2(36) + 18 * math.log2(18), rel=1e-15)
    # -2 to 4 and -4 to 2, on a circle of 8: even with one more offset than was asked for
    for edge in (Window(0, 3, 2, 5), Window(2, 5, 0, 3)):
        assert counted(5, edge, Window.full(5)) == 64 * 6 + 8 * 3
    # -3 to 5 on one of 10, with room for -4
    assert counted(7, Window(1, 4, 1, 4), Window.full(7)) == pytest.approx(
        100 * math.log2(100) + 12 * math.log2(12), rel=1e-15
    )
    # -2 to 5 fill a circle of 8, which then is not even
    assert counted(6, Window(0, 3, 0, 3), Window.full(6)) == 64 * 6 + 32 * 5


@pytest.mark.parametrize(
    ("M", "source", "target", "points", "normal", "shear"),
    [
        # -8 to 8 on 18, and -3 to 8: 12 hold them, 16 hold 8 as well, a third more points, which is worth it
        (9, Window(0, 9, 0, 4), Window.full(9), 18 * 16, 8, 2),
        (9, Window(0, 9, 5, 9), Window.full(9), 18 * 16, 8, 2),
        (9, Window(0, 4, 0, 9), Window.full(9), 18 * 16, 8, 2),
        (9, Window(5, 9, 0, 9), Window.full(9), 18 * 16, 8, 2),
        # the same with -7 to 3, from a target that does not begin at 0: what is odd has nothing opposite 0
        (9, Window(5, 9, 0, 9), Window(1, 9, 0, 9), 18 * 16, 8, 4),
        (9, Window(0, 9, 5, 9), Window(0, 9, 1, 9), 18 * 16, 8, 4),
        # -9 to 9 on 20, and -6 to 9: 16 hold them, 18 hold 9 as well, an eighth more
        (10, Window(0, 10, 0, 7), Window.full(10), 20 * 18, 8, 2),
        # -9 to 9 on 20, and -2 to 9: 12 hold them, 18 would be a half more
        (10, Window(0, 10, 0, 3), Window.full(10), 20 * 12, 2, 2),
        (10, Window(7, 10, 0, 10), Window.full(10), 20 * 12, 2, 2),
    ],
)
def test_a_little_more_padding_for_an_even_kernel(M, source, target, points, normal, shear):
    counter = Counter()
    operator = FFTInfluence(Grid(1.0, M), 0.3, source=source, target=target, counter=counter)
    field = np.random.default_rng(5).random(source.shape)
    found = operator.normal(field), operator.shear(field)
    assert counter.point_logs == pytest.approx(
        2 * points * math.log2(points)
        + points // normal * math.log2(points // normal)
        + points // shear * math.log2(points // shear),
        rel=1e-15,
    )
    dense, whole = DenseInfluence(Grid(1.0, M), 0.3), source.spread(field, M)
    for one, other in zip(found, (dense.normal(whole), dense.shear(whole)), strict=True):
        np.testing.assert_allclose(one, other[target.slices], atol=1e-14 * np.abs(other).max())


@pytest.mark.parametrize("operator", [FFTInfluence, PeriodicInfluence])
def test_threads_are_by_the_points_of_a_transform(operator, monkeypatch):
    """An application's own, and its kernel's."""
    asked = []
    module = sys.modules[operator.__module__]
    monkeypatch.setattr(module, "threads", lambda points: asked.append(points) or 1)
    counter = Counter()
    for kind in KINDS:
        getattr(operator(Grid(1.0, 12), 0.7, counter=counter), kind)(np.ones((12, 12)))
    points = 24 * 24 if operator is FFTInfluence else 12 * 12
    assert len(asked) >= 3
    assert set(asked) == {points}


def test_periodic_applications_count_their_points():
    counter = Counter()
    operator = PeriodicInfluence(Grid(1.0, 8), 0.7, counter=counter)
    for kind in KINDS:
        getattr(operator, kind)(np.zeros((8, 8)))
    assert counter.tally == {"normal": 1, "shear": 2}
    assert counter.point_logs == 3 * 64 * 6


def test_a_window_that_fills_its_transform_stays_within_the_grid() -> None:
    """Eleven elements are padded to 24 points, which hold twelve; the twelfth lies on the inner side."""
    assert Window(13, 24, 0, 11).filling(24) == Window(12, 24, 0, 12)
    assert Window(6, 17, 6, 17).filling(24).shape == (12, 12)


def test_few_points_are_multiplied_by_complex_numbers_and_many_by_real_ones() -> None:
    """The same numbers: what is quicker is a matter of size alone."""
    few, many = (FFTInfluence(Grid(1.0, M), 0.0) for M in (128, 200))
    assert few._normal_hat.dtype == np.complex128
    assert not few._normal_hat.imag.any()
    assert many._normal_hat.dtype == np.float64
