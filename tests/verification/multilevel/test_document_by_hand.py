"""Published numbers of an ensemble study from two repetitions, and costs of its terms, by hand."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from tests.verification.multilevel.drawn import TABLE
from verification.cli.ensemble import table
from verification.multilevel.__main__ import document
from verification.multilevel.ensemble import Ensemble, _solved, ensemble
from verification.multilevel.estimator import Estimate
from verification.multilevel.estimator import estimate as estimated
from verification.sweep import engine
from verification.sweep.study import Study
from verification.sweep.study_file import study_from_dict


def repetition(
    mu: Estimate, area: Estimate, finest: tuple[float, ...], one: float, **changes: Any
) -> Ensemble:
    """Of three grids, the coarsest dropped: 10 solves of 2 s, 4 pairs of 5 s, 3 s for finding out."""
    fields: dict[str, Any] = {
        "grids": (8, 16, 32),
        "means": {"friction_coefficient": mu, "contact_area": area},
        "samples": (0, 10, 4),
        "seconds": (0, 2.0, 5.0),
        "plain": {"friction_coefficient": 172.0, "contact_area": None},
        "finest": {"friction_coefficient": finest, "contact_area": tuple(3 * x for x in finest)},
        "met": True,
        "failures": {},
        "dropped": 3.0,
        "finest_seconds": one,
    }
    return Ensemble(**fields | changes)


DONE = [
    repetition(Estimate(1.0, 0.3, 0.1, 9.0), Estimate(20.0, 3.0, 5.0, 9.0), (1.0, 2.0), 4.0),
    repetition(
        Estimate(1.4, 0.4, 0.25, 9.0), Estimate(26.0, 4.0, 2.0, 9.0), (3.0, 6.0), 6.0, samples=(0, 20, 2),
        seconds=(0, 2.0, 9.0), dropped=2.0, met=False,
    ),
]  # fmt: skip


def test_a_study_of_two_repetitions() -> None:
    """Costs 43 and 60 s, 51.5 in the mean; a finest solve 5 s; means 1.2 and 23."""
    found = document(DONE, 0.02)
    mu, area = (found["quantities"][name] for name in ("friction_coefficient", "contact_area"))
    assert (mu["mean"], area["mean"]) == pytest.approx((1.2, 23.0))
    # |1.0 - 1.2| > 0.1 and |1.4 - 1.2| < 0.25; within the standard errors both would be
    assert (mu["covered"], area["covered"]) == (1, 1)
    # half of the difference: the scatter of two means, over the root of two
    assert (mu["doubt"], area["doubt"]) == pytest.approx((0.2, 3.0))
    assert mu["standard error"] == pytest.approx(0.35 / 1.2)
    assert (mu["means"], mu["half widths"]) == ([1.0, 1.4], [0.1, 0.25])
    # the finest solves 1, 2, 3, 6: mean 3, variance 14 / 3
    assert mu["mean of the finest solves alone"] == pytest.approx(3.0)
    assert mu["its standard error"] == pytest.approx(math.sqrt(14 / 3) / 2)
    # as many solves of 5 s as reach the mean square of 0.3 and 0.4: 14 / 3 / 0.125
    assert mu["cost over plain"] == pytest.approx(51.5 / (5 * (14 / 3) / 0.125))
    assert area["cost over plain"] == pytest.approx(51.5 / (5 * 42 / 12.5))
    assert (found["seconds"], found["seconds on the finest grid"]) == (51.5, 5.0)
    assert (found["samples"], found["seconds of a sample"]) == ([0.0, 15.0, 3.0], [0.0, 2.0, 7.0])
    assert (found["met"], found["repetitions"], found["target"], found["grids"]) == (1, 2, 0.02, [8, 16, 32])


def test_the_table_of_one() -> None:
    """43 of 172 s are 25 %; the error of the mean 1.0 is 30 %, its interval 10 %."""
    lines = [line.split() for line in table(DONE[0]).splitlines()]
    assert ["friction_coefficient", "1", "30.00%", "+-", "10.00%", "25%"] in lines
    assert ["contact_area", "20", "15.00%", "+-", "25.00%", "nothing", "scatters"] in lines
    assert lines[5:8] == [["8", "dropped", "-"], ["16", "10", "2"], ["32", "4", "5"]]
    assert "took 3 s" in table(DONE[0])
    assert "not met" not in table(DONE[0])
    assert "the target was not met" in table(DONE[1])


def test_terms_costs_and_seeds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Solves of 1 s and of 6 s; grids differ by a hundredth of what realisations do: both pay."""
    seeds: list[tuple[tuple[int, ...], int]] = []

    def drawn(study: Study, *_: Any, **__: Any) -> engine.Sweep:
        rows, spent = [], []
        for run in study.runs():
            seed = study.first_seed + 2 * int(run.coordinates["realisation"])
            value = 100 + np.random.default_rng(seed).standard_normal()
            if run.inputs["grid"] == 32:
                value += 0.01 * np.random.default_rng([seed, 1]).standard_normal()
            row = {
                "friction_coefficient": value,
                "contact_area": 2 * value,
                "contact_area_corrected": 2 * value,
            }
            rows.append(row | {"normal_force": 70.0, "status": "converged", "key": run.key})
            spent.append(1.0 if run.inputs["grid"] == 16 else 6.0)
        seeds.append((study.vary["grid"], study.first_seed))
        return engine.Sweep(0, len(rows), {}, rows, spent, 0.0)

    monkeypatch.setattr(engine, "sweep", drawn)
    found = ensemble(study_from_dict(TABLE), tmp_path / "a.sqlite", 0.002, workers=0)
    assert found.met
    assert found.seconds == (1.0, 7.0)
    assert (found.finest_seconds, found.dropped) == (6.0, 0.0)
    assert found.cost == found.samples[0] + 7.0 * found.samples[1]
    (first, pairs) = ({seed for grid, seed in seeds if len(grid) == n} for n in (1, 2))
    assert first == {1}
    assert pairs == {1 + 10**7}
    mu = found.means["friction_coefficient"]
    assert found.plain["friction_coefficient"] == pytest.approx(6.0 / mu.standard_error**2, rel=0.4)
    assert len(found.finest["contact_area"]) == found.samples[1]


