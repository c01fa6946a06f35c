"""Terms that a solved contact shows to matter, and notes: what `solve` makes of them, once."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

import refimpl as rf
from refimpl.driver import refined
from refimpl.driver.options import Options
from refimpl.planning import terms
from refimpl.planning.term_effects import Effect

SCENE = rf.Scene(
    upper=rf.Body(rf.Material(200e9, 0.3), rf.Sphere(0.1)),
    lower=rf.Body(rf.Material(200e9, 0.31), rf.Flat()),
    friction=rf.Friction(tau=1e6, beta=0.05),
    load=20.0,
    side=1e-3,
)


@pytest.mark.parametrize(("share", "restored"), [(0.6, True), (0.4, False)])
def test_the_sum_of_all_effects_is_held_to_the_budget(
    monkeypatch: pytest.MonkeyPatch, share: float, restored: bool
) -> None:
    """Two effects of 0.6 of the budget each exceed it together; the larger one's term comes back."""
    plan = Options(scene=SCENE, accuracy=0.05).plan()
    assert set(plan.neglected) == {"coupled", "oblique"}

    def effects(names: tuple[str, ...], *_: Any) -> dict[str, Effect]:
        sizes = {"coupled": share, "oblique": share + 0.01}
        return {name: Effect(sizes.get(name, 0.0) * plan.budget, 0.0) for name in names}

    monkeypatch.setattr(refined, "effects_in", effects)
    found = rf.solve(SCENE, accuracy=0.05)
    assert found.plan.includes("oblique") is restored
    assert not found.plan.includes("coupled")


def test_what_a_named_warning_states_is_no_note_as_well() -> None:
    rough = rf.Body(SCENE.lower.material, rf.GaussianRoughness(1e-8, 1e-4, seed=3))
    found = rf.solve(replace(SCENE, lower=rough), 20)
    assert sum("correlation length" in str(w) for w in found.warnings) == 1


def test_a_cap_that_pressures_reach_costs_both_solves(monkeypatch: pytest.MonkeyPatch) -> None:
    """The plan expects no more than the mean pressure, 0.22 GPa; the peak, 0.33 GPa, reaches 0.3 GPa."""
    monkeypatch.setattr(terms, "_PEAK_OVER_MEAN", 1.0)
    soft = rf.Body(rf.Material(200e9, 0.31, hardness=0.3e9), rf.Flat())
    scene = replace(SCENE, lower=soft, load=150.0)
    elastic, capped = (rf.solve(scene, 16, plastic=given) for given in (False, True))
    assert elastic.max_pressure > 0.3e9
    assert not Options(scene=scene, grid=16).plan().includes("plastic")
    found = rf.solve(scene, 16)
    assert found.max_pressure == capped.max_pressure == 0.3e9
    assert found.cost.point_logs == elastic.cost.point_logs + capped.cost.point_logs
