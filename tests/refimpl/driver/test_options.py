"""Options of a solve, limits and interrupts of a refinement, terms that a solved contact restores."""

from __future__ import annotations

import re
import time
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.driver import on_grid
from refimpl.driver.limits import Allowance, Limits
from refimpl.driver.options import Options
from refimpl.planning import terms
from refimpl.planning.term_effects import Effect

BALL, SOFT = rf.Body(rf.Material(200e9, 0.3), rf.Sphere(0.1)), rf.Material(3e9, 0.4, hardness=0.2e9)
HARD = rf.Scene(BALL, rf.Body(SOFT, rf.Flat()), rf.Friction(1e6, 0.05), 2.0, size=(1e-3, 0.8e-3))
ELASTIC = replace(HARD, lower=rf.Body(replace(SOFT, hardness=None), rf.Flat()))


def asked(**given: Any) -> Options:
    options: dict[str, Any] = {"scene": HARD, "grid": 8}
    return Options(**options | given)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"method": "fem"}, "method = 'fem': expected one of dense, fft, paper"),
        (
            {"method": "paper", "scene": replace(HARD, upper=HARD.lower, periodic=True)},
            "method = 'paper': expected dense or fft for a periodic",
        ),
        ({"scene": replace(HARD, load=161.0)}, "load = 161.0: expected at most 160 N, the softer"),
        ({"limits": Limits(max_seconds=9.0)}, "max_seconds = 9.0: expected none without an accuracy"),
    ],
)
def test_what_is_no_option_is_refused_with_what_would_do(given: dict[str, Any], said: str) -> None:
    with pytest.raises(rf.InputError, match=f"^{re.escape(said)}"):
        asked(**given)


def test_tolerances_and_quantities_by_default() -> None:
    """An accuracy of 0.2 % takes a thousandth of it; the paper's own tolerance of the load is 1e-4."""
    own = asked(), asked(grid=None, accuracy=0.002), asked(method="paper"), asked(tolerance=0.2)
    assert [one.residual_tolerance for one in own] == pytest.approx([1e-8, 2e-6, 1e-4, 0.2])
    assert [one.plan().demand for one in own[1:]] == [0.002, 1e-4, 0.2]
    assert asked().target_quantity == "friction_coefficient_corrected"
    assert asked(scene=replace(HARD, friction=rf.Friction())).target_quantity == "contact_area"


def test_seconds_that_the_opening_grids_exceed_are_refused_by_name() -> None:
    with pytest.raises(rf.InputError, match=r"grid = 64: .*max_seconds = 1e-09"):
        rf.solve(HARD, accuracy=0.1, max_seconds=1e-9)


