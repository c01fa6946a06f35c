"""Rough contact, judged by recomputing what the solver claims, and against elimination on dense matrices."""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array
from verification.framework.case import Measured
from verification.solver_suite import reference_solution
from verification.solver_suite.check import CLAIMS, COMPLIANCE, MODULUS, Entrant, Fault, Pressed, check
from verification.solver_suite.gaps import rough_bump, waves
from verification.solver_suite.protocol import Coupling

SOURCE = "the contact conditions themselves, with displacements by dense matrices of the textbook's formulas"
PERIODIC_SOURCE = "the contact conditions themselves, with displacements by the exact Fourier symbols"
CLAIM = "in claims: a solver is held to the residual that it reports, and to rounding"
ALWAYS = (
    Fault.STUCK,
    Fault.SINGLE_PRECISION,
    Fault.MODULUS_OFF,
    Fault.MODULUS_DOUBLED,
    Fault.TRANSPOSED,
    Fault.HALF_ELEMENT,
)
OF_NUMBERS = (
    Fault.APPROACH_SIGN,
    Fault.APPROACH_DATUM,
    Fault.AREA_IN_ELEMENTS,
    Fault.AREA_CORRECTED,
    Fault.DISPLACEMENT_OF_CONTACT,
)
"""Faults of numbers beside the pressures, which every case judges where a solver returns them."""
AND_MEAN = (
    "in claims: the squared energy-norm error, at most half the complementarity gap (proven), and the square "
    "of the mean's, at most K (f, a f)/N^2 times that with K the contact's stiffness (Cauchy and Schwarz): "
)
LOADS = (0.001, 0.01, 0.05)
"""Load (N) over E* times the unit square: from a few peaks to half the elements."""


def judged(entrant: Entrant, pressed: Pressed) -> Measured:
    """The worst residual in claims, with all three in the note."""
    parts = reference_solution.residual(pressed.problem, pressed.pressure)
    note = f"gap {parts.gap:.1e}, balance {parts.balance:.1e}, tension {parts.tension:.1e}"
    return Measured(entrant.residual(pressed), unit=CLAIMS, note=note)


def wavy(M: int, seed: int) -> Array:
    """A periodic rough gap (m) on a unit square."""
    heights = waves(M, seed, longest=2, shortest=7)
    return np.asarray(0.01 * (heights.max() - heights))


@check(
    "rough-residual",
    title="A rough bump under a load: what was claimed is so",
    claim="Complementarity gap, load balance and tension, recomputed from the pressures, meet the claim",
    source=SOURCE,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(
        *ALWAYS,
        Fault.PERIODIC_FOR_APERIODIC,
        Fault.NEAR_FIELD,
        Fault.TENSION,
        Fault.MEAN_PRESSURE_LOST,
        *OF_NUMBERS,
    ),
)
def rough_residual(entrant: Entrant) -> Measured:
    return judged(entrant, entrant.press(rough_bump(32, seed=3), 1.0, load=0.05 * MODULUS))


@check(
    "rough-residual-light",
    title="A rough bump barely touched: what was claimed is so",
    claim="A contact of a few elements, sought from far above, meets the claim as well",
    source=SOURCE,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(Fault.MODULUS_OFF, Fault.MODULUS_DOUBLED, Fault.HALF_ELEMENT, Fault.NEAR_FIELD),
)
def rough_residual_light(entrant: Entrant) -> Measured:
    return judged(entrant, entrant.press(rough_bump(32, seed=4), 1.0, load=0.001 * MODULUS))


@check(
    "rough-residual-approach",
    title="A rough bump at a prescribed approach: what was claimed is so",
    claim="No element penetrates, and the loaded ones lie at the approach, to the claim",
    source=SOURCE,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(*ALWAYS, Fault.PERIODIC_FOR_APERIODIC, Fault.MEAN_DISPLACEMENT_LOST, Fault.ODD_GRIDS),
)
def rough_residual_approach(entrant: Entrant) -> Measured:
    gap = rough_bump(31, seed=5)
    return judged(entrant, entrant.press(gap, 1.0, approach=float(gap.min()) + 0.1))


@check(
    "rough-elimination",
    title="A rough bump against elimination",
    claim="The pressures are those of block principal pivoting on the dense matrix, element by element",
    source="principal pivoting (Murty 1974), written for this suite",
    metric="at_most",
    tolerance=1.1,
    tolerance_reason="in claims of the squared energy-norm error: at most the complementarity gap (proven)",
    catches=(
        Fault.MODULUS_OFF,
        Fault.TRANSPOSED,
        Fault.HALF_ELEMENT,
        Fault.PERIODIC_FOR_APERIODIC,
        Fault.MEAN_PRESSURE_LOST,
        Fault.ODD_GRIDS,
    ),
)
def rough_elimination(entrant: Entrant) -> Measured:
    pressed = entrant.press(rough_bump(21, seed=6), 1.0, load=0.05 * MODULUS)
    return entrant.against((pressed, reference_solution.eliminated(pressed.problem)))


@check(
    "load-balance",
    title="Load balance over two decades of load",
    claim="sum f dA is the prescribed load, to the claim, from a few elements to half of them",
    source="equilibrium",
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(Fault.MEAN_PRESSURE_LOST,),
)
def load_balance(entrant: Entrant) -> Measured:
    gap, loads = rough_bump(24, seed=7), [share * MODULUS for share in LOADS]
    found = [entrant.press(gap, 1.0, load=load).load for load in loads]
    worst = max(abs(carried / load - 1) for carried, load in zip(found, loads, strict=True))
    return Measured(worst / entrant.claim, unit=CLAIMS, data={"asked": loads, "carried": found})


