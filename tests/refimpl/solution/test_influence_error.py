"""The shipped tables of coefficient errors, in plane and in space: closed parts, symmetries, refusals."""

from __future__ import annotations

import json
import math
from dataclasses import astuple
from importlib import resources
from itertools import product

import numpy as np
import pytest

import refimpl as rf
from appendix_a.fem.coefficient_map import CoefficientMap
from refimpl.half_space.influence_error import (
    SlopeError,
    coefficient_error,
    constant_along_an_axis,
    slope_error,
)
from refimpl.half_space.influence_error_3d import element_error
from refimpl.model.materials import Pair
from refimpl.model.slopes import Slopes

STEEL, COPPER = rf.Material(E=200e9, nu=0.3), rf.Material(E=118e9, nu=0.3)
PAIR = Pair(lower=COPPER, upper=STEEL)
TABLE = json.loads(resources.files("refimpl").joinpath("data", "coefficient_error.json").read_text("utf-8"))


def flat_neighbour(nu: float) -> float:
    """u(2a) - u(0) of a strip on a flat half-plane, by adding 20000 line loads (p a / E)."""
    source = (np.arange(20000) + 0.5) / 10000 - 1
    log = np.log(np.abs(2 - source)) - np.log(np.abs(source))
    return float(2 * (1 - nu**2) / math.pi * log.mean() * 2)


def test_between_the_nodes_it_is_the_number_of_the_appendix_map() -> None:
    """Two readers of one file, one with splines and harmonics at both neighbours only."""
    with resources.as_file(resources.files("refimpl") / "data" / "coefficient_error.json") as path:
        table = CoefficientMap.read(path)
    neighbours = [table.offset.index(x) for x in (-2.0, 2.0)]
    rng = np.random.default_rng(3)
    for _ in range(20):
        degrees, wavelength = rng.uniform(0.5, 30), rng.uniform(8, 400)
        position, ratios = rng.uniform(0, 1), rng.uniform(-0.5, 0.499, 2)
        bodies = [rf.Material(E, nu) for E, nu in zip((1e9, 3e9), ratios, strict=True)]
        where = degrees, wavelength, position
        one = np.abs(table.percent(*where, ratios[0])[neighbours]).max() / 100
        pair = [(body.E, body.nu) for body in bodies]
        both = np.abs(table.pair_percent(*where, pair[0], pair[1])[neighbours]).max() / 100
        for expected, upper in ((one, None), (both, bodies[1])):
            found = coefficient_error(
                math.radians(degrees), bodies[0], upper, wavelength=wavelength, position=position
            )
            assert found == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45])
def test_gentle_slope_has_the_first_order_error(nu: float) -> None:
    slope = math.radians(0.5)
    expected = (1 + nu) * (1 - 2 * nu) * math.tan(slope) / flat_neighbour(nu)
    found = coefficient_error(slope, rf.Material(E=1e9, nu=nu), position=0.25)
    # the rest is second order: below 3 tan^2 by the table's largest entries
    assert found == pytest.approx(expected, abs=3 * math.tan(slope) ** 2)


def test_below_the_gentlest_tabulated_slope_the_second_order_is_exact() -> None:
    gentlest = math.tan(math.radians(TABLE["slope_deg"][0]))
    for nu in (0.1, 0.5):  # identical bodies, and one that couples nothing to first order
        body, upper = rf.Material(1e9, nu), rf.Material(1e9, nu) if nu < 0.5 else None
        least, third = (coefficient_error(math.atan(gentlest / n), body, upper) for n in (1, 3))
        assert least / third == pytest.approx(9, rel=1e-12)
    assert coefficient_error(0.0, STEEL) == 0.0


