"""Tamaas (Frerot, Anciaux, Rey, Pham-Ba, Molinari 2020), by its Polonsky-Keer solver.

Free space takes two steps: ``registerNonPeriodic`` adds the zero-padded operator to the model, and
``setIntegralOperator`` tells the solver to use it. Without the second, Tamaas 2.9.0 solves the periodic
problem and says nothing; `verification.adapters.traps` keeps that in view.

``rough-friction verify --solver verification.adapters.tamaas:solve``
"""

from __future__ import annotations

import numpy as np

from verification.adapters.peer import Peer, PeerAnswer, closure, imported
from verification.contestants.protocol import Abilities, ContactProblem, Unsupported

_FREE_SPACE = "dcfft"
_ITERATIONS = 5000
_GAP_FORMULATION = 0.3
"""Its pressures are a by-product: they miss the approach, which its error does not see, by a third more."""


def press(problem: ContactProblem, *, second_step: bool = True) -> PeerAnswer:
    """Pressures of the Polonsky-Keer solver. Its error is the mean gap under the pressure over std(heights).

    Loads are mean pressures. A periodic approach is minus the mean gap, which the same solver takes as
    constraint of its gap formulation. ``second_step=False`` falls into the trap. Raises `Unsupported` for an
    approach in free space: Tamaas has none.
    """
    tm = imported("tamaas")
    tm.set_log_level(tm.LogLevel.error)
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
    return PeerAnswer(pressure, bool(error <= tolerance))


solve = Peer(
    distribution="tamaas",
    extra="tamaas",
    setup="PolonskyKeerRey on a basic_2d model; in free space by registerNonPeriodic and setIntegralOperator",
    abilities=Abilities(rectangle=True, oblong_elements=True),
    press=press,
)
"""The contestant."""
