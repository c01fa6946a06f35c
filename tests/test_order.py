"""Settings of all tests: a module is imported once, whichever is collected first, and small numbers count."""

from __future__ import annotations

import subprocess
import sys

import pytest

from tests.documents import ROOT


def test_doctests_may_come_before_the_tests_of_their_module() -> None:
    """The test pickles a class of the module: with a second copy of the module it is another class."""
    paths = ("refimpl/solution/limits.py", "tests/refimpl/solution/test_limits.py")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *paths, "-k", "notes_are_read"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def test_numbers_below_the_usual_absolute_tolerance_are_compared() -> None:
    """`tests.conftest` removes it: compliances of 1e-17 and 2e-17 m/Pa are not equal, nor is 1e-300 zero."""
    assert pytest.approx(1e-17, rel=0.5) != 2e-17
    assert pytest.approx(0.0) != 1e-300
    assert pytest.approx([1e-17, 0.0], rel=1e-6) == [1.0000001e-17, 0.0]
