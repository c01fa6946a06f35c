"""The map of coefficient errors: entries, look-up between and beyond them, pairs of bodies."""

from __future__ import annotations

import math

import numpy as np
import pytest

from appendix_a.fem.coefficient_map import CoefficientMap, height_change, interpolation_error
from appendix_a.fem.halfplane import pressed_strip
from appendix_a.leading_order import coupling, first_order
from tests.appendix_a.made_up import invented


def test_lookup_meets_the_nodes_and_mirrors():
    table = invented()
    nu, tangent = 0.3, np.tan(np.radians(10.0))
    node = tangent**2 * (1 + nu) * ((3 - 4 * nu) * table.kappa_part + table.constant_part)[1, 2, 0]
    crest = table.departure(10.0, 32.0, 0.0, nu)
    climb = tangent * 32.0 / (2 * np.pi) * (1 - np.cos(2 * np.pi / 32.0))
    assert crest == pytest.approx(node - coupling(nu) * climb, abs=1e-12)
    downhill, uphill = table.departure(10.0, 32.0, 0.2, nu), table.departure(10.0, 32.0, 0.8, nu)
    assert uphill == pytest.approx(downhill[::-1], abs=1e-12)


def test_the_stated_interpolation_error_is_small_and_grows_with_the_slope() -> None:
    steep, gentle = interpolation_error(25.0), interpolation_error(6.5)
    assert gentle < steep
    assert steep[0] < steep[1] < 0.07


TABLE_OFFSETS = np.array([-3.0, -0.5, 2.0, 4.0])
RNG = np.random.default_rng(7)
TABLE = CoefficientMap(
    slope_deg=(2.0, 5.0, 9.0, 14.0),
    wavelength=(5.0, 10.0, 30.0, 80.0),
    position=(0.0, 0.25, 0.5),
    offset=tuple(TABLE_OFFSETS),
    kappa_part=RNG.normal(size=(4, 4, 3, 4)),
    constant_part=RNG.normal(size=(4, 4, 3, 4)),
    error_percentage_points=RNG.uniform(size=(4, 4, 3)),
)


@pytest.mark.parametrize("wavelength", [80.0001, 1e4])
def test_beyond_the_largest_wavelength_the_rest_is_taken_from_there(wavelength: float) -> None:
    """At nu = 1/2 there is no first order: the same table entry, whatever the wavelength."""
    found, last = (TABLE.departure(7.0, length, 0.25, 0.5) for length in (wavelength, 80.0))
    assert np.array_equal(found, last)
    nearer = TABLE.departure(7.0, 60.0, 0.25, 0.5)
    assert not np.allclose(nearer, last, rtol=1e-3)


def test_the_first_order_is_that_of_the_sinusoid() -> None:
    depth = height_change(5.0, 10.0, 0.1, TABLE_OFFSETS)
    amplitude = math.tan(math.radians(5.0)) * 10 / (2 * math.pi)
    clipped = [-1.0, -0.5, 1.0, 1.0]
    expected = [
        amplitude * (math.cos(0.2 * math.pi) - math.cos(2 * math.pi * (x / 10 + 0.1))) for x in clipped
    ]
    assert depth == pytest.approx(expected)
    assert first_order(lambda x: 0.3 * x, TABLE_OFFSETS, 0.2) == pytest.approx(
        [-1.2 * 0.6 * 0.3 * x for x in clipped]
    )


def test_a_pair_is_the_sum_of_both_bodies_half_a_wave_apart() -> None:
    """E of 2 and 5: displacements over each modulus, and the flat ones with each Poisson ratio."""
    below, above = TABLE.departure(5.0, 12.0, 0.1, 0.2), TABLE.departure(5.0, 12.0, 0.6, 0.4)
    flat = pressed_strip(TABLE_OFFSETS, 0.2) / 2 + pressed_strip(TABLE_OFFSETS, 0.4) / 5
    found = TABLE.pair_percent(5.0, 12.0, 0.1, (2.0, 0.2), (5.0, 0.4))
    assert found == pytest.approx(100 * (below / 2 + above / 5) / flat)
    rigid = TABLE.pair_percent(5.0, 12.0, 0.1, (2.0, 0.2), (1e30, 0.4))
    assert rigid == pytest.approx(TABLE.percent(5.0, 12.0, 0.1, 0.2))
