"""Dense reference against production solver: one case per reported quantity, on all cross-check scenes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache

import numpy as np

import refimpl as rf
from verification.cases import Measured, case, family
from verification.scenes.cross_checks import Trial, cross_checks

SOURCE = "principal pivoting on dense matrices (Murty 1974; Judice and Pires 1994)"
REASON = "required of both solvers is 1e-12; a thousand times that is still below what any grid resolves"


def ended_well(trials: tuple[Trial, ...]) -> tuple[Trial, ...]:
    """Return the trials; RuntimeError where a solver did not end with a certified state."""
    for trial in trials:
        for solution in (trial.dense, trial.fft):
            if not solution.converged:
                raise RuntimeError(f"{trial.name}: {solution.plan.method} ended {solution.status.value}")
    return trials


@cache
def trials() -> tuple[Trial, ...]:
    """Return the scenes, each solved once for all rows."""
    return ended_well(cross_checks())


def worst_of(differences: Mapping[str, float]) -> Measured:
    """Return the largest difference, with all of them as the figure's series."""
    name = max(differences, key=lambda key: differences[key])
    note = f"largest on {name}; {len(differences)} scenes"
    return Measured(value=differences[name], data={"worst": differences}, note=note)


@case("cross-check/contact-sets", metric="equal", tolerance=0.0, source=SOURCE)
def contact_sets() -> Measured:
    """Contact sets of both solvers.

    Claim: dense and fft find the same contact, and exclude the same elements from tau, on every scene
    Tolerance: the contact problem has one solution, and tau's rule is the same for both
    """
    differing = [
        trial.name
        for trial in trials()
        if not np.array_equal(trial.dense.contact, trial.fft.contact)
        or not np.array_equal(trial.dense.details.excluded, trial.fft.details.excluded)
        or trial.dense.status is not trial.fft.status
    ]
    cycled = [trial.name for trial in trials() if trial.dense.status is rf.Status.CYCLED]
    note = f"differing: {', '.join(differing) or 'none'}; cycled: {', '.join(cycled)}"
    return Measured(value=len(differing), reference=0.0, note=note)


def approaches(dense: rf.Solution, fft: rf.Solution) -> float:
    """Return the relative difference of approaches from first contact: never over zero."""
    return abs(dense.approach - fft.approach) / abs(dense.approach + dense.details.problem.datum)


@family(
    "difference, name, claim, tolerance_reason",
    {
        "cross-check/pressure": (
            lambda dense, fft: float(np.abs(dense.pressure - fft.pressure).max()) / dense.max_pressure,
            "Pressures", "dense and fft agree in every element's pressure to 1e-9 of the peak", REASON),
        "cross-check/area": (
            lambda dense, fft: abs(fft.contact_area / dense.contact_area - 1), "Contact areas",
            "dense and fft report one contact area, to 1e-9", "equal sets have equal areas"),
        "cross-check/approach": (
            approaches, "Approaches", "dense and fft report one approach, to 1e-9 of it", REASON),
        "cross-check/friction": (
            lambda dense, fft: abs(dense.friction_coefficient - fft.friction_coefficient),
            "Friction coefficients", "dense and fft report one mu, to 1e-9 absolute", REASON),
        "cross-check/binormal": (
            lambda dense, fft: abs(dense.binormal_force - fft.binormal_force) / dense.normal_force,
            "Binormal forces", "dense and fft report one Q / P, to 1e-9 absolute", REASON),
    },
    metric="at_most", tolerance=1e-9, source=SOURCE,
)  # fmt: skip
def number(difference: Callable[[rf.Solution, rf.Solution], float]) -> Measured:
    """{name} of both solvers."""
    return worst_of({trial.name: difference(trial.dense, trial.fft) for trial in trials()})
