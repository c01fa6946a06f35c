"""Ensembles that are refused: studies that are none, scenes that do not scatter, targets out of reach."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from refimpl.errors import InputError
from tests.verification.multilevel.drawn import TABLE, spied
from verification.multilevel.ensemble import PILOT, ensemble
from verification.sweep.study_file import study_from_dict


@pytest.mark.parametrize("target", [1e-6, 1e-30, 1e-300])
def test_a_target_out_of_reach_is_refused_after_the_pilot(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, target: float
) -> None:
    solved = spied(monkeypatch, scatter=(1.0, 1.0, 1.0))
    study = study_from_dict(TABLE | {"vary": {"grid": [8, 16, 32]}})
    with pytest.raises(InputError, match=f"--target-error = {target:g}: .*realisations.*1000000") as refused:
        ensemble(study, tmp_path / "a.sqlite", target)
    assert len(solved) == PILOT[0] + 2 * PILOT[1] + 2 * PILOT[2]
    assert re.search("takes ([1-9].*|inf) realisations", refused.value.allowed)


def test_how_far_out_of_reach_goes_by_the_inverse_square(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    spied(monkeypatch, scatter=(1.0, 1.0, 1.0))
    study, numbers = study_from_dict(TABLE | {"vary": {"grid": [8, 16, 32]}}), []
    for target in (1e-6, 1e-7):
        with pytest.raises(InputError) as refused:
            ensemble(study, tmp_path / "a.sqlite", target)
        told = re.search(r"takes (\S+) realisations", refused.value.allowed)
        assert told is not None
        numbers.append(float(told[1]))
    # scatter of 1 in 100, hence 1e8 plain samples of it, within what a pilot of four may be off
    assert 1e7 < numbers[0] < 1e9
    assert numbers[1] == pytest.approx(100 * numbers[0], rel=0.1)


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"vary": {"grid": [16, 48]}}, "vary.grid"),
        ({"vary": {"grid": [16]}}, "vary.grid"),
        ({"vary": {"grid": [16, 32], "load": [1.0]}}, "vary"),
        ({"realisations": 75}, "realisations"),
        ({"first_seed": 2**63 - 10**6}, "first_seed"),
    ],
)
def test_a_study_that_is_no_ensemble_is_refused(tmp_path: Path, change: dict, field: str) -> None:
    with pytest.raises(InputError) as refused:
        ensemble(study_from_dict(TABLE | change), tmp_path / "a.sqlite", 0.05)
    assert refused.value.field == field


def test_a_scene_without_scatter_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="random"):
        ensemble(study_from_dict(TABLE | {"scene": "hertz"}), tmp_path / "a.sqlite", 0.05)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("target", [0.0, 1.0, -0.1])
def test_a_target_out_of_range_is_refused(tmp_path: Path, target: float) -> None:
    with pytest.raises(InputError, match="target-error"):
        ensemble(study_from_dict(TABLE), tmp_path / "a.sqlite", target)
