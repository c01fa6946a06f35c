"""The spectral preconditioner: its symbol, its spectrum on a contact, its cost."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.grid import Grid, Window
from refimpl.operators.fft import Counter, FFTInfluence
from refimpl.operators.influence import WindowInfluence, window_influence
from refimpl.operators.kernel_tables import unit_table
from refimpl.operators.preconditioner import SpectralPreconditioner
from refimpl.solution.energy_norm import SMALLEST_SYMBOL, smallest_symbol
from verification.exact.dense_influence import DenseInfluence

COMPLIANCE = 1e-11


def on(
    n: int, m: int, dx: float = 1e-4, dy: float | None = None, counter: Counter | None = None
) -> FFTInfluence:
    """The influence of a window of that shape on itself, in the middle of a larger grid."""
    grid = Grid((n + 2, m + 2), ((n + 2) * dx, (m + 2) * (dy or dx)))
    return FFTInfluence(grid, 0.0, source=Window(1, n + 1, 1, m + 1), counter=counter)


def periodic(n: int, m: int, dx: float, dy: float) -> WindowInfluence:
    return window_influence(Grid((n, m), (n * dx, m * dy), periodic=True), 0.0)


def spectral(operator: WindowInfluence, compliance: float = COMPLIANCE) -> SpectralPreconditioner:
    return SpectralPreconditioner(operator, compliance * operator.symbol)


def matrix(precondition: SpectralPreconditioner, n: int, m: int) -> np.ndarray:
    return np.array([precondition(row.reshape(n, m)).ravel() for row in np.eye(n * m)])


@pytest.mark.parametrize("shape", [(1, 1), (1, 6), (7, 5), (8, 3)])
@pytest.mark.parametrize("dy", [1e-4, 2e-5, 7e-4])
def test_the_preconditioner_is_symmetric_and_positive(shape: tuple[int, int], dy: float) -> None:
    found = matrix(spectral(on(*shape, dy=dy)), *shape)
    np.testing.assert_allclose(found, found.T, atol=1e-14 * found.max())
    assert np.linalg.eigvalsh(found).min() > 0


@pytest.mark.parametrize("n", [1, 7, 130])
@pytest.mark.parametrize("m", [1, 2, 81])
def test_symbols_are_positive_on_every_window(n: int, m: int) -> None:
    """The infinite lattice's least is 1.824, `SMALLEST_SYMBOL`; a window sees less of its kernel: 1.820."""
    symbol = on(n, m, 0.5).symbol / 0.5
    assert symbol.shape == (on(n, m).circle[0] // 2 + 1, on(n, m).circle[1])
    assert symbol.min() >= SMALLEST_SYMBOL - 0.005


@pytest.mark.parametrize("aspect", [0.1, 2.5])
@pytest.mark.parametrize("shape", [(7, 5), (1, 81), (2, 130)])
def test_symbols_of_oblong_elements_are_positive(shape: tuple[int, int], aspect: float) -> None:
    """At least 0.7889 of the infinite lattice's least symbol, of which long windows two elements wide lack
    most (measured for 1 to 200 elements an axis and aspects of 0.02 to 50)."""
    symbol = on(*shape, 0.5, 0.5 * aspect).symbol / 0.5
    assert symbol.min() >= 0.788 * smallest_symbol(aspect)


@pytest.mark.parametrize("aspect", [1.0, 0.4])
def test_the_symbol_is_the_periodic_sum_of_the_kernel(aspect: float) -> None:
    """Every second frequency of a padded circle: the kernel summed over the circle's images."""
    operator = on(3, 4, 0.5, 0.5 * aspect)
    n, m = operator.circle
    assert (n, m) == (3, 4)
    i, j = np.meshgrid(np.arange(-n, n), np.arange(-m, m), indexing="ij")
    kernel = unit_table("normal", (5, 5), aspect)[np.abs(i), np.abs(j)]
    for k in range(n // 2 + 1):
        for q in range(m):
            wave = np.cos(2 * np.pi * (k * i / n + q * j / m))
            assert operator.symbol[k, q] == pytest.approx(0.5 * np.sum(kernel * wave), rel=1e-12)


@pytest.mark.parametrize("aspect", [1.0, 2.0])
def test_the_spectrum_on_a_disc_lies_between_one_and_about_two(aspect: float) -> None:
    """What the first length rests on; a circle as short as the window costs some per cent below one."""
    n, m = 24, round(24 / aspect)
    grid = Grid((n, m), (1e-3, 1e-3))
    precondition = spectral(window_influence(grid, 0.0))
    x, y = grid.x - 0.5e-3, grid.y - 0.5e-3
    disc = (x[:, None] ** 2 + y[None, :] ** 2 < 0.45e-3**2).ravel()
    inverse = np.array([precondition(row.reshape(n, m)).ravel() for row in np.eye(n * m)[disc]])[:, disc]
    flexibility = COMPLIANCE * DenseInfluence(grid, 0.0).normal_matrix[np.ix_(disc, disc)]
    # on the tangent space of the load, as CG works
    tangent = np.eye(disc.sum()) - 1 / disc.sum()
    values = np.sort(np.linalg.eigvals(tangent @ inverse @ tangent @ flexibility).real)[1:]
    assert values[0] > 0.9
    assert values[-1] < 2.2


@pytest.mark.parametrize(("n", "m"), [(5, 5), (12, 3)])
def test_the_mean_has_half_of_the_longest_waves_stiffness(n: int, m: int) -> None:
    """Of a periodic scene: q = pi over the longer side."""
    operator = periodic(n, m, 0.5, 0.4)
    before = operator.symbol.copy()
    precondition = SpectralPreconditioner(operator, 3.0 * operator.symbol)
    q = np.pi / max(n * 0.5, m * 0.4)
    np.testing.assert_allclose(precondition(np.ones((n, m))), q / (2 * np.pi * 3.0), rtol=1e-14)
    SpectralPreconditioner(operator, operator.symbol)
    assert np.array_equal(operator.symbol, before)  # the argument stays as it is


def test_a_single_element_that_repeats_has_no_wave_and_is_left_as_it_is() -> None:
    assert spectral(periodic(1, 1, 0.5, 0.5), 3.0)(np.full((1, 1), 0.7)) == pytest.approx(
        np.full((1, 1), 0.7)
    )


@pytest.mark.parametrize(("k", "m"), [(1, 0), (0, 2), (3, -1), (-2, 5)])
@pytest.mark.parametrize("shape", [(12, 12), (12, 15), (9, 16)])
def test_periodic_it_inverts_the_half_space_on_waves(k: int, m: int, shape: tuple[int, int]) -> None:
    """A wave's pressure is ``q / (2 pi compliance)`` of its displacement."""
    operator = periodic(*shape, 0.5, 0.3)
    precondition = spectral(operator, 3.0)
    grid = operator.grid
    q = 2 * np.pi * np.array([k, m]) / grid.lengths
    wave = np.cos(q[0] * grid.x[:, None] + q[1] * grid.y[None, :] + 0.3)
    np.testing.assert_allclose(precondition(wave), np.hypot(*q) / (6 * np.pi) * wave, atol=1e-14)


def test_a_preconditioners_cost_is_of_half_the_padded_lengths() -> None:
    counter = Counter()
    operator = on(11, 7, counter=counter)
    precondition = spectral(operator, 3.0)
    before = counter.point_logs
    found = precondition(np.ones((11, 7)))
    assert found.shape == (11, 7)
    assert counter.point_logs - before == pytest.approx(96 * np.log2(96), rel=1e-14)  # 12 and 8
    assert counter.tally["preconditioner"] == 1
