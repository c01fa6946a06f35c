"""Multilevel ensembles: which grids they keep, what they know of means, and how they resume."""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.errors import InputError
from reports.studies.multilevel import build
from tests.verification.multilevel.drawn import TABLE, spied
from verification.cli import main
from verification.cli.ensemble import reported, table
from verification.multilevel.__main__ import document
from verification.multilevel.ensemble import (
    _BLOCK,
    FEWEST,
    PILOT,
    QUANTITIES,
    Ensemble,
    _checked,
    _numbers,
    _Term,
    _values,
    ensemble,
)
from verification.multilevel.estimator import Estimate
from verification.sweep import engine
from verification.sweep.study import MAX_RUNS, Study
from verification.sweep.study_file import study_from_dict


def test_grids_too_coarse_to_help_are_dropped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What grids of 8 and 16 elements say has nothing to do with the finest: plain sampling is cheapest."""
    study = study_from_dict(TABLE | {"vary": {"grid": [8, 16, 32]}})
    kept = spied(monkeypatch, scatter=(9.0, 4.0, 1.0))
    found = ensemble(study, tmp_path / "a.sqlite", 0.0005, workers=0)
    assert found.met
    assert found.grids == (8, 16, 32)
    assert found.samples[:2] == (0, 0)
    assert found.samples[2] == len(found.finest["contact_area"]) > PILOT[2]
    assert found.cost == pytest.approx(sum(kept.values()))  # the pilot's solves are paid for
    # 400 solves do, and the pilot's four may take the variance for 2.6 times as large (chi-square, 95 %)
    assert min(found.cost / plain for plain in found.plain.values()) < 2.6
    for mean in found.means.values():  # asked for 3 % less, rounds of more samples can overshoot a little
        assert 0.85 < mean.standard_error / (0.0005 * mean.mean) <= 1
    assert ensemble(study, tmp_path / "a.sqlite", 0.0005, workers=0) == found


def test_without_friction_there_is_no_mean_of_mu(tmp_path: Path) -> None:
    scene = rf.read_scene("table1-rough")
    (tmp_path / "dry.toml").write_text(rf.scene_to_toml(replace(scene, friction=rf.Friction())), "utf-8")
    study = study_from_dict(TABLE | {"scene": "dry.toml", "vary": {"grid": [8, 16]}}, tmp_path)
    found = ensemble(study, tmp_path / "a.sqlite", 0.3, workers=0)
    assert found.met
    assert set(found.means) == set(found.plain) == set(found.finest) == {"contact_area"}


@pytest.mark.parametrize("friction", [rf.Friction(tau=15e6), rf.Friction(beta=0.1)])
def test_either_friction_has_a_mean_of_mu(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, friction: rf.Friction
) -> None:
    kept = spied(monkeypatch, scatter=(1.0, 1.0, 1.0, 1.0, 1.0))
    scene = replace(rf.read_scene("table1-rough"), friction=friction)
    (tmp_path / "one.toml").write_text(rf.scene_to_toml(scene), "utf-8")
    # on more grids than the pilot has numbers for, whose last holds for all that follow
    study = study_from_dict(TABLE | {"scene": "one.toml", "vary": {"grid": [8, 16, 32, 64, 128]}}, tmp_path)
    found = ensemble(study, tmp_path / "a.sqlite", 0.05, workers=0)
    assert found.met
    assert set(found.means) == set(QUANTITIES)
    assert found.samples == (0, 0, 0, 0, FEWEST)  # nothing on one grid tells of another
    last = PILOT[-1]
    assert len(kept) == PILOT[0] + 2 * (PILOT[1] + PILOT[2] + last + last) + (FEWEST - last)


def test_an_element_in_contact_may_come_where_nothing_scatters(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With full contact, say: an error of one element in 3 of 100, and no share of plain sampling's cost."""
    spied(monkeypatch, scatter=(0.0, 0.0))
    found = ensemble(study_from_dict(TABLE | {"vary": {"grid": [8, 16]}}), tmp_path / "a.sqlite", 0.05)
    assert found.met
    element = (1.61e-3 / 16) ** 2
    parts = [min(1.0, 3 / N) * element**2 / N for N in found.samples if N]
    assert found.means["contact_area"].standard_error == pytest.approx(sum(parts) ** 0.5)
    share = 15e6 / 70.0 * sum(parts) ** 0.5  # tau on it over the load
    assert found.means["friction_coefficient"].standard_error == pytest.approx(share)
    assert found.means["contact_area"].half_width > 0
    assert found.plain == dict.fromkeys(QUANTITIES)
    assert table(found).count("nothing scatters") == 2


