"""`rough-friction solve --budget`: the table's parts, the JSON, and tolerances read from the scene's file."""

from __future__ import annotations

import importlib
import json
import math
import os
import warnings
from dataclasses import replace
from pathlib import Path

import pytest

import refimpl as rf
from refimpl.sensitivities.budget import Budget, Budgets
from refimpl.sensitivities.sensitivity import NUMBERS, Sensitivity
from verification.cli import budget as lines
from verification.cli import main


def test_a_scene_with_tolerances_gets_a_budget(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene, found = tmp_path / "scene.toml", tmp_path / "found.json"
    text = rf.scene_to_toml(rf.read_scene("table1-smooth"))
    scene.write_text(text + '\n[tolerances]\n"friction.tau" = 0.1\n')
    assert main(["solve", str(scene), "--grid", "48", "--json", str(found)]) == 0
    shown = capsys.readouterr().out
    for word in ("numerical", "input", "friction.tau, 0.1", "sampling", "model form", "cosines", "total"):
        assert word in shown
    stated = json.loads(found.read_text())["budget"]
    mu = stated["numbers"]["friction_coefficient"]
    assert mu["inputs"]["friction.tau"] == pytest.approx(mu["input"])
    independent = math.hypot(mu["numerical"], mu["input"])
    assert mu["total"] == pytest.approx(mu["model_form"] + independent)
    assert set(stated["derivatives"]) == set(NUMBERS)


def test_a_budget_repeats_no_warning_of_the_surfaces(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The solution has it: "correlation length" where elements exceed a quarter of one."""
    scene, found = tmp_path / "scene.toml", tmp_path / "found.json"
    rough = rf.GaussianRoughness(rms=1e-7, correlation_length=5e-5, seed=3)
    smooth = rf.read_scene("table1-smooth")
    scene.write_text(rf.scene_to_toml(replace(smooth, lower=rf.Body(smooth.lower.material, rough))))
    with warnings.catch_warnings(record=True) as raw:
        warnings.simplefilter("always")
        assert main(["solve", str(scene), "--grid", "48", "--budget", "--json", str(found)]) == 0
    assert [str(w.message) for w in raw] == []
    assert capsys.readouterr().out.count("warning (correlation length)") == 1
    told = json.loads(found.read_text())["warnings"]
    assert sum("correlation length" in w["text"] for w in told) == 1


def toleranced(folder: Path) -> str:
    path = folder / "scene.toml"
    text = rf.scene_to_toml(rf.read_scene("table1-smooth"))
    path.write_text(text + '\n[tolerances]\n"friction.tau" = 0.1\n')
    return str(path)


def test_an_interrupted_budget_leaves_the_solution(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(importlib.import_module("refimpl.sensitivities.budget"), "budget", interrupted)
    found = tmp_path / "found.json"
    assert main(["solve", toleranced(tmp_path), "--grid", "16", "--json", str(found)]) == 130
    assert "status: CONVERGED" in capsys.readouterr().out
    assert json.loads(found.read_text())["status"] == "converged"


def test_standard_output_holds_one_document(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["solve", toleranced(tmp_path), "--grid", "16", "--json", "-"]) == 0
    assert "budget" in json.loads(capsys.readouterr().out)


def test_a_pipe_is_given_one_document(tmp_path: Path) -> None:
    pipe = tmp_path / "found"
    os.mkfifo(pipe)
    kept = os.open(pipe, os.O_RDWR)  # a reader that does not leave; the document fits into the pipe
    try:
        assert main(["solve", toleranced(tmp_path), "--grid", "16", "--json", str(pipe)]) == 0
        assert "budget" in json.loads(os.read(kept, 2**16))
    finally:
        os.close(kept)


@pytest.mark.parametrize(
    ("options", "status", "why"),
    [
        (["--approach", "3e-6"], 0, "at a prescribed approach"),
        (["--approach", "0"], 1, "at a prescribed approach"),
        (["--tolerance", "1e-300"], 1, "does not hold"),
        (["--tolerance", "1e-300", "--budget"], 1, "does not hold"),
    ],
)
def test_a_result_that_can_have_no_budget_says_why(
    options: list[str], status: int, why: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = tmp_path / "found.json"
    command = ["solve", toleranced(tmp_path), "--grid", "16", "--json", str(found)]
    assert main([*command, *options]) == status
    shown = capsys.readouterr()
    assert "friction coefficient mu" in shown.out
    (remark,) = (line for line in shown.out.splitlines() if line.startswith("no uncertainty budget: "))
    assert why in remark
    assert shown.err == ""
    assert json.loads(found.read_text())["budget"] is None


def test_a_budget_at_an_approach_is_refused(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delattr(rf, "solve")
    assert main(["solve", "hertz", "--approach", "3e-6", "--budget"]) == 2
    assert "--approach = 3e-06: expected none with --budget" in capsys.readouterr().err


def test_no_budget_unless_asked_for(tmp_path: Path) -> None:
    found = tmp_path / "found.json"
    assert main(["solve", "hertz", "--grid", "32", "--json", str(found)]) == 0
    assert "budget" not in json.loads(found.read_text())


def test_bad_tolerances_are_bad_input(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(rf.scene_to_toml(rf.read_scene("hertz")) + '\n[tolerances]\n"upper.colour" = 0.1\n')
    assert main(["solve", str(scene)]) == 2
    assert "upper.colour" in capsys.readouterr().err


def test_unbounded_and_missing_parts_are_named() -> None:
    empty: dict[str, dict[str, float]] = {number: {"load": 0.0} for number in NUMBERS}
    derivatives = Sensitivity(dict.fromkeys(NUMBERS, 0.0), {"load": 1.0}, empty, empty, 0.0)
    numbers = {"friction_coefficient": Budget(0.1, 0.001, {}, {"coefficients": math.inf})}
    shown = lines.table(Budgets(numbers, derivatives))
    assert "unbounded" in shown
    sampling = next(line for line in shown.splitlines() if "sampling" in line)
    assert sampling.split()[-1] == "-"
