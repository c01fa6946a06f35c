"""Declaration of the suite's cases: like any verification case, with the solver under test as argument."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Any

import numpy as np

from refimpl.grid import Array
from verification.framework.case import Case, Disproved, Measured, Metric, error_of, jsonable
from verification.solver_suite import numbers, reference_solution
from verification.solver_suite.protocol import ContactProblem, Coupling, SolverUnderTest, abilities_of, ask

MODULUS = 2e9
"""Reduced modulus E* (Pa) of the suite's problems."""
COMPLIANCE = 0.3 / (np.pi * MODULUS)
"""c0 (1/Pa) where friction couples: Dundurs' constant 0.3, as of nu = 2/7 against a rigid body."""

Side = float | tuple[float, float]
"""Length (m) of a square, or lengths of a rectangle along x and y."""

CLAIMS = "claims"
"""Unit of a residual, or of a squared relative error in the energy norm: what the solver claims to reach."""


class Fault(StrEnum):
    """Possible faults of a solver: a case names the fault that it must detect, and is tried on that fault."""

    SIGN_OF_C = "sign of c"
    PERIODIC_FOR_APERIODIC = "periodic instead of aperiodic"
    APERIODIC_FOR_PERIODIC = "aperiodic instead of periodic"
    MODULUS_OFF = "1 % modulus error"
    MODULUS_DOUBLED = "modulus with E instead of 2E"
    STUCK = "stuck iteration that claims success"
    TRANSPOSED = "transposed axes"
    HALF_ELEMENT = "half-element shift"
    SINGLE_PRECISION = "float32 noise"
    TAU_MISSING = "missing tau"
    MEAN_DISPLACEMENT_LOST = "lost mean of the displacement"
    MEAN_PLANES_LOST = "lost mean of the gap"
    MEAN_PRESSURE_LOST = "lost mean of the pressure"
    MEAN_PRESSURE_ADDED = "uniform pressure at a periodic approach"
    NEAR_FIELD = "wrong near-field coefficients"
    TENSION = "contact that pulls"
    FAINT_PRESSURE = "faint pressure off the contact"
    SPACING_KEPT = "spacing kept from an earlier problem"
    MODULUS_KEPT = "modulus kept from an earlier problem"
    C0_KEPT = "c0 kept from an earlier problem"
    DIRECTION_KEPT = "direction kept from an earlier problem"
    BORDERS_KEPT = "borders kept from an earlier problem"
    BETA_KEPT = "beta kept from an earlier problem"
    TAU_KEPT = "tau kept from an earlier problem"
    APPROACH_FORGOTTEN = "answer kept for a gap whatever the approach"
    FRICTION_FORGOTTEN = "answer kept for a gap whatever the friction"
    ABSOLUTE_THRESHOLD = "absolute threshold"
    TAU_EVERYWHERE = "tau outside the contact"
    TAU_NOT_ON_ALL = "tau on well loaded elements only"
    TAU_BESIDE = "tau one element off where periodic"
    TAU_ALONG_X = "tau along x where periodic"
    SIGN_OF_C_LOST = "c0 without its sign where periodic"
    UNCOUPLED_AT_APPROACH = "no coupling at a prescribed approach"
    ODD_GRIDS = "odd number of elements"
    CORNER_LEFT_OUT = "corner element left out"
    PADDING_SHORT = "padding short by one element"
    PADDING_CAPPED = "padding capped at 256 points"
    SHEAR_PADDING_CAPPED = "padding of shear capped at 128 points"
    EDGES_EXCHANGED = "dx and dy exchanged"
    SQUARE_ELEMENTS = "oblong elements taken for squares of the same area"
    STRETCHED = "a rectangle stretched to a square"
    HARDNESS_IGNORED = "hardness ignored"
    HARDNESS_CUT = "elastic pressures cut at the hardness"
    HARDNESS_KEPT = "hardness kept from an earlier problem"
    APPROACH_SIGN = "approach with the other sign"
    APPROACH_DATUM = "approach from the other datum"
    AREA_IN_ELEMENTS = "contact area in elements"
    AREA_CORRECTED = "contact area corrected by its perimeter"
    DISPLACEMENT_OF_CONTACT = "displacement averaged over the contact"


@dataclass(frozen=True, eq=False)
class Pressed:
    """A problem with the claimed answer of a solver under test."""

    problem: ContactProblem
    pressure: Array

    @property
    def load(self) -> float:
        """Sum of f dA (N)."""
        return float(self.pressure.sum()) * self.problem.element_area


