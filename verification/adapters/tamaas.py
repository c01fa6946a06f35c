"""Tamaas (Frerot, Anciaux, Rey, Pham-Ba, Molinari 2020), by its Polonsky-Keer solver.

A hardness is solved by ``KatoSaturated`` in units of E*: with moduli in Pa Tamaas 2.9.0 stays at the uniform
pressure that it starts from. Its error was 0 wherever we looked, so all steps are taken; on a bed of pins
(`verification.solver_suite.checks.hardness`) it comes to rest 0.2 H off. Free space takes two steps:
``registerNonPeriodic`` adds the zero-padded operator, ``setIntegralOperator`` makes the solver use it.
Without the second, the periodic problem is solved and nothing said (`negative_controls`).
"""

from __future__ import annotations

import numpy as np

from verification.adapters.published_code import PublishedAnswer, PublishedCode, closure, imported
from verification.solver_suite.protocol import Abilities, ContactProblem, Unsupported

_FREE_SPACE = "dcfft"
_ITERATIONS = 5000
_SATURATED_TOLERANCE = 1e-14
_SATURATED_STEPS = 3000
"""Steps of the projected gradient: on 32 x 32 elements 300 leave 5e-9 of the hardness, 3000 leave 4e-11."""
_GAP_FORMULATION = 0.3
"""Its pressures are a by-product: they miss the approach, which its error does not see, by a third more."""


def press(problem: ContactProblem, *, second_step: bool = True) -> PublishedAnswer:
    """Return the Polonsky-Keer pressures; the solver's error is the mean gap under them over std(heights).

    Loads are mean pressures; a periodic approach is minus the mean gap. ``second_step=False`` gives the
    negative control. Raises `Unsupported` for an approach in free space: Tamaas has none.
    """
    tm = imported("tamaas")
    tm.set_log_level(tm.LogLevel.error)
    if problem.hardness is not None:
        return _saturated(problem, problem.reduced_modulus)
    if problem.approach is not None and not problem.periodic:
        raise Unsupported("tamaas does not offer: an approach in free space")
    model = tm.ModelFactory.createModel(tm.model_type.basic_2d, list(problem.lengths), list(problem.shape))
    model.E, model.nu = problem.reduced_modulus, 0.0  # the other body is rigid, so E is the reduced modulus
    formulation = tm.PolonskyKeerRey.pressure if problem.approach is None else tm.PolonskyKeerRey.gap
    heights = np.ascontiguousarray(-problem.gap)
    tolerance = closure(problem) / (float(problem.gap.std()) or 1.0)
    if problem.approach is not None:
        tolerance *= _GAP_FORMULATION
    solver = tm.PolonskyKeerRey(model, heights, tolerance, formulation, formulation)
    solver.max_iter = solver.dump_freq = _ITERATIONS  # it writes its progress to stdout, at any log level
    if not problem.periodic:
        tm.ModelFactory.registerNonPeriodic(model, _FREE_SPACE)
        if second_step:
            solver.setIntegralOperator(_FREE_SPACE)
    target = -problem.approach if problem.approach is not None else (problem.load or 0.0) / problem.area
    error = solver.solve(target)
    pressure = np.array(model.traction)
    if problem.approach is not None:
        # the gap formulation leaves rounding where the gap is open; contact is where it is exactly closed
        pressure[np.asarray(model["gap"]) > 0] = 0.0
    return PublishedAnswer(pressure, bool(error <= tolerance))


def _saturated(problem: ContactProblem, unit: float) -> PublishedAnswer:
    """Return pressures up to the hardness in units of ``unit`` (Pa), E*. `Unsupported` for an approach."""
    tm = imported("tamaas")
    if problem.load is None or problem.hardness is None:
        raise Unsupported("tamaas does not offer: an approach with a hardness")
    model = tm.ModelFactory.createModel(tm.model_type.basic_2d, list(problem.lengths), list(problem.shape))
    model.E, model.nu = problem.reduced_modulus / unit, 0.0
    heights = np.ascontiguousarray(-problem.gap)
    solver = tm.KatoSaturated(model, heights, _SATURATED_TOLERANCE, problem.hardness / unit)
    solver.max_iter = solver.dump_freq = _SATURATED_STEPS
    if not problem.periodic:
        tm.ModelFactory.registerNonPeriodic(model, _FREE_SPACE)
        solver.setIntegralOperator(_FREE_SPACE)
    error = solver.solve(problem.load / problem.area / unit)
    return PublishedAnswer(np.array(model.traction) * unit, bool(error <= _SATURATED_TOLERANCE))


solve = PublishedCode(
    distribution="tamaas",
    extra="tamaas",
    setup="PolonskyKeerRey, or KatoSaturated in units of E*, on a basic_2d model; in free space by "
    "registerNonPeriodic and setIntegralOperator",
    abilities=Abilities(rectangle=True, oblong_elements=True, hardness=True),
    press=press,
    wrong="periodic grids of M elements, M odd: version 2.9.0 takes the waves of index (M - 1)/2 along x "
    "for the next shorter ones, so that displacements err by up to 19, 12 and 6 % on the highest waves of 9, "
    "15 and 33 elements, and reports success. KatoSaturated may rest at a wrong state, its error being 0",
)
"""Solver under test."""
