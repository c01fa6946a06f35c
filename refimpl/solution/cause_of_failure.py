"""Why a solve did not converge, where the state shows it: what no solver, or not this one, can balance."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from refimpl.model.state import Status
from refimpl.solution.evidence import Evidence

_ENDED_WELL = (Status.CONVERGED, Status.CYCLED, Status.NO_CONTACT, Status.ACCURACY_NOT_REACHED)
_STRONG_COUPLING = 4.0  # beta c / a above which lagged updates do not contract (`verification.stress_tests`)


def cause_of_failure(evidence: Evidence) -> str | None:
    """Return the first cause that applies to a solve that did not converge, with its number; else None."""
    if evidence.status in _ENDED_WELL:
        return None
    return next((f"{evidence.status.value}: {cause}" for cause in _causes(evidence)), None)


def _causes(evidence: Evidence) -> Iterator[str]:
    problem, state, load = evidence.problem, evidence.state, evidence.problem.load
    most = problem.largest_load(state.slopes)
    if load is not None and not load <= most:  # so that NaN counts as more, here and below
        at_most = f"{most:.6g} N at most"
        yield f"at the hardness everywhere the contact carries {at_most} on the slopes of this state"
    borne = evidence.scene.materials.reduced_modulus * problem.grid.nominal_area
    if load is not None and not load <= borne:
        times = f"{load / borne:.3g} times"
        yield f"the mean pressure is {times} the reduced modulus, where lagged slopes diverge"
    strength = abs(problem.friction.slope * problem.elasticity.coupling_ratio)
    if evidence.plan.method != "dense" and not strength <= _STRONG_COUPLING:
        above = f"{strength:.3g}, above {_STRONG_COUPLING:g}"
        yield f"coupling beta c / a = {above}: lagged updates do not contract"
    held = state.traction - problem.friction.slope * state.pressure
    _, by_tau = problem.load_weights(state.slopes, held)  # on the slopes that tau makes by itself
    carried = abs(by_tau)
    if load is not None and not carried <= load:
        yield f"tau on slopes carries {carried / load:.3g} times the load"
    excluded, contact = np.count_nonzero(state.excluded), np.count_nonzero(state.contact)
    if 2 * excluded > contact:
        yield f"under tau {excluded} of {contact} elements in contact carry no adhesive shear, more than half"
