"""SlipPY (Watson 2022), its Polonsky-Keer solver, in an interpreter of its own: `programs/slippy_program.py`.

SlipPY 0.5.2 requires numpy below 1.21, so Python 3.9 at most; on 3.11 pip ends with "Cannot install on Python
version 3.11.7; only versions >=3.7,<3.11 are supported" (of an old numba). The environment variable
``SLIPPY_PYTHON`` names the interpreter that has it:

    python3.9 -m venv slippy-env && slippy-env/bin/pip install slippy==0.5.2
    SLIPPY_PYTHON=slippy-env/bin/python rough-friction verify --solver slippy

A start of it takes some two seconds, and every problem is one.
"""

from __future__ import annotations

import os
import shlex
import subprocess
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path

from verification.adapters.published_code import PublishedAnswer, PublishedCode
from verification.solver_suite.command import Command
from verification.solver_suite.protocol import Abilities, ContactProblem

INTERPRETER = "SLIPPY_PYTHON"
SECONDS = 300.0
"""Limit for one problem."""
PROGRAM = Path(__file__).parent / "programs" / "slippy_program.py"
ABILITIES = Abilities(approach=False, rectangle=True)
"""``polonsky_and_keer`` takes loads, and its influence matrices square elements."""


@cache
def version_of(interpreter: str) -> str | None:
    """Return the version of SlipPY that an interpreter has, or None."""
    ask = "from importlib.metadata import version; print(version('slippy'))"
    try:
        done = subprocess.run(
            [interpreter, "-c", ask], capture_output=True, encoding="utf-8", timeout=60, check=True
        )
    except (OSError, subprocess.SubprocessError):
        return None
    return done.stdout.strip() or None


@dataclass(frozen=True)
class Elsewhere(PublishedCode):
    """A peer that another interpreter has."""

    @property
    def installed(self) -> str | None:
        """The version that the interpreter of ``SLIPPY_PYTHON`` has, or None."""
        interpreter = os.environ.get(INTERPRETER)
        return version_of(interpreter) if interpreter else None


def press(problem: ContactProblem, *, option: str = "") -> PublishedAnswer:
    """Return the program's pressures; ``option`` is ``--frequency`` for SlipPY's default in free space."""
    words = [os.environ[INTERPRETER], str(PROGRAM), *shlex.split(option)]
    answer = Command(tuple(words), ABILITIES, SECONDS)(problem)
    return PublishedAnswer(answer.pressure, answer.converged)


solve = Elsewhere(
    distribution="slippy",
    extra="",
    setup="polonsky_and_keer; free: influence in space (use_frequency_domain=False), periodic: by "
    "frequencies, with zero_frequency_value 0",
    abilities=ABILITIES,
    press=press,
    wrong="its default in free space (use_frequency_domain=True), a negative control here, takes periodic "
    "influence on twice the domain",
    needs=f"an interpreter (Python 3.9) with slippy 0.5.2, named by the environment variable {INTERPRETER}",
)
"""Solver under test."""

by_default = replace(
    solve,
    setup="the same with its default in free space, influence by frequencies, which is periodic",
    press=partial(press, option="--frequency"),
)
"""SlipPY's default set-up of a free half-space."""
