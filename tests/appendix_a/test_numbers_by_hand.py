"""Tables and errors of Appendix A from a few numbers: pairs, ends of axes, errors of meshes and radii."""

from __future__ import annotations

import math

import numpy as np
import pytest

from appendix_a.contact_fem.bodies import wave_height
from appendix_a.fem.coefficient_map import CoefficientMap, height_change
from appendix_a.fem.departure import Departure
from appendix_a.fem.halfplane import pressed_strip
from appendix_a.fem.result import WavyResult
from appendix_a.fem3d.coefficients import Coefficients3D
from appendix_a.fem3d.study import Point, row
from appendix_a.leading_order import first_order, slope_of_error

OFFSETS = np.array([-3.0, -0.5, 2.0, 4.0])
RNG = np.random.default_rng(7)
TABLE = CoefficientMap(
    slope_deg=(2.0, 5.0, 9.0, 14.0),
    wavelength=(5.0, 10.0, 30.0, 80.0),
    position=(0.0, 0.25, 0.5),
    offset=tuple(OFFSETS),
    kappa_part=RNG.normal(size=(4, 4, 3, 4)),
    constant_part=RNG.normal(size=(4, 4, 3, 4)),
    error_percentage_points=RNG.uniform(size=(4, 4, 3)),
)


@pytest.mark.parametrize("wavelength", [80.0001, 200.0, 1e4])
def test_beyond_the_largest_wavelength_the_rest_is_taken_from_there(wavelength: float) -> None:
    """At nu = 1/2 there is no first order: the same table entry, whatever the wavelength."""
    found, last = (TABLE.departure(7.0, length, 0.25, 0.5) for length in (wavelength, 80.0))
    assert np.array_equal(found, last)
    nearer = TABLE.departure(7.0, 60.0, 0.25, 0.5)
    assert not np.allclose(nearer, last, rtol=1e-3)


def test_entries_of_the_table_are_met_at_its_points() -> None:
    """tan^2 (1 + nu) [(3 - 4 nu) A + B] and the first order, on every axis."""
    for i, slope in enumerate(TABLE.slope_deg):
        for j, wavelength in enumerate(TABLE.wavelength):
            tangent, nu = math.tan(math.radians(slope)), 0.2
            rest = tangent**2 * 1.2 * (2.2 * TABLE.kappa_part[i, j, 0] + TABLE.constant_part[i, j, 0])
            first = -1.2 * 0.6 * height_change(slope, wavelength, 0.0, OFFSETS)
            found = TABLE.departure(slope, wavelength, 0.0, nu) - first
            assert found == pytest.approx(rest, rel=1e-9, abs=1e-12)


def test_the_first_order_is_that_of_the_sinusoid() -> None:
    depth = height_change(5.0, 10.0, 0.1, OFFSETS)
    amplitude = math.tan(math.radians(5.0)) * 10 / (2 * math.pi)
    clipped = [-1.0, -0.5, 1.0, 1.0]
    expected = [
        amplitude * (math.cos(0.2 * math.pi) - math.cos(2 * math.pi * (x / 10 + 0.1))) for x in clipped
    ]
    assert depth == pytest.approx(expected)
    assert first_order(lambda x: 0.3 * x, OFFSETS, 0.2) == pytest.approx(
        [-1.2 * 0.6 * 0.3 * x for x in clipped]
    )


def test_a_pair_is_the_sum_of_both_bodies_half_a_wave_apart() -> None:
    """E of 2 and 5: displacements over each modulus, and the flat ones with each Poisson ratio."""
    below, above = TABLE.departure(5.0, 12.0, 0.1, 0.2), TABLE.departure(5.0, 12.0, 0.6, 0.4)
    flat = pressed_strip(OFFSETS, 0.2) / 2 + pressed_strip(OFFSETS, 0.4) / 5
    found = TABLE.pair_percent(5.0, 12.0, 0.1, (2.0, 0.2), (5.0, 0.4))
    assert found == pytest.approx(100 * (below / 2 + above / 5) / flat)
    rigid = TABLE.pair_percent(5.0, 12.0, 0.1, (2.0, 0.2), (1e30, 0.4))
    assert rigid == pytest.approx(TABLE.percent(5.0, 12.0, 0.1, 0.2))


