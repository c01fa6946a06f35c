"""The shipped table of coefficient errors against its closed first-order part and its symmetries."""

from __future__ import annotations

import json
import math
from dataclasses import FrozenInstanceError
from importlib import resources

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
SOFT, STIFF = rf.Material(E=1e9, nu=0.1), rf.Material(E=1e15, nu=0.1)
TABLE = json.loads(resources.files("refimpl").joinpath("data", "coefficient_error.json").read_text("utf-8"))
STEEPEST = math.radians(TABLE["slope_deg"][-1])
VALLEY, LONGEST = len(TABLE["position"]) - 1, len(TABLE["wavelength"]) - 1
Node = tuple[int, int, int]  # numbers of a slope, a wavelength and a position of the table


def flat_neighbour(nu: float) -> float:
    """u(2a) - u(0) of a strip on a flat half-plane, by adding 20000 line loads (p a / E)."""
    source = (np.arange(20000) + 0.5) / 10000 - 1
    log = np.log(np.abs(2 - source)) - np.log(np.abs(source))
    return float(2 * (1 - nu**2) / math.pi * log.mean() * 2)


def tabulated(node: Node, nu: float) -> np.ndarray:
    """Rough minus flat at x = -2 and 2 by the file's ``formula``; beyond the valley by its ``symmetry``."""
    slope, wave, place = node
    if place > VALLEY:
        return tabulated((slope, wave, 2 * VALLEY - place), nu)[::-1]
    tangent, wavelength = math.tan(math.radians(TABLE["slope_deg"][slope])), TABLE["wavelength"][wave]

    def s(x: float) -> float:
        turn = 2 * math.pi * (x / wavelength + TABLE["position"][place])
        return -tangent * wavelength / (2 * math.pi) * math.cos(turn)

    found = []
    for x in (-2, 2):
        at = TABLE["offset"].index(x)
        kappa, constant = (TABLE[part][slope][wave][place][at] for part in ("kappa_part", "constant_part"))
        rest = tangent**2 * (1 + nu) * ((3 - 4 * nu) * kappa + constant)
        found.append(rest - (1 + nu) * (1 - 2 * nu) * (s(x / 2) - s(0)))
    return np.array(found)


NODES = [(0, LONGEST, 2), (2, 0, 3), (3, 3, 0), (4, 1, 1), (1, 2, VALLEY)]


@pytest.mark.parametrize("node", NODES)
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45])
def test_tabulated_displacements_are_met(node: Node, nu: float) -> None:
    """At the table's own points, the flat displacement being ``2 (1 - nu^2) / pi * 3 ln 3``."""
    slope, wavelength = math.radians(TABLE["slope_deg"][node[0]]), TABLE["wavelength"][node[1]]
    flat = 2 * (1 - nu**2) / math.pi * math.log(27)

    def found(place: int, upper: rf.Material | None = None) -> float:
        return coefficient_error(
            slope, rf.Material(1e9, nu), upper, wavelength=wavelength, position=place / (2 * VALLEY)
        )

    expected = np.abs(tabulated(node, nu)).max() / flat
    assert found(node[2]) == pytest.approx(expected, rel=1e-12)
    # the upper body, three times as stiff, has its valley over the lower one's crest
    opposite = (node[0], node[1], node[2] + VALLEY)
    both = tabulated(node, nu) + tabulated(opposite, nu) / 3
    expected = np.abs(both).max() / (flat * (1 + 1 / 3))
    assert found(node[2], rf.Material(3e9, nu)) == pytest.approx(expected, rel=1e-12)


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


def test_the_worst_position_is_the_default_and_so_is_the_longest_wave() -> None:
    slope, flat = math.radians(10.0), 2 * 0.91 / math.pi * math.log(27)
    ten = TABLE["slope_deg"].index(10.0)
    worst = max(np.abs(tabulated((ten, LONGEST, place), 0.3)).max() for place in range(VALLEY + 1)) / flat
    assert coefficient_error(slope, STEEL) == pytest.approx(worst, rel=1e-12)
    assert coefficient_error(slope, STEEL, wavelength=1e4) == pytest.approx(
        coefficient_error(slope, STEEL), rel=1e-3
    )
    assert coefficient_error(slope, STEEL, wavelength=256.0) == coefficient_error(slope, STEEL)


