"""Cases of the covering designs: one problem each, held to the claim by its recomputed residual.

A case of ``memory`` poses three in turn. A flat periodic gap stores no energy: its pressure is the mean one.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from verification.contestants.check import CLAIMS, Entrant, Pressed, check
from verification.contestants.checks.residuals import CLAIM, PERIODIC_SOURCE, SOURCE, judged
from verification.contestants.design import in_turn, posed, rows
from verification.framework.case import Measured


def _judged(entrant: Entrant, pressed: Pressed) -> Measured:
    problem, f = pressed.problem, pressed.pressure
    if not problem.periodic or problem.load is None or problem.gap.any():
        return judged(entrant, pressed)
    mean = problem.load / problem.area
    off = float(np.abs(f / mean - 1).max())
    return Measured(off**2 / entrant.claim, unit=CLAIMS, note=f"off the mean pressure by {off:.1e}")


def _declare(design: str, number: int, row: dict[str, Any]) -> None:
    levels = ", ".join(f"{name} {level}" for name, level in row.items())

    @check(
        f"design-{design}-{number:02}",
        title=f"Covering design, {design}, problem {number}",
        claim=f"The residuals meet the claim with {levels}",
        source=PERIODIC_SOURCE if row["borders"] == "periodic" else SOURCE,
        metric="at_most",
        tolerance=1.01,
        tolerance_reason=CLAIM,
        catches=(),
    )
    def covered(entrant: Entrant) -> Measured:
        answers = [entrant.pose(posed(each, number, entrant.claim)) for each in in_turn(row)]
        return max((_judged(entrant, each) for each in answers), key=lambda found: found.value)


for _design, _rows in rows().items():
    for _number, _row in enumerate(_rows, start=1):
        _declare(_design, _number, _row)
