"""Refinement of a scene: forecasts, interrupts, and terms that a solved contact shows to matter."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import pytest

import refimpl as rf
from refimpl.driver import refined
from refimpl.driver.options import Options
from refimpl.planning import terms
from refimpl.planning.term_effects import Effect
from refimpl.scene.discretise import Discretiser

SCENE = rf.Scene(
    upper=rf.Body(rf.Material(200e9, 0.3), rf.Sphere(0.1)),
    lower=rf.Body(rf.Material(3e9, 0.4), rf.Flat()),
    friction=rf.Friction(tau=1e6, beta=0.05),
    load=2.0,
    side=1e-3,
)


@pytest.mark.parametrize(("open_", "last"), [(True, 96), (False, 256)])
def test_a_forecast_goes_no_farther_than_the_data_where_they_leave_more_than_the_accuracy(
    monkeypatch: pytest.MonkeyPatch, open_: bool, last: int
) -> None:
    """Four elements a point of 24: 96, where no size up to there suffices; else up to the finest of all."""
    monkeypatch.setattr(refined, "GRID_SIZES", (64, 80, 96, 128, 256))
    monkeypatch.setattr(refined, "finest_by_data", lambda scene: 96.0)
    monkeypatch.setattr(refined, "leaves", lambda *_: open_)
    monkeypatch.setattr(refined, "predicted_size", lambda *_: None)
    options = Options(scene=SCENE, accuracy=1e-4)
    discretiser = Discretiser(SCENE, None)
    found = refined.forecast(options, options.plan(discretiser), discretiser)
    assert found.grid.shape == (last, last)
    assert [grid.shape for grid in found.solved] == [(32, 32), (64, 64)]
    assert f"{last} elements a side do not suffice" in found.refusal


def test_an_interrupt_has_the_last_finished_grid_with_its_own_bars() -> None:
    shown: list[str] = []

    def progress(line: str) -> None:
        shown.append(line)
        if stop in line:
            raise KeyboardInterrupt

    for stop in ("32 x", "next"):
        shown.clear()
        with pytest.raises(KeyboardInterrupt) as caught:
            rf.solve(replace(SCENE, side=None, size=(1e-3, 0.8e-3)), accuracy=1e-4, progress=progress)
        assert len(caught.value.args) == (stop == "next")
    (found,) = caught.value.args
    assert (found.grid.shape, found.status) == ((32, 26), rf.Status.ACCURACY_NOT_REACHED)
    assert found.warnings[-1] == "interrupted: the finest grid that was finished"
    assert found.error("contact_area") > 0
    assert shown[-2] == f"32 x 26 elements, {sum(found.cost.applications.values())} transforms"
    memory = found.plan.on(rf.Grid((64, 52), (1e-3, 0.8e-3))).memory / 1e9
    assert re.fullmatch(rf"64 x 52 elements next: about \S+ s, {memory:.2g} GB", shown[-1])


STIFF = replace(SCENE, lower=rf.Body(rf.Material(200e9, 0.31), rf.Flat()), load=20.0)


@pytest.mark.parametrize(("share", "restored"), [(0.6, True), (0.4, False)])
def test_the_sum_of_all_effects_is_held_to_the_budget(
    monkeypatch: pytest.MonkeyPatch, share: float, restored: bool
) -> None:
    """Two effects of 0.6 of the budget each exceed it together; the larger one's term comes back."""
    plan = Options(scene=STIFF, accuracy=0.05).plan()
    assert set(plan.neglected) == {"coupled", "oblique"}

    def effects(names: tuple[str, ...], *_: Any) -> dict[str, Effect]:
        sizes = {"coupled": share, "oblique": share + 0.01}
        return {name: Effect(sizes.get(name, 0.0) * plan.budget, 0.0) for name in names}

    monkeypatch.setattr(refined, "effects_in", effects)
    found = rf.solve(STIFF, accuracy=0.05)
    assert found.plan.includes("oblique") is restored
    assert not found.plan.includes("coupled")


def test_what_a_named_warning_states_is_no_note_as_well() -> None:
    rough = rf.Body(STIFF.lower.material, rf.GaussianRoughness(1e-8, 1e-4, seed=3))
    found = rf.solve(replace(STIFF, lower=rough), 20)
    assert sum("correlation length" in str(w) for w in found.warnings) == 1


def test_a_cap_that_pressures_reach_costs_both_solves(monkeypatch: pytest.MonkeyPatch) -> None:
    """The plan expects no more than the mean pressure, 0.22 GPa; the peak, 0.33 GPa, reaches 0.3 GPa."""
    monkeypatch.setattr(terms, "_PEAK_OVER_MEAN", 1.0)
    soft = rf.Body(rf.Material(200e9, 0.31, hardness=0.3e9), rf.Flat())
    scene = replace(STIFF, lower=soft, load=150.0)
    elastic, capped = (rf.solve(scene, 16, plastic=given) for given in (False, True))
    assert elastic.max_pressure > 0.3e9
    assert not Options(scene=scene, grid=16).plan().includes("plastic")
    found = rf.solve(scene, 16)
    assert found.max_pressure == capped.max_pressure == 0.3e9
    assert found.cost.point_logs == elastic.cost.point_logs + capped.cost.point_logs
