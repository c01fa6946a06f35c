"""Refinement of a scene: seconds kept of each grid, and where a forecast ends."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

import refimpl as rf
from refimpl.driver import refined
from refimpl.driver.options import Options
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


@pytest.mark.parametrize(("bound", "enough", "last"), [(0.01, None, 128), (0.2, 384, 384), (0.2, None, 1024)])
def test_a_forecast_of_a_slender_scene(
    monkeypatch: pytest.MonkeyPatch, bound: float, enough: int | None, last: int
) -> None:
    """A side of 6 : 1 doubles the numbers of elements along it; bars that are met need no more grids."""
    asked: list[tuple[int, ...]] = []

    def predicted(*given: tuple[int, ...]) -> int | None:
        asked.append(given[3])
        return enough

    monkeypatch.setattr(refined, "GRID_SIZES", (64, 80, 512))
    monkeypatch.setattr(refined, "relative_bound", lambda *_: bound)
    monkeypatch.setattr(refined, "predicted_size", predicted)
    scene = replace(SCENE, side=None, size=(3e-3, 0.5e-3), load=0.1)
    options, discretiser = Options(scene=scene, accuracy=0.05), Discretiser(scene, None)
    found = refined.forecast(options, options.plan(discretiser), discretiser)
    assert [max(grid.shape) for grid in (*found.solved, found.grid)] == [64, 128, last]
    assert asked == ([] if bound < 0.05 else [[160, 1024]])
    assert found.refusal == ("1024 elements a side do not suffice" if last == 1024 else "")
