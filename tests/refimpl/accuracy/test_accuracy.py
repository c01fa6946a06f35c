"""accuracy= and error bars: the bar is met, holds the error, and its parts are what they say."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.accuracy.iteration_error import CORRECTED, iteration_parts
from refimpl.solution.quantities import REPORTED
from tests.refimpl.states import state_of
from verification.coverage.class_scenes import Wave
from verification.exact.westergaard import Wave as Exact

STEEL, COPPER = rf.Material(E=200e9, nu=0.3), rf.Material(E=118e9, nu=0.3)


def sliding_ball(rms: float, seed: int, load: float = 70.0) -> rf.Scene:
    rough = rf.GaussianRoughness(rms=rms, correlation_length=200e-6, seed=seed)
    return replace(rf.read_scene("table1-smooth"), lower=rf.Body(COPPER, rough), load=load)


def bar(s: rf.Solution, name: str) -> float:
    return math.fsum(s.uncertainty[name].values())


def test_the_bar_is_met_and_holds_the_error() -> None:
    scene = sliding_ball(0.3e-6, 1)
    found = rf.solve(scene, accuracy=0.05)
    assert found.status in (rf.Status.CONVERGED, rf.Status.CYCLED)
    assert bar(found, "friction_coefficient_corrected") <= 0.05 * found.friction_coefficient_corrected
    # the finer grid's own error is part of the check
    finer = rf.solve(scene, grid=2 * found.grid.shape[0], tolerance=1e-6)
    for name in ("friction_coefficient_corrected", "friction_coefficient", "contact_area", "max_pressure"):
        assert abs(getattr(found, name) - getattr(finer, name)) <= bar(found, name), name


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ({"grid": 64, "accuracy": 0.1}, "grid"),
        ({"grid": 32, "max_grid": 64}, "max_grid"),
        ({"accuracy": 0.0}, "accuracy"),
        ({"accuracy": math.nan}, "accuracy"),
        ({"accuracy": 1.0}, "accuracy"),
        ({"accuracy": 0.1, "quantity": "F"}, "quantity"),
        ({"accuracy": 0.1, "max_grid": 0}, "max_grid"),
        ({"accuracy": 0.1, "max_seconds": -1.0}, "max_seconds"),
        ({"accuracy": 0.1, "max_memory": 0.0}, "max_memory"),
    ],
)
def test_bad_accuracies_are_refused(arguments: dict[str, Any], field: str) -> None:
    with pytest.raises(rf.InputError, match=f"^{field} = "):
        rf.solve(sliding_ball(0.3e-6, 1), **arguments)


def test_one_grid_has_bars_of_its_own() -> None:
    scene = sliding_ball(0.3e-6, 1)
    found, finer = rf.solve(scene, grid=64), rf.solve(scene, grid=256)
    for name in ("friction_coefficient", "contact_area", "max_pressure", "approach", "binormal_force"):
        bar = found.uncertainty[name]["discretisation"]
        assert abs(getattr(found, name) - getattr(finer, name)) <= bar, name
        assert finer.uncertainty[name]["discretisation"] < 0.4 * bar  # first order at least
    edge = found.contact_area - found.contact_area_corrected
    assert edge < found.uncertainty["contact_area"]["discretisation"] < 2 * edge
    assert found.uncertainty["approach"]["iteration"] <= 1e-8 * found.approach


def test_a_looser_certificate_has_a_larger_iteration_part() -> None:
    scene = sliding_ball(0.3e-6, 1)
    loose, tight = (rf.solve(scene, grid=64, tolerance=t) for t in (1e-3, 1e-10))
    assert loose.certificate.largest > tight.certificate.largest
    state = state_of(loose)
    parts, tighter = (
        iteration_parts(loose.details.problem, state),
        iteration_parts(tight.details.problem, state_of(tight)),
    )
    assert set(parts) == set(tighter) == set(REPORTED) - set(CORRECTED)
    # steep slopes can make a normal force negative at an approach
    pulled = replace(state, forces=state.forces._replace(normal=-state.forces.normal))
    assert iteration_parts(loose.details.problem, pulled)["binormal_force"] == parts["binormal_force"]
    for name in REPORTED:
        raw = CORRECTED.get(name, name)
        part = parts[raw]["iteration"]
        assert tighter[raw]["iteration"] <= part
        assert loose.uncertainty[name]["iteration"] == loose.uncertainty[raw]["iteration"]
        # the loose state lies within its own bar of the tight one
        missed = abs(getattr(loose, name) - getattr(tight, name))
        assert missed <= part + 1e-8 * abs(getattr(tight, name)), name


def test_against_hertz_errors_of_corrected_friction_are_a_fifth_and_each_within_its_bar() -> None:
    """mu of a flat ball is ``tau pi a^2 / P + beta``; domains of several sizes move its edge."""
    tau, beta, radius, load = 2e8, 0.1, 0.01, 40.0
    modulus = STEEL.E / (2 * (1 - STEEL.nu**2))
    exact = tau * math.pi * (3 * load * radius / (4 * modulus)) ** (2 / 3) / load + beta
    ball, flat, law = rf.Body(STEEL, rf.Sphere(radius)), rf.Body(STEEL, rf.Flat()), rf.Friction(tau, beta)
    sides = (1e-3 * (1 + 0.013 * k) for k in range(12))
    solved = [rf.solve(rf.Scene(ball, flat, law, load, side), 48, oblique=False) for side in sides]
    raw = np.array([s.friction_coefficient - exact for s in solved])
    corrected = np.array([s.friction_coefficient_corrected - exact for s in solved])
    bars = [s.error("friction_coefficient_corrected") for s in solved]
    assert np.sqrt(np.mean(corrected**2)) < np.sqrt(np.mean(raw**2)) / 5
    assert np.all(np.abs(corrected) <= bars)
    assert all(bar < s.error("friction_coefficient") for s, bar in zip(solved, bars, strict=True))


SIDE = 1e-3
MODULUS = 1 / ((1 - 0.3**2) * (1 / 118e9 + 1 / 200e9))  # Pa, E*
AMPLITUDE = 0.2e-6


@pytest.mark.parametrize(("axis", "share"), [(0, 0.2), (1, 0.5)])
def test_bars_of_grooves_hold_the_exact_numbers(axis: int, share: float) -> None:
    """Westergaard's strips at four places within an element: A, corrected A, mu and the approach."""
    flattening = math.pi * MODULUS * AMPLITUDE / SIDE
    mean = flattening * math.sin(math.pi * share / 2) ** 2
    exact = Exact(mean_pressure=mean, amplitude=AMPLITUDE, wavelength=SIDE, modulus=MODULUS)
    tau, area = 0.1 * mean / share, exact.contact_fraction * SIDE**2
    for place in range(0, 8, 2):
        wave = Wave(AMPLITUDE, (1 - axis, axis), 2 * math.pi * (0.13 + place / 8 / 64))
        scene = rf.Scene(
            rf.Body(STEEL, rf.Flat()), rf.Body(COPPER, wave), rf.Friction(tau=tau, beta=0.08),
            mean * SIDE**2, SIDE, periodic=True,
        )  # fmt: skip
        s = rf.solve(scene, 64, oblique=False)
        for name, number in {
            "contact_area": area,
            "contact_area_corrected": area,
            "friction_coefficient": tau * area / scene.load + 0.08,
            "approach": exact.approach - AMPLITUDE,
        }.items():
            assert abs(getattr(s, name) - number) <= bar(s, name), (place, name)


