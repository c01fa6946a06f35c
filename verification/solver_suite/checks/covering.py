"""Cases of the covering designs: one problem each, held to the claim by its recomputed residual.

A case of ``memory`` poses three in turn. A flat periodic gap stores no energy: its pressure is the mean one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

import numpy as np

from verification.framework.case import Measured
from verification.solver_suite import reference_solution
from verification.solver_suite.check import CLAIMS, Check, Entrant, Judge, Pressed
from verification.solver_suite.checks.residuals import PERIODIC_SOURCE, SOURCE, held, judged, worst_in_turn
from verification.solver_suite.design import further_rows, in_turn, posed, rows, seed_of


def _judged(entrant: Entrant, pressed: Pressed) -> Measured:
    problem, f = pressed.problem, pressed.pressure
    if problem.load is None or not reference_solution.stores_no_energy(problem):
        return judged(entrant, pressed)
    mean = problem.load / problem.area
    off = float(np.abs(f / mean - 1).max())
    return Measured(off**2 / entrant.claim, unit=CLAIMS, note=f"off the mean pressure by {off:.1e}")


def _covered(row: Mapping[str, Any], seed: int) -> Judge:
    return lambda entrant: worst_in_turn(
        entrant, [entrant.pose(posed(each, seed, entrant.claim)) for each in in_turn(row)], _judged
    )


def _checks(designs: Mapping[str, Sequence[dict[str, Any]]]) -> tuple[Check, ...]:
    return tuple(
        held(
            f"design-{design}-{number:02}",
            f"Covering design, {design}, problem {number}",
            "The residuals meet the claim with "
            + ", ".join(f"{name} {level}" for name, level in row.items()),
            PERIODIC_SOURCE if row["borders"] == "periodic" else SOURCE,
            (),
            _covered(row, seed_of(design, number)),
        )
        for design, found in designs.items()
        for number, row in enumerate(found, start=1)
    )


@cache
def further() -> tuple[Check, ...]:
    """Return the checks of the further designs, which ``--thorough`` adds to the suite."""
    return _checks(further_rows())


CHECKS = _checks(rows())
