"""Sets of tau on given states, and the rule's loop on a solver that plays contact sets."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import refimpl as rf
from refimpl.grid import Array, Mask
from refimpl.model.problem import Problem
from refimpl.model.state import Status
from refimpl.solvers.tau_active_set import (
    ActiveSet,
    ContactTest,
    FixedSet,
    GradualSet,
    TauResult,
    first_set,
    iterate,
)
from tests.refimpl.solvers.production.levels import BALL, problem_of

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
    assert FixedSet(on).held_traction(law, pressure, none).tolist() == [2.0, 2.0, 0.0]


@given(clearance=st.floats(-2, 2), pressure=st.sampled_from([0.0, 1e-9, 1.0]))
def test_shares_of_a_gradual_set_fall_with_the_clearance_outside_the_contact(
    clearance: float, pressure: float
) -> None:
    held = GradualSet(0.5).held_traction(
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
    ) -> None:
        self._contacts, self._edge, self._exhausted, self._stagnated = contacts, edge, exhausted, stagnated
        self._active = "?"
        self.asked: list[str] = []

    @property
    def contact(self) -> Mask:
        return mask(self._contacts.get(self._active, self._active))

    @property
    def window_too_small(self) -> bool:
        return self._active == self._edge

    @property
    def exhausted(self) -> bool:
        return self._active == self._exhausted

    @property
    def stagnated(self) -> bool:
        return self._active in self._stagnated

    def solve(self, tolerance: float, active: ActiveSet, enough: ContactTest | None = None) -> bool:
        assert tolerance == 1e-8
        if isinstance(active, FixedSet):
            self._active = "".join("x" if on else "." for on in np.atleast_1d(active.elements).ravel())
        ended = enough is not None and enough(self.contact)
        self.asked.append(self._active + (" early" if ended else ""))
        return True


def followed(solver: Played, problem: Problem = ADHESIVE) -> TauResult:
    return iterate(solver, problem, 1e-8)


def test_a_law_without_a_jump_holds_everywhere_and_needs_one_solve() -> None:
    solver = Played({"x" * 16: "x" + 15 * "."})
    found = followed(solver, problem_of(BALL, 4))
    assert (found.settled, found.solves, solver.asked) == (True, 1, ["x" * 16])
    assert not found.excluded.any()


def test_the_contact_of_the_gradual_state_is_the_active_set() -> None:
    solver = Played({"?": "xx."})
    found = followed(solver)
    assert (found.settled, found.solves, solver.asked) == (True, 2, ["? early", "xx."])
    assert found.status() is Status.CONVERGED


@pytest.mark.parametrize(("coupled", "oblique"), [(True, False), (False, True), (False, False)])
def test_the_gradual_state_may_end_early_where_tau_moves_a_surface(coupled: bool, oblique: bool) -> None:
    """By coupling or by slopes; where it moves nothing, the gradual state is the final one."""
    solver = Played({"?": "xx."})
    followed(solver, problem_of(SCENE, 4, coupled=coupled, oblique=oblique))
    assert solver.asked == ["? early" if coupled or oblique else "?", "xx."]


def test_elements_that_come_back_are_excluded() -> None:
    solver = Played({"?": "xx.", "xx.": "xxx"})
    found = followed(solver)
    assert solver.asked == ["? early", "xx."]
    assert np.array_equal(found.excluded, mask("..x"))
    assert found.status() is Status.CYCLED
    assert found.status(Status.STAGNATED) is Status.STAGNATED


def test_active_elements_out_of_contact_are_dropped_for_good() -> None:
    solver = Played({"?": "xxx.", "xxx.": "x.xx", "x.x.": "xxx."})
    found = followed(solver)
    assert solver.asked == ["? early", "xxx. early", "x.x."]
    assert np.array_equal(found.excluded, mask(".x.."))
    assert found.solves == 3


def test_a_set_that_loses_most_of_the_contact_is_given_up() -> None:
    """Of half of the contact it may: then as much of the law is left."""
    half, more = (followed(Played({"?": gradual, gradual: "xxxx"})) for gradual in ("xx..", "x..."))
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


@settings(max_examples=200)
@given(st.integers(2, 6).flatmap(lambda n: st.tuples(st.just(n), st.randoms(use_true_random=False))))
def test_any_map_from_sets_to_contacts_ends_in_a_set_within_its_contact(drawn: tuple[int, object]) -> None:
    """Without a cycle, after as many solves as there are elements, and two more, at most."""
    n, random = drawn
    draw = getattr(random, "random")  # noqa: B009
    sets = [format(k, f"0{n}b").replace("0", ".").replace("1", "x") for k in range(2**n)]
    solver = Played({s: sets[int(draw() * 2**n)] for s in ("?", *sets)})
    found = followed(solver)
    last, contact = mask(solver.asked[-1].split()[0]), solver.contact
    assert found.solves <= n + 2
    assert np.all(last <= contact)
    assert np.array_equal(found.excluded, contact & ~last)
