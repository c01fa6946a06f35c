"""Cases of the covering design: one problem each, held to the claim by its recomputed residual."""

from __future__ import annotations

from typing import Any

from verification.contestants.asking import ask
from verification.contestants.check import Entrant, Pressed, check
from verification.contestants.checks.residuals import CLAIM, PERIODIC_SOURCE, SOURCE, judged
from verification.contestants.design import posed, rows
from verification.framework.case import Measured


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
        problem = posed(row, number, entrant.claim)
        return judged(entrant, Pressed(problem, ask(entrant.contestant, problem)))


for _design, _rows in rows().items():
    for _number, _row in enumerate(_rows, start=1):
        _declare(_design, _number, _row)
