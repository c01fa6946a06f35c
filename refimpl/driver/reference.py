"""The plain reference, `refimpl.plain`, applied to a problem; certified by the production operators."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from refimpl import plain
from refimpl.errors import InputError, NotConverged
from refimpl.grid import Window
from refimpl.model.certificate import State, certify
from refimpl.model.elasticity import Elasticity
from refimpl.model.forces import Forces
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
    state = certify(problem, operator, f, r, slopes, depth, excluded=excluded, status=status)
    return _with_own_numbers(problem, state, found)


def _with_own_numbers(problem: Problem, state: State, found: SimpleNamespace) -> State:
    """Return the state with the reference's own numbers; their differences are a residual."""
    forces = Forces(found.normal, found.friction, found.transverse)
    terms = float(np.sum(np.abs(found.pressure) + np.abs(found.traction)))
    scale = terms * problem.grid.element_area or 1.0
    differences = [abs(own - other) / scale for own, other in zip(forces, state.forces, strict=True)]
    differences.append(abs(found.area - state.contact_area) / problem.grid.nominal_area)
    if found.normal and problem.nominal_load(found.normal) == problem.nominal_load(state.forces.normal):
        size = abs(found.mu) + scale / abs(problem.nominal_load(found.normal))
        differences.append(abs(found.mu - state.friction_coefficient) / size)
    approach = found.approach + problem.datum
    if np.any((found.pressure > 0) & (found.pressure < problem.cap)):  # else an interval of approaches
        of_element = problem.elasticity.element_compliance(problem.grid) * float(found.p_max)
        size = max(abs(approach), abs(found.approach), of_element) or 1.0  # from either datum
        differences.append(abs(approach - state.approach) / size)
    return replace(
        state,
        forces=forces,
        friction_coefficient=float(found.mu),
        contact_area=float(found.area),
        approach=float(approach),
        certificate=replace(state.certificate, reference=max(differences)),
    )
