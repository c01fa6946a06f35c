"""Keys of problems, units of disproved numbers, and statuses that are a success."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from verification.framework.case import Disproved
from verification.solver_suite import numbers, own
from verification.solver_suite.protocol import Answer, ContactProblem, Coupling
from verification.solver_suite.reference.posed import _key

GAP = np.array([[0.0, 1.0, 5.0], [3.0, 2.0, 4.0]]) * 1e-7
SLIDES = Coupling(tau=2e6, beta=0.7, shear_compliance=-3e-11, sliding_direction=2.5)
WHOLE = ContactProblem(
    GAP, 1e-6, 5e9, approach=-4e-8, periodic=True, coupling=SLIDES, spacing_y=3e-6, hardness=8e8
)
LOADED = replace(WHOLE, approach=None, load=6e-3, periodic=False, coupling=None, hardness=None)


def test_a_problem_that_differs_in_one_number_is_another_one() -> None:
    others: list[dict[str, Any]] = [
        {"spacing": 2e-6}, {"spacing_y": 2e-6}, {"reduced_modulus": 1e9}, {"approach": -1e-8},
        {"hardness": 1e9}, {"approach": None, "load": 1.0}, {"periodic": False}, {"gap": GAP[::-1]},
        {"gap": GAP.reshape(3, 2)}, *({"coupling": replace(SLIDES, **{key: 0.5})} for key in vars(SLIDES)),
    ]  # fmt: skip
    posed = [WHOLE, *(replace(WHOLE, **other) for other in others)]
    assert len({_key(problem) for problem in posed}) == len(posed)


def test_a_disproved_number_is_reported_with_its_unit() -> None:
    """Three elements of 3e-12 m^2, and half of one."""
    answer = Answer(np.where(GAP < 2.5e-7, 1.0, 0.0), True, contact_area=1e-12)
    said = r"contact area 1e-12 m\^2: its pressures give 9e-12 \+- [12]e-12 m\^2"
    with pytest.raises(Disproved, match=said):
        numbers.require(LOADED, answer)


def test_that_nothing_touches_is_success_at_an_approach_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    ended = SimpleNamespace(pressure=GAP, approach=2.0, contact_area=3.0, status=rf.Status.NO_CONTACT)
    monkeypatch.setattr(own, "solved", lambda *_: ended)
    assert [own.solve(problem).converged for problem in (WHOLE, LOADED)] == [True, False]
    assert (own.solve(WHOLE).approach, own.solve(WHOLE).contact_area) == (2.0, 3.0)
