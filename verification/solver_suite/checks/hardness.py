"""Pressures that end at a hardness: chosen ones that come back, residuals of both bounds, plastic limit."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from refimpl.grid import Array
from verification.framework.case import Measured
from verification.solver_suite.check import COMPLIANCE, MODULUS, Entrant, Fault, Pressed, check
from verification.solver_suite.checks.exact import BOUND, SOURCE
from verification.solver_suite.checks.residuals import ALWAYS, CLAIM, PERIODIC_SOURCE, judged, wavy
from verification.solver_suite.checks.residuals import SOURCE as CONDITIONS
from verification.solver_suite.gaps import rough_bump
from verification.solver_suite.pin_arrays import PEAK, PinArray, standing, uneven
from verification.solver_suite.protocol import Coupling

HARDNESS = 0.6 * PEAK
"""Hardness (Pa) of the pin arrays: some half of the pins are at it."""
BUMP, WAVY = 0.03 * MODULUS, 0.08 * MODULUS
"""Hardness (Pa) of a rough bump and of a rough plane: a quarter to a half of the contact is at it."""
SEEN = tuple(fault for fault in ALWAYS if fault is not Fault.SINGLE_PRECISION)
"""Without noise: where both bounds count no element is measured against the lowest v of all."""
OF_CAP = (Fault.HARDNESS_IGNORED, Fault.HARDNESS_CUT)


@dataclass(frozen=True, eq=False)
class YieldingPins:
    """A bed of pins, some of them at the hardness: there the bodies overlap by random depths."""

    array: PinArray

    @classmethod
    def of(cls, pressure: Array, coupling: Coupling | None = None) -> YieldingPins:
        """The free array of pressures that end at the hardness."""
        return cls(PinArray(np.minimum(pressure, HARDNESS), coupling))

    @property
    def gap(self) -> Array:
        """The gap (m) that the pressures close, less the depths where they are at the hardness."""
        depths = np.random.default_rng(7).uniform(0.05, 0.5, self.array.pressure.shape) * self.array.touch
        return self.array.gap - np.where(self.array.pressure >= HARDNESS, depths, 0.0)

    def pressed(self, entrant: Entrant, *, by_load: bool) -> tuple[Pressed, Array]:
        """Return the answer under the load, or at the approach, of the pressures, and the pressures."""
        array = self.array
        pressed = entrant.press(
            self.gap,
            1.0,
            load=array.load if by_load else None,
            approach=None if by_load else array.touch,
            coupling=array.coupling,
            hardness=HARDNESS,
        )
        return pressed, array.pressure


@check(
    "capped-pins",
    title="A bed of pins, half of them at the hardness",
    claim="Pressures that were chosen, some at the hardness over bodies that overlap, come back under a load",
    source=SOURCE,
    metric="at_most",
    tolerance=1.1,
    tolerance_reason=BOUND + "a load off by 1e-8 adds nothing that shows",
    catches=(*OF_CAP, Fault.MODULUS_OFF, Fault.TRANSPOSED, Fault.PERIODIC_FOR_APERIODIC),
)
def capped_pins(entrant: Entrant) -> Measured:
    return entrant.against(YieldingPins.of(uneven(standing(12), seed=1)).pressed(entrant, by_load=True))


@check(
    "capped-pins-approach",
    title="A bed of pins at an approach, half of them at the hardness",
    claim="Pressures that were chosen, some at the hardness, come back at a prescribed approach",
    source=SOURCE,
    metric="at_most",
    tolerance=1.1,
    tolerance_reason=BOUND + "the approach is exact",
    catches=(*OF_CAP, Fault.MODULUS_OFF, Fault.TRANSPOSED, Fault.MEAN_DISPLACEMENT_LOST),
)
def capped_pins_approach(entrant: Entrant) -> Measured:
    return entrant.against(YieldingPins.of(uneven(standing(12), seed=2)).pressed(entrant, by_load=False))


@check(
    "capped-sheared-pins",
    title="A sliding bed of pins, half of them at the hardness",
    claim="With shear tau + beta f, at the hardness tau + beta H, the chosen pressures come back",
    source=SOURCE,
    metric="at_most",
    tolerance=1.1,
    tolerance_reason=BOUND + "shear is fixed on pins that all stand",
    catches=(*OF_CAP, Fault.SIGN_OF_C, Fault.TAU_MISSING),
)
def capped_sheared_pins(entrant: Entrant) -> Measured:
    coupling = Coupling(0.02 * PEAK, 0.3, COMPLIANCE, sliding_direction=2.2)
    array = YieldingPins.of(uneven(standing(12), seed=3), coupling)
    return entrant.against(array.pressed(entrant, by_load=True))


@check(
    "capped-residual",
    title="A rough bump that yields: what was claimed is so",
    claim="The complementarity gap of both bounds, load balance, tension and excess meet the claim",
    source=CONDITIONS,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(*SEEN, *OF_CAP, Fault.PERIODIC_FOR_APERIODIC, Fault.NEAR_FIELD, Fault.TENSION),
)
def capped_residual(entrant: Entrant) -> Measured:
    pressed = entrant.press(rough_bump(32, seed=3), 1.0, load=0.02 * MODULUS, hardness=BUMP)
    return judged(entrant, pressed)


@check(
    "capped-residual-approach",
    title="A rough bump that yields at an approach: what was claimed is so",
    claim="At a prescribed approach the gap of both bounds, tension and excess meet the claim",
    source=CONDITIONS,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(*SEEN, *OF_CAP, Fault.PERIODIC_FOR_APERIODIC, Fault.MEAN_DISPLACEMENT_LOST, Fault.ODD_GRIDS),
)
def capped_residual_approach(entrant: Entrant) -> Measured:
    gap = rough_bump(31, seed=5)
    return judged(entrant, entrant.press(gap, 1.0, approach=float(gap.min()) + 0.05, hardness=BUMP))


@check(
    "capped-residual-periodic",
    title="A periodic rough plane that yields: what was claimed is so",
    claim="The complementarity gap of both bounds, load balance, tension and excess meet the claim",
    source=PERIODIC_SOURCE,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(*SEEN, *OF_CAP, Fault.APERIODIC_FOR_PERIODIC, Fault.TENSION, Fault.MEAN_PRESSURE_LOST),
)
def capped_residual_periodic(entrant: Entrant) -> Measured:
    pressed = entrant.press(wavy(32, seed=91), 1.0, load=0.02 * MODULUS, periodic=True, hardness=WAVY)
    return judged(entrant, pressed)


@check(
    "capped-lower-and-lower",
    title="One rough bump with three hardnesses, one after the other",
    claim="Each hardness has its own pressures: none is kept from an earlier problem",
    source=CONDITIONS,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(*OF_CAP, Fault.HARDNESS_KEPT),
)
def capped_lower_and_lower(entrant: Entrant) -> Measured:
    gap = rough_bump(24, seed=8)
    found = [
        judged(entrant, entrant.press(gap, 1.0, load=0.01 * MODULUS, hardness=share * BUMP))
        for share in (2.0, 1.0, 0.5)
    ]
    return max(found, key=lambda one: one.value)


@check(
    "plastic-limit",
    title="The fully plastic limit",
    claim="Under half the load that the hardness bears on the whole square, nearly all of the contact is at "
    "the hardness, and the residuals meet the claim",
    source=CONDITIONS,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(*OF_CAP, Fault.MEAN_PRESSURE_LOST, Fault.TENSION),
)
def plastic_limit(entrant: Entrant) -> Measured:
    hardness = 1e-3 * MODULUS
    pressed = entrant.press(rough_bump(24, seed=9), 1.0, load=0.497 * hardness, hardness=hardness)
    short = pressed.pressure[pressed.pressure > 0] < 0.999 * hardness
    found = judged(entrant, pressed)
    return replace(found, note=f"{found.note}; {int(short.sum())} of {short.size} below the hardness")
