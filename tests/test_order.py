"""Tests and doctests in any order: a module is imported once, whichever is collected first."""

from __future__ import annotations

import subprocess
import sys

import pytest

from tests.documents import ROOT


@pytest.mark.parametrize(
    "paths",
    [
        ("refimpl/solution/limits.py", "tests/refimpl/solution/test_limits.py::test_notes_are_read_like_warnings"),
        ("refimpl/planning/terms.py", "tests/refimpl/planning/test_plan.py::test_exact_zeros_are_neglected_at_no_cost"),
    ],
)  # fmt: skip
def test_doctests_may_come_before_the_tests_of_their_module(paths: tuple[str, str]) -> None:
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *paths]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
