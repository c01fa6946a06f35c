"""The libraries of transforms: what each has to find, and that the solvers do not depend on which it is."""

from __future__ import annotations

import numpy as np
import pytest

import refimpl as rf
from refimpl.operators import fft, periodic, preconditioner, symmetric, transforms
from refimpl.operators.transforms import Ducc, Library, SciPy

RANDOM = np.random.default_rng(5)
SHAPES = [(1, 1), (1, 6), (7, 5), (12, 8), (45, 64)]


def ducc() -> Library:
    pytest.importorskip("ducc0", reason="ducc0 is an optional extra")
    return Ducc()


@pytest.fixture(params=[SciPy, ducc])
def library(request: pytest.FixtureRequest) -> Library:
    return request.param()


def by_sums(values: np.ndarray, axis: int) -> np.ndarray:
    """The definition: ``sum_j values_j exp(-2 pi i j k / n)`` along an axis."""
    n = values.shape[axis]
    turns = np.outer(np.arange(n), np.arange(n)) % n / n
    return np.moveaxis(np.tensordot(values, np.exp(-2j * np.pi * turns), axes=(axis, 0)), -1, axis)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("workers", [1, 2])
def test_planes_there_and_back(library: Library, shape: tuple[int, int], workers: int) -> None:
    values = RANDOM.normal(size=shape)
    spectrum = library.plane(values, shape, workers)
    expected = by_sums(by_sums(values, 1), 0)[: shape[0] // 2 + 1]
    np.testing.assert_allclose(spectrum, expected, atol=1e-14 * values.size)
    np.testing.assert_allclose(library.plane_back(spectrum, shape, workers), values, atol=1e-14)


def test_planes_are_padded_with_zeros(library: Library) -> None:
    values, padded = RANDOM.normal(size=(5, 7)), np.zeros((8, 9))
    padded[:5, :7] = values
    found = library.plane(values, (8, 9), 1)
    np.testing.assert_allclose(found, library.plane(padded, (8, 9), 1), atol=1e-13)


@pytest.mark.parametrize("shape", SHAPES)
def test_columns_and_rows_there_and_back(library: Library, shape: tuple[int, int]) -> None:
    """Into the middle of a larger spectrum, whose other columns stay as they are."""
    values, (n, m) = RANDOM.normal(size=shape), shape
    spectrum = np.full((n // 2 + 1, m + 3), 7.0 + 0.0j)
    library.columns(values, spectrum[:, 2 : m + 2], 1)
    assert np.all(spectrum[:, [0, 1, -1]] == 7)
    half = by_sums(values, 0)[: n // 2 + 1]
    np.testing.assert_allclose(spectrum[:, 2:-1], half, atol=1e-13 * n)
    rows = library.rows(spectrum[:, 2:-1].copy(), 1, forward=True)
    np.testing.assert_allclose(rows, by_sums(half, 1), atol=1e-13 * m * n)
    back = library.rows(rows, 1, forward=False)
    np.testing.assert_allclose(back, half, atol=1e-13 * n)
    np.testing.assert_allclose(library.columns_back(back, n, 1), values, atol=1e-13)


@pytest.mark.parametrize("shape", [(2, 2), (2, 5), (6, 4)])
def test_an_even_plane_by_its_quarter(library: Library, shape: tuple[int, int]) -> None:
    quarter = RANDOM.normal(size=shape)
    i, j = (np.abs(np.r_[0:n, 2 - n : 0]) for n in shape)
    whole = by_sums(by_sums(quarter[np.ix_(i, j)], 1), 0)
    assert np.abs(whole.imag).max() < 1e-13
    found = library.even_plane(quarter, 1)
    np.testing.assert_allclose(found, whole.real[: shape[0], : shape[1]], atol=1e-13)


@pytest.mark.parametrize("shape", [(2, 2), (2, 5), (3, 2), (6, 4)])
def test_an_odd_plane_by_its_quarter(library: Library, shape: tuple[int, int]) -> None:
    """Whatever the quarter holds at 0 and opposite; it stays as it was."""
    quarter = RANDOM.normal(size=shape)
    kept, inside = quarter.copy(), quarter.copy()
    inside[[0, -1]] = 0
    i, j = (np.r_[0:n, 2 - n : 0] for n in shape)
    whole = by_sums(by_sums(np.sign(i)[:, None] * inside[np.ix_(np.abs(i), np.abs(j))], 1), 0)
    assert np.abs(whole.real).max() < 1e-13
    found = library.odd_plane(quarter, 1)
    np.testing.assert_allclose(found, -whole.imag[: shape[0], : shape[1]], atol=1e-13)
    assert np.array_equal(quarter, kept)


@pytest.mark.parametrize("across", [False, True])
def test_kernels_by_their_quarters(across: bool) -> None:
    """Spread over circles of 10 and 6, the sum of two parts: odd along x, and along y."""
    along_x, along_y = RANDOM.normal(size=(2, 6, 4))
    along_x[[0, -1]] = 0
    along_y[:, [0, -1]] = 0
    i, j = np.r_[0:6, -4:0], np.r_[0:4, -2:0]
    place = np.ix_(np.abs(i), np.abs(j))
    parts = np.sign(i)[:, None] * along_x[place], np.sign(j) * along_y[place]
    whole = sum(parts) if across else parts[0]
    found = symmetric.odd_hat(along_x, along_y if across else None, 1)
    np.testing.assert_allclose(found, by_sums(by_sums(whole, 1), 0)[:6], atol=1e-13)
    even = symmetric.even_hat(along_x.copy(), 1)
    np.testing.assert_allclose(even, by_sums(by_sums(along_x[place], 1), 0)[:6], atol=1e-13)


@pytest.mark.parametrize("name", ["table1-rough", "rough-planes"])
def test_solutions_are_the_same_by_either(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """To rounding: measured 1e-14 of the largest pressure."""
    found = []
    for library in (SciPy(), ducc()):
        for module in (transforms, fft, symmetric, periodic, preconditioner):
            monkeypatch.setattr(module, "fourier", library)
        found.append(rf.solve(rf.read_scene(name), 48, tolerance=1e-10))
    one, other = found
    assert one.converged
    assert other.converged
    assert np.array_equal(one.contact, other.contact)
    np.testing.assert_allclose(one.pressure, other.pressure, rtol=0, atol=1e-12 * one.max_pressure)


def test_without_ducc0_it_is_scipys(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(name: str) -> None:
        raise ImportError(name)

    assert isinstance(transforms.best_installed(), SciPy | Ducc)
    monkeypatch.setattr(transforms, "import_module", missing)
    assert isinstance(transforms.best_installed(), SciPy)
