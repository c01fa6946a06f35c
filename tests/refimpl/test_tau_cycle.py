"""Tau's support when it chases the contact set: the rule must still end with a certified state."""

from __future__ import annotations

from dataclasses import replace

import refimpl as rf


def test_a_cycle_longer_than_two_is_settled() -> None:
    # One element enters and leaves every third update; found among 540 solves of rough balls on rough flats.
    smooth = rf.read_scene("table1-smooth")
    ball = rf.GaussianRoughness(0.084e-6, 104e-6, seed=2021, normalise=True)
    flat = rf.GaussianRoughness(0.2e-6, 104e-6, seed=2022, normalise=True)
    scene = replace(
        smooth,
        upper=rf.Body(smooth.upper.material, smooth.upper.surface + ball),
        lower=rf.Body(smooth.lower.material, flat),
    )
    s = rf.solve(scene, 128)
    assert s.status is rf.Status.CYCLED
    assert s.certificate.worst <= s.tolerance
    assert s.uncertainty["friction_coefficient"]["tau support"] < 1e-3 * s.friction_coefficient