@pytest.mark.parametrize(
    ("name", "value", "allowed"),
    [
        ("slope", 0.6, "an angle of 0 to 0.5236 rad"),
        ("slope", -1e-9, "an angle of 0 to 0.5236 rad"),
        ("slope", math.nan, "an angle of 0 to 0.5236 rad"),
        ("wavelength", 2.0, "at least 8 half-widths"),
        ("wavelength", 7.999, "at least 8 half-widths"),
        ("position", -1e-9, "a share of the wavelength, 0 to 1"),
        ("position", 1.001, "a share of the wavelength, 0 to 1"),
    ],
)
def test_outside_the_table_is_refused(name: str, value: float, allowed: str) -> None:
    arguments = {"slope": 0.1} | {name: value}
    with pytest.raises(rf.InputError) as refusal:
        coefficient_error(lower=STEEL, **arguments)
    assert str(refusal.value) == f"{name} = {value!r}: expected {allowed}"


def test_a_solution_quotes_its_slopes() -> None:
    solution = rf.solve(rf.read_scene("table1-rough"), grid=64)
    quoted = solution.details.slope_error
    loaded = solution.contact
    steepest = np.hypot(np.tan(solution.slopes.theta_x), np.tan(solution.slopes.theta_y))[loaded].max()
    assert quoted.max_slope == pytest.approx(math.atan(steepest), rel=1e-12)
    in_space = element_error(quoted.max_slope, COPPER, STEEL)
    assert quoted.at_max == in_space.in_line > coefficient_error(quoted.max_slope, COPPER, STEEL)
    assert quoted.across_at_max == max(in_space.self_coefficient, in_space.across)
    assert quoted.rms_gradient <= quoted.max_slope


def test_slopes_are_weighted_by_pressure_where_it_is() -> None:
    # squares of the tangents 0.25 and 0.01, weighted 1 : 3, make (0.25 + 0.03) / 4 = 0.07; the rest is free
    tan_x, tan_y = np.array([[0.3, 0.06], [9.0, 0.0]]), np.array([[-0.4, 0.08], [0.0, 9.0]])
    found = slope_error(Slopes(tan_x, tan_y), np.array([[1e6, 3e6], [0.0, -1e6]]), PAIR, plane=True)
    assert found.rms_gradient == pytest.approx(math.atan(math.sqrt(0.07)), rel=1e-15)
    assert found.max_slope == pytest.approx(math.atan(0.5), rel=1e-15)
    assert found.at_rms == coefficient_error(found.rms_gradient, COPPER, STEEL)
    assert found.at_max == coefficient_error(found.max_slope, COPPER, STEEL)


def test_a_surface_constant_along_an_axis_is_plane() -> None:
    ridge = np.repeat(np.array([[0.0], [1.0]]), 3, axis=1)
    assert constant_along_an_axis(ridge, 0 * ridge)
    assert not constant_along_an_axis(ridge, ridge.T[:2].repeat(2, axis=1)[:, :3] + np.eye(2, 3))


def test_beyond_the_table_is_not_available() -> None:
    loaded, none = np.ones((1, 1)), np.zeros((1, 1))
    steep = Slopes(loaded, none)
    assert slope_error(steep, loaded, PAIR).at_max is None
    assert slope_error(steep, none, PAIR) == SlopeError(0.0, 0.0, 0.0, 0.0)
    assert slope_error(Slopes.flat((1, 1)), loaded, PAIR) == SlopeError(0.0, 0.0, 0.0, 0.0)


AUXETIC = rf.Material(E=1e9, nu=-0.1)
TABLE_3D = json.loads(
    resources.files("refimpl").joinpath("data", "coefficient_error_3d.json").read_text("utf-8")
)
STANDARD = {"wavelength": 20.0, "kind": "ridge", "width": "projected"}
ROWS = {
    (p["slope_deg"], p["nu"], p["position"]): p["error"]
    for p in TABLE_3D["points"]
    if all(p[k] == v for k, v in STANDARD.items())
}


def row(degrees: float, nu: float, position: float) -> np.ndarray:
    """The table's ten errors of a ridge of the standard length."""
    return np.array(ROWS[degrees, nu, position])


