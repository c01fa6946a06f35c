"""Sets of tau on given states, the rule's loop on played contact sets, and on scenes."""

from __future__ import annotations

from copy import copy
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace
from typing import Literal

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import refimpl as rf
from refimpl import plain
from refimpl.grid import Array, Mask
from refimpl.model.problem import Problem
from refimpl.model.state import Status
from refimpl.operators.fft import Counter
from refimpl.solvers.production.nested_solver import solve_fft
from refimpl.solvers.production.projected_cg import ProjectedCG
from refimpl.solvers.tau_active_set import (
    ActiveSet,
    ContactTest,
    FixedSet,
    GradualSet,
    TauResult,
    first_set,
    iterate,
)
from tests.refimpl.solvers.production.levels import BALL, FAINT, level_solver, problem_of
from verification.benchmarks import problems
from verification.coverage import scenes as study

SCENE = replace(BALL, friction=rf.Friction(tau=3e6, beta=0.1))
ADHESIVE = problem_of(SCENE, 4)


def mask(marks: str) -> Mask:
    """Marked elements of a row.

    >>> mask("x.")
    array([ True, False])
    """
    return np.array([mark == "x" for mark in marks])


def none() -> Array:
    raise AssertionError("a fixed set asks for no clearance")


def test_a_fixed_set_carries_tau_whatever_the_state() -> None:
    law, pressure, on = rf.Friction(tau=2.0, beta=0.5), np.array([4.0, 0.0, 4.0]), mask("xx.")
    assert FixedSet(on).traction(law, pressure, none).tolist() == [4.0, 2.0, 2.0]
    assert FixedSet(on).shear_offset(law, pressure, none).tolist() == [2.0, 2.0, 0.0]


@given(clearance=st.floats(-2, 2), pressure=st.sampled_from([0.0, 1e-9, 1.0]))
def test_shares_of_a_gradual_set_fall_with_the_clearance_outside_the_contact(
    clearance: float, pressure: float
) -> None:
    held = GradualSet(0.5).shear_offset(
        rf.Friction(tau=2.0), np.array([pressure]), lambda: np.array([clearance])
    )
    share = 1.0 if pressure else min(max(1 - clearance / 0.5, 0.0), 1.0)
    assert held.tolist() == [2.0 * share]


def test_the_reach_is_what_tau_on_an_element_moves_the_gap_by() -> None:
    """Twice as much; where bodies do not couple, a hundredth of what pressure as large as tau would."""
    found = first_set(ADHESIVE)
    assert isinstance(found, GradualSet)
    pair, h = SCENE.materials, ADHESIVE.grid.element_size
    assert found.reach == pytest.approx(2 * abs(pair.shear_compliance) * 3e6 * 2 * h, rel=1e-12)
    turned = first_set(problem_of(replace(SCENE, upper=SCENE.lower, lower=SCENE.upper), 4))
    assert isinstance(turned, GradualSet)
    assert turned.reach == pytest.approx(found.reach, rel=1e-12)  # whichever body shear displaces more
    apart = first_set(problem_of(SCENE, 4, coupled=False))
    assert isinstance(apart, GradualSet)
    assert apart.reach == pytest.approx(2 * 0.01 * pair.normal_compliance * 3e6 * 2 * h, rel=1e-12)


class Played:
    """A solver whose contact is given by the active set, and is the active set itself where not given.

    ``"?"`` stands for the gradual state. On ``edge`` the contact meets the window's edge; after ``exhausted``
    and ``stagnated`` sets the solver is that.
    """

    def __init__(
        self,
        contacts: dict[str, str],
        *,
        edge: str = "",
        exhausted: str = "",
        stagnated: tuple[str, ...] = (),
        bears: float = 0.0,
    ) -> None:
        self._bears = bears or 1e-9
        self._contacts, self._edge, self._exhausted, self._stagnated = contacts, edge, exhausted, stagnated
        self.active = "?"
        self.asked: list[str] = []

    operator = SimpleNamespace(shear=lambda traction: 0 * traction)

    @property
    def pressure(self) -> Array:
        return np.where(self.contact, self._bears, 0.0)

    def copy(self) -> Played:
        return copy(self)

    def restore(self, copied: Played) -> None:
        vars(self).update(vars(copied))

    @property
    def contact(self) -> Mask:
        return mask(self._contacts.get(self.active, self.active))

    @property
    def window_too_small(self) -> bool:
        return self.active == self._edge

    @property
    def exhausted(self) -> bool:
        return self.active == self._exhausted

    @property
    def stagnated(self) -> bool:
        return self.active in self._stagnated

    def solve(self, tolerance: float, active: ActiveSet, enough: ContactTest | None = None) -> bool:
        assert tolerance == 1e-8
        if isinstance(active, FixedSet):
            self.active = "".join("x" if on else "." for on in np.atleast_1d(active.elements).ravel())
        ended = enough is not None and enough(self.contact)
        self.asked.append(self.active + (" early" if ended else ""))
        return True


