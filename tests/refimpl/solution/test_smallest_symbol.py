"""The least symbol of oblong elements: a bound below every grid's eigenvalues, and the sum that it is."""

from __future__ import annotations

import math

import mpmath as mp
import numpy as np
import pytest

from refimpl.grid import Grid
from refimpl.kernels import normal_table
from refimpl.solution.energy_norm import smallest_symbol
from verification.exact.dense_influence import DenseInfluence

ASPECTS = [0.1, 0.5, 0.99, 1.0, 1.3, 3.0, 10.0]
LIMIT = 8 * float(mp.catalan) / math.pi
"""Of elements without end: ``sum (-1)^m 2 pi/|k| 2/k`` over ``k = (2 m + 1) pi``."""


@pytest.mark.parametrize("aspect", ASPECTS)
def test_no_grid_has_a_smaller_eigenvalue(aspect: float) -> None:
    """They fall towards it as the grid grows: within 3 % on 20 elements an axis, square or not."""
    dx, bound = 1e-3, smallest_symbol(aspect)
    excess = []
    for n, m in ((1, 1), (1, 30), (30, 1), (5, 60), (7, 7), (13, 11), (20, 20)):
        matrix = DenseInfluence(Grid((n, m), (n * dx, m * dx * aspect)), 0.0).normal_matrix
        excess.append(float(np.linalg.eigvalsh(matrix).min()) / (bound * dx) - 1)
    assert min(excess) > 0
    assert excess[-1] < 0.03


@pytest.mark.parametrize(
    ("aspect", "accuracy"), [*((a, 5e-10) for a in ASPECTS), (0.01, 1e-10), (300.0, 1e-4)]
)
def test_it_is_the_alternating_sum_of_the_coefficients(aspect: float, accuracy: float) -> None:
    """Of 1000 offsets an axis, with the mean of the last partial sums: enough as long as these are many
    lengths of an element's longer edge."""
    table = normal_table(1000, 1000, 1.0, aspect)
    weights = np.where(np.arange(1000) % 2, -2.0, 2.0)
    weights[0], weights[-1] = 1.0, 0.5 * weights[-1]
    assert smallest_symbol(aspect) == pytest.approx(float(weights @ table @ weights), rel=accuracy)


@pytest.mark.parametrize(
    ("aspect", "least", "most"), [(1.0, 0.0, 1e-10), (1.7, 0.9e-12, 1.1e-12), (1e3, 0.9e-12, 1.1e-12)]
)
def test_it_is_the_integral_to_many_digits(aspect: float, least: float, most: float) -> None:
    """By other code: Poisson's sum for small t, tanh-sinh quadrature.

    Below the integral by 1e-12 of its value; square elements have a constant of ten digits.
    """

    def alternating(t: mp.mpf) -> mp.mpf:
        if t < 2:
            waves = (
                (-1) ** n / mp.mpf(2 * n + 1) * mp.exp(-(((n + 0.5) * mp.pi / t) ** 2)) for n in range(12)
            )
            return 4 / (mp.sqrt(mp.pi) * t) * mp.fsum(waves)
        tails = ((-1) ** m * mp.erfc((m + mp.mpf(1) / 2) * t) for m in range(12))
        return mp.sqrt(mp.pi) / t * (1 - 2 * mp.fsum(tails))

    with mp.workdps(25):
        a = mp.mpf(aspect)
        total = mp.quad(
            lambda t: alternating(t) * a * alternating(a * t), [0, 0.5, 1, 2, 4, 8, 16, 64, mp.inf]
        )
        exact = 2 / mp.sqrt(mp.pi) * total
        assert least < (exact - mp.mpf(smallest_symbol(aspect))) / exact < most


def test_it_goes_with_lengths_and_axes() -> None:
    """Elements ``1 x a`` are ``a`` times elements ``1/a x 1``."""
    for aspect in (1.2, 7.0, 1e4):
        assert smallest_symbol(1 / aspect) == pytest.approx(smallest_symbol(aspect) / aspect, rel=1e-14)


def test_it_rises_with_the_aspect_to_catalans_constant() -> None:
    values = [smallest_symbol(aspect) for aspect in np.geomspace(0.01, 10, 40)]
    assert np.all(np.diff(values) > 0)
    assert smallest_symbol(1e9) == pytest.approx(LIMIT, rel=2e-12)
