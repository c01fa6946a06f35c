"""Scenes that people bring, where bars once failed in silence: grooves, lay, maps, full windows, units."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from verification.coverage.drawing import Wave
from verification.exact.westergaard import Wave as Exact

SIDE = 1e-3
COPPER, STEEL = rf.Material(E=118e9, nu=0.3), rf.Material(E=200e9, nu=0.3)
MODULUS = 1 / ((1 - 0.3**2) * (1 / 118e9 + 1 / 200e9))  # Pa, E*
AMPLITUDE = 0.2e-6


def bar(s: rf.Solution, name: str) -> float:
    """Sum of a number's parts."""
    return math.fsum(s.uncertainty[name].values())


@pytest.mark.parametrize("share", [0.2, 0.5])
@pytest.mark.parametrize("axis", [0, 1])
def test_bars_of_grooves_hold_the_exact_numbers(axis: int, share: float) -> None:
    """Westergaard's strips at eight places within an element: A, corrected A, mu and the approach."""
    flattening = math.pi * MODULUS * AMPLITUDE / SIDE
    mean = flattening * math.sin(math.pi * share / 2) ** 2
    exact = Exact(mean_pressure=mean, amplitude=AMPLITUDE, wavelength=SIDE, modulus=MODULUS)
    tau, area = 0.1 * mean / share, exact.contact_fraction * SIDE**2
    for place in range(8):
        wave = Wave(AMPLITUDE, 1, 2 * math.pi * (0.13 + place / 8 / 64), axis)
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


@pytest.mark.parametrize("grid", [64, 128])
def test_bars_hold_where_a_lay_is_along_the_grid(grid: int) -> None:
    """Under a ball, against four times the elements: in five of six surfaces at least."""
    held = 0
    for seed in range(6):
        lay = rf.GaussianRoughness(0.5e-6, (500e-6, 60e-6), seed=seed, lay=math.pi / 2)
        ball, friction = rf.Body(STEEL, rf.Sphere(0.14)), rf.Friction(tau=15e6, beta=0.08)
        scene = rf.Scene(ball, rf.Body(COPPER, lay), friction, 70.0, 1.6e-3)
        coarse, fine = rf.solve(scene, grid), rf.solve(scene, 4 * grid)
        names = ("contact_area", "friction_coefficient")
        held += all(abs(getattr(coarse, n) - getattr(fine, n)) <= bar(coarse, n) for n in names)
    assert held >= 5


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


def test_limits_of_a_refinement_end_it_with_the_best_grid_within_them() -> None:
    s = rf.solve(MAP, accuracy=1e-4, max_grid=96)
    assert s.status is rf.Status.ACCURACY_NOT_REACHED
    assert s.certified
    assert max(s.grid.shape) <= 96
    for limit in ({"max_grid": 0}, {"max_seconds": -1.0}, {"max_memory": 0.0}):
        with pytest.raises(rf.InputError):
            rf.solve(MAP, accuracy=0.1, **limit)
    with pytest.raises(rf.InputError, match="accuracy"):
        rf.solve(MAP, 32, max_grid=64)


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


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"lower": rf.Body(rf.Material(E=200.0, nu=0.3), rf.Flat()), "load": 1e-3}, "did you mean GPa"),
        ({"friction": rf.Friction(tau=15e9, beta=0.08)}, "did you mean MPa"),
        ({"lower": rf.Body(rf.Material(E=118e9, nu=0.3, hardness=50e9), rf.Flat())}, "above a tenth of E"),
        ({"lower": rf.Body(rf.Material(E=118e9, nu=0.3, hardness=1e9), rf.Flat()),
          "friction": rf.Friction(tau=2e9)}, "below tau"),
        ({"upper": rf.Body(STEEL, rf.Sphere(0.5e-3))}, "is below the domain's"),
        ({"lower": rf.Body(COPPER, rf.GaussianRoughness(1e-7, 104.0, seed=1))}, "beyond the domain's"),
    ],
)  # fmt: skip
def test_inputs_that_are_seldom_meant_get_a_note_with_help(change: dict[str, object], said: str) -> None:
    tau, ball = rf.Friction(tau=15e6, beta=0.08), rf.Body(STEEL, rf.Sphere(0.14))
    usual = rf.Scene(ball, rf.Body(COPPER, rf.Flat()), tau, 70.0, 1.6e-3)
    assert not any(said in line for line in rf.solve(usual, 16).warnings)
    assert any(said in line for line in rf.solve(replace(usual, **change), 16, plastic=False).warnings)


def test_the_gap_is_nowhere_negative_beyond_the_penetration() -> None:
    """On slopes the surfaces' own distance is; with a cap the indentation is added."""
    steep = rf.GaussianRoughness(2e-6, 60e-6, seed=3)
    for hardness in (None, 0.8e9):
        body = rf.Body(rf.Material(E=118e9, nu=0.3, hardness=hardness), steep)
        scene = rf.Scene(rf.Body(STEEL, rf.Sphere(0.05)), body, rf.Friction(tau=15e6, beta=0.08), 20.0, 1e-3)
        s = rf.solve(scene, 64)
        allowed = (s.certificate.penetration + 1e-12) * s.approach
        assert s.gap.min() >= -allowed
        assert np.abs(s.gap[s.contact]).max() <= 1e-6 * s.approach
        assert s.separation.min() < -1e-4 * s.approach
