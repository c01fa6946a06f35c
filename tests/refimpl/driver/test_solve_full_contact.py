"""Full and near-full periodic contact, where a mean pressure displaces nothing and the matrix is singular."""

from __future__ import annotations

import numpy as np
import pytest

import refimpl as rf

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
