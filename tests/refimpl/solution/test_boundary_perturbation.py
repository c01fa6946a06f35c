"""First-order recession of undeformed surfaces: closed forms, symmetry, and the warnings that rest on it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Grid
from refimpl.half_space.boundary_perturbation import Contact, gap_changes
from refimpl.half_space.model_form import steepness
from refimpl.model.materials import Material, Pair
from refimpl.model.slopes import Slopes
from refimpl.sensitivities.half_space import half_space_error

NU, E = 0.2, 3e9
WAVE = Grid((64, 4), (1.0, 4 / 64), periodic=True)
RIGID = Material(math.inf, 0.3)


def contact(grid: Grid, height: Array, pressure: Array, traction: Array | None = None) -> Contact:
    """An elastic lower body under a rigid flat; the common surface flat, its displacement that of the gap."""
    zero = grid.zeros
    return Contact(
        grid=grid,
        pair=Pair(Material(E, NU), RIGID),
        heights=(height, zero),
        displacements=(height.copy(), zero),
        pressure=pressure,
        traction=zero if traction is None else traction,
        slopes=Slopes.flat(grid.shape),
        direction=0.0,
    )


def test_a_wave_pressed_flat_recedes_as_bettis_theorem_wants() -> None:
    # full contact of a cos(kx) under p0 + p1 cos(kx), H flat: material points see C (<eta f> + eta <f>).
    # At the places of the deformed surface div(f u_s) adds, with u_s = -(C p1 / k) sin(kx) and
    # f u_s = -(C / k)(p0 p1 sin + p1^2 / 2 sin 2kx): the half-plane moves by 2 (1 - nu^2) / (E k)
    # times -C (p0 p1 cos kx + p1^2 / 2 cos 2kx), the second wave having twice the wavenumber.
    a, p0, p1, k = 1e-3, 5e6, 2e6, 2 * math.pi
    cos, twice = np.cos(k * WAVE.x), np.cos(2 * k * WAVE.x)
    height, pressure = (np.repeat(z[:, None], 4, axis=1) for z in (a * cos, p0 + p1 * cos))
    lower, upper = gap_changes(contact(WAVE, height, pressure))
    C = (1 + NU) * (1 - 2 * NU) / E
    half_plane = 2 * (1 - NU**2) / (E * k)
    expected = C * (a * p1 / 2 + a * cos * p0) - half_plane * C * (p0 * p1 * cos + p1**2 / 2 * twice)
    assert lower == pytest.approx(np.repeat(expected[:, None], 4, axis=1), rel=1e-12)
    assert not upper.any()


def wave_scene(slope_deg: float, M: int = 96) -> rf.Scene:
    amplitude = math.tan(math.radians(slope_deg)) / (2 * math.pi)
    wave = amplitude * np.cos(2 * math.pi * ((np.arange(M) + 0.5) / M - 0.5))
    height = np.repeat(wave[:, None], 4, axis=1)
    return rf.Scene(
        upper=rf.Body(rf.Material(math.inf, 0.3), np.zeros_like(height)),
        lower=rf.Body(rf.Material(1e9, 0.0), height),
        friction=rf.Friction(),
        load=0.3 * math.pi * 1e9 * amplitude * 4 / M,
        size=(1.0, 4 / M),
        periodic=True,
    )


@pytest.mark.parametrize(("slope_deg", "approach", "normal"), [(6.5, 0.037, 0.067), (15.0, 0.0847, 0.142)])
def test_a_wave_under_a_rigid_plane_states_what_finite_elements_found(
    slope_deg: float, approach: float, normal: float
) -> None:
    # finite elements (case model-form/half-space-wave): the approach by 3.7 and 8.5 % larger, N by 6.7 and
    # 14.2 % smaller; on a crest pressed flat no slope in contact tells of it
    scene = wave_scene(slope_deg)
    solution = rf.solve(scene, grid=(96, 4))
    found = half_space_error(scene, solution)
    first = solution.approach + solution.details.problem.datum
    stated = found.stated("approach") / first, found.stated("normal_force") / scene.load
    assert approach <= stated[0] <= 1.5 * approach
    assert normal <= stated[1] <= 1.5 * normal
    assert normal <= solution.details.model_form.normal_force <= 2 * normal
    (warning,) = [w for w in solution.warnings if w.limit == "half-space"]
    error = solution.details.model_form
    assert f"misstates N at a given approach by up to {warning.number:.1%}" in warning
    assert f"the approach under a load by {error.approach:.1%}" in warning
    # by a quarter of tan^2 of the wave's steepest slope more
    further = 0.25 * math.tan(math.radians(slope_deg)) ** 2
    assert warning.number - solution.details.model_form.normal_force == pytest.approx(further, rel=0.01)
    assert (solution.details.slope_error.at_rms or 0.0) < 0.01


def test_a_gentle_wave_warns_of_nothing() -> None:
    solution = rf.solve(wave_scene(1.5), grid=(96, 4))
    assert not [w for w in solution.warnings if w.limit == "half-space"]
    assert 0 < solution.details.model_form.normal_force < 0.025


@pytest.mark.parametrize("facets_solved", [False, True])
def test_a_quarter_turn_of_everything_turns_the_recession(facets_solved: bool) -> None:
    """Sliding obliquely, with facets: shear along y is as shear along x, a quarter turn on."""
    grid = Grid((16, 16), (1.0, 1.0), periodic=True)
    draw = np.random.default_rng(3)
    height, pressure = 0.02 * draw.normal(size=(16, 16)), 1e6 * draw.uniform(size=(16, 16))

    def at(turns: int, direction: float) -> Array:
        z, f = np.rot90(height, turns), np.rot90(pressure, turns)  # from the first axis towards the second
        posed = contact(grid, z, f, 0.3 * f)
        slopes = Slopes.of_surface(z, grid, direction)
        posed = replace(posed, slopes=slopes, direction=direction, facets_solved=facets_solved)
        return gap_changes(posed)[0]

    once = at(0, 0.4)
    assert at(1, 0.4 + math.pi / 2) == pytest.approx(np.rot90(once), rel=1e-9, abs=1e-12 * abs(once).max())


SHARP = rf.Body(rf.Material(E=210e9, nu=0.3), rf.Sphere(4e-3))


def warned(rms: float) -> tuple[rf.Solution, list[float]]:
    """A ball on a rough soft body, and the numbers of its half-space warnings."""
    rough = rf.GaussianRoughness(rms=rms, correlation_length=40e-6, seed=3)
    soft = rf.Body(rf.Material(E=3e9, nu=0.1), rough)
    scene = rf.Scene(SHARP, soft, friction=rf.Friction(tau=1e6, beta=0.1), load=0.3, side=1e-3)
    solution = rf.solve(scene, 160)
    found = [text.number for text in solution.warnings if text.limit == "half-space"]
    return solution, [number for number in found if number is not None]


def test_steep_surfaces_are_warned_of_with_the_number_of_the_whole_grid() -> None:
    solution, (number,) = warned(8e-6)
    details = solution.details
    whole = details.model_form.normal_force + 0.25 * steepness(details.problem, solution.contact)
    assert number > 0.05
    assert number == pytest.approx(whole, rel=0.05)


def test_gentle_surfaces_are_not() -> None:
    assert warned(0.2e-6)[1] == []
