"""Problem and answer of a contact solver: the whole interface of a solver under test.

Heights count upwards, and the gap is ``z_upper - z_lower``. The elements are rectangles ``dx`` by ``dy``,
mostly squares, of uniform pressure f (Pa); displacements are taken at their centres, in arrays ``[i, j]``
along x, y with centres at ``(i + 1/2) dx, (j + 1/2) dy``:

    u(x) = 1/(pi E*) sum f I[1/rho] + c0 sum r I[s/rho^2],      r = tau [f > 0] + beta f
    u + gap >= approach,   f >= 0,   f (u + gap - approach) = 0,

With a hardness H no pressure exceeds it: ``f <= H``, and ``u + gap <= approach`` where f = H.

An element is in contact where f > 0, and tau acts only there: off the contact an answer holds exact zeros.
``I`` integrates over one element; rho is the distance from source to field point, and s the offset from
source to field point along the sliding direction ``(cos phi, sin phi)``, in which the upper body slides.
Friction drags the lower body along it and the upper one against it; the second sum is what that moves the
surfaces normally, with ``c0`` of the lower body minus that of the upper. A rigid ball on a softer flat has
``c0 > 0``, and its pressure shifts towards ``-(cos phi, sin phi)``, the trailing edge. Identical materials
do not couple: ``c0 = 0``, as without coupling. u is what both bodies give way, so displacements and the
approach count positive where they come together.

A periodic problem repeats the domain in both directions; its fields are the band-limited interpolants of the
element values, with the symbols ``2/(E* q)`` for pressure and ``-2 pi i c0 q_s/q^2`` for shear, where q is
the wave vector's length and ``q_s`` its part along the sliding direction, for waves ``exp(i q x)``. There
the mean pressure displaces nothing, so ``approach`` counts from the mean planes: the conditions hold with
``approach + mean(gap)`` in the place of ``approach``, and an approach is negative as long as contact is
partial.

Residuals are the complementarity gap ``sum f (v - min v)`` with ``v = u + gap``, over the elastic energy
``1/2 sum f (a f)`` with ``a f`` the first sum; the load balance ``|N - P| / P``, with N the load that the
pressures carry and P the required load; and the largest tension over the maximum pressure. At a prescribed
approach the first is ``|sum f (v - approach)| + max(0, approach - min v) sum |f|``, over the same energy.
With a hardness it is ``sum [f (v - d)+ + (H - f)(d - v)+]``, d being the approach, or under a load the mean
of v weighted by the pressures between the bounds; and what exceeds H counts as tension does.
"""

from __future__ import annotations

import math
import numbers
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from refimpl.errors import InputError, require_number
from refimpl.grid import Array
from verification.framework.case import Unavailable

LARGEST_PRECISION = 1e-6
"""Least residual that a solver may claim. A relative gap g allows pressure errors of sqrt(g) in the energy
norm, here 0.1 %, a tenth of the smallest fault that must be seen; single precision reaches it."""


class Unsupported(Unavailable):
    """Raised by a solver that cannot pose a problem: the case is not applicable, and no pass."""


class BadAnswer(Exception):
    """The answer of a solver cannot be judged: wrong shape, NaN, no array, no success claimed."""


@dataclass(frozen=True)
class Coupling:
    """Friction whose shear moves the surfaces normally, without slopes.

    tau : shear strength of the contact (Pa)
    beta : friction coefficient proper
    shear_compliance : c0 (1/Pa), ``(1+nu)(1-2nu)/(2 pi E)`` of the lower body minus that of the upper
    sliding_direction : angle phi (rad); the upper body slides along ``(cos phi, sin phi)``
    """

    tau: float
    beta: float
    shear_compliance: float
    sliding_direction: float = 0.0

    def __post_init__(self) -> None:
        require_number("coupling.tau", self.tau, "a shear strength in Pa, not negative", at_least=0)
        require_number("coupling.beta", self.beta, "a finite number, not negative", at_least=0)
        for name in ("shear_compliance", "sliding_direction"):
            require_number(f"coupling.{name}", getattr(self, name), "a finite number")