def test_bytes_beyond_the_limit_end_a_refinement_on_the_grid_within_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of a process that holds nothing else: a tenth more than 64 elements a side take."""
    monkeypatch.setattr(
        "psutil.Process", lambda: SimpleNamespace(memory_info=lambda: SimpleNamespace(rss=0.0))
    )
    most = 1.1 * rf.solve(HARD, 64).plan.memory
    found = rf.solve(HARD, accuracy=1e-6, max_memory=most, max_grid=256)
    assert (found.status, max(found.grid.shape)) == (rf.Status.ACCURACY_NOT_REACHED, 64)
    assert re.search(r"not to 1e-06: grid = \d+: .* beside 0 GB in use, are at most", found.warnings[0])


GRID = rf.Grid((10, 20), (1e-3, 2e-3))


@pytest.mark.parametrize(
    ("limits", "refusal"),
    [
        (Limits(max_grid=20, max_memory=2.6e9, max_seconds=1e-9), None),
        (Limits(max_grid=19), "grid = 20: .*max_grid = 19"),
        (Limits(max_memory=2.59e9), r"estimated 2.5 GB, beside 0.1 GB in use, are at most 2.59 GB"),
    ],
)
def test_the_longer_side_and_the_whole_process_count_and_no_seconds_before_any_grid(
    limits: Limits, refusal: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    in_use = SimpleNamespace(memory_info=lambda: SimpleNamespace(rss=0.1e9))
    monkeypatch.setattr("psutil.Process", lambda: in_use)
    if refusal is None:
        Allowance(limits).check(GRID, memory=2.5e9)
        return
    with pytest.raises(rf.InputError, match=refusal):
        Allowance(limits).check(GRID, memory=2.5e9)


def test_seconds_grow_as_a_transform_does_and_by_a_third_more() -> None:
    """From 200 elements to 800: 4 times as many, ln 800 / ln 200 = 1.26165, 1.3 for iterations: 6.56057."""
    allowance = Allowance(Limits())
    fine = rf.Grid((20, 40), (1e-3, 2e-3))
    assert allowance.expected_seconds(fine) == 0
    allowance.record(fine, 5.0)
    allowance.record(GRID, 3.0)  # the last one counts
    assert allowance.expected_seconds(fine) == pytest.approx(3 * 6.56057, rel=1e-6)


def test_seconds_spent_and_to_expect_are_within_the_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """19.68 s to be expected: after 10 s they fit into 29.7 s, and not into 29.6 s."""
    monkeypatch.setattr(time, "perf_counter", lambda: 100.0)
    fine = rf.Grid((20, 40), (1e-3, 2e-3))
    enough, short = (Allowance(Limits(max_seconds=most)) for most in (29.7, 29.6))
    for allowance in (enough, short):
        allowance.record(GRID, 3.0)
    monkeypatch.setattr(time, "perf_counter", lambda: 110.0)
    enough.check(fine, memory=1.0)
    with pytest.raises(rf.InputError, match=r"19.7 s to be expected, after 10 s"):
        short.check(fine, memory=1.0)


def test_an_interrupt_has_the_last_finished_grid_with_its_own_bars() -> None:
    shown: list[str] = []

    def progress(line: str) -> None:
        shown.append(line)
        if stop in line:
            raise KeyboardInterrupt

    for stop in ("32 x", "next"):
        shown.clear()
        with pytest.raises(KeyboardInterrupt) as caught:
            rf.solve(ELASTIC, accuracy=1e-4, progress=progress)
        assert len(caught.value.args) == (stop == "next")
    (found,) = caught.value.args
    assert (found.grid.shape, found.status) == ((32, 26), rf.Status.ACCURACY_NOT_REACHED)
    assert "interrupted: the finest grid that was finished" in found.warnings
    assert found.error("contact_area") > 0
    assert shown[-2] == f"32 x 26 elements, {sum(found.cost.applications.values())} transforms"
    memory = found.plan.on(rf.Grid((64, 52), (1e-3, 0.8e-3))).memory / 1e9
    assert re.fullmatch(rf"64 x 52 elements next: about \S+ s, {memory:.2g} GB", shown[-1])


STIFF = replace(ELASTIC, lower=rf.Body(rf.Material(200e9, 0.31), rf.Flat()), load=20.0)


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

    monkeypatch.setattr(on_grid, "effects_in", effects)
    found = rf.solve(STIFF, accuracy=0.05)
    assert found.plan.includes("oblique") is restored
    assert not found.plan.includes("coupled")


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_a_single_grid_is_solved_again_with_a_term_that_its_contact_shows_to_matter(
    monkeypatch: pytest.MonkeyPatch, share: float
) -> None:
    scene = replace(STIFF, friction=rf.Friction())
    plan = Options(scene=scene, grid=16).plan()
    assert plan.neglected == ("oblique",)
    effects = {"oblique": Effect(0.0, share * plan.budget)}
    monkeypatch.setattr(on_grid, "effects_in", lambda names, *_: {name: effects[name] for name in names})
    assert rf.solve(scene, 16).plan.includes("oblique") is (share > 1)


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


@pytest.mark.parametrize(
    ("heights", "side", "said"),
    [
        (1e-6, 1e-5, r"load = 2.0: expected at most 0.02 N, .*; lower: array: rms slope .* unit"),
        (1e-9, 1e-6, r"load = 2.0: expected the domain is only 1e-06 x 1e-06 m \(units"),
        (1e-8, 1e-5, r"load = 2.0: expected at most 0.02 N, the softer"),
    ],
)
def test_sizes_of_a_map_are_doubted_with_its_load(heights: float, side: float, said: str) -> None:
    z = heights * np.random.default_rng(1).normal(size=(64, 64))
    scene = rf.Scene(BALL, rf.Body(SOFT, z), rf.Friction(1e6, 0.05), 2.0, side=side)
    with pytest.raises(rf.InputError, match=f"^{said}"):
        rf.solve(scene)
