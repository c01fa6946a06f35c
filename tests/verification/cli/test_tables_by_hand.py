"""Every column of the command line's tables once against a number worked out by hand: units, signs, bars."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import refimpl as rf
from refimpl.scene.resolution import Resolution
from refimpl.sensitivities.budget import Budget, Budgets
from refimpl.sensitivities.sensitivity import Sensitivity
from refimpl.surfaces.surface import Detail
from verification.cli import budget, explain, main, solve_table
from verification.cli.output import judgement
from verification.framework.case import Case, Measured, Metric

SCENE = rf.Scene(
    upper=rf.Body(rf.Material(7e9, 0.2), rf.Sphere(0.05)),
    lower=rf.Body(rf.Material(2e9, 0.35, hardness=5e6), rf.Flat()),
    friction=rf.Friction(tau=1e6, beta=0.2),
    load=5.0,
    side=4e-3,
)
NUMBERS = {
    "friction_coefficient": 0.25,
    "contact_area": 3e-6,
    "contact_area_corrected": 2.5e-6,
    "plastic_area": 0.75e-6,
    "max_pressure": 400e6,
    "approach": -1.5e-6,
    "normal_force": 12.5,
    "friction_force": 3.125,
    "binormal_force": -0.5,
}
BARS = {
    "friction_coefficient": {"iteration": 0.01, "discretisation": 0.03},
    "contact_area": {"iteration": 2e-7},
    "contact_area_corrected": {"discretisation": 3e-7},
    "plastic_area": {"iteration": 5e-8, "discretisation": 1e-8},
    "max_pressure": {"discretisation": 7e6},
    "approach": {"discretisation": 6e-8},
    "normal_force": {},
    "friction_force": {"iteration": 0.5},
    "binormal_force": {"discretisation": math.inf},
}


@pytest.fixture(scope="module")
def solution() -> rf.Solution:
    return replace(rf.solve(SCENE, 12, plastic=True), **NUMBERS, uncertainty=BARS)


def test_numbers_bars_and_units_of_a_solve(solution: rf.Solution) -> None:
    """The plastic area is a quarter of A; bars are sums of parts, in the unit beside them."""
    found = [line.split() for line in solve_table.table(solution, "scene").splitlines()]
    for row in (
        "friction coefficient mu 0.25 +- 0.04",
        "contact area A 3.0 +- 0.2 mm^2",
        "A, perimeter-corrected 2.5 +- 0.3 mm^2",
        "plastic area, 25.0% of A 0.75 +- 0.06 mm^2",
        "maximum pressure p_max 400 +- 7 MPa",
        "approach -1.50 +- 0.06 um",
        "normal force N 12.5 N",
        "friction force F 3.1 +- 0.5 N",
        "binormal force Q -0.50 unbounded (not usable) N",
    ):
        assert row.split() in found, row


@pytest.mark.parametrize("status", list(rf.Status))
def test_a_solve_is_a_success_where_its_status_is(
    status: rf.Status, solution: rf.Solution, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A certificate that holds is not enough: the accuracy may be missing."""
    (tmp_path / "s.toml").write_text(rf.scene_to_toml(SCENE))
    monkeypatch.setattr(rf, "solve", lambda *_, **__: replace(solution, status=status))
    assert solution.certified
    solved = status in (rf.Status.CONVERGED, rf.Status.CYCLED)
    assert main(["solve", str(tmp_path / "s.toml"), "--grid", "12"]) == int(not solved)


def made_up() -> Budgets:
    """mu = 0.5 and Q = -0.25, with derivatives 0.2 and -0.1 by a load of 2, and 0 by tau."""
    found = {"friction_coefficient": 0.5, "contact_area": 4e-6, "max_pressure": 2e8, "binormal_force": -0.25}
    slopes = {
        "friction_coefficient": {"load": 0.2, "friction.tau": 0.0},
        "contact_area": {"load": 1e-6, "friction.tau": 2e-13},
        "max_pressure": {"load": -5e7, "friction.tau": 10.0},
        "binormal_force": {"load": -0.1, "friction.tau": 5e-8},
    }
    scatter = {
        number: {"load": 0.5 * abs(row["load"]), "friction.tau": 0.0} for number, row in slopes.items()
    }
    derivatives = Sensitivity(found, {"load": 2.0, "friction.tau": 1e6}, slopes, scatter, 0.0)
    tolerances = {"load": 0.1}
    numbers = {
        number: Budget(
            value,
            numerical=0.03 * abs(value),
            inputs={"load": 0.04 * abs(value)},
            sources={"coefficients": 0.02 * abs(value), "cosines": 0.01 * abs(value)},
            sampling=0.12 * abs(value) if number == "contact_area" else None,
        )
        for number, value in found.items()
    }
    return Budgets(numbers, derivatives, tolerances)