@dataclass(frozen=True, eq=False)
class ContactProblem:
    """Two surfaces pressed together, frictionless or sliding steadily.

    gap : ``z_upper - z_lower`` undeformed, shape ``(Mx, My)``, ``min gap = 0`` (m); square unless the ability
        ``rectangle`` is claimed
    spacing : edge of one element (m), along x where elements are oblong
    reduced_modulus : E* (Pa), ``1/E* = sum (1 - nu^2)/E``
    load : normal load on the domain (N), or None
    approach : prescribed approach (m), from first contact or, if periodic, from the mean planes; or None
    periodic : the domain repeats in both directions; otherwise the half-space is free around it
    tolerance : relative residual to reach: complementarity gap over elastic energy, and load balance
    coupling : friction, or None
    hardness : cap of the pressures (Pa), or None; posed only where the ability ``hardness`` is claimed
    spacing_y : edge of one element along y (m), that along x by default; another one only where the ability
        ``oblong_elements`` is claimed

    Exactly one of load and approach is given. Raises `InputError` naming the field.
    """

    gap: Array
    spacing: float
    reduced_modulus: float
    load: float | None = None
    approach: float | None = None
    periodic: bool = False
    tolerance: float = 1e-8
    coupling: Coupling | None = None
    spacing_y: float | None = None
    hardness: float | None = None

    def __post_init__(self) -> None:
        gap = np.array(self.gap, dtype=np.float64)
        if gap.ndim != 2 or not gap.size or not np.isfinite(gap).all():
            raise InputError("gap", gap.shape, "a 2-D array of finite heights in m")
        if gap.min() != 0:
            raise InputError("gap", float(gap.min()), "a gap whose least value is 0 m (first contact)")
        object.__setattr__(self, "gap", gap)
        for edge in ("spacing", "spacing_y"):
            if getattr(self, edge) is not None:
                require_number(edge, getattr(self, edge), "a positive length in m", above=0)
        require_number("reduced_modulus", self.reduced_modulus, "a positive modulus in Pa", above=0)
        require_number("tolerance", self.tolerance, "a number between 0 and 1", above=0, below=1)
        if (self.load is None) == (self.approach is None):
            raise InputError("load", self.load, "a load or an approach, and not both")
        if self.hardness is not None:
            require_number("hardness", self.hardness, "a positive pressure in Pa", above=0)
        if self.load is not None:
            require_number("load", self.load, "a positive load in N", above=0)
        if self.approach is not None:
            require_number("approach", self.approach, "a finite approach in m")

    @property
    def M(self) -> int:
        """Elements along the longer axis: along one side of a square."""
        return max(self.shape)

    @property
    def shape(self) -> tuple[int, int]:
        """Elements along x and y."""
        return self.gap.shape[0], self.gap.shape[1]

    @property
    def spacings(self) -> tuple[float, float]:
        """Edges ``(dx, dy)`` of one element (m)."""
        return self.spacing, self.spacing if self.spacing_y is None else self.spacing_y

    @property
    def lengths(self) -> tuple[float, float]:
        """Lengths of the domain along x and y (m)."""
        return self.shape[0] * self.spacings[0], self.shape[1] * self.spacings[1]

    @property
    def area(self) -> float:
        """Area of the domain (m^2)."""
        return self.lengths[0] * self.lengths[1]

    @property
    def element_area(self) -> float:
        """Area of one element (m^2)."""
        return self.spacings[0] * self.spacings[1]

    @property
    def coupling_strength(self) -> float:
        """``pi |c0| E* beta``: the largest change of pressures by a step that lags friction, over that of the
        step before. Such steps converge below 1, slowly near it; tau's contact edge is not counted."""
        if self.coupling is None:
            return 0.0
        return math.pi * abs(self.coupling.shear_compliance) * self.reduced_modulus * self.coupling.beta

    @property
    def approach_from_touch(self) -> float | None:
        """The prescribed approach counted from first contact, periodic or not (m); None under a load."""
        if self.approach is None or not self.periodic:
            return self.approach
        return self.approach + float(self.gap.mean())


