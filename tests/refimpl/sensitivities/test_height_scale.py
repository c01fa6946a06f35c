"""The z calibration of an instrument: a factor on a map's heights, with a tolerance and derivatives."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import refimpl as rf
from refimpl.sensitivities.budget import budget
from tests import plate

NAME = "lower.surface[0].height_scale"


def on_map(path: Path, scale: float = 1.0) -> rf.Scene:
    """The ball on a small plate read from a file."""
    scene = plate.scene(plate.worn(), load=1.0, points=(100, 75))
    return replace(scene, lower=rf.Body(plate.STEEL, plate.measured(path, height_scale=scale)))


def test_a_tolerance_of_the_height_scale_moves_mu_as_another_solve_does(tmp_path: Path) -> None:
    path = plate.write(plate.sampled(plate.worn(), plate.CLEAN, (100, 75)), tmp_path / "map.txt")
    scene = on_map(path)
    low, solution, high = (rf.solve(on_map(path, scale), 96) for scale in (0.9, 1.0, 1.1))
    found = budget(scene, solution, {NAME: 0.1})
    assert NAME in found.tolerances
    derived = rf.sensitivity(scene, solution, [NAME])
    slope = derived.derivatives["friction_coefficient_corrected"][NAME]
    change = (high.friction_coefficient_corrected - low.friction_coefficient_corrected) / 0.2
    assert slope < 0  # rougher: less area under tau
    assert slope == pytest.approx(change, rel=0.15)  # quotients over 5 and 10 % differ by 13 %


def test_the_factor_is_of_heights_and_positive(tmp_path: Path) -> None:
    path = plate.write(plate.sampled(plate.worn(), plate.CLEAN, (40, 30)), tmp_path / "map.txt")
    one, two = (plate.measured(path, height_scale=scale).levelled((64e-6, 48e-6))[1] for scale in (1.0, 2.0))
    assert two == pytest.approx(2 * one)
    with pytest.raises(rf.InputError, match="height_scale"):
        plate.measured(path, height_scale=0.0)
