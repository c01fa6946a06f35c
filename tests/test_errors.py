"""Both packages' InputError: the message names everything, and survives the way between processes."""

from __future__ import annotations

import pickle

import pytest

import appendix_a.errors
import refimpl.errors


@pytest.mark.parametrize("kind", [refimpl.errors.InputError, appendix_a.errors.InputError])
def test_an_input_error_can_be_pickled(kind: type[refimpl.errors.InputError]) -> None:
    error = kind("load", -1.0, "a positive force in N")
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is kind
    assert str(again) == str(error) == "load = -1.0: expected a positive force in N"
    assert (again.field, again.value, again.allowed) == ("load", -1.0, "a positive force in N")
