"""Which terms enter, decided before a solve, and what memory is free for it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import psutil
import pytest

import refimpl as rf
from refimpl import operating_system as module
from refimpl.grid import Grid
from refimpl.model.problem import Terms
from refimpl.operating_system import free_memory
from refimpl.planning import plan, term_effects
from refimpl.planning.expected_contact import expected_contact, solved_contact
from refimpl.planning.plan import Plan, make_plan, memory_of
from refimpl.planning.term_effects import Scales
from refimpl.scene.discretise import discretise
from refimpl.solution.quantities import REPORTED

STEEL, COPPER, RUBBER = rf.Material(200e9, 0.30), rf.Material(118e9, 0.30), rf.Material(10e6, 0.5)
SMOOTH = rf.read_scene("table1-smooth")
ROUGH = replace(SMOOTH, lower=rf.Body(COPPER, rf.GaussianRoughness(0.5e-6, 104e-6, seed=2)))
INCOMPRESSIBLE = replace(
    SMOOTH, upper=rf.Body(RUBBER, rf.Sphere(0.14)), lower=rf.Body(rf.Material(1e6, 0.5), rf.Flat()), load=1e-3
)
FRICTIONLESS = replace(SMOOTH, friction=rf.Friction())
TWINS = replace(SMOOTH, lower=rf.Body(STEEL, rf.Flat()))
RECTANGLE = Grid((144, 80), (1.8e-3, 1e-3))


def planned(
    scene: rf.Scene, grid: int | Grid, *, approach: float | None = None, demand: float = 1e-8, **words: bool
) -> Plan:
    """The plan of a scene on ``M x M`` elements, or on any grid, with what is requested of each term."""
    grid = scene.grid(grid) if isinstance(grid, int) else grid
    return make_plan(discretise(scene, grid, approach=approach), "fft", Terms(**words), demand=demand)


@pytest.mark.parametrize(
    ("scene", "why"),
    [(TWINS, "cancel"), (INCOMPRESSIBLE, "nu = 0.5 on both"), (FRICTIONLESS, "no friction")],
)
def test_exact_zeros_are_neglected_at_no_cost(scene: rf.Scene, why: str) -> None:
    chosen = planned(scene, 32)
    term = chosen.term("coupled")
    assert not term.included
    assert why in term.reason
    assert term.effect == term_effects.NONE
    assert "coupled" not in chosen.neglected


def test_with_a_grid_alone_nothing_that_shear_does_is_small_enough() -> None:
    chosen = planned(ROUGH, 64)
    assert chosen.demand == 1e-8
    assert chosen.neglected == ()
    assert all(chosen.includes(name) for name in ("coupled", "oblique", "tilted", "active_set"))


@pytest.mark.parametrize("accuracy", [0.3, 0.001])
def test_what_is_neglected_stays_within_its_budget(accuracy: float) -> None:
    chosen = planned(ROUGH, 256, demand=accuracy)
    assert chosen.budget == 0.5 * accuracy
    assert sum(chosen.term(name).effect.larger for name in chosen.neglected) <= chosen.budget
    rest = [t for t in chosen.terms if t.included and t.name in ("coupled", "oblique")]
    spent = sum(chosen.term(name).effect.larger for name in chosen.neglected)
    assert all(spent + term.effect.larger > chosen.budget for term in rest)


def test_the_user_has_the_last_word() -> None:
    for word in (True, False):
        chosen = planned(ROUGH, 64, coupled=word, oblique=True, tilted=word, demand=0.5)
        assert chosen.includes("coupled") is word
        assert chosen.includes("tilted") is word
        assert chosen.term("coupled").reason == ("requested" if word else "excluded")
    assert not planned(ROUGH, 64, oblique=False).includes("tilted")
    assert planned(ROUGH, 64, oblique=True, demand=0.5).includes("oblique")


def test_a_slope_correction_needs_the_coupling() -> None:
    with pytest.raises(rf.InputError) as caught:
        planned(ROUGH, 16, slope_correction=True, coupled=False)
    assert caught.value.field == "coupled"


def test_tau_that_moves_nothing_has_no_active_set_to_iterate() -> None:
    chosen = planned(TWINS, 32, oblique=False)
    assert not chosen.includes("active_set")
    assert "moves nothing" in chosen.term("active_set").reason


@pytest.mark.parametrize("grid", [SMOOTH.grid(128), RECTANGLE], ids=str)
def test_hertz_is_expected(grid: Grid) -> None:
    """Area, approach and mean pressure of the smooth ball, to the grid's resolution."""
    problem = discretise(SMOOTH, grid)
    contact = expected_contact(problem)
    radius = (3 * 70.0 * 0.14 / (4 * problem.pair.reduced_modulus)) ** (1 / 3)
    area = np.pi * radius**2
    assert contact.elements * grid.element_area == pytest.approx(area, rel=0.03)
    assert contact.mean_pressure == pytest.approx(70.0 / area, rel=0.03)
    assert contact.approach == pytest.approx(radius**2 / 0.14, rel=0.03)
    assert contact.symmetric
    assert contact.mirrored
    assert contact.patches == 1