def rough_map(points: int) -> np.ndarray:
    """Heights (m) with waves down to two points."""
    rng = np.random.default_rng(4)
    q = np.hypot(np.fft.fftfreq(points)[:, None], np.fft.rfftfreq(points)[None, :]) * points
    shape = np.maximum(q, 4.0) ** -1.8 * (q > 0)
    z = np.fft.irfft2(np.fft.rfft2(rng.normal(size=(points, points))) * shape, s=(points, points))
    return np.asarray(0.4e-6 * z / z.std())


MAP = rf.Scene(
    rf.Body(STEEL, rf.Sphere(0.02)),
    rf.Body(COPPER, rough_map(96)),
    rf.Friction(tau=50e6, beta=0.05),
    5.0,
    2e-4,
)


@pytest.mark.filterwarnings("ignore::refimpl.surfaces.surface.SurfaceWarning")
def test_an_accuracy_does_not_end_above_the_pitch_of_the_data() -> None:
    """Bars have a part for the data, which no grid shortens: the refinement says so and ends."""
    s = rf.solve(MAP, accuracy=0.003, quantity="contact_area")
    assert s.status is rf.Status.ACCURACY_NOT_REACHED
    assert s.uncertainty["contact_area"]["data"] > 0.003 * s.contact_area
    assert max(s.grid.shape) <= 4 * 96
    assert any("points of the data" in line for line in s.warnings)


def test_contact_that_fills_the_window_has_no_error_bar() -> None:
    """Hertz's radius is 165 um, half of the domain 50 um: both stand in the warning."""
    radius = 165e-6
    load = 4 * MODULUS * radius**3 / (3 * 0.05)
    friction = rf.Friction(tau=1e6, beta=0.08)
    full = rf.Scene(rf.Body(STEEL, rf.Sphere(0.05)), rf.Body(COPPER, rf.Flat()), friction, load, 1e-4)
    s = rf.solve(full, 32)
    for name in ("contact_area", "friction_coefficient", "approach"):
        assert math.isinf(bar(s, name))
    assert any("0.000165 m" in line and "5e-05 m" in line for line in s.warnings)
    refined = rf.solve(full, accuracy=0.01)
    assert refined.status is rf.Status.ACCURACY_NOT_REACHED
    assert max(refined.grid.shape) == 64


def test_a_sum_over_slopes_that_cancels_is_no_better_known_than_its_terms() -> None:
    """Without friction F is slopes alone, a vector's component: there is a direction in which it is zero."""
    scene = replace(sliding_ball(0.3e-6, 1), friction=rf.Friction())
    ahead = rf.solve(scene, grid=64, oblique=True, tolerance=1e-12)
    across = math.atan2(-ahead.friction_force, ahead.binormal_force)
    scene = replace(scene, sliding_direction=across)
    loose, tight = (rf.solve(scene, grid=64, oblique=True, tolerance=t) for t in (1e-3, 1e-12))
    assert abs(tight.friction_force) < 1e-6 * abs(tight.binormal_force)
    for name in ("friction_coefficient", "friction_force"):
        missed = abs(getattr(loose, name) - getattr(tight, name))
        assert 0.01 * abs(getattr(loose, name)) < missed < loose.uncertainty[name]["iteration"]