@check(
    "no-tension",
    title="No element pulls",
    claim="Pressures are nowhere negative beyond the claim",
    source="no adhesion: f >= 0",
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(Fault.TENSION,),
)
def no_tension(entrant: Entrant) -> Measured:
    pressed = entrant.press(rough_bump(24, seed=8), 1.0, load=0.02 * MODULUS)
    tension = reference_solution.residual(pressed.problem, pressed.pressure).tension
    return Measured(tension / entrant.claim, unit=CLAIMS)


@check(
    "periodic-residual",
    title="A periodic rough plane under a load: what was claimed is so",
    claim="Gap, balance and tension meet the claim with the periodic symbols",
    source=PERIODIC_SOURCE,
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(
        *ALWAYS,
        Fault.APERIODIC_FOR_PERIODIC,
        Fault.TENSION,
        Fault.MEAN_PRESSURE_LOST,
        Fault.ODD_GRIDS,
        *OF_NUMBERS,
    ),
)
def periodic_residual(entrant: Entrant) -> Measured:
    return judged(entrant, entrant.press(wavy(45, seed=9), 1.0, load=0.02 * MODULUS, periodic=True))


@check(
    "periodic-elimination",
    title="A periodic rough plane against elimination",
    claim="Under a load, and at the approach of the mean planes that goes with it, pressures are those of "
    "principal pivoting",
    source="principal pivoting (Murty 1974), written for this suite",
    metric="at_most",
    tolerance=2.0,
    tolerance_reason="in claims of the squared energy-norm error, as `pins` at the approach",
    catches=(Fault.MODULUS_OFF, Fault.TRANSPOSED, Fault.HALF_ELEMENT, Fault.APERIODIC_FOR_PERIODIC),
)
def periodic_elimination(entrant: Entrant) -> Measured:
    pressed = entrant.press(wavy(16, seed=10), 1.0, load=0.02 * MODULUS, periodic=True)
    return entrant.against((pressed, reference_solution.eliminated(pressed.problem)))


@check(
    "periodic-approach",
    title="A periodic rough plane at a prescribed approach of the mean planes",
    claim="The load that goes with an approach counted from the mean planes is elimination's",
    source="principal pivoting (Murty 1974), written for this suite",
    metric="at_most",
    tolerance=2.0,
    tolerance_reason=AND_MEAN + "1.3 here",
    catches=(
        Fault.MEAN_PLANES_LOST,
        Fault.MEAN_PRESSURE_ADDED,
        Fault.MODULUS_OFF,
        Fault.APERIODIC_FOR_PERIODIC,
        Fault.ODD_GRIDS,
    ),
)
def periodic_approach(entrant: Entrant) -> Measured:
    gap = wavy(17, seed=11)
    pressed = entrant.press(gap, 1.0, approach=-0.6 * float(gap.mean()), periodic=True)
    return entrant.against((pressed, reference_solution.eliminated(pressed.problem)))


@check(
    "sliding-residual",
    title="A rough bump sliding with coupling: what was claimed is so",
    claim="With shear beta f in an oblique direction the residuals meet the claim",
    source=SOURCE + "; c is lower minus upper (verification.solver_suite.protocol)",
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM,
    catches=(*ALWAYS, Fault.SIGN_OF_C, Fault.ODD_GRIDS),
)
def sliding_residual(entrant: Entrant) -> Measured:
    coupling = Coupling(tau=0.0, beta=0.5, shear_compliance=COMPLIANCE, sliding_direction=0.6)
    gap = rough_bump(23, seed=12)
    return judged(entrant, entrant.press(gap, 1.0, load=0.05 * MODULUS, coupling=coupling))


@check(
    "sliding-elimination",
    title="A rough bump sliding with coupling against elimination",
    claim="With shear beta f the pressures are those of principal pivoting on the unsymmetric matrix",
    source="principal pivoting (Murty 1974), written for this suite; a + beta c is positive definite",
    metric="at_most",
    tolerance=1.1,
    tolerance_reason="in claims of the squared energy-norm error: at most the complementarity gap (proven)",
    catches=(Fault.SIGN_OF_C, Fault.TRANSPOSED, Fault.HALF_ELEMENT),
)
def sliding_elimination(entrant: Entrant) -> Measured:
    coupling = Coupling(tau=0.0, beta=0.5, shear_compliance=-COMPLIANCE, sliding_direction=2.2)
    pressed = entrant.press(rough_bump(20, seed=13), 1.0, load=0.05 * MODULUS, coupling=coupling)
    return entrant.against((pressed, reference_solution.eliminated(pressed.problem)))


@check(
    "sliding-periodic-residual",
    title="A periodic rough plane sliding with coupling: what was claimed is so",
    claim="With shear beta f in an oblique direction the residuals meet the claim, with the periodic symbols",
    source=PERIODIC_SOURCE + "; c is lower minus upper (verification.solver_suite.protocol)",
    metric="at_most",
    tolerance=1.01,
    tolerance_reason=CLAIM + ". An odd number of elements has no Nyquist frequency to disagree about",
    catches=(*ALWAYS, Fault.SIGN_OF_C),
)
def sliding_periodic_residual(entrant: Entrant) -> Measured:
    coupling = Coupling(tau=0.0, beta=0.5, shear_compliance=COMPLIANCE, sliding_direction=-0.9)
    gap = wavy(45, seed=14)
    return judged(entrant, entrant.press(gap, 1.0, load=0.02 * MODULUS, periodic=True, coupling=coupling))
