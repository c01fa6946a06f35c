"""What no point of the data says, and what lies beyond the domain: shares of error bars by closed forms."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

import refimpl as rf
from refimpl.driver.reference import solve_reference
from refimpl.grid import Array, Grid, Mask
from refimpl.model.problem import Terms
from refimpl.scene.discretise import discretise
from refimpl.solution.domain_error import data_error, finest_by_data, unseen_parts
from refimpl.surfaces import Surface
from tests import plate

LENGTHS = (4e-3, 2e-3)


@dataclass(frozen=True)
class Wave(Surface):
    """A cosine along an axis (0 or 1): lengths in m; with a pitch it stands for a measured map."""

    amplitude: float
    wavelength: float
    axis: int = 0
    data: float | None = None
    kind: ClassVar[str] = "wave"

    def heights_on(self, grid: Grid, offset: tuple[float, float]) -> Array:
        along = ((grid.x + offset[0])[:, None], (grid.y + offset[1])[None, :])[self.axis]
        return np.broadcast_to(self.amplitude * np.cos(2 * np.pi * along / self.wavelength), grid.shape)

    def pitch(self, lengths: tuple[float, float]) -> float | None:
        return self.data


def waves(upper: Surface, lower: Surface, *, periodic: bool = True) -> rf.Scene:
    return rf.Scene(
        upper=rf.Body(rf.Material(30e9, 0.3), upper),
        lower=rf.Body(rf.Material(2e9, 0.2), lower),
        friction=rf.Friction(tau=3e5, beta=0.15),
        load=7.0,
        size=LENGTHS,
        periodic=periodic,
    )


MEASURED = Wave(3e-6, wavelength=4e-3, data=0.25e-3)  # 16 points a wave


def test_roughness_by_formula_beside_the_data_makes_them_matter_less() -> None:
    """At d = 2 p, in (a / d)^2: 2 sin^2(22.5) = 0.29289 of the data on the grid, 8 sin^2(11.25) = 0.30448 at
    the pitch; beside it 2 (b / a)^2 sin^2(45) = 0.25 of a wave across, b = a / 2: 1 - sqrt(0.54289 / 0.55448)
    = 0.01051 is missed. Cubics through every second point have (9 cos 22.5 - cos 67.5) / 8 = 0.99153 of the
    wave: (1 - 0.99153)^2 / (4 sin^2 11.25) = 4.7e-4 of 0.30448 may lie between, once and a half.
    """
    across = Wave(1.5e-6, wavelength=2e-3, axis=1)
    scene = waves(across, MEASURED)
    assert data_error(scene, Grid((8, 4), LENGTHS, True)) == pytest.approx(0.01070, abs=6e-6)


@pytest.mark.parametrize(
    "lower", [rf.Sphere(0.2), Wave(3e-6, wavelength=1e-3), Wave(0.0, wavelength=4e-3, data=0.25e-3)]
)
def test_formulas_and_a_level_map_leave_nothing_open(lower: Surface) -> None:
    assert data_error(waves(rf.Flat(), lower), Grid((8, 4), LENGTHS, True)) == 0


def test_a_balls_slope_is_no_roughness_beside_the_data() -> None:
    """The share is the map's alone, although the ball's rms gradient is twice the map's."""
    assert data_error(waves(rf.Sphere(0.2), MEASURED), Grid((8, 4), LENGTHS, True)) == pytest.approx(
        0.01957, abs=6e-6
    )


GRID = Grid((8, 4), LENGTHS, False)
SHORT = Wave(3e-6, wavelength=1.6e-3, data=0.5e-3)


@pytest.fixture(params=[None, 4e-6], ids=["load", "approach"])
def approach(request: pytest.FixtureRequest) -> float | None:
    found: float | None = request.param
    return found