def test_a_crest_goes_flat_as_its_wave_grows() -> None:
    """To first order as 1 / wavelength, beyond the table's waves as well; the rest is second order."""
    slope = 1e-3
    near, far = (coefficient_error(slope, STEEL, wavelength=w, position=0.0) for w in (1e3, 1e4))
    assert near == pytest.approx(10 * far, abs=20 * slope**2)
    assert far < 0.2 * near


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45])
def test_gentle_slope_has_the_first_order_error(nu: float) -> None:
    slope = math.radians(0.5)
    expected = (1 + nu) * (1 - 2 * nu) * math.tan(slope) / flat_neighbour(nu)
    found = coefficient_error(slope, rf.Material(E=1e9, nu=nu), position=0.25)
    # the rest is second order: below 3 tan^2 by the table's largest entries
    assert found == pytest.approx(expected, abs=3 * math.tan(slope) ** 2)


def test_identical_bodies_keep_only_the_second_order() -> None:
    one, pair = (coefficient_error(math.radians(5), STEEL, upper) for upper in (None, STEEL))
    assert pair < 0.2 * one
    halved = coefficient_error(math.radians(2.5), STEEL, STEEL)
    assert pair / halved == pytest.approx(4, rel=0.05)


def test_below_the_gentlest_tabulated_slope_the_second_order_is_exact() -> None:
    gentlest = math.tan(math.radians(TABLE["slope_deg"][0]))
    for nu in (0.1, 0.5):  # identical bodies, and one that couples nothing to first order
        body, upper = rf.Material(1e9, nu), rf.Material(1e9, nu) if nu < 0.5 else None
        least, third = (coefficient_error(math.atan(gentlest / n), body, upper) for n in (1, 3))
        assert least / third == pytest.approx(9, rel=1e-12)
    assert coefficient_error(0.0, STEEL) == 0.0


def test_a_rigid_partner_changes_nothing() -> None:
    for slope in np.radians([1.0, 6.5, 20.0]):
        alone = coefficient_error(slope, SOFT)
        assert coefficient_error(slope, SOFT, STIFF) == pytest.approx(alone, rel=1e-5)


def test_steel_on_copper_stays_below_two_percent_where_one_body_does_not() -> None:
    slope = math.radians(6.5)
    assert coefficient_error(slope, COPPER, STEEL) < 0.02 < coefficient_error(slope, COPPER)


def test_mirrored_positions_agree() -> None:
    for position in (0.1, 0.25, 0.4):
        first, second = (
            coefficient_error(0.1, COPPER, STEEL, position=place) for place in (position, 1 - position)
        )
        assert first == pytest.approx(second, rel=1e-12)


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


def test_the_tables_ends_belong_to_it() -> None:
    shortest = coefficient_error(STEEPEST, STEEL, wavelength=8.0, position=0.0)
    assert coefficient_error(STEEPEST, STEEL, wavelength=8.0, position=1.0) == pytest.approx(shortest)
    assert shortest > 0


def test_a_solution_quotes_its_slopes() -> None:
    solution = rf.solve(rf.read_scene("table1-rough"), grid=64)
    quoted = solution.slope_error
    loaded = solution.contact
    steepest = np.hypot(np.tan(solution.theta_x), np.tan(solution.theta_y))[loaded].max()
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


def test_what_was_quoted_never_changes() -> None:
    with pytest.raises(FrozenInstanceError):
        SlopeError(0.0, 0.0, 0.0, 0.0).at_max = None  # type: ignore[misc]  # the point of the test


def test_beyond_the_table_is_not_available() -> None:
    loaded, none = np.ones((1, 1)), np.zeros((1, 1))
    steep = Slopes(loaded, none)
    assert slope_error(steep, loaded, PAIR).at_max is None
    assert slope_error(steep, none, PAIR) == SlopeError(0.0, 0.0, 0.0, 0.0)
    assert slope_error(Slopes.flat((1, 1)), loaded, PAIR) == SlopeError(0.0, 0.0, 0.0, 0.0)