def test_displacements_for_every_ratio_go_by_kappa() -> None:
    """u / (1 + nu) is linear in nu: 1 at 0, 2.6 / 1.3 = 2 at 0.3, so 1 + 0.5 / 0.3 at 1/2."""
    found = Departure(np.array([1.0]), np.array([2.6]))
    assert found.at(0.0) == pytest.approx([1.0])
    assert found.at(0.3) == pytest.approx([2.6])
    assert found.at(0.5) == pytest.approx([1.5 * (1 + 0.5 / 0.3)])


def test_errors_of_meshes_and_radii() -> None:
    """Changes 4 and 1 (ratio 1/4, index 1.25 / 3) and one offset that the last mesh does not notice."""
    flat = np.array([10.0, 0.0, -20.0])
    meshes = [np.array([5.0, 2.0, 0.0]), np.array([1.0, 2.5, 0.0]), np.array([0.0, 2.5, 0.0])]
    radii = [np.array([0.0, 0.0, 9.0]), np.array([0.5, 0.0, 1.0]), np.array([0.25, 0.125, 1.0])]
    found = WavyResult.of(OFFSETS[:3], flat, meshes, radii)
    factor = 1.25 * 0.25 / 0.75
    assert found.mesh_error == pytest.approx([factor * 2.0, factor * 0.25, 0.0])  # half of the change before
    assert found.truncation_error == pytest.approx([0.25, 0.125, 0.0])
    assert found.discretisation_error == pytest.approx(factor * 2.0 + 0.25)
    assert found.wavy == pytest.approx([10.0, 2.5, -20.0])
    assert found.mesh_values[0] == pytest.approx([15.0, 2.0, -20.0])
    percent = found.percentage_points
    assert percent[0] == pytest.approx(10 * (factor * 2.0 + 0.25))
    assert np.isnan(percent[1])
    assert percent[2] == 0.0


@pytest.mark.parametrize("offset", [0.5, 2.0, 6.0])
def test_the_slope_of_two_per_cent_is_where_the_first_order_is(offset: float) -> None:
    """First order of a facet at that slope over the flat coefficient: 2 %."""
    slope = math.tan(math.radians(slope_of_error(offset, 0.3)))
    change = first_order(lambda x: slope * x, np.array([offset]), 0.3)[0]
    # the flat strip's displacement in closed form
    x = offset
    profile = (x + 1) * math.log(abs(x + 1)) - (x - 1) * math.log(abs(x - 1))
    flat = -2 * (1 - 0.3**2) / math.pi * profile
    assert abs(change / flat) == pytest.approx(0.02, rel=1e-9)


def test_a_harmonic_has_its_share_order_and_phase() -> None:
    """At an eighth of a wave cos 45 deg, and of the second order cos(90 deg + 0.3) = -sin 0.3."""
    found = wave_height(np.array([0.125]), 2.0, ((2, 0.4, 0.3),))
    assert found == pytest.approx(2 * (math.sqrt(0.5) - 0.4 * math.sin(0.3)), rel=1e-14)


def test_a_row_of_the_three_dimensional_study() -> None:
    parts = [np.array([k / 7.0, -0.0]) for k in range(1, 5)]
    made = row(Point(6.5, 20.0, 0.25, 0.3), Coefficients3D(9 * parts[0], *parts, 1.234e-9, 81), 2.345)
    assert [*made.values()][7:] == [
        [0.142857, 0.0], [0.286, 0.0], [0.429, 0.0], [0.571, 0.0], 1.2e-9, 81, 2.3,
    ]  # fmt: skip
    assert list(made)[7:10] == ["error", "discretisation", "truncation"]
    assert math.copysign(1.0, made["error"][1]) == 1.0  # type: ignore[index]