def test_what_a_perimeter_adds_makes_no_correction(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It goes with the element; on the finest grid all of it is meant to stay."""
    tau, load, side = 15e6, 70.0, 1.61e-3

    def drawn(study: Study, *_: Any, **__: Any) -> engine.Sweep:
        rows = []
        for run in study.runs():
            seed = study.first_seed + 2 * int(run.coordinates["realisation"])
            inside = side**2 * np.random.default_rng(seed).uniform(0.1, 0.2)
            area = inside + side**2 / run.inputs["grid"]
            row = {"contact_area": area, "contact_area_corrected": inside, "key": run.key}
            rows.append(
                row | {"friction_coefficient": tau * area / load, "normal_force": load, "status": "converged"}
            )
        return engine.Sweep(0, len(rows), {}, rows, [1.0] * len(rows), 0.0)

    monkeypatch.setattr(engine, "sweep", drawn)
    study = study_from_dict(TABLE | {"vary": {"grid": [8, 16, 32]}})
    found = ensemble(study, tmp_path / "a.sqlite", 0.1)
    start = next(k for k, number in enumerate(found.samples) if number)
    seeds = study.first_seed + start * _BLOCK + 2 * np.arange(found.samples[start])
    inside = side**2 * np.mean([np.random.default_rng(seed).uniform(0.1, 0.2) for seed in seeds])
    area = inside + side**2 / 32
    assert found.means["contact_area"].mean == pytest.approx(area, rel=1e-12)
    assert found.means["friction_coefficient"].mean == pytest.approx(tau * area / load, rel=1e-12)


@pytest.mark.parametrize(("scatter", "reach"), [(700.0, "0.73 or more"), (2000.0, "none")])
def test_the_least_share_is_told_where_there_is_one(scatter: float, reach: str) -> None:
    """A million samples of that scatter about a mean of 1."""
    samples = np.array([[1 - scatter], [1 + scatter]]) / 2**0.5
    with pytest.raises(InputError, match=f"expected {reach}: it takes"):
        _numbers([_Term(samples, samples, np.zeros(1), 1.0, 1.0, {})], 1e-3, np.ones(1))


def test_seeds_must_leave_room_for_all_terms() -> None:
    last = 2**63 - 1 - 2 * _BLOCK - 2 * MAX_RUNS
    assert _checked(study_from_dict(TABLE | {"first_seed": last}), 0.1) == [16, 32]
    with pytest.raises(InputError, match="first_seed"):
        _checked(study_from_dict(TABLE | {"first_seed": last + 1}), 0.1)


def test_coarse_areas_are_those_of_the_finest_grids_elements() -> None:
    """Half the correction on elements twice as large; none on the finest; tau on that area over the load."""
    row = {
        "contact_area": 4.0,
        "contact_area_corrected": 3.0,
        "friction_coefficient": 1.0,
        "normal_force": 2.0,
    }
    assert _values(row, QUANTITIES, 0.1, 0.5) == pytest.approx([1.0 - 0.1 * 0.5 / 2.0, 3.5])
    assert _values(row, ("contact_area",), 0.1, 0.0) == [4.0]


def test_an_ensemble_resumes_and_repeats(tmp_path: Path) -> None:
    study = study_from_dict(TABLE)
    first = ensemble(study, tmp_path / "a.sqlite", 0.05, workers=0)
    again = ensemble(study, tmp_path / "a.sqlite", 0.05, workers=0)
    assert first.met
    assert all(e.standard_error <= 0.05 * e.mean for e in first.means.values())
    assert again == first
    shown = build(json.loads(json.dumps(document([first, again], 0.05))))
    assert len(shown.tables) == 2


def test_the_rows_of_the_report_are_the_documents() -> None:
    quantity = {
        "mean": 0.2, "standard error": 0.011, "covered": 38, "cost over plain": 0.345,
        "mean of the finest solves alone": 0.206, "its standard error": 0.004,
        "means": [0.19, 0.21], "half widths": [0.02, 0.03],
    }  # fmt: skip
    shown = build(
        {
            "scene": "table1-rough", "target": 0.01, "repetitions": 40, "seconds": 7.25,
            "grids": [64, 128], "samples": [9, 0], "seconds of a sample": [0.5, None],
            "quantities": {"friction_coefficient": quantity},
        }
    )  # fmt: skip
    means, terms = shown.tables
    assert list(zip(means.head, means.rows[0], strict=True)) == [
        ("mean", "mu"),
        ("value", 0.2),
        ("standard error", "1.10%"),
        ("covered", "38 of 40"),
        ("cost over plain sampling", "34.5%"),
        ("mean of the finest solves alone, off by standard errors", "+1.50"),
    ]
    assert [*terms.rows] == [(64, 9, 0.5), (128, "dropped", "-")]


@pytest.mark.parametrize("broken", [0, 3])
def test_no_mean_is_taken_of_what_did_not_converge(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], broken: int
) -> None:
    sweep = engine.sweep

    def spoilt(study: Study, *args: Any, **options: Any) -> engine.Sweep:
        done = sweep(study, *args, **options | {"workers": 0})
        if study.vary["grid"] == (16, 32):
            done.rows[2 * broken + 1]["status"] = done.rows[-1]["status"] = "stagnated"
        return done

    monkeypatch.setattr(engine, "sweep", spoilt)
    found = ensemble(study_from_dict(TABLE), tmp_path / "a.sqlite", 0.05, workers=0)
    assert not found.met
    assert not found.means
    (told,) = found.failures.values()
    seeds = 1 + _BLOCK + 2 * broken
    assert "2 of 16 runs did not converge" in told
    assert f"seeds {seeds} and {seeds + 1} on 32 elements a side, stagnated" in told
    (tmp_path / "e.toml").write_text('scene = "table1-rough"\n[vary]\ngrid = [16, 32]\n')
    command = ["sweep", str(tmp_path / "e.toml"), "--store", str(tmp_path / "s.sqlite")]
    assert main([*command, "--target-error", "5%"]) == 1
    assert "2 of 16 runs did not converge" in capsys.readouterr().out


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, out = tmp_path / "e.toml", tmp_path / "e.json"
    file.write_text('scene = "table1-rough"\n[vary]\ngrid = [16, 32]\n[solve]\ntolerance = 1e-3\n')
    command = ["sweep", str(file), "--store", str(tmp_path / "s.sqlite"), "--workers", "1"]
    assert main([*command, "--target-error", "8%", "--json", str(out)]) == 0
    assert "cost over plain sampling" in capsys.readouterr().out
    assert json.loads(out.read_text())["met"] is True
    assert main([*command, "--target-error", "8%", "--csv", str(tmp_path / "x.csv")]) == 2


@pytest.mark.parametrize(("met", "status"), [(True, 0), (False, 1)])
def test_the_status_says_whether_the_target_was_met(
    met: bool, status: int, capsys: pytest.CaptureFixture[str]
) -> None:
    estimate = Estimate(0.5, 0.01, 0.02, 8.0)
    found = Ensemble((16,), {"contact_area": estimate}, (9,), (0.1,), {"contact_area": 1.0}, {}, met, {})
    assert reported(argparse.Namespace(json=None), found) == status
    assert capsys.readouterr().out
