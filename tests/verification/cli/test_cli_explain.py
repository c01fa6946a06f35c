"""`solve --explain`: the plan in at most 100 columns, as JSON, and without a solve."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import refimpl
from refimpl.planning.term_effects import Effect
from refimpl.planning.terms import LABELS, Term
from verification.cli import main
from verification.cli.explain import _row

Capture = pytest.CaptureFixture[str]


@pytest.mark.parametrize("scene", refimpl.shipped_scenes())
@pytest.mark.parametrize("size", [["--grid", "64"], ["--accuracy", "0.01"]])
def test_the_table_fits_100_columns(
    scene: str, size: list[str], capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise AssertionError("something was solved")

    monkeypatch.setattr(refimpl, "solve", refuse)
    assert main(["solve", scene, *size, "--explain"]) == 0
    text = capsys.readouterr().out
    assert max(map(len, text.splitlines())) <= 100
    for name in LABELS.values():
        assert name in text
    opening = "solved are only 32 x 32 and 64 x 64 elements, for the forecast"
    assert ("nothing is solved" if "--grid" in size else opening) in text


def test_the_forecast_names_the_grid_that_the_refinement_ends_on(tmp_path: Path, capsys: Capture) -> None:
    """Four octaves of sizes, four an octave: one step off is 17 to 25 per cent."""
    path = tmp_path / "plan.json"
    assert main(["solve", "table1-smooth", "--accuracy", "0.01", "--explain", "--json", str(path)]) == 0
    assert "friction_coefficient to 0.01 takes" in capsys.readouterr().out
    expected = json.loads(path.read_text())["forecast"]
    last = refimpl.solve(refimpl.read_scene("table1-smooth"), accuracy=0.01).problem.grid.shape[0]
    assert expected["solved"] == [[32, 32], [64, 64]]
    assert expected["refusal"] == ""
    assert expected["grid"][0] == pytest.approx(last, rel=0.26)
    assert expected["memory"] > 0
    assert expected["seconds"] > 0


def test_the_forecast_says_that_the_domain_cuts_the_contact_off(tmp_path: Path, capsys: Capture) -> None:
    """Hertz radius 165 um on a half side of 50 um."""
    path = tmp_path / "small.toml"
    path.write_text(
        "load = 5.0\nside = 1e-4\n[upper]\nmaterial = {E = 200e9, nu = 0.3}\n"
        "surface = [{kind = 'sphere', radius = 0.1}]\n[lower]\nmaterial = {E = 118e9, nu = 0.34}\n"
        "surface = [{kind = 'flat'}]\n[friction]\ntau = 15e6\nbeta = 0.08\n"
    )
    assert main(["solve", str(path), "--accuracy", "0.01", "--explain"]) == 0
    out = " ".join(capsys.readouterr().out.split())
    assert "is not to be reached: the domain cuts the contact off" in out


def test_it_says_what_a_frictionless_smooth_scene_does_without(capsys: Capture) -> None:
    assert main(["solve", "hertz", "--grid", "64", "--explain"]) == 0
    lines = capsys.readouterr().out.splitlines()
    for name in LABELS.values():
        row = next(line for line in lines if line.strip().startswith(name))
        assert " out " in row
    assert any("no friction" in line for line in lines)


def test_json_holds_the_estimates(tmp_path: Path, capsys: Capture) -> None:
    path = tmp_path / "plan.json"
    arguments = [
        "solve",
        "table1-rough",
        "--accuracy",
        "0.05",
        "--explain",
        "--no-tilted",
        "--json",
        str(path),
    ]
    assert main(arguments) == 0
    capsys.readouterr()
    plan = json.loads(path.read_text())
    terms = {term["name"]: term for term in plan["terms"]}
    assert plan["budget"] == 0.5 * plan["demand"] == 0.025
    assert plan["grid"] is None
    assert terms["coupled"]["effect"]["area"] > 0
    assert plan["resolution"]["required"] > 4
    assert not terms["tilted"]["included"]


def test_bad_input_is_refused_as_in_a_solve(capsys: Capture) -> None:
    assert main(["solve", "hertz", "--grid", "0", "--explain"]) == 2
    assert "grid = 0" in capsys.readouterr().err


STEEP = """
load = 0.5
side = 1.0e-3
[upper.material]
E = "rigid"
nu = 0.3
[[upper.surface]]
kind = "flat"
[lower.material]
E = 1e9
nu = 0.0
[[lower.surface]]
kind = "gaussian"
rms = 10e-6
correlation_length = 100e-6
seed = 1
[friction]
beta = 0.1
"""


def test_steep_surfaces_are_told_before_anything_is_solved(tmp_path: Path, capsys: Capture) -> None:
    scene = tmp_path / "steep.toml"
    scene.write_text(STEEP, encoding="utf-8")
    assert main(["solve", str(scene), "--grid", "32", "--explain"]) == 0
    row = next(line for line in capsys.readouterr().out.splitlines() if line.startswith("  half-space"))
    # 0.7 tan(slope) for nu = 0 on a rigid flat
    assert "slopes of 19 degrees" in row
    assert row.endswith("N at a given approach may be off by 24%")


def test_a_term_has_its_changes_of_mu_and_of_the_area_in_this_order() -> None:
    term = Term("coupled", False, "small", Effect(friction=0.0123, area=0.0))
    assert _row(term) == [LABELS["coupled"], "out", "1.2e-02", "0", "small"]
