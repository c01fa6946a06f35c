"""`solve --explain` and `solve --budget`: plan, forecast and uncertainty budget as tables and as JSON."""

from __future__ import annotations

import importlib
import json
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import refimpl as rf
from refimpl.planning.term_effects import Effect
from refimpl.planning.terms import LABELS, Term
from refimpl.sensitivities.budget import Budget, Budgets
from refimpl.sensitivities.difference_quotients import NUMBERS
from refimpl.sensitivities.sensitivity import Sensitivity
from refimpl.solution.domain_error import Resolution
from refimpl.surfaces.surface import Detail
from tests.verification.cli.commands import answer, shown
from verification.cli import budget, explain

SMALL = (  # Hertz radius 165 um on a half side of 50 um
    "load = 5.0\nside = 1e-4\n[upper]\nmaterial = {E = 200e9, nu = 0.3}\n"
    "surface = [{kind = 'sphere', radius = 0.1}]\n[lower]\nmaterial = {E = 118e9, nu = 0.34}\n"
    "surface = [{kind = 'flat'}]\n[friction]\ntau = 15e6\nbeta = 0.08\n"
)
TOLERANCES = '\n[tolerances]\n"friction.tau" = 0.1\n'


@pytest.fixture
def toleranced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A scene with tolerances in the working directory."""
    monkeypatch.chdir(tmp_path)
    Path("scene.toml").write_text(rf.scene_to_toml(rf.read_scene("table1-smooth")) + TOLERANCES)


@pytest.mark.parametrize("size", ["--grid 64", "--accuracy 0.01"])
def test_a_plan_is_shown_in_100_columns_without_a_solve(size: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(rf, "solve")
    for scene in ("hertz", "metal-polymer"):
        text = shown(f"solve {scene} {size} --explain")
        assert max(map(len, text.splitlines())) <= 100
        assert all(name in text for name in LABELS.values())
        opening = "solved are only 32 x 32 and 64 x 64 elements, for the forecast"
        assert ("nothing is solved" if "--grid" in size else opening) in text


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ("--accuracy 0.01", "is not to be reached: the domain cuts the contact off"),
        ("--grid 40x40", "40 x 40 elements"),
    ],
)
def test_limits_are_stated_before_anything_is_solved(options: str, says: str, tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(SMALL)
    assert says in " ".join(shown(f"solve {tmp_path}/scene.toml {options} --explain").split())


def test_the_contact_is_about_the_solved_one() -> None:
    text = " ".join(shown("solve rough-planes --grid 32 --explain").split())
    assert re.search(r"contact about \d+\.\d\d% of the domain, \d+ of 32 x 32 elements", text)
    assert "(from at most 64 x 64 heights: within a factor of 2.5 on 25 rough scenes)" in text
    assert "Persson (elastic)" in text
    assert "Persson" not in shown("solve table1-rough --grid 32 --explain")


def test_a_term_has_its_changes_of_mu_and_of_the_area_in_this_order() -> None:
    term = Term("coupled", False, "small", Effect(friction=0.0123, area=0.0))
    assert explain._row(term) == [LABELS["coupled"], "out", "1.2e-02", "0", "small"]


def test_missing_slopes_fall_with_the_square_of_the_elements(monkeypatch: pytest.MonkeyPatch) -> None:
    """A length of 3 and five elements: 9 / 8 / 25 = 0.045 of the rms slope."""
    detail = Detail("correlation length", 1e-4, 4.0, 3.0, 0.1, 0.0, "")
    monkeypatch.setattr(explain, "resolution", lambda *_: Resolution(detail, 5.0, 48.0))
    printed = shown("solve table1-smooth --grid 16 --explain")
    assert "5: rms slopes are seen 4.5e-02 too small" in printed
    assert "48 required by the accuracy" in shown("solve table1-smooth --accuracy 0.01 --explain")


@pytest.mark.usefixtures("toleranced")
def test_a_scene_with_tolerances_gets_a_budget() -> None:
    printed = shown("solve scene.toml --grid 24 --json found.json")
    for word in ("numerical", "input", "friction.tau, 0.1", "sampling", "model form", "cosines", "total"):
        assert word in printed
    assert max(map(len, printed.splitlines())) <= 100
    stated = json.loads(Path("found.json").read_text())["budget"]
    mu = stated["numbers"]["friction_coefficient_corrected"]
    assert mu["inputs"]["friction.tau"] == pytest.approx(mu["input"])
    assert mu["total"] == pytest.approx(mu["model_form"] + math.hypot(mu["numerical"], mu["input"]))
    assert set(stated["derivatives"]) == set(NUMBERS)
    assert answer("solve scene.toml --grid 12")["budget"]  # standard output holds one document


def test_a_budget_is_of_what_is_asked_and_repeats_no_warning(folder: Path) -> None:
    """Elements exceed a quarter of a correlation length; a rigid body has no modulus to derive by."""
    assert "budget" not in answer("solve scene.toml --grid 12")
    rigid = Path("oblong.toml").read_text().replace("200e9", '"rigid"')
    Path("rigid.toml").write_text(rigid)
    assert "upper.material.E" not in json.dumps(answer("solve rigid.toml --grid 20x10 --budget")["budget"])
    rough = rf.GaussianRoughness(rms=1e-7, correlation_length=5e-5, seed=3)
    smooth = rf.read_scene("table1-smooth")
    Path("rough.toml").write_text(
        rf.scene_to_toml(replace(smooth, lower=rf.Body(smooth.lower.material, rough)))
    )
    printed = shown("solve rough.toml --grid 24 --budget --json found.json")
    assert printed.count("warning (correlation length)") == 1
    stated = json.loads(Path("found.json").read_text())["warnings"]
    assert sum("correlation length" in w["text"] for w in stated) == 1


@pytest.mark.usefixtures("toleranced")
def test_an_interrupted_budget_leaves_the_solution(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(importlib.import_module("refimpl.sensitivities.budget"), "budget", interrupted)
    assert "status: CONVERGED" in shown("solve scene.toml --grid 16 --json found.json", 130)
    assert json.loads(Path("found.json").read_text())["status"] == "converged"


@pytest.mark.usefixtures("toleranced")
@pytest.mark.parametrize(
    ("options", "status", "why"),
    [
        ("--approach 3e-6", 0, "at a prescribed approach"),
        ("--tolerance 1e-300 --budget", 1, "does not hold"),
    ],
)
def test_a_result_that_can_have_no_budget_says_why(options: str, status: int, why: str) -> None:
    printed = shown(f"solve scene.toml --grid 16 --json found.json {options}", status)
    assert "friction coefficient mu" in printed
    (note,) = (line for line in printed.splitlines() if line.startswith("no uncertainty budget: "))
    assert why in note
    assert json.loads(Path("found.json").read_text())["budget"] is None


def made_up() -> Budgets:
    """mu = 0.5 and Q = -0.25, with derivatives 0.2 and -0.1 by a load of 2, and 0 by tau."""
    found = {
        "friction_coefficient_corrected": 0.5,
        "contact_area_corrected": 4e-6,
        "max_pressure": 2e8,
        "binormal_force": -0.25,
    }
    slopes = {
        "friction_coefficient_corrected": {"load": 0.2, "friction.tau": 0.0},
        "contact_area_corrected": {"load": 1e-6, "friction.tau": 2e-13},
        "max_pressure": {"load": -5e7, "friction.tau": 10.0},
        "binormal_force": {"load": -0.1, "friction.tau": 5e-8},
    }
    scatter = {name: {"load": 0.5 * abs(row["load"]), "friction.tau": 0.0} for name, row in slopes.items()}
    derivatives = Sensitivity(found, {"load": 2.0, "friction.tau": 1e6}, slopes, scatter, 0.0)
    numbers = {
        number: Budget(
            value,
            numerical=0.03 * abs(value),
            inputs={"load": 0.04 * abs(value)},
            sources={"coefficients": 0.02 * abs(value), "cosines": 0.01 * abs(value)},
            sampling=0.12 * abs(value) if number == "contact_area_corrected" else None,
        )
        for number, value in found.items()
    }
    return Budgets(numbers, derivatives, {"load": 0.1})


def test_a_budget_in_per_cent() -> None:
    """Per cents have no sign; sqrt(3^2 + 4^2) = 5 and 3 of the model make 8; with 12 of sampling 13 + 3."""
    shares, changes = budget.table(made_up()).split("\n\n")
    rows = {" ".join(line.split()) for line in shares.splitlines()}
    assert rows >= {
        "mu A p_max Q", "numerical 3 3 3 3", "input 4 4 4 4", "load, 0.1 4 4 4 4", "sampling - 12 - -",
        "model form 3 3 3 3", "coefficients 2 2 2 2", "cosines 1 1 1 1", "total 8 16 8 8",
    }  # fmt: skip
    whole = "mu = 0.50 +- 0.04, A = 4.0 +- 0.6 mm^2, p_max = 200 +- 16 MPa, Q = -0.25 +- 0.02 N"
    assert f"with all parts: {whole}" in " ".join(shares.split())
    # 0.2 * 2 / 0.5, 1e-6 * 2 / 4e-6, -5e7 * 2 / 2e8, -0.1 * 2 / -0.25; scatter is half of each
    assert {" ".join(line.split()) for line in changes.splitlines()} >= {
        "load +0.800 +-0.4 +0.500 +-0.25 -0.500 +-0.25 +0.800 +-0.4",
        "friction.tau +0.000 +0.050 +0.050 -0.200",
    }


def test_a_budget_as_json() -> None:
    found: dict[str, Any] = json.loads(json.dumps(budget.document(made_up())))
    assert found["tolerances"] == {"load": 0.1}
    area = found["numbers"]["contact_area_corrected"]
    assert area["inputs"] == pytest.approx({"load": 1.6e-7})
    assert area["model_form_sources"] == pytest.approx({"coefficients": 8e-8, "cosines": 4e-8})
    parts = [area[name] for name in ("value", "numerical", "input", "sampling", "model_form", "total")]
    assert parts == pytest.approx([4e-6, 1.2e-7, 1.6e-7, 4.8e-7, 1.2e-7, 6.4e-7])
    assert found["derivatives"]["max_pressure"] == {"load": -5e7, "friction.tau": 10.0}
    assert found["derivatives_scatter"]["max_pressure"] == {"load": 2.5e7, "friction.tau": 0.0}


def test_an_unbounded_part_is_named() -> None:
    mu = Budget(0.1, 0.001, {"load": 0.0}, {"coefficients": math.inf})
    assert "unbounded" in budget.table(replace(made_up(), numbers={"friction_coefficient_corrected": mu}))
