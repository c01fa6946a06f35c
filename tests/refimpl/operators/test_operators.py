"""Influence operators and tables of their kernels against sums over pairs of elements, on rectangles."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest

from refimpl.grid import Array, Grid, Window
from refimpl.kernels import normal_integral, normal_table, tangential_integral, tangential_table
from refimpl.operators.fft import Counter, FFTInfluence, WholeGridInfluence
from refimpl.operators.influence import whole_grid_influence, window_influence
from refimpl.operators.kernel_tables import signed_table, unit_table
from refimpl.operators.periodic import PeriodicInfluence
from verification.exact.dense_influence import DenseInfluence

KINDS = ("normal", "shear", "shear_across")
ANGLES = (0.7, 2.0)
ROUNDING = 2e-15
"""Over sum |kernel| |traction|: an FFT of a hundred points is accurate to a few eps log2(n)."""

GRIDS = [
    Grid.square(0.3, 1),
    Grid.square(0.3, 5),
    Grid((7, 4), (1.4, 2.0)),  # dy / dx = 2.5
    Grid((6, 9), (1.0, 0.3)),  # 0.2
    Grid((3, 2), (0.3, 0.2)),  # square to rounding
    Grid((60, 5), (1.0, 1.0)),  # strips
    Grid((5, 60), (1.0, 3.0)),
    Grid((7, 1), (2.0, 0.1)),
    Grid((1, 8), (1.0, 1.0)),
    Grid((2, 31), (1.0, 1.0)),
]
"""Squares and rectangles, odd and even, with elements from ten times as long as wide to ten times as wide."""


def name(grid: Grid) -> str:
    return f"{grid}, dy/dx = {grid.aspect:.3g}"


on_grids = pytest.mark.parametrize("grid", GRIDS, ids=name)
of_kinds = pytest.mark.parametrize("kind", KINDS)


def traction(grid: Grid, seed: int = 1) -> Array:
    return np.random.default_rng(seed).standard_normal(grid.shape)


def by_pairs(grid: Grid, angle: float, kind: str, source: Array) -> tuple[Array, float]:
    """Sum over all pairs of elements, from their centres; and the largest sum of absolute values."""
    x, y = (centres.ravel() for centres in np.meshgrid(grid.x, grid.y, indexing="ij"))
    x, y = x[:, None] - x[None, :], y[:, None] - y[None, :]
    dx, dy = grid.spacings
    if kind == "normal":
        values = normal_integral(x, y, dx, dy)
    else:
        turned = angle + (math.pi / 2 if kind == "shear_across" else 0.0)
        along_x, along_y = tangential_integral(x, y, dx, dy), tangential_integral(y, x, dy, dx)
        values = math.cos(turned) * along_x + math.sin(turned) * along_y
    scale = np.abs(normal_integral(x, y, dx, dy)) @ np.abs(source.ravel())  # the larger kernel's
    return (values @ source.ravel()).reshape(grid.shape), float(scale.max())


@on_grids
@of_kinds
@pytest.mark.parametrize("angle", ANGLES)
def test_dense_and_fft_are_the_sum_over_pairs(kind: str, angle: float, grid: Grid) -> None:
    source = traction(grid)
    expected, scale = by_pairs(grid, angle, kind, source)
    for operator in (DenseInfluence(grid, angle), FFTInfluence(grid, angle)):
        assert np.all(np.abs(getattr(operator, kind)(source) - expected) <= ROUNDING * scale)


def windows(shape: tuple[int, int], every: int = 1) -> list[Window]:
    rows, columns = (list(itertools.combinations(range(n + 1), 2)) for n in shape)
    return [Window(*i, *j) for i in rows for j in columns][::every]


@of_kinds
@pytest.mark.parametrize("grid", [Grid.square(1.0, 5), Grid((4, 6), (1.0, 3.5))], ids=name)
def test_every_source_window_reaches_the_whole_grid(kind: str, grid: Grid) -> None:
    """A window at the grid's lower border once lost its farthest targets (offset 3 of 4)."""
    angle, loads = 0.7, traction(grid)
    dense = DenseInfluence(grid, angle)
    for window in windows(grid.shape):
        source = window.spread(loads[window.slices], grid.shape)
        operator = whole_grid_influence(grid, angle, window)
        assert isinstance(operator, WholeGridInfluence)
        expected = getattr(dense, kind)(source)
        np.testing.assert_allclose(getattr(operator, kind)(source), expected, atol=2e-14, rtol=0)