def test_shares_of_every_number(approach: float | None) -> None:
    """Areas and the approach move as the data leave open, the maximum pressure twice as much, and of friction
    the part that is tau A: F = tau A + beta N without slopes. Q is zero, what is prescribed has no part.
    """
    scene = waves(rf.Flat(), SHORT, periodic=False)
    problem = discretise(scene, GRID, Terms(oblique=False), approach=approach)
    state = solve_reference(problem)
    share, found = data_error(scene, GRID), unseen_parts(problem, state, scene)
    assert 0.1 < share < 1
    sheared = 3e5 * state.contact_area
    expected = {
        "friction_coefficient": share * sheared / state.forces.normal,
        "contact_area": share * state.contact_area,
        "max_pressure": 2 * share * state.pressure.max(),
        "friction_force": share * sheared,
        "approach": share * state.approach,
    }
    if approach is None:
        assert found.pop("normal_force", None) is None
    else:
        del expected["approach"]
    assert {name: parts["data"] for name, parts in found.items()} == pytest.approx(expected, rel=1e-12)
    assert {parts["border"] for parts in found.values()} == {0.0}


def ball(approach: float, elements: tuple[int, int]) -> tuple[Mask, dict[str, dict[str, float]], float]:
    """Contact of a ball on the domain's middle, the parts of its bars, and its contact area (m^2)."""
    scene = rf.Scene(
        upper=rf.Body(rf.Material(30e9, 0.3), rf.Sphere(0.05)),
        lower=rf.Body(rf.Material(2e9, 0.2), rf.Flat()),
        friction=rf.Friction(tau=3e5, beta=0.15),
        load=7.0,
        size=LENGTHS,
    )
    problem = discretise(scene, Grid(elements, LENGTHS, False), Terms(oblique=False), approach=approach)
    state = solve_reference(problem)
    return state.contact, unseen_parts(problem, state, scene), state.contact_area


def test_a_contact_that_goes_on_by_half_of_itself_has_no_bar() -> None:
    """8 of 24 widths of elements round the domain: 8 / 24 of 8 mm^2 beyond the 4 mm^2 found."""
    contact, parts, _ = ball(23e-6, (8, 4))
    assert (int(contact.sum()), int(contact[1:-1, 1:-1].sum())) == (16, 8)
    assert parts["contact_area"]["border"] == math.inf


def test_a_contact_within_the_domain_has_no_part() -> None:
    contact, parts, _ = ball(4e-6, (16, 8))
    assert contact.any()
    assert parts == {}


def test_the_closest_points_of_both_bodies_limit_the_grid_along_the_longer_side() -> None:
    """Points 10 um apart below, 25 um above, on 300 x 100 um: four elements in 10 um are 120 in 300."""
    few, many, ball = np.zeros((12, 4)), np.zeros((30, 10)), rf.Sphere(0.1)
    rough = rf.GaussianRoughness(1e-7, 1e-4, seed=2)
    soft = rf.Material(2e9, 0.4)
    for lower, upper, most in ((many, few, 120.0), (few, ball, 48.0), (rough, ball, math.inf)):
        bodies = rf.Body(soft, upper), rf.Body(soft, lower)
        scene = rf.Scene(*bodies, friction=rf.Friction(), load=1.0, size=(300e-6, 100e-6))
        assert finest_by_data(scene) == most


def test_the_part_covers_maps_of_a_known_surface_and_tells_band_limited_ones() -> None:
    """Self-affine to the pitch the data leave an error of mu, of waves above eight points a tenth of that."""
    shares, errors = {}, {}
    for points in (1, 8):
        plate_ = plate.worn(seed=5, short_cut=points * plate.PITCH)
        array = plate.sampled(plate_, plate.CLEAN, (96, 96))
        known, mapped = (
            rf.solve(plate.scene(surface, 0.5, (96, 96)), 288) for surface in (plate_, rf.ArraySurface(array))
        )
        mu = known.friction_coefficient_corrected
        errors[points] = abs(mapped.friction_coefficient_corrected - mu) / mu
        parts = mapped.uncertainty["friction_coefficient_corrected"]
        shares[points] = parts["data"] / mu
        assert abs(mapped.friction_coefficient_corrected - mu) < sum(parts.values())
    assert errors[1] < shares[1] < 20 * errors[1]
    assert shares[8] < shares[1] / 10
