"""Which elements are in contact: those where f > 0, and no others.

An answer within a claim g may take an element for the wrong one only in doubt: its squared energy-norm error
is at most half of g (proven), so an element that should carry more than 10 sqrt(g) of the peak must be
loaded, and an element whose own displacements leave more than 4 sqrt(g) of the approach open must be
free. That is 1 % and 0.4 % at the laxest claim, 1e-6. On these gaps no element is so near to changing sides
(both bounds are computed in the tests), so that nothing is excused.
"""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array
from verification.framework.case import Measured
from verification.solver_suite import reference_solution
from verification.solver_suite.check import Entrant, Fault, Pressed, check
from verification.solver_suite.checks.invariance import LOAD
from verification.solver_suite.checks.residuals import wavy
from verification.solver_suite.gaps import rough_bump

SOURCE = "principal pivoting (Murty 1974), written for this suite"
BEYOND_DOUBT = "a number of elements; none can change sides within the laxest claim"
NOTHING = "a number of elements; with zero pressures every condition holds exactly"
CATCHES = (Fault.FAINT_PRESSURE, Fault.TRANSPOSED, Fault.HALF_ELEMENT)


def wrong_sides(pressed: Pressed) -> Measured:
    """Number of elements that are in contact and should not be, or the other way round."""
    exact = reference_solution.eliminated(pressed.problem)
    inside, outside = (pressed.pressure > 0) & (exact <= 0), (pressed.pressure <= 0) & (exact > 0)
    counts = [int(np.count_nonzero(wrong)) for wrong in (inside, outside)]
    note = f"{counts[0]} elements wrongly in contact, {counts[1]} wrongly out of it"
    return Measured(sum(counts), unit="elements", note=note)


@check(
    "contact-set",
    title="A rough bump: which elements touch",
    claim="f > 0 on the elements of elimination's contact, and on no other",
    source=SOURCE,
    metric="at_most",
    tolerance=0.0,
    tolerance_reason=BEYOND_DOUBT,
    catches=(*CATCHES, Fault.MODULUS_DOUBLED, Fault.PERIODIC_FOR_APERIODIC, Fault.MEAN_PRESSURE_LOST),
)
def contact_set(entrant: Entrant) -> Measured:
    return wrong_sides(entrant.press(rough_bump(16, 82), 1.0, load=LOAD))


@check(
    "contact-set-periodic",
    title="A periodic rough plane at a prescribed approach: which elements touch",
    claim="At an approach of the mean planes f > 0 on the elements of elimination's contact, and on no other",
    source=SOURCE,
    metric="at_most",
    tolerance=0.0,
    tolerance_reason=BEYOND_DOUBT,
    catches=(*CATCHES, Fault.APERIODIC_FOR_PERIODIC, Fault.MEAN_PRESSURE_ADDED),
)
def contact_set_periodic(entrant: Entrant) -> Measured:
    gap = wavy(17, 80)
    return wrong_sides(entrant.press(gap, 1.0, approach=-0.5 * float(gap.mean()), periodic=True))


def touching_apart(entrant: Entrant, gap: Array, near: float, apart: float, *, periodic: bool) -> Measured:
    """Number of elements with any pressure at an approach out of reach, posed after one within reach.

    Raises ValueError where nothing presses within reach either: that would be no answer, but a habit.
    """
    if not entrant.press(gap, 1.0, approach=near, periodic=periodic).pressure.any():
        raise ValueError("nothing presses within reach either")
    empty = entrant.press(gap, 1.0, approach=apart, periodic=periodic)
    return Measured(int(np.count_nonzero(empty.pressure)), unit="elements")


@check(
    "out-of-reach",
    title="A rough bump drawn back: nothing touches",
    claim="At an approach short of first contact no element has any pressure, and that is an answer",
    source="f (u + gap - approach) = 0",
    metric="at_most",
    tolerance=0.0,
    tolerance_reason=NOTHING,
    catches=(Fault.APPROACH_FORGOTTEN,),
)
def out_of_reach(entrant: Entrant) -> Measured:
    gap = rough_bump(16, 45)
    return touching_apart(entrant, gap - gap.min(), 0.05, -0.05, periodic=False)


@check(
    "out-of-reach-periodic",
    title="A periodic rough plane drawn back: nothing touches",
    claim="Where the mean planes are farther apart than the highest peak no element has any pressure",
    source="f (u + gap - approach) = 0",
    metric="at_most",
    tolerance=0.0,
    tolerance_reason=NOTHING,
    catches=(Fault.APPROACH_FORGOTTEN,),
)
def out_of_reach_periodic(entrant: Entrant) -> Measured:
    gap = wavy(16, 45)
    mean = float(gap.mean() - gap.min())
    return touching_apart(entrant, gap, -0.6 * mean, -1.1 * mean, periodic=True)