@of_kinds
@pytest.mark.parametrize("grid", [Grid.square(1.0, 6), Grid((7, 5), (1.0, 3.5))], ids=name)
def test_any_source_and_target_windows(kind: str, grid: Grid) -> None:
    angle, chosen = 2.0, windows(grid.shape, every=23)
    dense = DenseInfluence(grid, angle)
    for source, target in itertools.product(chosen, chosen):
        loaded = traction(grid)[source.slices]
        found = getattr(FFTInfluence(grid, angle, source=source, target=target), kind)(loaded)
        expected = getattr(dense, kind)(source.spread(loaded, grid.shape))[target.slices]
        np.testing.assert_allclose(found, expected, atol=2e-14, rtol=0)


@on_grids
@of_kinds
def test_periodic_fft_is_the_periodic_matrix(kind: str, grid: Grid) -> None:
    grid = replace(grid, periodic=True)
    fft, dense = window_influence(grid, 0.7), DenseInfluence(grid, 0.7)
    assert isinstance(fft, PeriodicInfluence)
    found, expected = (getattr(operator, kind)(traction(grid)) for operator in (fft, dense))
    scale = float(np.abs(dense.normal_matrix).sum(axis=1).max()) * np.abs(traction(grid)).max()
    np.testing.assert_allclose(found, expected, atol=1e-14 * scale, rtol=0)


@on_grids
@pytest.mark.parametrize("periodic", [False, True])
def test_both_kernels_in_one_product_cost_one(grid: Grid, periodic: bool) -> None:
    counter = Counter()
    operator = window_influence(replace(grid, periodic=periodic), 0.7, counter=counter)
    pressure = traction(grid)
    product = operator.coupled(0.5)
    before = counter.point_logs
    found = product(pressure)
    after = counter.point_logs
    expected = operator.normal(pressure) + 0.5 * operator.shear(pressure)
    assert math.isclose(after - before, 0.5 * (counter.point_logs - after), rel_tol=1e-14)
    assert counter.tally["normal and shear"] == 1
    scale = float(np.abs(operator.normal(np.abs(pressure))).max())
    assert np.abs(found - expected).max() <= 1e-14 * scale


def test_kernels_count_by_their_symmetry():
    def counted(M, source, target):
        counter = Counter()
        operator = FFTInfluence(Grid.square(1.0, M), 0.0, source=source, target=target, counter=counter)
        operator.normal(np.zeros(operator.source.shape))
        return counter.point_logs

    # 13 offsets an axis, on a circle of 16: even around zero, so an eighth of an application
    assert counted(7, None, None) == 256 * 8 + 32 * 5
    # the offsets 1 to 5, on a circle of 6, are not
    apart = counted(6, Window(0, 2, 0, 2), Window(2, 6, 2, 6))
    assert apart == pytest.approx(36 * math.log2(36) + 18 * math.log2(18), rel=1e-15)
    # -2 to 4 and -4 to 2, on a circle of 8: even with one more offset than was asked for
    for edge in (Window(0, 3, 2, 5), Window(2, 5, 0, 3)):
        assert counted(5, edge, Window.full((5, 5))) == 64 * 6 + 8 * 3
    # -3 to 5 on one of 10, with room for -4
    assert counted(7, Window(1, 4, 1, 4), Window.full((7, 7))) == pytest.approx(
        100 * math.log2(100) + 12 * math.log2(12), rel=1e-15
    )
    # -2 to 5 fill a circle of 8, which then is not even
    assert counted(6, Window(0, 3, 0, 3), Window.full((6, 6))) == 64 * 6 + 32 * 5


INTEGRALS = {"normal": normal_integral, "tangential": tangential_integral}
ACCURACY = 1e-13
"""Relative, of either value: what `refimpl.kernels` promises."""

of_integrals = pytest.mark.parametrize("kind", INTEGRALS)


@of_integrals
@pytest.mark.parametrize("aspect", [1.0, 0.37])
def test_signed_offsets_have_the_kernels_parity(kind: str, aspect: float) -> None:
    rows, columns = np.array([-2, -1, 0, 1, 2, 9]), np.array([0, 1, -3])
    found = signed_table(kind, rows, columns, aspect)
    exact = INTEGRALS[kind](rows[:, None].astype(float), aspect * columns, 1.0, aspect)
    np.testing.assert_allclose(found, exact, rtol=2 * ACCURACY)
    sign = -1 if kind == "tangential" else 1
    assert np.array_equal(found[:2], sign * found[[4, 3]])


@of_integrals
@pytest.mark.parametrize("aspect", [1.0, 0.53, 2.9])
def test_a_table_grows_without_a_change_of_any_bit(kind: str, aspect: float) -> None:
    """Whatever shapes were asked for before, also where one axis grows and the other does not."""
    table = normal_table if kind == "normal" else tangential_table
    for shape in ((5, 5), (9, 40), (30, 30), (12, 90), (70, 60), (2, 3), (200, 9)):
        assert np.array_equal(unit_table(kind, shape, aspect), table(*shape, 1.0, aspect))
