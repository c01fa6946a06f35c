"""The suite's former name, which scripts use, for one release."""

from __future__ import annotations

import subprocess
import sys

SCRIPT = """
from verification.contestants import own, suite
from verification.contestants.protocol import Abilities, Answer, ContactProblem
from verification.contestants.command import write_problem
from verification.solver_suite import protocol
assert Answer is protocol.Answer and own.solve.abilities.coupling and suite.identity()["cases"] == 393
"""


def test_public_modules_are_the_same_ones_by_the_former_name() -> None:
    words = [sys.executable, "-W", "default", "-c", SCRIPT]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "DeprecationWarning: verification.contestants is now verification.solver_suite" in done.stderr
