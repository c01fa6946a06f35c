"""Which elements are in contact: those where f > 0, and no others.

An answer within a claim g may take an element for the wrong one only in doubt: its squared energy-norm error
is at most half of g (proven), so an element that should carry more than 10 sqrt(g) of the peak must be
loaded, and an element whose own displacements leave more than 4 sqrt(g) of the approach open must be
free. That is 1 % and 0.4 % at the laxest claim, 1e-6. On these gaps no element is so near to changing sides
(both bounds are computed in the tests), so that nothing is excused.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from refimpl.grid import Array
from verification.framework.case import Measured
from verification.solver_suite import reference_solution
from verification.solver_suite.check import Check, Entrant, Judge, pressing
from verification.solver_suite.check import Fault as F
from verification.solver_suite.checks.invariance import LOAD
from verification.solver_suite.checks.residuals import PIVOTING, wavy
from verification.solver_suite.gaps import rough_bump

BEYOND_DOUBT = "a number of elements; none can change sides within the laxest claim"
NOTHING = "a number of elements; with zero pressures every condition holds exactly"
ALONE = "f (u + gap - approach) = 0"
CATCHES = (F.FAINT_PRESSURE, F.TRANSPOSED, F.HALF_ELEMENT)


def sides(gap: Array, **how: Any) -> Judge:
    """Return the judge that counts elements in contact that should not be, or the other way round."""
    press = pressing(gap, **how)

    def judge(entrant: Entrant) -> Measured:
        pressed = press(entrant)
        exact = reference_solution.eliminated(pressed.problem)
        inside, outside = (pressed.pressure > 0) & (exact <= 0), (pressed.pressure <= 0) & (exact > 0)
        counts = [int(np.count_nonzero(wrong)) for wrong in (inside, outside)]
        note = f"{counts[0]} elements wrongly in contact, {counts[1]} wrongly out of it"
        return Measured(sum(counts), unit="elements", note=note)

    return judge


def apart(gap: Array, near: float, far: float, **how: Any) -> Judge:
    """Return the judge that counts elements with pressure out of reach, after an approach within reach.

    It raises ValueError where nothing presses within reach either: that would be no answer, but a habit.
    """

    def judge(entrant: Entrant) -> Measured:
        if not pressing(gap, deep=near, **how)(entrant).pressure.any():
            raise ValueError("nothing presses within reach either")
        empty = pressing(gap, deep=far, **how)(entrant)
        return Measured(int(np.count_nonzero(empty.pressure)), unit="elements")

    return judge


# fmt: off
CHECKS = (
    Check("contact-set", "A rough bump: which elements touch",
          "f > 0 on the elements of elimination's contact, and on no other", PIVOTING, 0.0, BEYOND_DOUBT,
          (*CATCHES, F.MODULUS_DOUBLED, F.PERIODIC_FOR_APERIODIC, F.MEAN_PRESSURE_LOST),
          sides(rough_bump(16, 82), load=LOAD)),
    Check("contact-set-periodic", "A periodic rough plane at a prescribed approach: which elements touch",
          "At an approach of the mean planes f > 0 on the elements of elimination's contact, and on no other",
          PIVOTING, 0.0, BEYOND_DOUBT, (*CATCHES, F.APERIODIC_FOR_PERIODIC, F.MEAN_PRESSURE_ADDED),
          sides(wavy(17, 80), deep=-0.5, periodic=True)),
    Check("out-of-reach", "A rough bump drawn back: nothing touches",
          "At an approach short of first contact no element has any pressure, and that is an answer",
          ALONE, 0.0, NOTHING, (F.APPROACH_FORGOTTEN,), apart(rough_bump(16, 45), 0.05, -0.05)),
    Check("out-of-reach-periodic", "A periodic rough plane drawn back: nothing touches",
          "Where the mean planes are farther apart than the highest peak no element has any pressure",
          ALONE, 0.0, NOTHING, (F.APPROACH_FORGOTTEN,), apart(wavy(16, 45), -0.6, -1.1, periodic=True)),
)
# fmt: on
