"""Rough contact, judged by recomputing what the solver claims, and against elimination on dense matrices."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np

from refimpl.grid import Array
from verification.framework.case import Measured
from verification.solver_suite import reference_solution
from verification.solver_suite.check import (
    CLAIMS,
    COMPLIANCE,
    MODULUS,
    Check,
    Entrant,
    Judge,
    Pressed,
    Side,
    pressing,
)
from verification.solver_suite.check import Fault as F
from verification.solver_suite.gaps import rough_bump, waves
from verification.solver_suite.protocol import ContactProblem, Coupling

SOURCE = "the contact conditions themselves, with displacements by dense matrices of the textbook's formulas"
PERIODIC_SOURCE = "the contact conditions themselves, with displacements by the exact Fourier symbols"
SIGN = "; c is lower minus upper (verification.solver_suite.protocol)"
PIVOTING = "principal pivoting (Murty 1974), written for this suite"
CLAIM = "in claims: a solver is held to the residual that it reports, and to rounding"
PROVEN = "in claims of the squared energy-norm error: at most the complementarity gap (proven)"
AND_MEAN = (
    "in claims: the squared energy-norm error, at most half the complementarity gap (proven), and the square "
    "of the mean's, at most K (f, a f)/N^2 times that with K the contact's stiffness (Cauchy and Schwarz): "
)
ALWAYS = (F.STUCK, F.SINGLE_PRECISION, F.MODULUS_OFF, F.MODULUS_DOUBLED, F.TRANSPOSED, F.HALF_ELEMENT)
OF_NUMBERS = (
    *(F.APPROACH_SIGN, F.APPROACH_DATUM, F.AREA_IN_ELEMENTS, F.AREA_CORRECTED),
    F.DISPLACEMENT_OF_CONTACT,
)
"""Faults of numbers beside the pressures, which every case judges where a solver returns them."""
FIELDS = fields(ContactProblem)
LOADS = (0.001, 0.01, 0.05)
"""Load (N) over E* times the unit square: from a few peaks to half the elements."""


def judged(entrant: Entrant, pressed: Pressed) -> Measured:
    """Return the worst residual in claims, with all three in the note."""
    parts = reference_solution.residual(pressed.problem, pressed.pressure)
    gap, balance, tension = (f"{part:.1e}" for part in parts)
    note = f"complementarity gap {gap}, load balance {balance}, tension {tension}"
    return Measured(parts.worst / entrant.claim, unit=CLAIMS, note=note)


def worst_in_turn(
    entrant: Entrant, answers: Sequence[Pressed], judge: Callable[[Entrant, Pressed], Measured] = judged
) -> Measured:
    """Return the worst of problems in turn; the note names it and the fields changed from the one before."""
    found = [judge(entrant, each) for each in answers]
    k = max(range(len(found)), key=lambda k: found[k].value)
    which = f"problem {k + 1} of {len(found)}" if len(found) > 1 else ""
    if k:
        pairs = [(f.name, *(getattr(answers[i].problem, f.name) for i in (k - 1, k))) for f in FIELDS]
        changed = [name for name, old, new in pairs if not np.array_equal(old, new)]
        which += f", {' and '.join(changed)} changed"
    return replace(found[k], note=": ".join(filter(None, (which, found[k].note))))


def residual(gap: Array, side: Side = 1.0, **how: Any) -> Judge:
    """Return the judge of one problem by its residual."""
    press = pressing(gap, side, **how)
    return lambda entrant: judged(entrant, press(entrant))


def elimination(gap: Array, side: Side = 1.0, **how: Any) -> Judge:
    """Return the judge of one problem by the pressures of elimination."""
    press = pressing(gap, side, **how)

    def judge(entrant: Entrant) -> Measured:
        pressed = press(entrant)
        return entrant.against((pressed, reference_solution.eliminated(pressed.problem)))

    return judge


def held(slug: str, title: str, claim: str, source: str, catches: tuple[F, ...], judge: Judge) -> Check:
    """Return a check that holds a solver to its claim."""
    return Check(slug, title, claim, source, 1.01, CLAIM, catches, judge)


def wavy(M: int, seed: int) -> Array:
    """Return a periodic rough gap (m) on a unit square."""
    heights = waves(M, seed, longest=2, shortest=7)
    return np.asarray(0.01 * (heights.max() - heights))


def sliding(direction: float, sign: float = 1.0) -> Coupling:
    """Return friction by beta alone."""
    return Coupling(0.0, 0.5, sign * COMPLIANCE, direction)


def _load_balance(entrant: Entrant) -> Measured:
    gap, loads = rough_bump(24, seed=7), [share * MODULUS for share in LOADS]
    found = [entrant.press(gap, 1.0, load=load).load for load in loads]
    worst = max(abs(carried / load - 1) for carried, load in zip(found, loads, strict=True))
    return Measured(worst / entrant.claim, unit=CLAIMS, data={"loads asked (N)": loads, "carried": found})


def _no_tension(entrant: Entrant) -> Measured:
    pressed = entrant.press(rough_bump(24, seed=8), 1.0, load=0.02 * MODULUS)
    found = judged(entrant, pressed)
    tension = reference_solution.residual(pressed.problem, pressed.pressure).tension
    return replace(found, value=tension / entrant.claim)


# fmt: off
CHECKS = (
    held("rough-residual", "A rough bump under a load: what was claimed is so",
         "Complementarity gap, load balance and tension, recomputed from the pressures, meet the claim",
         SOURCE,
         (*ALWAYS, F.PERIODIC_FOR_APERIODIC, F.NEAR_FIELD, F.TENSION, F.MEAN_PRESSURE_LOST, *OF_NUMBERS),
         residual(rough_bump(32, seed=3), load=0.05 * MODULUS)),
    held("rough-residual-light", "A rough bump barely touched: what was claimed is so",
         "A contact of a few elements, sought from far above, meets the claim as well",
         SOURCE, (F.MODULUS_OFF, F.MODULUS_DOUBLED, F.HALF_ELEMENT, F.NEAR_FIELD),
         residual(rough_bump(32, seed=4), load=0.001 * MODULUS)),
    held("rough-residual-approach", "A rough bump at a prescribed approach: what was claimed is so",
         "No element penetrates, and the loaded ones lie at the approach, to the claim",
         SOURCE, (*ALWAYS, F.PERIODIC_FOR_APERIODIC, F.MEAN_DISPLACEMENT_LOST, F.ODD_GRIDS),
         residual(rough_bump(31, seed=5), deep=0.1)),
    Check("rough-elimination", "A rough bump against elimination",
          "The pressures are those of block principal pivoting on the dense matrix, element by element",
          PIVOTING, 1.1, PROVEN,
          (F.MODULUS_OFF, F.TRANSPOSED, F.HALF_ELEMENT, F.PERIODIC_FOR_APERIODIC, F.MEAN_PRESSURE_LOST,
           F.ODD_GRIDS),
          elimination(rough_bump(21, seed=6), load=0.05 * MODULUS)),
    held("load-balance", "Load balance over two decades of load",
         "sum f dA is the prescribed load, to the claim, from a few elements to half of them",
         "equilibrium", (F.MEAN_PRESSURE_LOST,), _load_balance),
    held("no-tension", "No element pulls", "Pressures are nowhere negative beyond the claim",
         "no adhesion: f >= 0", (F.TENSION,), _no_tension),
    held("periodic-residual", "A periodic rough plane under a load: what was claimed is so",
         "Gap, balance and tension meet the claim with the periodic symbols", PERIODIC_SOURCE,
         (*ALWAYS, F.APERIODIC_FOR_PERIODIC, F.TENSION, F.MEAN_PRESSURE_LOST, F.ODD_GRIDS, *OF_NUMBERS),
         residual(wavy(45, seed=9), load=0.02 * MODULUS, periodic=True)),
    Check("periodic-elimination", "A periodic rough plane against elimination",
          "Under a load, and at the approach of the mean planes that goes with it, pressures are those of "
          "principal pivoting",
          PIVOTING, 2.0, "in claims of the squared energy-norm error, as `pins` at the approach",
          (F.MODULUS_OFF, F.TRANSPOSED, F.HALF_ELEMENT, F.APERIODIC_FOR_PERIODIC),
          elimination(wavy(16, seed=10), load=0.02 * MODULUS, periodic=True)),
    Check("periodic-approach", "A periodic rough plane at a prescribed approach of the mean planes",
          "The load that goes with an approach counted from the mean planes is elimination's",
          PIVOTING, 2.0, AND_MEAN + "1.3 here",
          (F.MEAN_PLANES_LOST, F.MEAN_PRESSURE_ADDED, F.MODULUS_OFF, F.APERIODIC_FOR_PERIODIC, F.ODD_GRIDS),
          elimination(wavy(17, seed=11), deep=-0.6, periodic=True)),
    held("sliding-residual", "A rough bump sliding with coupling: what was claimed is so",
         "With shear beta f in an oblique direction the residuals meet the claim",
         SOURCE + SIGN, (*ALWAYS, F.SIGN_OF_C, F.ODD_GRIDS),
         residual(rough_bump(23, seed=12), load=0.05 * MODULUS, coupling=sliding(0.6))),
    Check("sliding-elimination", "A rough bump sliding with coupling against elimination",
          "With shear beta f the pressures are those of principal pivoting on the unsymmetric matrix",
          PIVOTING + "; a + beta c is positive definite", 1.1, PROVEN,
          (F.SIGN_OF_C, F.TRANSPOSED, F.HALF_ELEMENT),
          elimination(rough_bump(20, seed=13), load=0.05 * MODULUS, coupling=sliding(2.2, sign=-1.0))),
    Check("sliding-periodic-residual", "A periodic rough plane sliding with coupling: what was claimed is so",
          "With shear beta f in an oblique direction the residuals meet the claim, with the periodic symbols",
          PERIODIC_SOURCE + SIGN,
          1.01, CLAIM + ". An odd number of elements has no Nyquist frequency to disagree about",
          (*ALWAYS, F.SIGN_OF_C),
          residual(wavy(45, seed=14), load=0.02 * MODULUS, periodic=True, coupling=sliding(-0.9))),
)
# fmt: on
