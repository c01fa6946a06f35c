"""The libraries of transforms against their definition, and the threads that transforms get."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

import refimpl as rf
from refimpl.operators import fft, periodic, preconditioner, threads, transforms
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


@pytest.mark.parametrize("name", ["table1-rough", "rough-planes"])
def test_solutions_are_the_same_by_either(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """To rounding: measured 1e-14 of the largest pressure."""
    found = []
    for library in (SciPy(), ducc()):
        for module in (transforms, fft, periodic, preconditioner):
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


def test_threads_are_the_cores_of_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    monkeypatch.setattr(os, "cpu_count", lambda: 7)
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0, 2, 5}, raising=False)
    assert threads.allowed_threads() == 3
    monkeypatch.delattr(os, "sched_getaffinity")
    assert threads.allowed_threads() == 7


@pytest.mark.parametrize("said", ["0", "-2", "", "\u00b2", "9" * 20, "1" * 5000, "2.0"])
def test_of_numbers_of_threads_the_first_counts_and_one_that_is_none_for_nothing(
    monkeypatch: pytest.MonkeyPatch, said: str
) -> None:
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    by_itself = threads.allowed_threads()
    monkeypatch.setenv("OMP_NUM_THREADS", said)
    assert threads.allowed_threads() == by_itself
    monkeypatch.setenv("OMP_NUM_THREADS", " 3,1")
    assert threads.allowed_threads() == 3


def test_no_number_of_threads_ends_in_an_assertion_of_a_library() -> None:
    said = {"OMP_NUM_THREADS": "2,1", "DUCC0_NUM_THREADS": "-1"}
    code = "from refimpl.operators.transforms import fourier; import numpy, os; "
    code += (
        f"assert {said}.items() <= os.environ.items(); fourier.plane(numpy.ones((200, 200)), (200, 200), 2)"
    )
    done = subprocess.run([sys.executable, "-c", code], env=os.environ | said, capture_output=True)
    assert done.returncode == 0, done.stderr.decode()


def test_small_transforms_have_one_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", "3")
    assert transforms.threads(256 * 256) == 1
    assert transforms.threads(1024 * 1024) == 3


_INNER = """
import numpy as np
from refimpl.grid import inner
random = np.random.default_rng(1)
for n in (9_999, 10_000, 10_001, 200_000):
    print(inner(*random.standard_normal((2, 1, n))).hex())
"""


def test_inner_products_are_the_same_on_any_number_of_threads() -> None:
    """On either side of the length from which OpenBLAS takes more of them, where BLAS's own differ."""
    said = [
        subprocess.run(
            [sys.executable, "-c", _INNER],
            env=os.environ | {"OMP_NUM_THREADS": threads, "OPENBLAS_NUM_THREADS": threads},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for threads in ("1", "2")
    ]
    assert said[0] == said[1]
    assert len(said[0].splitlines()) == 4
