"""The plain reference, `refimpl.plain`, applied to a problem; certified by the production operators."""

from __future__ import annotations

import math

import numpy as np

from refimpl import plain
from refimpl.errors import InputError, NotConverged
from refimpl.grid import Window
from refimpl.model.certificate import State, certify
from refimpl.model.elasticity import Elasticity
from refimpl.model.friction import Friction
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.model.state import Status
from refimpl.operators.influence import whole_grid_influence

_SOFTER = {1: "lower", -1: "upper", 0: None}


def solve_reference(problem: Problem) -> State:
    """Return the plain solution as a certified state.

    Statuses are `CONVERGED`, `CYCLED` and `ITERATION_LIMIT`, and concern the loops only. Raises `InputError`
    for a friction law other than `Friction`, and `NotConverged` where the problem has no solution.
    """
    law, shape, pair = problem.friction, problem.gap.shape, problem.pair
    if not isinstance(law, Friction):
        raise InputError("friction", law, "Friction(tau, beta): the plain reference has no other law")
    if type(problem.elasticity) is not Elasticity:
        raise InputError("elasticity", problem.elasticity, "two half-spaces, by method dense")
    lower, upper = problem.elasticity.equivalent_bodies()
    z_lower, z_upper = problem.heights
    try:
        found = plain.solve(
            z_lower,
            z_upper,
            problem.grid.lengths,
            lower,
            upper,
            law.jump,
            law.slope,
            load=problem.load,
            approach=None if problem.approach is None else problem.approach - problem.datum,
            direction=problem.direction,
            hardness=problem.cap,
            softer=_SOFTER[int(pair.softer_sign)] if math.isfinite(problem.cap) else None,
            periodic=problem.grid.periodic,
            slopes=bool(problem.terms.oblique),
            facets=problem.terms.slope_correction,
        )
    except np.linalg.LinAlgError:
        raise NotConverged("no approach balances the load") from None
    excluded = (found.pressure > 0) & ~found.active
    operator = whole_grid_influence(problem.grid, problem.direction, Window(0, shape[0], 0, shape[1]))
    slopes = Slopes(*found.tangents) if problem.terms.oblique else Slopes.flat(shape)
    u_lower, u_upper = problem.displacements(operator, found.pressure, found.traction, slopes)
    depth = problem.indentation(
        found.pressure, u_lower + u_upper, slopes.cosine_product, found.approach + problem.datum
    )
    status = Status.CYCLED if excluded.any() else Status.CONVERGED
    if found.ended != "converged" or 2 * np.count_nonzero(excluded) > np.count_nonzero(found.pressure > 0):
        status = Status.ITERATION_LIMIT
    f, r = found.pressure, found.traction
    return certify(problem, operator, f, r, slopes, depth, excluded=excluded, status=status)
