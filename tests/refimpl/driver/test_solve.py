"""What `solve` returns: statuses, options, reported numbers, warnings; small cases with known answers."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.solvers.production import constants

STEEL, COPPER = rf.Material(200e9, 0.30), rf.Material(118e9, 0.30)
SMOOTH = rf.read_scene("table1-smooth")
METHODS = pytest.mark.parametrize("method", ["dense", "fft"])


def one_spike(load: float = 0.01) -> rf.Scene:
    """A single element of height 1 um, 5 x 5."""
    z = np.zeros((5, 5))
    z[2, 2] = 1e-6
    return replace(SMOOTH, upper=rf.Body(STEEL, rf.Flat()), lower=rf.Body(COPPER, z), load=load, side=1e-3)


@METHODS
def test_one_element_by_hand(method: str) -> None:
    """Without slopes: f = P / dA, and the approach is 4 asinh(1) h / (pi E*) f for a square of edge h."""
    s = rf.solve(one_spike(), 5, method=method, oblique=False)
    h = 2e-4
    modulus = 1 / ((1 - 0.09) / 200e9 + (1 - 0.09) / 118e9)
    assert s.contact.sum() == 1
    assert s.max_pressure == pytest.approx(0.01 / h**2, rel=1e-14)
    by_hand = s.max_pressure * 4 * math.asinh(1) * h / (math.pi * modulus)
    assert s.approach == pytest.approx(by_hand, rel=1e-13)
    assert s.friction_force == pytest.approx(15e6 * h**2 + 0.08 * 0.01, rel=1e-14)
    assert s.friction_coefficient == pytest.approx(s.friction_force / 0.01, rel=1e-14)
    assert s.normal_force == pytest.approx(0.01, rel=1e-14)
    assert s.contact_area == pytest.approx(h**2, rel=1e-14)


@METHODS
@pytest.mark.parametrize("M", [1, 2, 3])
def test_the_smallest_grids(method: str, M: int) -> None:
    s = rf.solve(SMOOTH, M, method=method)
    assert s.status is rf.Status.CONVERGED
    assert s.pressure.shape == (M, M)
    assert s.normal_force == pytest.approx(70.0, rel=1e-8)


@pytest.mark.parametrize(
    ("method", "approach"), [("dense", 0.0), ("fft", 0.0), ("fft", -1e-6), ("paper", -1e-6)]
)
def test_an_approach_that_leaves_the_surfaces_apart(method: str, approach: float) -> None:
    s = rf.solve(SMOOTH, 8, method=method, approach=approach)
    assert s.status is rf.Status.NO_CONTACT
    assert s.normal_force == s.friction_force == s.contact_area == s.max_pressure == 0
    assert math.isnan(s.friction_coefficient)
    assert s.details.separation.min() == pytest.approx(-approach, abs=1e-18)


@METHODS
def test_periodic_planes_too_far_apart(method: str) -> None:
    z = 1e-7 * np.cos(2 * np.pi * (np.arange(8) + 0.5) / 8)[:, None] * np.ones(8)
    apart = replace(SMOOTH, upper=rf.Body(STEEL, rf.Flat()), lower=rf.Body(COPPER, z), periodic=True)
    assert rf.solve(apart, 8, method=method, approach=-1e-6).status is rf.Status.NO_CONTACT
    assert rf.solve(apart, 8, method=method, approach=-0.5e-7).status is rf.Status.CONVERGED


def test_a_caller_whose_floating_point_errors_raise_gets_the_same_numbers() -> None:
    scene = rf.read_scene("rough-planes")
    with np.errstate(all="raise"):
        found = rf.solve(scene, 12)
    assert found.contact_area == rf.solve(scene, 12).contact_area


def test_a_starved_solver_never_claims_convergence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(constants, "CG_LIMIT", 2)
    scene = rf.read_scene("metal-polymer")
    s = rf.solve(scene, 24)
    assert s.status in (rf.Status.STAGNATED, rf.Status.ITERATION_LIMIT)
    assert not s.certificate.satisfies(s.details.tolerance)


@pytest.mark.parametrize(("tau", "spike"), [(1e7, (0, 1)), (6e7, (0, 0))])
def test_a_contact_that_opens_on_the_way_is_found_again(tau: float, spike: tuple[int, int]) -> None:
    """With tau the one element is pushed off, without it is not: both solvers end in the state without."""
    gap = np.full((2, 2), 0.175)
    gap[spike] = 0.0
    scene = rf.Scene(
        upper=rf.Body(rf.Material(1e9, 0.3), gap),
        lower=rf.Body(rf.Material(1e10, 0.3), rf.Flat()),
        friction=rf.Friction(tau, 0.0),
        load=1.0,
        side=1.0,
    )
    dense, fft = (
        rf.solve(scene, 2, method=m, approach=1.75e-7, slope_correction=True) for m in ("dense", "fft")
    )
    assert fft.status is dense.status
    np.testing.assert_array_equal(fft.traction, dense.traction)
    np.testing.assert_allclose(fft.pressure, dense.pressure, rtol=1e-6)


def nanoscale(unit: float) -> rf.Scene:
    """Roughness of 0.2 nm rms on a square of 1 um, by the unit: coarse means lie above first touch."""
    rough = rf.GaussianRoughness(0.2e-9 * unit, 50e-9 * unit, seed=1)
    return replace(
        SMOOTH, upper=rf.Body(STEEL, rough), lower=rf.Body(COPPER, rf.Flat()), side=1e-6 * unit, load=1.0
    )


@pytest.mark.parametrize(("unit", "rounding"), [(2.0**-20, 0.0), (1e3, 1e-9)])
@pytest.mark.parametrize(("M", "approach"), [(33, 1e-13), (64, 1e-10)])
def test_lengths_all_scaled_alike_change_no_pressure(
    M: int, approach: float, unit: float, rounding: float
) -> None:
    """Also at an approach that nested grids do not reach. Powers of two scale without rounding."""
    one, other = (rf.solve(nanoscale(u), M, approach=approach * u) for u in (1.0, unit))
    assert one.status is other.status is rf.Status.CONVERGED
    np.testing.assert_allclose(other.pressure, one.pressure, rtol=0, atol=rounding * one.max_pressure)


@pytest.mark.parametrize("pressure", [30.0, 100.0])
def test_slopes_that_run_off_end_with_a_status(pressure: float) -> None:
    """Mean pressures of many E*: no division by a vanished cosine, no bars on numbers without meaning."""
    bowl = rf.Body(COPPER, rf.GaussianRoughness(rms=0.5e-6, correlation_length=104e-6, seed=3))
    load = pressure * SMOOTH.materials.reduced_modulus * SMOOTH.side**2
    s = rf.solve(replace(SMOOTH, lower=bowl, load=load), 5)
    assert s.status in (rf.Status.STAGNATED, rf.Status.ITERATION_LIMIT)