def followed(solver: Played, problem: Problem = ADHESIVE) -> TauResult:
    return iterate(solver, problem, 1e-8)


@pytest.mark.parametrize("tau", [0.0, 1e-320])
def test_a_law_without_a_jump_that_moves_any_holds_everywhere_and_needs_one_solve(tau: float) -> None:
    solver = Played({"x" * 16: "x" + 15 * "."})
    found = followed(solver, problem_of(replace(BALL, friction=rf.Friction(tau, BALL.friction.beta)), 4))
    assert (found.settled, found.solves, solver.asked) == (True, 1, ["x" * 16])
    assert not found.excluded.any()


@pytest.mark.parametrize(
    ("contacts", "asked", "excluded"),
    [
        ({"?": "xx."}, ["? early", "xx."], "..."),  # the contact of the gradual state is the set
        ({"?": "xx.", "xx.": "xxx"}, ["? early", "xx."], "..x"),  # elements that come back
        # elements out of contact are dropped for good
        ({"?": "xxx.", "xxx.": "x.xx", "x.x.": "xxx."}, ["? early", "xxx. early", "x.x."], ".x.."),
    ],
)
def test_the_set_follows_the_contact(contacts: dict[str, str], asked: list[str], excluded: str) -> None:
    solver = Played(contacts)
    found = followed(solver)
    assert (found.settled, found.solves, solver.asked) == (True, len(asked), asked)
    assert np.array_equal(found.excluded, mask(excluded))
    assert found.status() is (Status.CYCLED if "x" in excluded else Status.CONVERGED)
    assert found.status(Status.STAGNATED) is Status.STAGNATED


@pytest.mark.parametrize(("coupled", "oblique"), [(True, False), (False, True), (False, False)])
def test_the_gradual_state_may_end_early_where_tau_moves_a_surface(coupled: bool, oblique: bool) -> None:
    """By coupling or by slopes; where it moves nothing, the gradual state is the final one."""
    solver = Played({"?": "xx."})
    followed(solver, problem_of(SCENE, 4, coupled=coupled, oblique=oblique))
    assert solver.asked == ["? early" if coupled or oblique else "?", "xx."]


@pytest.mark.parametrize(("bears", "all_on", "asked"), [(1e9, "xxx", 1), (1e9, "xx.", 1), (1e-9, "xxx", 0)])
def test_tau_on_all_of_the_contact_is_tried_once_where_it_may_hold(
    bears: float, all_on: str, asked: int
) -> None:
    """Its state is the final one if its contact is the set; else the solver is back where it was."""
    solver = Played({"?": "xx.", "xx.": "xxx", "xxx": all_on}, bears=bears)
    found = followed(solver)
    assert solver.asked[2:] == ["xxx" + (" early" if all_on != "xxx" else "")] * asked
    held = bool(asked) and all_on == "xxx"
    assert np.array_equal(found.excluded, mask("..." if held else "..x"))
    assert solver.contact.tolist() == [True] * 3
    assert found.status() is (Status.CONVERGED if held else Status.CYCLED)


def test_a_set_that_loses_most_of_the_contact_is_given_up() -> None:
    """Of half of the contact it may: then as much of the law is left."""
    lost = {"xxxx": "...x"}
    half, more = (followed(Played({"?": gradual, gradual: "xxxx"} | lost)) for gradual in ("xx..", "x..."))
    assert (half.settled, more.settled) == (True, False)
    assert more.status() is Status.ITERATION_LIMIT


@pytest.mark.parametrize(
    ("end", "state", "asked"),
    [
        ("edge", "?", ["? early"]),
        ("edge", "xx", ["? early", "xx early"]),
        ("exhausted", "xx", ["? early", "xx early"]),
    ],
)
def test_a_windows_edge_and_an_exhausted_solver_end_the_loop(end: str, state: str, asked: list[str]) -> None:
    solver = Played({"?": "xx", "xx": "x."}, **{end: state})  # type: ignore[arg-type]  # two options of one type
    assert not followed(solver).settled
    assert solver.asked == asked


def test_the_loop_has_a_limit() -> None:
    """Of 200 solves; here each loses one element."""
    sets = ["x" * k + "." * (300 - k) for k in range(300, 0, -1)]
    found = followed(Played({"?": sets[0], **dict(pairwise(sets))}))
    assert not found.settled
    assert found.solves == 200


@pytest.mark.parametrize(
    ("stagnated", "solves"), [(("?", "xxxx"), 5), (("?", "xxxx", "xxx."), 3), (("xxx.", "xx..", "x..."), 5)]
)
def test_three_solves_in_a_row_that_stagnate_end_the_loop(stagnated: tuple[str, ...], solves: int) -> None:
    solver = Played({"?": "xxxx", "xxxx": "xxx.", "xxx.": "xx..", "xx..": "x..."}, stagnated=stagnated)
    assert followed(solver).solves == solves