def test_a_rough_contact_is_expected_within_a_factor_of_two() -> None:
    s = rf.solve(ROUGH, 128)
    expected = s.plan.contact
    found = solved_contact(s.details.problem, s.pressure, s.details.clearance, expected)
    assert 0.5 < expected.elements / found.elements < 2
    assert 0.5 < expected.pressure / found.pressure < 2
    assert 0.5 < expected.slope_squared / found.slope_squared < 2
    assert 0.5 < expected.approach / s.approach < 2


def test_memory_is_that_of_all_elements_and_a_refusal_names_the_longer_side(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    square, oblong = SMOOTH.grid(48), Grid((24, 96), (1e-3, 4e-3))
    for method in plan.METHODS:
        assert memory_of(method, square) == memory_of(method, oblong)
    chosen = planned(SMOOTH, 256)
    room = memory_of("fft", square, extent=chosen.contact.extent)
    monkeypatch.setattr(plan, "free_memory", lambda: room)
    monkeypatch.setattr(plan, "UNREAD", 0)
    assert memory_of("fft", oblong) < chosen.on(oblong).memory == room
    for refuse in (lambda grid: memory_of("fft", grid, extent=chosen.contact.extent), chosen.on):
        with pytest.raises(rf.InputError, match=r"grid = 97: .* GB") as refused:
            refuse(Grid((24, 97), (1e-3, 4e-3)))
        assert refused.value.field == "grid"


def test_shear_tilts_the_common_surface_of_twins() -> None:
    """Twins do not couple, but shear moves both surfaces alike: F loses what the estimate says."""
    strong = replace(TWINS, friction=rf.Friction(beta=0.5), load=7000.0, side=6e-3)
    tilted, level = (rf.solve(strong, 64, tilted=word) for word in (True, False))
    lost = level.friction_coefficient - tilted.friction_coefficient
    scales = Scales(tilted.plan.contact, tilted.details.problem.pair, strong.friction)
    assert "shear" in tilted.cost.applications
    assert "shear" not in level.cost.applications
    assert 0 < lost <= term_effects.tilted(scales).friction * scales.mu < 3 * lost


def test_slopes_neglected_in_a_frictionless_scene_leave_mu_open() -> None:
    """All of mu, and of Q, is theirs: it was told as 0 without a bar."""
    scene = replace(ROUGH, friction=rf.Friction())
    s = rf.solve(scene, accuracy=0.1)
    assert "oblique" in s.plan.neglected
    full = rf.solve(scene, max(s.grid.shape), oblique=True)
    for name in ("friction_coefficient", "friction_force", "binormal_force"):
        assert getattr(s, name) == 0.0
        assert 0 < abs(getattr(full, name)) <= s.uncertainty[name]["neglected"], name


@pytest.mark.parametrize("at_approach", [False, True])
def test_neglected_terms_are_in_the_error_bars_of_all_numbers(at_approach: bool) -> None:
    """Of the approach and the corrected area as well, which followed without one; then of the force."""
    scene = rf.Scene(
        upper=rf.Body(rf.Material(6.6e10, 0.0), rf.Sphere(0.0498)),
        lower=rf.Body(rf.Material(3.55e16, 0.3), rf.Sphere(0.0699)),
        friction=rf.Friction(0.0, 0.3),
        load=14883.7,
        side=8.3517e-3,
        sliding_direction=5.2365,
    )
    approach = 5.5e-5 if at_approach else None
    s = rf.solve(scene, accuracy=0.2, quantity="contact_area", approach=approach)
    assert "coupled" in s.plan.neglected
    full = rf.solve(scene, max(s.grid.shape), approach=approach)
    given = {"approach"} if at_approach else {"normal_force"}
    for name in set(REPORTED) - given:
        left_out = s.uncertainty[name]["neglected"]
        assert abs(getattr(s, name) - getattr(full, name)) <= left_out, name
    assert "neglected" not in s.uncertainty.get(given.pop(), {})


GB = 2**30


@pytest.fixture
def system(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A machine with 8 GB free, without groups and limits."""
    (tmp_path / "proc/self").mkdir(parents=True)
    monkeypatch.setattr(module, "PROC", tmp_path / "proc")
    monkeypatch.setattr(module, "GROUPS", tmp_path / "cgroup")
    monkeypatch.setattr(psutil, "virtual_memory", lambda: SimpleNamespace(available=8 * GB))
    monkeypatch.setattr(psutil, "Process", lambda: SimpleNamespace())
    return tmp_path


def group(folder: Path, limit: str, **other: str) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in ({"memory.max": limit, "memory.current": f"{GB}"} | other).items():
        (folder / name).write_text(text)


@pytest.mark.parametrize(
    ("limit", "left"), [("max", 8), (f"{4 * GB}", 3), (f"{GB // 2}", 0), ("nonsense", 8)]
)
def test_the_group_of_the_process(limit: str, left: int, system: Path) -> None:
    (system / "proc/self/cgroup").write_text("0::/a/b\n")
    group(system / "cgroup/a/b", limit)
    assert free_memory() == left * GB


def test_groups_above_it_count_and_dropped_pages_are_free(system: Path) -> None:
    (system / "proc/self/cgroup").write_text("0::/a/b\n")
    group(system / "cgroup/a/b", "max")
    group(system / "cgroup/a", f"{3 * GB}", **{"memory.stat": f"anon 1\ninactive_file {GB // 2}\n"})
    assert free_memory() == 2 * GB + GB // 2


@pytest.mark.skipif(not hasattr(psutil, "RLIMIT_AS"), reason="psutil has no limits here")
@pytest.mark.parametrize(("which", "left"), [("RLIMIT_AS", 2 * GB), ("RLIMIT_DATA", 5 * GB // 2)])
def test_limits_of_the_process(which: str, left: int, system: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the address space 1 GB is used, of the data segment half of that."""
    limits = {getattr(psutil, which): (3 * GB, 3 * GB)}
    process = SimpleNamespace(
        memory_info=lambda: SimpleNamespace(vms=GB, data=GB // 2),
        rlimit=lambda asked: limits.get(asked, (psutil.RLIM_INFINITY, psutil.RLIM_INFINITY)),
    )
    monkeypatch.setattr(psutil, "Process", lambda: process)
    assert free_memory() == left


@pytest.mark.parametrize("share", [0.1, 0.9])
def test_slopes_across_the_edge_of_a_flat_top_are_not_negligible(share: float) -> None:
    """At a wall the common surface falls to the middle of the gap, whichever body is softer.

    A frictionless square punch: without slope terms p_max is off by more than a fifth, the approach by 1 %.
    """
    x = np.abs((np.arange(64) + 0.5) / 64 - 0.5)
    top = np.where(np.maximum(x[:, None], x) < 0.25, 0.0, -1e-5)
    soft, stiff = (rf.Material(E=modulus, nu=0.3) for modulus in (1e11, 1e11 * share / (1 - share)))
    punch, plane = rf.Body(stiff, rf.ArraySurface(top)), rf.Body(soft, rf.Flat())
    scene = rf.Scene(upper=plane, lower=punch, friction=rf.Friction(), load=50.0, side=5e-4)
    flat, planned = rf.solve(scene, 64, oblique=False), rf.solve(scene, 64)
    assert planned.plan.includes("oblique")
    assert flat.max_pressure > 1.2 * planned.max_pressure
    assert abs(flat.approach - planned.approach) > 0.01 * planned.approach
