"""Capped contact in other codes: the same gaps and hardnesses, free and periodic, if installed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from verification.adapters import contactmechanics, tamaas
from verification.adapters.published_code import PublishedCode
from verification.cases import Measured, family
from verification.solver_suite import own
from verification.solver_suite.check import MODULUS
from verification.solver_suite.gaps import rough_bump, waves
from verification.solver_suite.protocol import ContactProblem

M, SEEDS = 48, (11, 12)
SHARES = (0.8, 0.5, 0.25)
"""Hardness over the elastic peak: 2 to 97 % of the contact is plastic."""
LOAD = 0.02 * MODULUS


def problems() -> dict[str, ContactProblem]:
    """Return capped problems by name: rough bumps in free space and rough planes that repeat."""
    found = {}
    for seed in SEEDS:
        heights = waves(M, seed, longest=2, shortest=7)
        gaps = {"free": rough_bump(M, seed), "periodic": 0.01 * (heights.max() - heights)}
        for kind, gap in gaps.items():
            elastic = ContactProblem(
                gap - gap.min(), 1 / M, MODULUS, load=LOAD, periodic=kind == "periodic", tolerance=1e-12
            )
            peak = float(np.asarray(own.solve(elastic).pressure).max())
            for share in SHARES:
                found[f"{kind}, seed {seed}, H = {share} p_max"] = replace(elastic, hardness=share * peak)
    return found


@family(
    "code, name, source, tolerance_reason",
    {
        "capped/tamaas": (
            tamaas.solve, "Tamaas", "Tamaas' KatoSaturated (Stanley and Kato 1997; Almqvist and others 2007)",
            "relative to the hardness; measured 6e-11 after 3000 steps of a projected gradient"),
        "capped/contactmechanics": (
            contactmechanics.solve, "ContactMechanics",
            "ContactMechanics 1.8.3, hardness of minimize_proxy (Pastewka, Sanner and others)",
            "relative to the hardness; measured 5e-11, with the tolerance 1e-12 of both solvers"),
    },
    metric="at_most", tolerance=1e-9,
)  # fmt: skip
def agreement(code: PublishedCode) -> Measured:
    """Capped contact: pressures of {name} on the same gaps.

    Claim: free and periodic, with 2 to 97 % of the contact at the hardness, {name} finds the same pressures
    """
    differences = {}
    for name, problem in problems().items():
        assert problem.hardness is not None
        answer, ours = code(problem), own.solve(problem)
        if not (answer.converged and ours.converged):
            raise RuntimeError(f"{name}: not converged: {code.distribution if ours.converged else 'refimpl'}")
        theirs, found = np.asarray(answer.pressure), np.asarray(ours.pressure)
        differences[name] = float(np.abs(theirs - found).max() / problem.hardness)
    return Measured(max(differences.values()), data={"differences": differences}, note=code.version)
