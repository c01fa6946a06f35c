"""ContactMechanics (Pastewka, Sanner and others), by its constrained conjugate gradients.

Under a load: ``minimize_proxy`` (Polonsky and Keer), which at an offset in free space is apt to come to rest
at a wrong state (and says so); there ``dual_minimize_proxy``. A periodic half-space keeps its default
``stiffness_q0`` under a load (`negative_controls`). A hardness is a force of an element: where most of the
contact is at it the solver turns to relaxation, and may not end.
"""

from __future__ import annotations

import math
from types import ModuleType
from typing import Any

import numpy as np

from verification.adapters.published_code import PublishedAnswer, PublishedCode, closure, imported
from verification.solver_suite.protocol import Abilities, ContactProblem, Unsupported

_ITERATIONS = 5000


def press(problem: ContactProblem, *, mean_stiffness: float | None = None) -> PublishedAnswer:
    """Return the pressures on the periodic or free half-space, under a load or at an offset.

    ``mean_stiffness`` is ``stiffness_q0`` under a load; zero gives the negative control.
    """
    package = imported("ContactMechanics")
    topography = imported("SurfaceTopography").Topography(
        -problem.gap, problem.lengths, periodic=problem.periodic
    )
    system = imported("ContactMechanics.Systems").NonSmoothContactSystem(
        _half_space(package, problem, mean_stiffness), topography
    )
    if problem.hardness is not None and problem.load is None:
        raise Unsupported("ContactMechanics does not offer: an offset with a hardness, without restarts")
    if problem.load is not None:
        hardness = None if problem.hardness is None else problem.hardness * problem.element_area
        found = system.minimize_proxy(
            external_force=problem.load, hardness=hardness, maxiter=_ITERATIONS, **_tolerances(problem)
        )
        force, work = found.jac, int(found.nfev)
    else:
        found = system.dual_minimize_proxy(
            problem.approach_from_touch,
            init_force=np.zeros(problem.gap.shape),
            gtol=closure(problem),
            maxiter=_ITERATIONS,
        )
        force, work = found.x, 2 * int(found.nit)
    pressure = np.array(force).reshape(problem.gap.shape) / problem.element_area
    return PublishedAnswer(pressure, bool(found.success), operations={"displacements": work})


def _half_space(package: ModuleType, problem: ContactProblem, mean_stiffness: float | None) -> Any:
    shape, sides = problem.shape, problem.lengths
    E = problem.reduced_modulus
    if not problem.periodic:
        return package.FreeFFTElasticHalfSpace(shape, E, sides)
    # at zero the mean pressure displaces nothing, so that offsets count as the problem's approaches do
    stiffness = mean_stiffness if problem.load is not None else 0.0
    return package.PeriodicFFTElasticHalfSpace(shape, E, sides, stiffness_q0=stiffness)


def _tolerances(problem: ContactProblem) -> dict[str, float]:
    """Return the absolute ones in m and N: the defaults fit neither SI units nor a relative gap of 1e-8.

    Penetrations up to ``pentol`` under the pressure make at most twice that of mean gap.
    """
    assert problem.load is not None
    return {
        "pentol": 0.5 * closure(problem),
        # per element; a tension left over changes the energy by its square, so the tolerance's root will do
        "forcetol": math.sqrt(problem.tolerance) * problem.load / problem.gap.size,
        "thermotol": problem.tolerance,
    }


solve = PublishedCode(
    distribution="ContactMechanics",
    extra="contactmechanics",
    setup="NonSmoothContactSystem on the periodic or free FFT half-space: minimize_proxy under a load, "
    "dual_minimize_proxy at an approach",
    abilities=Abilities(rectangle=True, oblong_elements=True, hardness=True),
    press=press,
    wrong="surfaces out of reach: at an approach where nothing touches, version 1.8.3 returns no pressures, "
    "which is right, and says that it did not converge",
)
"""Solver under test."""
