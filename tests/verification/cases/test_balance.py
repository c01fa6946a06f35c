"""What the balance cases measure, where it is not the solver's own number."""

from __future__ import annotations

from dataclasses import replace

import pytest

import refimpl as rf
from tests.changed import changed
from verification.cases.contact.balance import normal_force


def test_slopes_at_the_border_are_the_problems_whatever_the_approach() -> None:
    """Pressed until the border touches: an approach from mean planes is positive then."""
    solution = rf.solve(replace(rf.read_scene("rough-planes"), load=4000.0), 32)
    assert solution.pressure[0].any()
    for approach in (-1e-6, 1e-6):
        found = normal_force(changed(solution, approach=approach))
        assert found == pytest.approx(solution.normal_force, rel=1e-12)
