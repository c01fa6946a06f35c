"""Tau's rule walked by a state that plays contact sets from a script."""

from __future__ import annotations

import math

import numpy as np
import pytest

from refimpl.model.friction import Mask
from refimpl.model.state import Visited
from refimpl.solvers import tau_active_set
from refimpl.solvers.tau_active_set import followed


def mask(marks: str) -> Mask:
    """Elements in contact, by capitals.

    >>> mask("Ab")
    array([ True, False])
    """
    return np.array([mark.isupper() for mark in marks])


class Played:
    """The contact that each support leads to; ``left`` supports are left at that residual."""

    def __init__(
        self,
        contacts: dict[str, str],
        *,
        left: str = "",
        at: float = 1e-3,
        edge: str = "",
        runs: str = "",
        sticks: str = "",
    ) -> None:
        self._contacts, self._left, self._at = contacts, left.split(), at
        self._edge, self._runs, self._sticks = edge, runs, sticks.split()
        self._support, self.residual = "", math.inf
        self.asked: list[str] = []

    @property
    def contact(self) -> Mask:
        return mask(self._contacts.get(self._support, "ab"))

    @property
    def cramped(self) -> bool:
        return self._support == self._edge

    @property
    def ran_off(self) -> bool:
        return self._support == self._runs

    @property
    def stuck(self) -> bool:
        return self._support in self._sticks

    def settle(self, tolerance: float, support: Mask, withheld: Mask | None = None) -> bool:
        assert tolerance == 1e-8 or (withheld is None and tolerance == 1e-6)
        self._support = "".join(c.upper() if on else c for c, on in zip("ab", support, strict=True))
        self.asked.append(self._support + ("" if withheld is not None else " fully"))
        left = withheld is not None and self._support in self._left
        self.residual = self._at if left else tolerance
        return not left

    def visited(self) -> Visited:
        return Visited(float(len(self.asked)), float(self.contact.sum()))


def test_the_last_state_is_the_one_that_leads_to_itself() -> None:
    state = Played({"ab": "Ab", "Ab": "AB", "AB": "AB"}, left="ab Ab")
    rule, in_cycles = followed(state, 1e-8)
    assert rule.settled
    assert in_cycles == []
    assert state.asked == ["ab", "Ab", "AB"]


@pytest.mark.parametrize(
    ("left", "again", "visited"),
    [
        ("", [], [Visited(3, 1), Visited(2, 2)]),
        ("ab", [], [Visited(3, 1), Visited(2, 2)]),
        ("AB", ["AB fully"], [Visited(4, 1), Visited(2, 2)]),
        ("Ab AB", ["AB fully", "Ab fully"], [Visited(4, 1), Visited(5, 2)]),
    ],
)
def test_states_of_a_cycle_that_were_left_early_are_settled_to_be_told(
    left: str, again: list[str], visited: list[Visited]
) -> None:
    """And the rule goes on without what changed in it."""
    state = Played({"ab": "Ab", "Ab": "AB", "AB": "Ab"}, left=left)
    rule, in_cycles = followed(state, 1e-8)
    assert in_cycles == visited
    assert rule.settled
    assert np.array_equal(rule.withheld, mask("aB"))
    assert state.asked == ["ab", "Ab", "AB", *again, "Ab"]


def test_states_of_a_cycle_whose_mu_is_known_already_are_not_settled_again() -> None:
    state = Played({"ab": "Ab", "Ab": "AB", "AB": "Ab"}, left="Ab AB", at=1e-6)
    _, in_cycles = followed(state, 1e-8)
    assert in_cycles == [Visited(3, 1), Visited(2, 2)]
    assert state.asked == ["ab", "Ab", "AB", "Ab"]


def test_what_meets_the_windows_edge_is_not_asked_where_it_leads() -> None:
    state = Played({"ab": "Ab", "Ab": "AB"}, edge="Ab")
    rule, _ = followed(state, 1e-8)
    assert not rule.settled
    assert np.array_equal(rule.current, mask("Ab"))
    assert state.asked == ["ab", "Ab"]


def test_slopes_that_run_off_end_the_path() -> None:
    state = Played({"ab": "Ab", "Ab": "AB"}, runs="Ab")
    followed(state, 1e-8)
    assert state.asked == ["ab", "Ab"]


def test_where_the_rule_gives_up_the_last_state_is_settled() -> None:
    contacts = {"ab": "AB", "AB": "Ab", "Ab": "aB", "aB": "AB"}
    state = Played(contacts, left="ab AB Ab aB")
    rule, in_cycles = followed(state, 1e-8)
    assert rule.given_up
    assert in_cycles == []
    assert state.asked == ["ab", "AB", "Ab", "aB", "aB fully"]
    assert state.residual == 1e-8


def test_a_path_without_end_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tau_active_set, "_SUPPORT_ITERATIONS", 2)
    state = Played({"ab": "Ab", "Ab": "AB", "AB": "AB"})
    assert not followed(state, 1e-8)[0].settled
    assert state.asked == ["ab", "Ab"]


def test_a_path_of_states_that_cannot_be_settled_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """A single one on the way is not the end: what comes after it may be settled, and lawful."""
    state = Played({"ab": "Ab", "Ab": "aB", "aB": "AB", "AB": "AB"}, sticks="ab Ab")
    assert followed(state, 1e-8)[0].settled  # two are not, either
    state = Played({"ab": "Ab", "Ab": "aB", "aB": "AB", "AB": "AB"}, sticks="ab Ab aB")
    assert not followed(state, 1e-8)[0].settled
    assert state.asked == ["ab", "Ab", "aB"]
    monkeypatch.setattr(tau_active_set, "_STUCK", 2)
    contacts = {"ab": "Ab", "Ab": "AB", "AB": "AB"}
    state = Played(contacts, sticks="Ab")
    assert followed(state, 1e-8)[0].settled
    state = Played({"ab": "Ab", "Ab": "aB", "aB": "AB", "AB": "AB"}, sticks="ab aB")
    assert followed(state, 1e-8)[0].settled
    state = Played(contacts, sticks="ab Ab")
    assert not followed(state, 1e-8)[0].settled
    assert state.asked == ["ab", "Ab"]
