"""The spectral preconditioner: its symbol, its spectrum on a contact, its cost."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.contact.preconditioner import SpectralPreconditioner, _over_q
from refimpl.grid import Grid
from refimpl.operators.dense import DenseInfluence
from refimpl.operators.fft import Counter

M, SIDE, COMPLIANCE = 10, 1e-3, 1e-11
GRID = Grid(SIDE, M)
A = COMPLIANCE * DenseInfluence(GRID, 0.0).normal_matrix


def test_the_preconditioner_is_symmetric_and_positive() -> None:
    spectral = SpectralPreconditioner((7, 5), 1e-4, COMPLIANCE, Counter())
    matrix = np.array([spectral(row.reshape(7, 5)).ravel() for row in np.eye(35)])
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-14 * matrix.max())
    assert np.linalg.eigvalsh(matrix).min() > 0


def test_the_preconditioner_clusters_the_spectrum() -> None:
    """What it is there for: the condition number of 100 elements falls by half at least."""
    spectral = SpectralPreconditioner((M, M), GRID.spacing, COMPLIANCE, Counter())
    matrix = np.array([spectral(row.reshape(M, M)).ravel() for row in np.eye(M * M)])
    values = np.sort(np.linalg.eigvals(matrix @ A).real)
    assert values[0] > 0
    assert values[-1] / values[0] < 0.5 * np.linalg.cond(A)


def test_the_spectrum_on_a_disc_lies_between_one_and_about_two() -> None:
    """What the first step's length rests on; a periodic window and one fold cost a few per cent below one."""
    n = 24
    grid = Grid(SIDE, n)
    spectral = SpectralPreconditioner((n, n), grid.spacing, COMPLIANCE, Counter())
    x = np.arange(n) - (n - 1) / 2
    disc = (x[:, None] ** 2 + x[None, :] ** 2 < (0.45 * n) ** 2).ravel()
    inverse = np.array([spectral(row.reshape(n, n)).ravel() for row in np.eye(n * n)[disc]])[:, disc]
    flexibility = COMPLIANCE * DenseInfluence(grid, 0.0).normal_matrix[np.ix_(disc, disc)]
    # on the tangent space of the load, as CG works
    tangent = np.eye(disc.sum()) - 1 / disc.sum()
    values = np.sort(np.linalg.eigvals(tangent @ inverse @ tangent @ flexibility).real)[1:]
    assert values[0] > 0.9
    assert values[-1] < 2.2


@pytest.mark.parametrize("shape", [(4, 12), (12, 4), (12, 12)])
def test_the_mean_has_half_of_the_smallest_frequency(shape: tuple[int, int]) -> None:
    """q = pi over the longer edge, along either axis."""
    precondition = SpectralPreconditioner(shape, 0.5, 3.0, Counter(), band_limited=True)
    q = np.pi / (max(shape) * 0.5)
    np.testing.assert_allclose(precondition(np.ones(shape)), q / (2 * np.pi * 3.0), rtol=1e-14)


@pytest.mark.parametrize(("k", "m"), [(1, 0), (0, 2), (3, -1), (-2, 5)])
def test_band_limited_it_inverts_the_half_space_on_waves(k: int, m: int) -> None:
    """A wave's pressure is ``q / (2 pi compliance)`` of its displacement."""
    shape, spacing = (8, 12), 0.5
    precondition = SpectralPreconditioner(shape, spacing, 3.0, Counter(), band_limited=True)
    q = 2 * np.pi * np.array([k, m]) / (np.array(shape) * spacing)
    x, y = (spacing * np.arange(n) for n in shape)
    wave = np.cos(q[0] * x[:, None] + q[1] * y + 0.3)
    np.testing.assert_allclose(precondition(wave), np.hypot(*q) / (6 * np.pi) * wave, atol=1e-14)


def test_one_fold_is_nearly_the_full_sum() -> None:
    """Against twenty folds: 0.081 off in the band's corner, 0.025 in the mean; without one 0.22, 0.06."""
    n, spacing = 12, 0.5
    folded = 1 / (2 * np.pi * 3.0 * SpectralPreconditioner((n, n), spacing, 3.0, Counter())._symbol)
    q_x = (2 * np.pi * np.fft.rfftfreq(n, spacing)[:, None]).astype(np.float64)
    q_y = (2 * np.pi * np.fft.fftfreq(n, spacing)[None, :]).astype(np.float64)
    error = np.abs(folded / _over_q(q_x=q_x, q_y=q_y, spacing=spacing, folds=20) - 1)
    assert error.max() <= 0.085
    assert error.mean() <= 0.03


def test_the_symbol_in_the_bands_corner_and_in_its_middle() -> None:
    """By hand: bands meet there at odd multiples of pi/h, with sinc(1/2) = 2/pi and sinc(3/2) = -2/(3 pi)."""
    n, spacing = 64, 0.5
    precondition = SpectralPreconditioner(
        shape=(n, n), spacing=spacing, compliance=1 / (2 * np.pi), counter=Counter()
    )
    sincs = {-1: 2 / np.pi, 1: 2 / np.pi, 3: -2 / (3 * np.pi)}
    folded = sum(sincs[k] * sincs[m] / np.hypot(k, m) for k in sincs for m in sincs) * spacing / np.pi
    assert precondition._symbol[n // 2, n // 2] == pytest.approx(1 / folded, rel=1e-12)
    # long waves see the half-space alone: sincs and folds are of second order in q h
    for k, m in ((1, 0), (0, 1), (1, 1), (1, -1)):
        q = 2 * np.pi * np.hypot(k, m) / (n * spacing)
        assert precondition._symbol[k, m] == pytest.approx(q, rel=(q * spacing) ** 2)


def test_a_preconditioners_cost_is_of_the_next_fast_length() -> None:
    counter = Counter()
    SpectralPreconditioner((11, 7), 0.5, 3.0, counter)(np.ones((11, 7)))
    assert counter.point_logs == pytest.approx(96 * np.log2(96), rel=1e-14)  # 12 and 8