@dataclass(frozen=True, eq=False)
class Answer:
    """Pressures in the gap's shape (Pa), the solver's own statement of convergence, and numbers, if any.

    approach : as the problem counts it (m): from first contact or, if periodic, from the mean planes
    contact_area : area of the elements with a pressure (m^2)
    mean_displacement : mean over the domain of u, by pressure and by shear (m)

    Each of the numbers is judged by the pressures where it is returned; None is no number, and not judged.
    """

    pressure: ArrayLike
    converged: bool | np.bool_
    approach: float | None = None
    contact_area: float | None = None
    mean_displacement: float | None = None


NUMBERS = ("approach", "contact_area", "mean_displacement")
"""Names of the numbers of an `Answer`."""


FLAGS = ("periodic", "aperiodic", "load", "approach", "coupling", "rectangle", "oblong_elements", "hardness")


@dataclass(frozen=True)
class Abilities:
    """Problems that a solver accepts; an attribute ``abilities`` of the solver may state them.

    rectangle : arrays that are not square
    oblong_elements : elements whose edges differ
    hardness : pressures that end at a given one
    largest : most elements along the longer axis that it should be given (None: any)
    precision : the relative residual that it claims to reach, at most 1e-6: the suite's problems have it as
        their tolerance, and the solver is held to it
    strongest : largest `ContactProblem.coupling_strength` that it should be given (None: any)
    """

    periodic: bool = True
    aperiodic: bool = True
    load: bool = True
    approach: bool = True
    coupling: bool = False
    largest: int | None = None
    precision: float = 1e-8
    rectangle: bool = False
    oblong_elements: bool = False
    hardness: bool = False
    strongest: float | None = None

    def __post_init__(self) -> None:
        for flag in FLAGS:
            if not isinstance(getattr(self, flag), bool):
                raise InputError(f"abilities.{flag}", getattr(self, flag), "true or false")
        if self.largest is not None and not (type(self.largest) is int and self.largest >= 1):
            raise InputError("abilities.largest", self.largest, "a number of elements per side, or None")
        if self.strongest is not None:
            require_number("abilities.strongest", self.strongest, "at least 0, or None", at_least=0)
        require_number(
            "abilities.precision",
            self.precision,
            f"a relative residual above 0 and at most {LARGEST_PRECISION:g}",
            above=0,
            at_most=LARGEST_PRECISION,
        )

    @classmethod
    def named(cls, names: str, *, largest: int | None = None, precision: float = 1e-8) -> Abilities:
        """Return only the abilities of a list with commas. `InputError` if unknown, or if none is posed."""
        words = (name.strip().replace("-", " ").split() for name in names.split(","))
        given = ["_".join(name) for name in words if name]
        domain, control = {"periodic", "aperiodic"} & {*given}, {"load", "approach"} & {*given}
        if not {*given} <= {*FLAGS} or not domain or not control:
            allowed = (
                "periodic or aperiodic, load or approach (of both pairs at least one), coupling, rectangle, "
                "oblong elements, hardness"
            )
            raise InputError("abilities", names, f"a list of {allowed}")
        return cls(**{name: name in given for name in FLAGS}, largest=largest, precision=precision)

    def lacking(self, problem: ContactProblem) -> str | None:
        """Return the requirement of the problem beyond these abilities, or None."""
        required = {
            "periodic": problem.periodic,
            "aperiodic": not problem.periodic,
            "load": problem.load is not None,
            "approach": problem.approach is not None,
            "coupling": problem.coupling is not None,
            "rectangle": problem.shape[0] != problem.shape[1],
            "oblong_elements": problem.spacings[0] != problem.spacings[1],
            "hardness": problem.hardness is not None,
        }
        for name, is_required in required.items():
            if is_required and not getattr(self, name):
                return name.replace("_", " ")
        if self.largest is not None and self.largest < problem.M:
            return f"{problem.M} elements along one axis"
        if self.strongest is not None and self.strongest < problem.coupling_strength:
            return f"coupling of strength {problem.coupling_strength:.3g}"
        return None


