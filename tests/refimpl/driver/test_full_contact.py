"""Full and near-full periodic contact, where a mean pressure displaces nothing and the matrix is singular."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import refimpl as rf
from refimpl.planning.plan import Method

SIDE, M = 1e-3, 12
STEEL = rf.Material(200e9, 0.3)


def wavy(nominal: float, amplitude: float = 1e-6) -> tuple[rf.Scene, np.ndarray, float]:
    """A wavy plane under a mean pressure, its exact full-contact pressure, and the wave's part of it (Pa).

    The gap ``A (1 - cos q x)`` is flattened by ``E* q A / 2 cos q x`` (Westergaard 1939).
    """
    x = (np.arange(M) + 0.5) / M
    wave = np.cos(2 * np.pi * x)[:, None] * np.ones(M)
    modulus = STEEL.plane_strain_modulus / 2
    part = modulus * (2 * np.pi / SIDE) * amplitude / 2
    scene = rf.Scene(
        upper=rf.Body(STEEL, -amplitude * wave),
        lower=rf.Body(STEEL, rf.Flat()),
        friction=rf.Friction(),
        load=nominal * SIDE**2,
        side=SIDE,
        periodic=True,
    )
    return scene, nominal + part * wave, part


@pytest.mark.parametrize("method", ["dense", "fft"])
@pytest.mark.parametrize("excess", [1.01, 1.5, 20.0])
def test_full_contact_is_westergaards(method: str, excess: float) -> None:
    _, _, part = wavy(1.0)
    scene, exact, _ = wavy(excess * part)
    solution = rf.solve(scene, M, method=method, oblique=False, tolerance=1e-11)
    assert solution.status is rf.Status.CONVERGED
    # rounding of the mean pressure, which is up to twenty times the wave's
    assert np.abs(solution.pressure - exact).max() <= 1e-12 * exact.max()
    assert abs(solution.approach) <= 1e-11 * 1e-6


@pytest.mark.parametrize("share", [0.3, 0.9, 0.96])  # the lowest centre lies at cos(165 deg) = -0.966
def test_both_solvers_agree_up_to_full_contact(share: float) -> None:
    _, _, part = wavy(1.0)
    scene, _, _ = wavy(share * part)
    dense, fft = (rf.solve(scene, M, method=m, oblique=False, tolerance=1e-12) for m in ("dense", "fft"))
    assert np.array_equal(dense.contact, fft.contact)
    assert np.abs(dense.pressure - fft.pressure).max() <= 1e-11 * dense.max_pressure
    back = rf.solve(scene, M, method="dense", oblique=False, approach=dense.approach)
    assert np.abs(dense.pressure - back.pressure).max() <= 1e-9 * dense.max_pressure


POLYMER = rf.Material(3e9, 0.4)


def planes(friction: rf.Friction, load: float, side: float) -> rf.Scene:
    """Flat periodic planes; the pressure is the load over the area."""
    return rf.Scene(
        upper=rf.Body(STEEL, rf.Flat()), lower=rf.Body(POLYMER, rf.Flat()), friction=friction, load=load,
        side=side, periodic=True,
    )  # fmt: skip


@settings(max_examples=25, deadline=None)
@given(
    st.sampled_from(["fft", "dense"]), st.integers(1, 12), st.floats(-9, 3), st.floats(-6, 1), st.booleans()
)
def test_flat_periodic_planes_converge_on_every_grid(
    method: Method, M: int, load: float, side: float, rubs: bool
) -> None:
    """All displacements are rounding there, and a gap over an energy would be rounding over rounding."""
    pressure = 10**load / (10**side) ** 2
    friction = rf.Friction(min(0.1 * pressure, 1e7), 0.3) if rubs else rf.Friction()
    scene = planes(friction, 10**load, 10**side)
    if pressure > 1e9:
        scene = replace(scene, load=1e9 * scene.side**2)
    solution = rf.solve(scene, M, method=method)
    assert solution.status is rf.Status.CONVERGED
    np.testing.assert_allclose(solution.pressure, scene.load / scene.side**2, rtol=1e-12)


ROUGH = rf.read_scene("rough-planes")


@pytest.mark.parametrize(("method", "approach"), [("fft", -5e-324), ("dense", -5e-324), ("fft", -1e-21)])
def test_an_approach_without_digits_beside_the_mean_gap_is_refused(approach: float, method: Method) -> None:
    with pytest.raises(rf.InputError, match="approach"):
        rf.solve(ROUGH, 16, method=method, approach=approach)


@settings(max_examples=20, deadline=None)
@given(st.floats(-25, -5))
def test_no_approach_divides_by_zero(exponent: float) -> None:
    """Of any size: refused, ended with a status, or solved."""
    try:
        solution = rf.solve(ROUGH, 8, approach=-(10.0**exponent))
    except rf.InputError:
        assert exponent < -19
        return
    assert solution.certificate.satisfies(1e-8) or solution.status is rf.Status.STAGNATED


def test_heights_beyond_the_side_are_told_the_way_out() -> None:
    """Dimensionless set-ups: heights by s with moduli over s have the same pressures without slope terms."""
    z = np.random.default_rng(4).standard_normal((8, 8))

    def scene(s: float) -> rf.Scene:
        upper, lower = (rf.Body(rf.Material(E / s, 0.3), h) for E, h in ((1.0, rf.Flat()), (2.0, s * z)))
        return rf.Scene(upper=upper, lower=lower, friction=rf.Friction(0.1, 0.2), load=0.3, side=1.0)

    with pytest.raises(rf.InputError, match=r"times s .* same pressures"):
        rf.solve(scene(1.0), 8, oblique=False)
    ways_out = [rf.solve(scene(s), 8, oblique=False) for s in (0.01, 0.1)]
    np.testing.assert_allclose(ways_out[0].pressure, ways_out[1].pressure, atol=1e-7)
    assert 0 < ways_out[0].contact.sum() < 64