def test_degrees_of_freedom_are_satterthwaites() -> None:
    """One term of N samples has N - 1; two of equal parts (4 / 4 and 8 / 8): 2^2 / (1 / 3 + 1 / 7)."""
    one = np.array([1.0, -1.0, 1.0, -1.0]) * math.sqrt(3)  # variance 4
    two = np.array([1.0, -1.0] * 4) * math.sqrt(7)  # variance 8
    assert estimated([one], 0.0).freedom == pytest.approx(3.0)
    found = estimated([one, two], 0.0)
    assert found.standard_error == pytest.approx(math.sqrt(2))
    assert found.freedom == pytest.approx(4 / (1 / 3 + 1 / 7))


def test_a_term_of_a_rectangle(tmp_path: Path) -> None:
    """Of 2 x 0.5 mm on 32 x 8 elements; half of the corrections 1 and -1 is added on the coarse grid."""
    scene = replace(rf.read_scene("table1-rough"), side=None, size=(2e-3, 5e-4))
    (tmp_path / "s.toml").write_text(rf.scene_to_toml(scene))
    study = study_from_dict(TABLE | {"scene": "s.toml"}, tmp_path)
    row = {"contact_area_corrected": 1.0, "normal_force": 30.0, "status": "converged"}
    done = engine.Sweep(0, 4, {}, [row | {"contact_area": float(k)} for k in range(4)], [1.0, 4.0] * 2, 0.0)
    term = _solved(study, ["contact_area"], lambda _: done, 1, (16, 32), 2, 32)
    assert term.element == pytest.approx([1e-6 / 256])
    assert (term.seconds, term.finer_seconds, term.cost) == (5, 4, 10)
    assert term.samples.ravel() == pytest.approx([0.5, 1.5])