@dataclass(frozen=True)
class Entrant:
    """A solver under test at work: poses problems and holds the solver to its claim.

    ``wrong_numbers`` are the sentences on numbers that differ from those of the pressures beside them.
    """

    solver: SolverUnderTest
    wrong_numbers: list[str] = field(default_factory=list)

    @property
    def claim(self) -> float:
        """The relative residual that it is held to."""
        return abilities_of(self.solver).precision

    def press(
        self,
        gap: Array,
        side: Side = 1.0,
        *,
        load: float | None = None,
        approach: float | None = None,
        periodic: bool = False,
        coupling: Coupling | None = None,
        modulus: float = MODULUS,
        hardness: float | None = None,
    ) -> Pressed:
        """Pose a gap (m) on a square of ``side`` (m), or a rectangle; under a load (N) or at an approach (m).

        An aperiodic approach counts from the gap's own zero, which need not be its least value: an indenter's
        tip may lie between element centres. Raises what `pose` raises.
        """
        if approach is not None and not periodic:
            approach -= float(gap.min())
        Lx, Ly = side if isinstance(side, tuple) else (side, side)
        dx, dy = Lx / gap.shape[0], Ly / gap.shape[1]
        return self.pose(
            ContactProblem(
                gap=gap - gap.min(),
                spacing=dx,
                spacing_y=None if dx == dy else dy,
                reduced_modulus=modulus,
                load=load,
                approach=approach,
                periodic=periodic,
                tolerance=self.claim,
                coupling=coupling,
                hardness=hardness,
            )
        )

    def pose(self, problem: ContactProblem) -> Pressed:
        """Pose a problem, and note numbers other than its pressures'. Raises what `ask` raises."""
        answer = ask(self.solver, problem)
        self.wrong_numbers.extend(numbers.wrong(problem, answer))
        return Pressed(problem, np.asarray(answer.pressure))

    def misfit(self, pressed: Pressed, exact: Array) -> float:
        """Return the squared energy-norm error against exact pressures, in units of the claim.

        The mean of a periodic pressure stores no energy: its relative error counts as squared as well. Raises
        ValueError for pressures to compare with that hold no energy, or carry no load.
        """
        error, carried = reference_solution.misfit(pressed.problem, pressed.pressure, exact), exact.sum()
        if not carried > 0:
            raise ValueError("the pressures to compare with carry no load")
        if pressed.problem.periodic:
            error += float(pressed.pressure.sum() / carried - 1) ** 2
        return error / self.claim

    def against(self, *answers: tuple[Pressed, Array]) -> Measured:
        """Return the worst misfit against exact pressures; the note tells where that answer is off."""
        misfits = [self.misfit(pressed, exact) for pressed, exact in answers]
        worst = int(np.argmax(misfits))
        which = f"problem {worst + 1} of {len(answers)}: " if len(answers) > 1 else ""
        note = which + difference(answers[worst][0].pressure, answers[worst][1])
        return Measured(misfits[worst], unit=CLAIMS, note=note)


def difference(found: Array, exact: Array) -> str:
    """State in words the load that is carried, if another one, and the element that is farthest off.

    >>> difference(np.array([[1.0, 2.0]]), np.array([[1.0, 4.0]]))
    'carries 0.6 of the right load; farthest off is element [0, 1] with 2 Pa for 4 Pa'
    """
    i, j = np.unravel_index(np.argmax(abs(found - exact)), exact.shape)
    share = f"{found.sum() / exact.sum():.6g}" if exact.sum() > 0 else "1"
    load = f"carries {share} of the right load; " if share != "1" else ""
    return load + f"farthest off is element [{i}, {j}] with {found[i, j]:.5g} Pa for {exact[i, j]:.5g} Pa"


Judge = Callable[[Entrant], Measured]
Press = Callable[[Entrant], Pressed]


def pressing(gap: Array, side: Side = 1.0, *, deep: float | None = None, **how: Any) -> Press:
    """Return what poses a gap (m) to a solver, by further arguments of `Entrant.press`.

    ``deep`` is an approach (m) from first contact, or of a periodic gap a share of its mean.
    """
    if deep is not None:
        how["approach"] = deep * float(gap.mean()) if how.get("periodic") else float(gap.min()) + deep
    return lambda entrant: entrant.press(gap, side, **how)


@dataclass(frozen=True)
class Check:
    """A case of the suite, as a row of a table; ``case`` fills in the solver under test."""

    slug: str
    title: str
    claim: str
    source: str
    tolerance: float
    tolerance_reason: str
    catches: tuple[Fault, ...]
    judge: Judge
    metric: Metric = Metric.AT_MOST

    @property
    def id(self) -> str:
        """Id of its verification case."""
        return f"solver/{self.slug}"

    @property
    def description(self) -> str:
        """The claim, and what the case is meant to catch."""
        return f"{self.claim}. Meant to catch: {', '.join(self.catches) or 'no single fault'}"

    def case(self, solver: SolverUnderTest) -> Case:
        """Return the verification case of this solver."""
        return Case(
            id=self.id,
            title=self.title,
            claim=self.description,
            source=self.source,
            metric=self.metric,
            tolerance=self.tolerance,
            tolerance_reason=self.tolerance_reason,
            function=lambda: self._measured(Entrant(solver)),
        )

    def _measured(self, entrant: Entrant) -> Measured:
        """Judge the pressures, then the numbers beside them. Raises `Disproved` for wrong numbers alone."""
        found = self.judge(entrant)
        wrong = "; ".join(entrant.wrong_numbers[:1])
        if wrong and error_of(self.metric, self.tolerance, found) <= self.tolerance:
            raise Disproved(wrong)
        return replace(found, note="; also ".join(filter(None, (found.note or in_words(found), wrong))))


def in_words(found: Measured) -> str:
    """Return the value, reference and data of a measurement.

    >>> in_words(Measured(2.0, 3.0, unit="N", data={"M": [12, 24]}))
    '2 for 3 N; M [12, 24]'
    """
    value = [] if found.reference is None else [f"{found.value:.6g} for {found.reference:.6g} {found.unit}"]
    return "; ".join([*value, *(f"{name} {jsonable(number)}" for name, number in found.data.items())])
