"""`check_solver` raises by itself: ``python -O`` drops every assert."""

from __future__ import annotations

import ast
import subprocess
import sys

from tests.layers import ROOT

PROGRAM = """
from dataclasses import replace
import refimpl as rf
from verification.properties import check_solver
def wrong(scene, grid, **options):
    found = rf.solve(scene, grid, **options)
    return replace(found, pressure=1.5 * found.pressure, normal_force=1.5 * found.normal_force)
try:
    check_solver(wrong, examples=2, only=["load_balance"])
except AssertionError:
    print("raised")
"""


def test_a_wrong_solver_is_refused_without_asserts() -> None:
    done = subprocess.run(
        [sys.executable, "-O", "-c", PROGRAM], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.stdout.strip() == "raised", done.stderr


def test_no_invariant_rests_on_an_assert() -> None:
    for path in (ROOT / "verification/properties").glob("*.py"):
        found = [
            n for n in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(n, ast.Assert)
        ]
        assert found == [], path.name
