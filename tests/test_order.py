"""Tests and doctests in any order: a module is imported once, whichever is collected first."""

from __future__ import annotations

import subprocess
import sys

from tests.documents import ROOT


def test_doctests_may_come_before_the_tests_of_their_module() -> None:
    """The test pickles a class of the module: with a second copy of the module it is another class."""
    paths = ("refimpl/solution/limits.py", "tests/refimpl/solution/test_limits.py")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *paths, "-k", "notes_are_read"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
