"""Options of the solves that repeat a scene for a derivative or a correction, and solves that fail."""

from __future__ import annotations

import importlib
from types import SimpleNamespace
from typing import Any

import pytest

import refimpl as rf
from refimpl.model.problem import Terms
from refimpl.sensitivities import half_space, surface_verdict

sensitivity = importlib.import_module("refimpl.sensitivities.sensitivity")  # no function of that name


@pytest.mark.parametrize(("facets", "plastic"), [(False, True), (True, False), (True, True)])
def test_a_scene_is_solved_again_as_it_was(
    facets: bool, plastic: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Facet tractions include shear: `coupled` is not stated then. A cap leaves none of them."""
    asked: list[Any] = []

    def solve(scene: object, shape: object, **options: object) -> object:
        asked.append((scene, shape, options))
        return SimpleNamespace(converged=len(asked) == 1, status=rf.Status.STAGNATED)

    terms = Terms(coupled=False, oblique=False, tilted=False, slope_correction=facets, plastic=plastic)
    solved: Any = SimpleNamespace(
        problem=SimpleNamespace(terms=terms), grid=rf.Grid((4, 6), (1, 1)), tolerance=1e-9
    )
    options = {
        "oblique": False, "tilted": False, "plastic": plastic, "tolerance": 1e-9,
        "coupled": None if facets else False, "slope_correction": facets and not plastic, "approach": None,
    }  # fmt: skip
    scene: Any = "scene"
    for module in (sensitivity, surface_verdict):
        monkeypatch.setattr(module, "solve", solve)
    half_space._solved(scene, solved, 3e-6)
    sensitivity.solved_again(scene, solved, plastic=plastic)
    assert asked[0] == (scene, (4, 6), options | {"approach": 3e-6})
    assert asked[1] == (scene, (4, 6), options)
    with pytest.raises(ArithmeticError, match="recession ended as stagnated"):
        half_space._solved(scene, solved, None)
    with pytest.raises(ArithmeticError, match="the solve ended as stagnated"):
        surface_verdict.surface_verdict(scene, 4)
