"""`refimpl` as a solver under test: translates the problem into a scene and hands back the pressures."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import refimpl as rf
from refimpl.planning.plan import Method
from verification.solver_suite.protocol import Abilities, Answer, ContactProblem, Unsupported

WORK = 3.0
"""How much stricter the suite is at a prescribed approach. It adds the work of what misses the approach, our
certificate's ``balance``, to that of what penetrates, which is the work of both, our ``gap``, less the first
or more: three times the larger at most."""

RIGID = 1e30
"""Modulus of a body that is to be rigid, over E*: its compliance vanishes beside the other's rounding."""


@dataclass(frozen=True)
class Own:
    """One of `refimpl`'s solvers.

    >>> import numpy as np
    >>> problem = ContactProblem(np.zeros((2, 2)), spacing=1e-6, reduced_modulus=1e9, load=4e-6)
    >>> bool(np.allclose(np.asarray(solve(problem).pressure), 1e6))
    True
    """

    method: Method
    abilities: Abilities

    @property
    def version(self) -> str:
        """Name and version of the package."""
        return f"refimpl {rf.__version__}"

    def __call__(self, problem: ContactProblem) -> Answer:
        """Return the pressures; converged when the solution is certified.

        An alternating contact edge is no success here: on it the problem, tau wherever f > 0, has no solution
        that the solver has found, though the pressures solve that without tau on a few elements.
        """
        solution = solved(problem, problem.tolerance, self.method)
        apart = solution.status is rf.Status.NO_CONTACT and problem.approach is not None
        lawful = solution.status is rf.Status.CYCLED and solution.certificate.law_violations == 0
        ended_well = apart or lawful or solution.status is rf.Status.CONVERGED
        return Answer(
            solution.pressure,
            ended_well,
            approach=solution.approach,
            contact_area=solution.contact_area,
        )


def solved(problem: ContactProblem, tolerance: float, method: Method = "fft") -> rf.Solution:
    """Return the problem's solution; ``tolerance`` is the suite's residual. Raises as `scene` does."""
    return rf.solve(
        scene(problem),
        problem.shape,
        method=method,
        approach=problem.approach,
        oblique=False,
        plastic=problem.hardness is not None,
        tolerance=tolerance / (1.0 if problem.approach is None else WORK),
    )


def scene(problem: ContactProblem) -> rf.Scene:
    """Return the problem as a scene, the gap over a flat. Raises `Unsupported` if no nu has its coupling."""
    coupling = problem.coupling
    lower, upper = materials(problem.reduced_modulus, coupling.shear_compliance if coupling else 0.0)
    lower = replace(lower, hardness=problem.hardness)
    return rf.Scene(
        upper=rf.Body(upper, rf.ArraySurface(problem.gap, pixel=problem.spacings)),
        lower=rf.Body(lower, rf.Flat()),
        friction=rf.Friction(coupling.tau, coupling.beta) if coupling else rf.Friction(),
        load=problem.load if problem.load is not None else 1.0,  # unused under a prescribed approach
        size=problem.lengths,
        sliding_direction=coupling.sliding_direction if coupling else 0.0,
        periodic=problem.periodic,
    )


def materials(reduced_modulus: float, shear_compliance: float) -> tuple[rf.Material, rf.Material]:
    """Return bodies of this E* (Pa) and c0 (1/Pa): two alike, or a compressible and a rigid one.

    For a rigid partner ``pi c0 E* = (1 - 2 nu)/(2 (1 - nu))``, which is solved for nu.

    >>> from refimpl.model.materials import Pair
    >>> pair = Pair(*materials(1e9, -1e-10))
    >>> round(pair.reduced_modulus / 1e9, 12), round(pair.shear_compliance * 1e10, 12)
    (1.0, -1.0)
    """
    if shear_compliance == 0:
        return (rf.Material(2 * reduced_modulus, 0.0),) * 2
    k = math.pi * abs(shear_compliance) * reduced_modulus
    if k >= 0.75:
        raise Unsupported(f"pi |c0| E* = {k:.3g}: below 0.75, or Poisson's ratio were -1 or less")
    nu = (1 - 2 * k) / (2 * (1 - k))
    soft = rf.Material(reduced_modulus * (1 - nu**2), nu)
    rigid = rf.Material(RIGID * reduced_modulus, 0.5)
    return (soft, rigid) if shear_compliance > 0 else (rigid, soft)


solve = Own("fft", Abilities(coupling=True, rectangle=True, oblong_elements=True, hardness=True))
"""The production solver."""
dense = Own("dense", replace(solve.abilities, largest=24))
"""The plain reference."""
