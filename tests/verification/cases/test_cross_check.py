"""Dense reference and production solver on every scene of `verification.scenes.cross_checks`."""

from __future__ import annotations

import numpy as np
import pytest

import refimpl as rf
from refimpl.solvers.production import coarse_grids
from verification.properties import Sample
from verification.scenes.cross_checks import TOLERANCE, Trial, cross_checks

TRIALS = {trial.name: trial for trial in cross_checks()}
ENDED_WELL = (rf.Status.CONVERGED, rf.Status.CYCLED)
pytestmark = pytest.mark.filterwarnings("ignore::refimpl.SurfaceWarning")


def agree(trial: Trial, fft: rf.Solution) -> None:
    """The issue's limits: equal sets, pressure, approach and area to 1e-9, mu and Q/P to 1e-9 absolute."""
    dense = trial.dense
    assert dense.status in ENDED_WELL
    assert fft.status is dense.status
    assert np.array_equal(dense.contact, fft.contact)
    assert np.array_equal(dense.details.excluded, fft.details.excluded)
    assert np.abs(dense.pressure - fft.pressure).max() <= 1e-9 * dense.max_pressure
    assert np.abs(dense.traction - fft.traction).max() <= 1e-9 * np.abs(dense.traction).max()
    assert fft.contact_area == pytest.approx(dense.contact_area, rel=1e-9)
    assert abs(dense.friction_coefficient - fft.friction_coefficient) <= 1e-9
    assert abs(dense.binormal_force - fft.binormal_force) <= 1e-9 * dense.normal_force


NESTED = ("direction-0.7", "strong-tau", "slope-correction")


@pytest.mark.parametrize("name", NESTED)
def test_nested_grids_and_windows_agree_too(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Production nests grids of more than 30 elements; here already of 10, so that windows come in."""
    monkeypatch.setattr(coarse_grids, "COARSEST", 5)
    monkeypatch.setattr(coarse_grids, "COARSEST_OF_TWO", 5)
    trial = TRIALS[name]
    M = trial.M - trial.M % 2
    scene_trial = Trial(trial.name, trial.stresses, trial.scene, M, trial.options)
    fft = rf.solve(trial.scene, M, tolerance=TOLERANCE, **trial.options)
    assert len(fft.cost.iterations) > 1
    agree(scene_trial, fft)


TWO_LAWFUL = Sample(
    bumps=((7, 4, 6, 3), (0, 0, 4, 6), (1, 5, 1, 1), (1, 0, 1, 0)),
    E=(1, 35), nu=(0, 30), pressure=50, tau=290, angle=180,
)  # fmt: skip
"""Two states satisfy everything, with seven and with six elements in contact; mu 1.27 and 0.91."""


def test_of_two_lawful_states_both_solvers_take_the_rules() -> None:
    dense, fft = (
        rf.solve(TWO_LAWFUL.scene, 4, method=method, oblique=False, tolerance=TOLERANCE)
        for method in ("dense", "fft")
    )
    assert dense.status is fft.status is rf.Status.CONVERGED
    assert np.array_equal(dense.contact, fft.contact)
