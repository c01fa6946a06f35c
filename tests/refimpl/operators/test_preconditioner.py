"""The spectral preconditioner, alone and continued beyond the contact by means of blocks: steps saved."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Grid, Mask, Window
from refimpl.operators.block_means import BlockMeans
from refimpl.operators.fft import Counter, FFTInfluence
from refimpl.operators.influence import WindowInfluence, window_influence
from refimpl.operators.kernel_tables import unit_table
from refimpl.operators.preconditioner import ExtendedPreconditioner, SpectralPreconditioner, extended
from refimpl.solvers.production import nested_solver
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


@pytest.mark.parametrize("size", [1e-200, 1e9])
def test_single_precision_on_large_windows(size: float) -> None:
    """Transforms of n points are wrong by about eps log2(n), in units of any size."""
    operator = on(200, 210)
    residual = size * np.random.default_rng(5).standard_normal((200, 210))
    spectrum = np.fft.rfft2(residual, s=operator.circle[::-1], axes=(1, 0)) / (COMPLIANCE * operator.symbol)
    expected = np.fft.irfft2(spectrum, s=operator.circle[::-1], axes=(1, 0))[:200, :210]
    found = spectral(operator)(residual)
    np.testing.assert_allclose(found, expected, rtol=0, atol=16 * 2.0**-24 * np.abs(expected).max())
    assert not np.allclose(found, expected, rtol=0, atol=1e-12 * np.abs(expected).max())


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


SHAPE = (18, 15)


def patches(shape: tuple[int, int] = SHAPE, share: float = 0.3, seed: int = 4) -> Mask:
    """Contact patches of a few elements, some at the window's border."""
    z = np.random.default_rng(seed).normal(size=shape)
    for axis in (0, 1):
        z = z + np.roll(z, 1, axis) + np.roll(z, -1, axis)
    return z > np.quantile(z, 1 - share)


def on_window(shape: tuple[int, int] = SHAPE) -> SpectralPreconditioner:
    n, m = shape
    operator = window_influence(Grid.square(max(shape) * 1e-4, max(shape)), 0.0, Window(0, n, 0, m))
    return SpectralPreconditioner(operator, COMPLIANCE * operator.symbol)


@pytest.mark.parametrize(
    "later", [patches(), patches() | patches(seed=6), patches() & patches(seed=8), ~patches()]
)
def test_it_is_symmetric_and_positive_on_any_set(later: Mask) -> None:
    precondition = ExtendedPreconditioner(on_window(), patches())
    x, y = later * np.random.default_rng(9).normal(size=(2, *SHAPE))
    assert np.vdot(x, precondition(y)) == pytest.approx(np.vdot(y, precondition(x)), rel=1e-10)
    assert np.vdot(x, precondition(x)) > 0


SCENE = replace(rf.read_scene("table1-rough"), friction=rf.Friction())


def steps(M: int) -> int:
    return rf.solve(SCENE, grid=M, oblique=False).cost.iterations[f"CG at {M} x {M}"]


def test_it_saves_a_fifth_of_the_steps_on_a_rough_surface(monkeypatch: pytest.MonkeyPatch) -> None:
    """Measured: 11 instead of 14 on 128 elements a side."""
    after = steps(128)
    monkeypatch.setattr(nested_solver, "extended", lambda precondition, contact: precondition)
    assert after <= 0.8 * steps(128)


def test_small_windows_do_without() -> None:
    mask = on_window()
    assert extended(mask, patches()) is mask
    assert extended(mask, np.zeros((19, 421), dtype=bool)) is mask  # 7,999 elements
    assert isinstance(extended(mask, np.zeros((80, 100), dtype=bool)), ExtendedPreconditioner)
    assert extended(mask, np.zeros((127, 63), dtype=bool)) is not mask  # 8,001


def test_means_fill_between_scattered_contact_and_keep_the_map_symmetric() -> None:
    contact = np.random.default_rng(4).random((320, 330)) < 0.05
    apply = ExtendedPreconditioner(spectral(on(320, 330)), contact)
    a, b = (contact * field for field in np.random.default_rng(6).standard_normal((2, 320, 330)))
    assert np.vdot(b, apply(a)) == pytest.approx(np.vdot(a, apply(b)), abs=1e-6 * np.vdot(a, apply(a)))


@pytest.mark.parametrize("shape", [(64, 96), (70, 41)])
def test_transposed_is_the_transpose(shape: tuple[int, int]) -> None:
    rng = np.random.default_rng(2)
    means = BlockMeans(rng.random(shape) < 0.1)
    a, b = rng.standard_normal((2, *shape))
    assert np.vdot(b, means.continued(a)) == pytest.approx(np.vdot(a, means.transposed(b)), rel=1e-12)


def test_dense_contact_is_continued_by_its_value_and_a_lone_element_fades() -> None:
    contact = np.zeros((128, 128), dtype=bool)
    contact[::2, ::2] = True
    found = BlockMeans(contact).continued(contact.astype(float))
    assert 0.7 < found[64, 64] < 1
    lone = np.zeros_like(contact)
    lone[64, 64] = True
    along = BlockMeans(lone).continued(lone.astype(float))[64, 65:]
    assert along[0] < 0.1
    assert np.all(np.diff(along[4:]) <= 0)
    assert along[-1] == 0
