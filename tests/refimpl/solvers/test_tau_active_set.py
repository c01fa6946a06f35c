"""The rule for tau's active set on hand-made sequences, and the loop on a solver that plays contact sets."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import refimpl as rf
from refimpl.grid import Mask
from refimpl.model.state import CycleState, Status
from refimpl.solvers.tau_active_set import TauActiveSet, TauResult, iterate

ADHESIVE = rf.Friction(tau=1.0)


def mask(marks: str) -> Mask:
    """Marked elements of a row.

    >>> mask("x.")
    array([ True, False])
    """
    return np.array([mark == "x" for mark in marks])


def play(*contacts: str) -> TauActiveSet:
    rule = TauActiveSet((len(contacts[0]),))
    for contact in contacts:
        rule.next(mask(contact))
    return rule


def test_it_starts_without_tau_and_settles_on_a_contact_set_that_stays() -> None:
    rule = TauActiveSet((3,))
    assert not rule.current.any()
    rule.next(mask("xx."))
    assert not rule.settled
    rule.next(mask("xx."))
    assert rule.settled
    assert rule.cycle == ()
    assert not rule.excluded.any()


def test_no_contact_settles_at_once() -> None:
    assert play("...").settled


def test_a_cycle_of_two_excludes_what_changed() -> None:
    rule = play("xx.", "x..", "xx.")
    assert len(rule.cycle) == 2
    np.testing.assert_array_equal(rule.excluded, mask(".x."))
    np.testing.assert_array_equal(rule.current, mask("x.."))
    rule.next(mask("xx."))
    assert rule.settled


def test_a_cycle_of_three_excludes_all_that_changed_within_it() -> None:
    rule = play("xx..", "x.x.", "x..x", "xx..")
    assert len(rule.cycle) == 3
    np.testing.assert_array_equal(rule.excluded, mask(".xxx"))


def test_a_return_to_no_tau_counts_as_a_cycle() -> None:
    """The state without tau, with which the rule starts, is one of the sequence."""
    rule = play("x", ".")
    assert len(rule.cycle) == 2
    np.testing.assert_array_equal(rule.excluded, mask("x"))


def test_what_came_before_the_cycle_does_not_count() -> None:
    rule = play("xxx.", "xx..", "x...", "xx..")
    assert len(rule.cycle) == 2
    np.testing.assert_array_equal(rule.excluded, mask(".x.."))


def test_active_sets_from_before_a_cycle_was_ended_are_forgotten() -> None:
    """Without its elements contact is another function of the active set."""
    rule = play("x..xx", ".x.xx", "x..xx")
    np.testing.assert_array_equal(rule.current, mask("...xx"))
    for contact in ("..xxx", "xx.xx"):
        rule.next(mask(contact))
    assert [list(active) for active in rule.cycle] == [list(mask("...xx")), list(mask("..xxx"))]


def test_what_leaves_for_the_third_time_is_excluded_though_no_active_set_returns() -> None:
    """The others stay; the state reported is the one that it leaves."""
    on_and_off = ("x.....", ".x....", "x.x...", "...x..", "x...x.")
    rule = play(*on_and_off)
    assert rule.cycle == ()
    np.testing.assert_array_equal(rule.current, mask("x...x."))
    rule.next(mask(".....x"))
    assert [list(state) for state in rule.cycle] == [list(mask("x...x."))]
    np.testing.assert_array_equal(rule.excluded, mask("x....."))
    np.testing.assert_array_equal(rule.current, mask(".....x"))
    rule.next(mask("x....x"))
    assert rule.settled
    assert rule.cycle == ()


def test_elements_that_flip_each_at_its_own_pace_settle_soon() -> None:
    """Contact goes round in groups of 2, 3, 5 and 7: together they return after 210 active sets."""
    groups = np.split(np.arange(17), [2, 5, 10])
    rule, contact = TauActiveSet((21,)), np.zeros(21, dtype=bool)
    contact[[0, 2, 5, 10, 17, 18, 19, 20]] = True
    for _ in range(3 * 7 + 1):
        rule.next(contact)
        for group in groups:
            contact[group] = np.roll(contact[group], 1)
    assert rule.excluded[:17].all()
    assert not rule.excluded[17:].any()
    rule.next(contact)
    assert rule.settled


@pytest.mark.parametrize(
    ("wide", "narrow", "given_up"), [("xx.", "x..", False), ("xxxx", "xx..", False), ("xxx.", "x...", True)]
)
def test_a_rule_that_would_take_tau_from_most_of_the_contact_is_given_up(
    wide: str, narrow: str, given_up: bool
) -> None:
    """And nothing changes: half of the contact at most may lose tau."""
    rule = play(wide, narrow, wide)
    assert rule.given_up is given_up
    assert not rule.settled
    assert (rule.cycle == ()) is given_up
    assert rule.excluded.any() is np.bool_(not given_up)
    np.testing.assert_array_equal(rule.current, mask(narrow))


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.integers(1, 5), st.integers(0, 2**32 - 1))
def test_it_ends_whatever_contact_answers(n: int, seed: int) -> None:
    """Contact is an arbitrary but fixed function of the active set; excluded elements only grow in number."""
    random = np.random.default_rng(seed)
    answer = random.integers(0, 2, (2**n, n)).astype(bool)
    rule, count = TauActiveSet((n,)), 0
    # between two of at most 3 n active sets that elements leave, active sets grow at most n times
    for _ in range((3 * n + 1) * (n + 1)):
        rule.next(answer[int(rule.current @ 2 ** np.arange(n))])
        assert int(rule.excluded.sum()) >= count
        assert not np.any(rule.current & rule.excluded)
        count = int(rule.excluded.sum())
        if rule.settled or rule.given_up:
            break
    assert rule.settled is not rule.given_up


def test_shapes_other_than_lines() -> None:
    rule = TauActiveSet((2, 2))
    rule.next(np.eye(2, dtype=bool))
    with pytest.raises(ValueError, match=r"broadcast|shape"):
        rule.next(np.ones((3, 3), dtype=bool))


class Played:
    """A solver whose contact is given by the active set, and is the active set itself where not given.

    Solves that may end early do so on the active sets ``early``, at the residual ``at``. On ``edge`` the
    contact meets the window's edge; after ``exhausted`` and ``stagnated`` sets the solver is that.
    """

    def __init__(
        self,
        contacts: dict[str, str],
        *,
        early: tuple[str, ...] = (),
        at: float = 1e-3,
        edge: str = "",
        exhausted: str = "",
        stagnated: tuple[str, ...] = (),
    ) -> None:
        self._contacts, self._early, self._at = contacts, early, at
        self._edge, self._exhausted, self._stagnated = edge, exhausted, stagnated
        self._active, self.residual = "." * len(next(iter(contacts))), math.inf
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

    def solve(self, tolerance: float, active: Mask, excluded: Mask | None = None) -> bool:
        assert tolerance == 1e-8 or (excluded is None and tolerance == 1e-6)
        self._active = "".join("x" if on else "." for on in active)
        self.asked.append(self._active + ("" if excluded is not None else " fully"))
        early = excluded is not None and self._active in self._early
        self.residual = self._at if early else tolerance
        return not early

    def cycle_state(self) -> CycleState:
        return CycleState(float(len(self.asked)), float(self.contact.sum()))


def followed(solver: Played) -> TauResult:
    return iterate(solver, ADHESIVE, 1e-8)


def test_a_law_without_a_jump_holds_everywhere_and_needs_one_solve() -> None:
    solver = Played({"..": "x."})
    found = iterate(solver, rf.Friction(beta=0.1), 1e-8)
    assert found.settled
    assert found.solves == 1
    assert solver.asked == ["xx fully"]
    assert not found.excluded.any()


def test_the_last_state_is_the_one_that_leads_to_itself() -> None:
    solver = Played({"..": "x.", "x.": "xx", "xx": "xx"}, early=("..", "x."))
    found = followed(solver)
    assert found.settled
    assert found.cycle_states == ()
    assert solver.asked == ["..", "x.", "xx"]
    assert found.solves == 3


@pytest.mark.parametrize(
    ("early", "again", "states"),
    [
        ((), [], (CycleState(3, 1), CycleState(2, 2))),
        (("..",), [], (CycleState(3, 1), CycleState(2, 2))),
        (("xx",), ["xx fully"], (CycleState(4, 1), CycleState(2, 2))),
        (("x.", "xx"), ["xx fully", "x. fully"], (CycleState(4, 1), CycleState(5, 2))),
    ],
)
def test_states_of_a_cycle_whose_solve_ended_early_are_solved_again_to_be_reported(
    early: tuple[str, ...], again: list[str], states: tuple[CycleState, ...]
) -> None:
    """And the rule goes on without the elements that changed in the cycle."""
    solver = Played({"..": "x.", "x.": "xx", "xx": "x."}, early=early)
    found = followed(solver)
    assert found.cycle_states == states
    assert found.settled
    assert np.array_equal(found.excluded, mask(".x"))
    assert solver.asked == ["..", "x.", "xx", *again, "x."]
    assert found.solves == len(solver.asked)


def test_states_of_a_cycle_whose_mu_is_known_already_are_not_solved_again() -> None:
    solver = Played({"..": "x.", "x.": "xx", "xx": "x."}, early=("x.", "xx"), at=1e-6)
    assert followed(solver).cycle_states == (CycleState(3, 1), CycleState(2, 2))
    assert solver.asked == ["..", "x.", "xx", "x."]


def test_a_contact_that_meets_the_windows_edge_ends_the_loop() -> None:
    solver = Played({"..": "x.", "x.": "xx"}, edge="x.")
    assert not followed(solver).settled
    assert solver.asked == ["..", "x."]


def test_an_exhausted_solver_ends_the_loop() -> None:
    solver = Played({"..": "x.", "x.": "xx"}, exhausted="x.")
    assert not followed(solver).settled
    assert solver.asked == ["..", "x."]


def test_where_the_rule_gives_up_the_last_state_is_solved_fully() -> None:
    contacts = {"..": "xx", "xx": "x.", "x.": ".x", ".x": "xx"}
    solver = Played(contacts, early=("..", "xx", "x.", ".x"))
    found = followed(solver)
    assert not found.settled
    assert found.cycle_states == ()
    assert not found.excluded.any()
    assert solver.asked == ["..", "xx", "x.", ".x", ".x fully"]
    assert solver.residual == 1e-8


def test_a_sequence_without_end_is_given_up() -> None:
    """After 200 active sets; here the contact is always one element larger."""
    sets = ["x" * k + "." * (300 - k) for k in range(300)]
    solver = Played(dict(pairwise(sets)))
    found = followed(solver)
    assert not found.settled
    assert found.solves == 200


@pytest.mark.parametrize(
    ("stagnated", "ends_at"),
    [
        (("....", "x..."), None),
        (("....", "x...", "xxx."), None),
        (("....", "xx..", "xxx."), None),
        (("....", "x...", "xx.."), "xx.."),
        (("x...", "xx..", "xxx."), "xxx."),
    ],
)
def test_three_stagnated_states_in_a_row_end_the_loop(
    stagnated: tuple[str, ...], ends_at: str | None
) -> None:
    """Fewer do not: a state that comes after them may converge, and be lawful."""
    sets = ["....", "x...", "xx..", "xxx.", "xxxx"]
    solver = Played(dict(pairwise(sets)), stagnated=stagnated)
    found = followed(solver)
    assert found.settled is (ends_at is None)
    assert solver.asked[-1] == (ends_at or "xxxx")


@pytest.mark.parametrize(
    ("settled", "contact", "ended", "expected"),
    [
        (True, "x.", Status.CONVERGED, Status.CONVERGED),
        (True, "xx", Status.CONVERGED, Status.CYCLED),  # an excluded element is in contact
        (False, "x.", Status.CONVERGED, Status.ITERATION_LIMIT),
        (True, "xx", Status.STAGNATED, Status.STAGNATED),
        (False, "xx", Status.STAGNATED, Status.STAGNATED),
    ],
)
def test_the_status_of_a_solver(settled: bool, contact: str, ended: Status, expected: Status) -> None:
    assert TauResult(settled, mask(".x"), (), 1).status(mask(contact), ended) is expected
