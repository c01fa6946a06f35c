"""Why a solve did not converge, where the state shows it: what no solver, or not this one, can balance."""

from __future__ import annotations

import numpy as np

from refimpl.model.state import Status
from refimpl.solution.evidence import Evidence

_ENDED_WELL = (Status.CONVERGED, Status.CYCLED, Status.NO_CONTACT, Status.ACCURACY_NOT_REACHED)
_STRONG_COUPLING = 4.0  # beta c / a above which lagged updates do not contract (`verification.stress_tests`)


def cause_of_failure(evidence: Evidence) -> str | None:
    """Return the first cause that applies to a solve that did not converge, with its number; else None."""
    if evidence.status in _ENDED_WELL:
        return None
    causes = (cause(evidence) for cause in (_hardness, _pressure, _coupling, _tilt, _excluded))
    return next((f"{evidence.status.value}: {cause}" for cause in causes if cause is not None), None)


def _hardness(evidence: Evidence) -> str | None:
    most = evidence.problem.largest_load(evidence.state.slopes)
    if evidence.problem.load is None or evidence.problem.load <= most:
        return None
    return f"at the hardness everywhere the contact carries {most:.6g} N at most on the slopes of this state"


def _pressure(evidence: Evidence) -> str | None:
    problem, modulus = evidence.problem, evidence.scene.materials.reduced_modulus
    if problem.load is None or problem.load <= modulus * problem.grid.nominal_area:
        return None
    times = problem.load / (modulus * problem.grid.nominal_area)
    return f"the mean pressure is {times:.3g} times the reduced modulus, where lagged slopes diverge"


def _coupling(evidence: Evidence) -> str | None:
    problem = evidence.problem
    strength = abs(problem.friction.slope * problem.elasticity.coupling_ratio)
    if evidence.plan.method == "dense" or strength <= _STRONG_COUPLING:
        return None
    return f"coupling beta c / a = {strength:.3g}, above {_STRONG_COUPLING:g}: lagged updates do not contract"


def _tilt(evidence: Evidence) -> str | None:
    """Describe the adhesive shear that carries more than the load on the slopes that it makes by itself."""
    problem, state = evidence.problem, evidence.state
    if problem.load is None:
        return None
    held = state.traction - problem.friction.slope * state.pressure
    _, offset = problem.load_weights(state.slopes, held)
    if abs(offset) <= problem.load:
        return None
    return f"tau on slopes carries {abs(offset) / problem.load:.3g} times the load"


def _excluded(evidence: Evidence) -> str | None:
    excluded, contact = (np.count_nonzero(x) for x in (evidence.state.excluded, evidence.state.contact))
    if 2 * excluded <= contact:
        return None
    return f"under tau {excluded} of {contact} elements in contact carry no adhesive shear, more than half"
