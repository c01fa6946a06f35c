"""Both packages' InputError: the message names everything, and survives the way between processes."""

from __future__ import annotations

import pickle

import pytest

import appendix_a.errors
import refimpl
import refimpl.errors
from refimpl.accuracy.refinement import Unfinished


@pytest.mark.parametrize("kind", [refimpl.errors.InputError, appendix_a.errors.InputError])
def test_an_input_error_can_be_pickled(kind: type[refimpl.errors.InputError]) -> None:
    error = kind("load", -1.0, "a positive force in N")
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is kind
    assert str(again) == str(error) == "load = -1.0: expected a positive force in N"
    assert (again.field, again.value, again.allowed) == ("load", -1.0, "a positive force in N")


def test_all_that_a_solve_raises_has_one_base() -> None:
    own = {found for found in vars(refimpl.errors).values() if isinstance(found, type)}
    raised = {kind for kind in own if issubclass(kind, Exception)}
    assert all(issubclass(kind, refimpl.Error) for kind in (*raised, Unfinished))
    assert (refimpl.InputError.__mro__[2], refimpl.NotConverged.__mro__[2]) == (ValueError, ArithmeticError)