def test_a_budget_in_per_cent() -> None:
    """Per cents have no sign; sqrt(3^2 + 4^2) = 5 and 3 of the model make 8; with 12 of sampling 13 + 3."""
    shares, changes = budget.table(made_up()).split("\n\n")
    rows = {line.split()[0]: line.split() for line in shares.splitlines()}
    assert rows["mu"] == ["mu", "A", "f_max", "Q"]
    assert rows["numerical"] == ["numerical", "3", "3", "3", "3"]
    assert rows["input"] == ["input", "4", "4", "4", "4"]
    assert rows["load,"] == ["load,", "0.1", "4", "4", "4", "4"]
    assert rows["sampling"] == ["sampling", "-", "12", "-", "-"]
    assert rows["model"] == ["model", "form", "3", "3", "3", "3"]
    assert rows["coefficients"] == ["coefficients", "2", "2", "2", "2"]
    assert rows["cosines"] == ["cosines", "1", "1", "1", "1"]
    assert rows["total"] == ["total", "8", "16", "8", "8"]
    load, tau = (
        next(line for line in changes.splitlines() if name in line).split() for name in ("load", "tau")
    )
    # 0.2 * 2 / 0.5, 1e-6 * 2 / 4e-6, -5e7 * 2 / 2e8, -0.1 * 2 / -0.25; scatter is half of each
    assert load == ["load", "+0.800", "+-0.4", "+0.500", "+-0.25", "-0.500", "+-0.25", "+0.800", "+-0.4"]
    assert tau == ["friction.tau", "+0.000", "+0.050", "+0.050", "-0.200"]


def test_a_budget_as_json() -> None:
    found: dict[str, Any] = json.loads(json.dumps(budget.document(made_up())))
    assert found["tolerances"] == {"load": 0.1}
    area = found["numbers"]["contact_area"]
    assert area["inputs"] == pytest.approx({"load": 1.6e-7})
    assert area["model_form_sources"] == pytest.approx({"coefficients": 8e-8, "cosines": 4e-8})
    parts = [area[name] for name in ("value", "numerical", "input", "sampling", "model_form", "total")]
    assert parts == pytest.approx([4e-6, 1.2e-7, 1.6e-7, 4.8e-7, 1.2e-7, 6.4e-7])
    assert found["derivatives"]["max_pressure"] == {"load": -5e7, "friction.tau": 10.0}
    assert found["derivatives_scatter"]["max_pressure"] == {"load": 2.5e7, "friction.tau": 0.0}


def test_missing_slopes_fall_with_the_square_of_the_elements(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A length of 3 and five elements: 9 / 8 / 25 = 0.045 of the rms slope."""
    detail = Detail("correlation length", 1e-4, 4.0, 3.0, "")
    monkeypatch.setattr(explain, "resolution", lambda *_: Resolution(detail, 5.0, 48.0))
    assert main(["solve", "table1-smooth", "--grid", "16", "--explain"]) == 0
    assert "5: rms slopes are seen 4.5e-02 too small" in capsys.readouterr().out
    assert main(["solve", "table1-smooth", "--accuracy", "0.01", "--explain"]) == 0
    assert "48 required by the accuracy" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("metric", "value", "text"),
    [
        (Metric.AT_MOST, 0.25, "0.25 <= 0.5"),
        (Metric.AT_MOST, 0.75, "0.75 > 0.5"),
        (Metric.AT_LEAST, 0.75, "0.75 >= 0.5"),
        (Metric.AT_LEAST, 0.25, "0.25 < 0.5"),
    ],
)
def test_the_sign_between_error_and_tolerance_is_that_of_the_verdict(
    metric: Metric, value: float, text: str
) -> None:
    case = Case("a/b", "t", "c", "s", metric, 0.5, "r", lambda: Measured(value))
    assert judgement(case.run()) == text
