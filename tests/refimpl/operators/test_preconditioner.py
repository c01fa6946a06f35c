"""The spectral preconditioner: its symbol, its spectrum on a contact, its cost."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.grid import Grid
from refimpl.grid.window import Window
from refimpl.operators.dense import DenseInfluence
from refimpl.operators.fft import Counter, FFTInfluence
from refimpl.operators.kernel_tables import unit_table
from refimpl.operators.periodic import PeriodicInfluence
from refimpl.operators.preconditioner import SpectralPreconditioner
from refimpl.solution.energy_norm import SMALLEST_SYMBOL

M, SIDE, COMPLIANCE = 10, 1e-3, 1e-11
GRID = Grid(SIDE, M)
A = COMPLIANCE * DenseInfluence(GRID, 0.0).normal_matrix


def on(n: int, m: int, spacing: float = 1e-4, counter: Counter | None = None) -> FFTInfluence:
    """The influence of a window of that shape on itself."""
    grid = Grid(max(n, m) * spacing, max(n, m))
    return FFTInfluence(grid, 0.0, source=Window(0, n, 0, m), counter=counter)


def matrix(precondition: SpectralPreconditioner, n: int, m: int) -> np.ndarray:
    return np.array([precondition(row.reshape(n, m)).ravel() for row in np.eye(n * m)])


@pytest.mark.parametrize("shape", [(1, 1), (1, 6), (7, 5), (8, 3)])
def test_the_preconditioner_is_symmetric_and_positive(shape: tuple[int, int]) -> None:
    found = matrix(SpectralPreconditioner(on(*shape), COMPLIANCE), *shape)
    np.testing.assert_allclose(found, found.T, atol=1e-14 * found.max())
    assert np.linalg.eigvalsh(found).min() > 0


@pytest.mark.parametrize("n", [1, 2, 3, 7, 16, 45, 130])
@pytest.mark.parametrize("m", [1, 2, 5, 16, 81, 300])
def test_symbols_are_positive_on_every_window(n: int, m: int) -> None:
    """The infinite lattice's least is 1.824, `SMALLEST_SYMBOL`; a window sees less of its kernel: 1.820."""
    symbol = on(n, m, spacing=0.5).symbol / 0.5
    assert symbol.shape == (on(n, m).circle[0] // 2 + 1, on(n, m).circle[1])
    assert symbol.min() >= SMALLEST_SYMBOL - 0.005


def test_the_symbol_is_the_periodic_sum_of_the_kernel() -> None:
    """Every second frequency of a padded circle: the kernel summed over the circle's images."""
    n, m = on(3, 4).circle
    assert (n, m) == (3, 4)
    i, j = np.meshgrid(np.arange(-n, n), np.arange(-m, m), indexing="ij")
    kernel = unit_table("normal", 5)[np.abs(i), np.abs(j)]
    for k in range(n // 2 + 1):
        for q in range(m):
            wave = np.cos(2 * np.pi * (k * i / n + q * j / m))
            assert on(3, 4, spacing=0.5).symbol[k, q] == pytest.approx(0.5 * np.sum(kernel * wave), rel=1e-12)


def test_the_preconditioner_clusters_the_spectrum() -> None:
    """What it is there for: the condition number of 100 elements falls by half at least."""
    inverse = matrix(SpectralPreconditioner(FFTInfluence(GRID, 0.0), COMPLIANCE), M, M)
    values = np.sort(np.linalg.eigvals(inverse @ A).real)
    assert values[0] > 0
    assert values[-1] / values[0] < 0.5 * np.linalg.cond(A)


def test_the_spectrum_on_a_disc_lies_between_one_and_about_two() -> None:
    """What the first length rests on; a circle as short as the window costs some per cent below one."""
    n = 24
    grid = Grid(SIDE, n)
    spectral = SpectralPreconditioner(FFTInfluence(grid, 0.0), COMPLIANCE)
    x = np.arange(n) - (n - 1) / 2
    disc = (x[:, None] ** 2 + x[None, :] ** 2 < (0.45 * n) ** 2).ravel()
    inverse = np.array([spectral(row.reshape(n, n)).ravel() for row in np.eye(n * n)[disc]])[:, disc]
    flexibility = COMPLIANCE * DenseInfluence(grid, 0.0).normal_matrix[np.ix_(disc, disc)]
    # on the tangent space of the load, as CG works
    tangent = np.eye(disc.sum()) - 1 / disc.sum()
    values = np.sort(np.linalg.eigvals(tangent @ inverse @ tangent @ flexibility).real)[1:]
    assert values[0] > 0.9
    assert values[-1] < 2.2


@pytest.mark.parametrize("n", [5, 12])
def test_the_mean_has_half_of_the_longest_waves_stiffness(n: int) -> None:
    """Of a periodic scene: q = pi over the side."""
    precondition = SpectralPreconditioner(PeriodicInfluence(Grid(0.5 * n, n), 0.0), 3.0)
    q = np.pi / (n * 0.5)
    np.testing.assert_allclose(precondition(np.ones((n, n))), q / (2 * np.pi * 3.0), rtol=1e-14)


def test_a_single_element_that_repeats_has_some_stiffness() -> None:
    precondition = SpectralPreconditioner(PeriodicInfluence(Grid(0.5, 1), 0.0), 3.0)
    assert precondition(np.ones((1, 1)))[0, 0] > 0


@pytest.mark.parametrize(("k", "m"), [(1, 0), (0, 2), (3, -1), (-2, 5)])
def test_periodic_it_inverts_the_half_space_on_waves(k: int, m: int) -> None:
    """A wave's pressure is ``q / (2 pi compliance)`` of its displacement."""
    n, spacing = 12, 0.5
    precondition = SpectralPreconditioner(PeriodicInfluence(Grid(n * spacing, n), 0.0), 3.0)
    q = 2 * np.pi * np.array([k, m]) / (n * spacing)
    x = spacing * np.arange(n)
    wave = np.cos(q[0] * x[:, None] + q[1] * x + 0.3)
    np.testing.assert_allclose(precondition(wave), np.hypot(*q) / (6 * np.pi) * wave, atol=1e-14)


def test_long_waves_see_the_half_space() -> None:
    """``2 pi / q``, but for what a window does not see of its kernel."""
    n, spacing = 64, 0.5
    symbol = on(n, n, spacing).symbol
    for k, m in ((2, 0), (0, 2), (3, 4), (8, 5)):
        q = 2 * np.pi * np.hypot(k, m) / (n * spacing)
        assert symbol[k, m] == pytest.approx(2 * np.pi / q, rel=0.12)


def test_a_preconditioners_cost_is_of_half_the_padded_lengths() -> None:
    counter = Counter()
    operator = on(11, 7, counter=counter)
    precondition = SpectralPreconditioner(operator, 3.0)
    before = counter.point_logs
    found = precondition(np.ones((11, 7)))
    assert found.shape == (11, 7)
    assert counter.point_logs - before == pytest.approx(96 * np.log2(96), rel=1e-14)  # 12 and 8
    assert counter.tally["preconditioner"] == 1