@pytest.mark.parametrize("degrees", [2.5, 6.5, 10.0, 15.0, 30.0])
@pytest.mark.parametrize("shares", [(1, 0), (1, 1), (3, 1), (1, 2)])
def test_tabulated_errors_of_two_bodies_add_by_their_compliance(
    degrees: float, shares: tuple[int, int]
) -> None:
    # the upper body's valley is over a crest, and where the lower one climbs along +x the upper one falls:
    # its +x is the other's -x
    turned = [0, 4, 5, 6, 1, 2, 3, 7, 8, 9]
    for ratios in product((0.0, 0.3, 0.45), repeat=2):
        lower, upper = (
            rf.Material(E=(1 - nu**2) / share, nu=nu) if share else None
            for nu, share in zip(ratios, shares, strict=True)
        )
        assert lower is not None
        worst = np.zeros(10)
        for below, above in ((0.0, 0.5), (0.25, 0.25), (0.5, 0.0)):
            other = row(degrees, ratios[1], above)
            other = other[turned] if above == 0.25 else other
            both = shares[0] * row(degrees, ratios[0], below) + shares[1] * other
            worst = np.maximum(worst, np.abs(both) / sum(shares))
        expected = worst[0], worst[1:7].max(), worst[7:].max()
        found = element_error(math.radians(degrees), lower, upper)
        assert astuple(found) == pytest.approx(expected, rel=1e-9, abs=1e-15)


def test_between_tabulated_slopes_the_error_over_the_tangent_is_linear() -> None:
    tangents = [math.tan(math.radians(degrees)) for degrees in (10.0, 15.0)]
    middle = sum(tangents) / 2
    worst = np.zeros(10)
    for position in (0.0, 0.25, 0.5):
        quotients = [row(d, 0.3, position) / t for d, t in zip((10.0, 15.0), tangents, strict=True)]
        worst = np.maximum(worst, np.abs(np.mean(quotients, axis=0)) * middle)
    expected = worst[0], worst[1:7].max(), worst[7:].max()
    assert astuple(element_error(math.atan(middle), STEEL)) == pytest.approx(expected, rel=1e-9)


def test_below_the_table_errors_are_proportional_to_the_tangent() -> None:
    gentlest = math.tan(math.radians(2.5))
    least, third = (element_error(math.atan(gentlest / n), COPPER, STEEL) for n in (1, 3))
    assert np.array(astuple(least)) / astuple(third) == pytest.approx(3.0, rel=1e-12)


@pytest.mark.parametrize(
    ("slope", "pair", "refusal"),
    [
        (-1e-9, (STEEL,), r"slope = .*: expected an angle of 0 to 0\.5236 rad"),
        (0.5237, (STEEL,), r"slope = .*: expected an angle of 0 to 0\.5236 rad"),
        (math.nan, (STEEL,), r"slope = .*: expected an angle of 0 to 0\.5236 rad"),
        (0.1, (AUXETIC,), r"nu = -0\.1: expected a Poisson's ratio of 0 to 0\.5"),
        (0.1, (STEEL, AUXETIC), r"nu = -0\.1: expected a Poisson's ratio of 0 to 0\.5"),
    ],
)
def test_beyond_the_table_is_refused(slope: float, pair: tuple[rf.Material, ...], refusal: str) -> None:
    with pytest.raises(rf.InputError, match=refusal):
        element_error(slope, *pair)


def test_the_shipped_tables_have_the_axes_that_interpolation_needs() -> None:
    """Cubics over slope and wavenumber, harmonics from crest to valley, both neighbours; quadratic in nu."""
    axes = {name: np.array(TABLE[name]) for name in ("slope_deg", "wavelength", "position", "offset")}
    assert TABLE["version"] == TABLE_3D["version"] == 1
    assert all((np.diff(values) > 0).all() for values in axes.values())
    assert min(len(axes["slope_deg"]), len(axes["wavelength"])) >= 4
    np.testing.assert_allclose(axes["position"], np.linspace(0, 0.5, len(axes["position"])), atol=1e-12)
    assert {-2.0, 2.0} <= set(axes["offset"])
    shape = tuple(map(len, axes.values()))
    assert np.shape(TABLE["kappa_part"]) == np.shape(TABLE["constant_part"]) == shape
    slopes, ratios, places = ({key[axis] for key in ROWS} for axis in range(3))
    assert len(slopes) >= 2
    assert len(ratios) >= 3
    assert {0.0, 0.25, 0.5} <= places
