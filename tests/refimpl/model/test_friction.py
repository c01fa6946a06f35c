"""Local friction and the rule for tau's support: hand-made sequences, and that it always ends."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from refimpl.model.friction import TauSupport, local_friction
from refimpl.scene.scene import Friction


def mask(text: str) -> np.ndarray:
    return np.array([c == "x" for c in text])


def play(*contacts: str) -> TauSupport:
    rule = TauSupport((len(contacts[0]),))
    for contact in contacts:
        rule.next(mask(contact))
    return rule


def test_local_friction_is_eq_8() -> None:
    f = np.array([0.0, 2.0, 3.0])
    found = local_friction(Friction(tau=5.0, beta=0.5), f, np.array([False, True, False]))
    np.testing.assert_array_equal(found, [0.0, 6.0, 1.5])


def test_it_starts_without_tau_and_settles_on_a_contact_set_that_stays() -> None:
    rule = TauSupport((3,))
    assert not rule.current.any()
    rule.next(mask("xx."))
    assert not rule.settled
    rule.next(mask("xx."))
    assert rule.settled
    assert rule.cycle == ()
    assert not rule.withheld.any()


def test_no_contact_settles_at_once() -> None:
    assert play("...").settled


def test_a_cycle_of_two_withholds_what_changed() -> None:
    rule = play("xx.", "x..", "xx.")
    assert len(rule.cycle) == 2
    np.testing.assert_array_equal(rule.withheld, mask(".x."))
    np.testing.assert_array_equal(rule.current, mask("x.."))
    rule.next(mask("xx."))
    assert rule.settled


def test_a_cycle_of_three_withholds_all_that_changed_within_it() -> None:
    rule = play("xx..", "x.x.", "x..x", "xx..")
    assert len(rule.cycle) == 3
    np.testing.assert_array_equal(rule.withheld, mask(".xxx"))


def test_a_return_to_no_tau_counts_as_a_cycle() -> None:
    """The state without tau, with which the rule starts, is one of the sequence."""
    rule = play("x", ".")
    assert len(rule.cycle) == 2
    np.testing.assert_array_equal(rule.withheld, mask("x"))


def test_what_came_before_the_cycle_does_not_count() -> None:
    rule = play("xxx.", "xx..", "x...", "xx..")
    assert len(rule.cycle) == 2
    np.testing.assert_array_equal(rule.withheld, mask(".x.."))


def test_supports_from_before_a_cycle_was_settled_are_forgotten() -> None:
    """Without its elements contact is another function of the support."""
    rule = play("x..xx", ".x.xx", "x..xx")
    np.testing.assert_array_equal(rule.current, mask("...xx"))
    for contact in ("..xxx", "xx.xx"):
        rule.next(mask(contact))
    assert [list(support) for support in rule.cycle] == [list(mask("...xx")), list(mask("..xxx"))]


def test_what_leaves_for_the_third_time_is_withheld_though_no_support_returns() -> None:
    """The others go on as they are; the state told is the one that it leaves."""
    on_and_off = ("x.....", ".x....", "x.x...", "...x..", "x...x.")
    rule = play(*on_and_off)
    assert rule.cycle == ()
    np.testing.assert_array_equal(rule.current, mask("x...x."))
    rule.next(mask(".....x"))
    assert [list(state) for state in rule.cycle] == [list(mask("x...x."))]
    np.testing.assert_array_equal(rule.withheld, mask("x....."))
    np.testing.assert_array_equal(rule.current, mask(".....x"))
    rule.next(mask("x....x"))
    assert rule.settled
    assert rule.cycle == ()


def test_elements_that_flip_each_at_its_own_pace_settle_soon() -> None:
    """Contact goes round in groups of 2, 3, 5 and 7: together they return after 210 supports."""
    groups = np.split(np.arange(17), [2, 5, 10])
    rule, contact = TauSupport((21,)), np.zeros(21, dtype=bool)
    contact[[0, 2, 5, 10, 17, 18, 19, 20]] = True
    for _ in range(3 * 7 + 1):
        rule.next(contact)
        for group in groups:
            contact[group] = np.roll(contact[group], 1)
    assert rule.withheld[:17].all()
    assert not rule.withheld[17:].any()
    rule.next(contact)
    assert rule.settled


@pytest.mark.parametrize(
    ("wide", "narrow", "given_up"), [("xx.", "x..", False), ("xxxx", "xx..", False), ("xxx.", "x...", True)]
)
def test_a_rule_that_would_take_tau_from_most_of_the_contact_is_given_up(
    wide: str, narrow: str, given_up: bool
) -> None:
    """And everything is as before: half of the contact may lose it."""
    rule = play(wide, narrow, wide)
    assert rule.given_up is given_up
    assert not rule.settled
    assert (rule.cycle == ()) is given_up
    assert rule.withheld.any() is np.bool_(not given_up)
    np.testing.assert_array_equal(rule.current, mask(narrow))


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.integers(1, 5), st.integers(0, 2**32 - 1))
def test_it_ends_whatever_contact_answers(n: int, seed: int) -> None:
    """Contact as an arbitrary but fixed function of the support; withheld elements only grow in number."""
    random = np.random.default_rng(seed)
    answer = random.integers(0, 2, (2**n, n)).astype(bool)
    rule, count = TauSupport((n,)), 0
    # between two of at most 3 n supports that elements leave, supports grow at most n times
    for _ in range((3 * n + 1) * (n + 1)):
        rule.next(answer[int(rule.current @ 2 ** np.arange(n))])
        assert int(rule.withheld.sum()) >= count
        assert not np.any(rule.current & rule.withheld)
        count = int(rule.withheld.sum())
        if rule.settled or rule.given_up:
            break
    assert rule.settled is not rule.given_up


def test_shapes_other_than_lines() -> None:
    rule = TauSupport((2, 2))
    rule.next(np.eye(2, dtype=bool))
    with pytest.raises(ValueError, match=r"broadcast|shape"):
        rule.next(np.ones((3, 3), dtype=bool))
