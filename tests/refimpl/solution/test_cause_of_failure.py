"""Causes that solves which do not converge name: pressure, coupling, hardness, tau."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf

STEEL, POLYMER = rf.Material(200e9, 0.30), rf.Material(3e9, 0.40)
HEIGHTS = 5e-7 * np.random.default_rng(8).standard_normal((5, 5))
SCENE = rf.Scene(
    upper=rf.Body(STEEL, rf.Sphere(0.14)),
    lower=rf.Body(POLYMER, HEIGHTS),
    friction=rf.Friction(tau=0.0, beta=0.12),
    load=30.0,
    side=1.61e-3,
    sliding_direction=0.7,
)
MODULUS_LOAD = SCENE.materials.reduced_modulus * 1.61e-3**2


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"load": 20 * MODULUS_LOAD}, "the mean pressure is 20 times the reduced modulus"),
        ({"friction": rf.Friction(beta=200.0)}, "coupling beta c / a = "),
        ({"friction": rf.Friction(tau=40e10)}, "tau on slopes carries "),
        ({"friction": rf.Friction(tau=40e7)}, "under tau 1"),
    ],
    ids=["pressure", "coupling", "tilt", "excluded"],
)
@pytest.mark.filterwarnings("ignore::refimpl.SurfaceWarning")
def test_the_cause_is_named_with_its_number(changes: dict[str, object], named: str) -> None:
    found = rf.solve(replace(SCENE, **changes), 5)
    assert found.status in (rf.Status.STAGNATED, rf.Status.ITERATION_LIMIT)
    assert any(named in warning and warning.startswith(found.status.value) for warning in found.warnings)


def test_what_converged_has_no_cause() -> None:
    found = rf.solve(SCENE, 5)
    assert found.status is rf.Status.CONVERGED
    assert not any(str(warning).startswith(found.status.value) for warning in found.warnings)
