"""Every invariant of `verification.properties` for both solvers, and the nightly search of them."""

from __future__ import annotations

import ast
import json
from functools import partial
from pathlib import Path
from typing import Any

import pytest

import refimpl as rf
from tests.changed import changed
from tests.layers import ROOT
from verification.output.result_files import read_result
from verification.properties import INVARIANTS, check_solver, nightly
from verification.properties.__main__ import main
from verification.properties.nightly import SOLVERS


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("name", INVARIANTS)
def test_invariant(name: str, solver: str) -> None:
    check_solver(SOLVERS[solver], examples=6, only=[name])


def test_no_invariant_rests_on_an_assert() -> None:
    """``python -O`` drops every one."""
    for path in (ROOT / "verification/properties").glob("*.py"):
        nodes = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        assert not any(isinstance(node, ast.Assert) for node in nodes), path.name


@pytest.fixture
def two_invariants(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only two of the invariants, so that a night takes a second."""
    chosen = {name: INVARIANTS[name] for name in ("positivity", "area_and_peak")}
    monkeypatch.setattr(nightly, "INVARIANTS", chosen)


@pytest.mark.usefixtures("two_invariants")
def test_a_night_resumes_and_another_seed_starts_anew(tmp_path: Path) -> None:
    log = tmp_path / "log.json"
    assert main(["--examples", "10", "--seed", "7", "--json", str(log)]) == 0
    found = read_result(log)
    assert (found["examples"], found["counterexamples"]) == (12, 0)  # four slices of three: at least ten
    assert [line["seed"] for line in found["slices"]] == [7, 8, 9, 10]
    assert {line["solver"] for line in found["slices"]} == {"fft", "dense"}
    found["slices"][0]["claim"] = "kept"
    del found["slices"][2]
    log.write_text(json.dumps(found))
    main(["--examples", "10", "--seed", "7", "--json", str(log)])
    slices = read_result(log)["slices"]
    assert sorted(line["number"] for line in slices) == [0, 1, 2, 3]
    assert slices[0]["claim"] == "kept"
    main(["--examples", "8", "--seed", "2", "--json", str(log)])
    assert [line["seed"] for line in read_result(log)["slices"]] == [2, 3, 4, 5]


def solve_with_a_wrong_peak(scene: rf.Scene, grid: int, **keywords: Any) -> rf.Solution:
    good = rf.solve(scene, grid, method="dense", tolerance=1e-12, **keywords)
    return changed(good, max_pressure=good.max_pressure * (1 if scene.periodic else 1 + 1e-15))


@pytest.mark.usefixtures("two_invariants")
def test_a_counterexample_fails_the_night_and_is_printed_shrunk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(nightly, "SOLVERS", {"wrong": solve_with_a_wrong_peak})
    log = tmp_path / "log.json"
    assert main(["--examples", "40", "--json", str(log)]) == 1
    found = read_result(log)
    assert found["counterexamples"] == 1
    assert "Sample(bumps=((0,0),(0,0))" in "".join(found["slices"][1]["counterexample"].split())


def test_seeds_draw_other_samples() -> None:
    drawn: dict[int | None, list[float]] = {}

    def noting(seen: list[float], scene: rf.Scene, grid: int, **keywords: Any) -> rf.Solution:
        seen.append(scene.load)
        return rf.solve(scene, grid, method="dense", tolerance=1e-12, **keywords)

    for seed in (None, 1, 2):
        check_solver(partial(noting, drawn.setdefault(seed, [])), examples=5, only=["positivity"], seed=seed)
    assert drawn[1] != drawn[2] != drawn[None] != drawn[1]