SolverUnderTest = Callable[[ContactProblem], "Answer | Array"]
"""A bare array is an answer that claims success. Optional attributes: ``abilities``, ``version`` (a text)."""


def abilities_of(solver: SolverUnderTest) -> Abilities:
    """Return ``abilities``, or squares of any size without coupling. Raises `InputError` for other types."""
    found = getattr(solver, "abilities", None)
    if found is None:
        return Abilities()
    if not isinstance(found, Abilities):
        raise InputError("abilities", found, "verification.solver_suite.protocol.Abilities")
    return found


HIGHEST = 1e50
"""Pressures (over E*) from which an answer is nonsense: sums and energies of what is below stay finite."""
EXPECTED = "expected an array of real numbers, or Answer(pressure, converged) with one"


def ask(solver: SolverUnderTest, problem: ContactProblem) -> Answer:
    """Return the claimed answer of a solver under test, checked; its pressures are an array of the gap's
    shape.

    The solver gets a copy of the problem. Raises `Unsupported` where its abilities do not reach, or where it
    says that it did not converge with coupling (one that lags friction may not), `BadAnswer` for an answer
    that cannot be judged or admits another failure, and every exception of the solver.
    """
    lacking = abilities_of(solver).lacking(problem)
    if lacking:
        raise Unsupported(f"the solver does not offer: {lacking}")
    answer: Any = solver(replace(problem, gap=problem.gap))
    beside = _numbers(answer) if isinstance(answer, Answer) else {}
    if isinstance(answer, Answer):
        if not isinstance(answer.converged, bool | np.bool_):
            raise BadAnswer(f"converged = {answer.converged!r}: expected true or false")
        if not answer.converged:
            said = "the solver did not converge by its own report"
            if problem.coupling is not None:
                raise Unsupported(f"{said}, at a coupling of strength {problem.coupling_strength:.2g}")
            raise BadAnswer(said)
        answer = np.asanyarray(answer.pressure)  # a mask stays
    if not isinstance(answer, np.ndarray) or answer.dtype.kind not in "fiu":
        kind = "None" if answer is None else f"a {type(answer).__name__}"
        kind = f"an array of {answer.dtype}" if isinstance(answer, np.ndarray) else kind
        raise BadAnswer(f"the solver returned {kind}: {EXPECTED}")
    if answer.shape != problem.gap.shape:
        raise BadAnswer(f"pressures of shape {answer.shape} for a gap of shape {problem.gap.shape}")
    if np.ma.is_masked(answer):  # values below a mask are no answer
        raise BadAnswer(f"{int(np.count_nonzero(np.ma.getmaskarray(answer)))} pressures are masked")
    pressure = np.array(answer, dtype=np.float64)
    if not np.isfinite(pressure).all():
        raise BadAnswer(f"{int(np.count_nonzero(~np.isfinite(pressure)))} pressures are not finite")
    if not np.abs(pressure).max() < HIGHEST * problem.reduced_modulus:
        raise BadAnswer(f"pressures up to {np.abs(pressure).max():.3g} Pa, beyond {HIGHEST:g} E*")
    return Answer(pressure, True, **beside)


def _numbers(answer: Answer) -> dict[str, float]:
    found = {name: getattr(answer, name) for name in NUMBERS if getattr(answer, name) is not None}
    for name, number in found.items():
        real = isinstance(number, numbers.Real) and not isinstance(number, bool)
        if not real or not math.isfinite(number):
            raise BadAnswer(f"{name} = {number!r}: expected a finite number, or None")
    return {name: float(number) for name, number in found.items()}