@settings(max_examples=60)
@given(st.integers(2, 6).flatmap(lambda n: st.tuples(st.just(n), st.randoms(use_true_random=False))))
def test_any_map_from_sets_to_contacts_ends_in_a_set_within_its_contact(drawn: tuple[int, object]) -> None:
    """Without a cycle, after as many solves as there are elements, and three more, at most."""
    n, random = drawn
    draw = getattr(random, "random")  # noqa: B009
    sets = [format(k, f"0{n}b").replace("0", ".").replace("1", "x") for k in range(2**n)]
    solver = Played({s: sets[int(draw() * 2**n)] for s in ("?", *sets)})
    found = followed(solver)
    last, contact = mask(solver.active), solver.contact
    assert len(solver.asked) <= n + 3
    assert np.all(last <= contact)
    assert np.array_equal(found.excluded, contact & ~last)


@pytest.mark.parametrize("oblique", [False, True])
def test_taus_states_are_the_same_on_any_window(oblique: bool) -> None:
    """Also where shares of tau beside the contact meet a window's edge."""
    problem = problem_of(FAINT, 80, oblique=oblique)
    everywhere = level_solver(problem).result(1e-8)
    result = solve_fft(problem, 1e-8, Counter())
    assert everywhere.status is result.status is rf.Status.CYCLED
    assert np.array_equal(result.excluded, everywhere.excluded)
    assert np.abs(result.pressure - everywhere.pressure).max() <= 1e-6 * everywhere.pressure.max()
    assert result.certificate.satisfies(1e-8)


def test_solves_that_end_early_do_not_change_the_sequence(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = problem_of(FAINT, 64)
    quick = level_solver(problem)
    short = quick.result(1e-8)
    monkeypatch.setattr(ProjectedCG, "undecided", lambda cg, stiffness, among: cg.free.size)
    thorough = level_solver(problem)
    long = thorough.result(1e-8)
    assert short.status is long.status
    assert np.array_equal(short.excluded, long.excluded)
    assert np.array_equal(short.traction > 0, long.traction > 0)
    assert np.abs(short.pressure - long.pressure).max() <= 1e-6 * long.pressure.max()
    assert quick.cg_iterations <= thorough.cg_iterations


def test_a_few_undecided_elements_do_not_hold_up_a_fine_smooth_contact() -> None:
    """In transforms friction with slopes takes at most 2.5 times the work of none: 2.4, or 2.8 if every
    element is decided before the next state. The set is the same."""
    without, coupled = (
        rf.solve(problems.scene("smooth", 512, law), grid=512, oblique=oblique)
        for law, oblique in ((rf.Friction(), False), (problems.FRICTION, True))
    )
    assert coupled.cost.point_logs <= 2.5 * without.cost.point_logs
    assert np.count_nonzero(coupled.details.excluded) == 2


def test_the_error_bar_of_the_active_set_holds_all_of_tau_on_excluded_elements() -> None:
    scene = study.random_scene(2071).scene
    found = rf.solve(scene, 128)
    spared = np.count_nonzero(found.details.excluded & (found.pressure > 0)) * found.grid.element_area
    assert spared > 0
    bar = found.uncertainty["friction_coefficient"]["active set"]
    assert bar == pytest.approx(scene.friction.tau * spared / scene.load, rel=1e-12)
    assert "active set" in found.uncertainty["contact_area"]


@pytest.mark.parametrize("method", ["fft", "dense"])
def test_tau_of_several_times_the_pressure_is_given_up(method: Literal["fft", "dense"]) -> None:
    """Most of the contact would lose it. The returned state has converged, but violates the law."""
    found = rf.solve(replace(FAINT, friction=rf.Friction(tau=2e7, beta=0.5)), 24, method=method)
    assert found.status is rf.Status.ITERATION_LIMIT
    assert found.certificate.satisfies(1e-8)
    violations = found.certificate.law_violations * found.grid.element_area
    assert found.uncertainty["friction_coefficient"]["active set"] >= 2e7 * violations / 0.1 > 0
    assert found.normal_force == pytest.approx(0.1, rel=1e-8)


def test_a_tau_in_the_wrong_unit_ends_the_dense_method_within_its_steps(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Slopes and contact follow each other for ever; the status says so, and the reason names tau."""
    steps, solve_parts = [], plain.Model.solve_parts
    monkeypatch.setattr(plain.Model, "solve_parts", lambda *given: (steps.append(1), solve_parts(*given)))
    found = rf.solve(replace(FAINT, friction=rf.Friction(tau=150e9, beta=0.08)), 8, method="dense")
    assert found.status is rf.Status.ITERATION_LIMIT
    assert len(steps) <= 150 + 50000 // 64
    assert any(str(warning).startswith("tau, 1.5e+11 Pa, is") for warning in found.warnings)
