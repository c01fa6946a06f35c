"""Faults of strangers that once passed the whole suite: each fails a problem of the covering design."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from verification.contestants import compact
from verification.contestants.protocol import ContactProblem, Coupling
from verification.contestants.suite import select


def friction(change: Callable[[Coupling], Coupling]) -> dict[str, Any]:
    def pose(_: ContactProblem, p: ContactProblem) -> ContactProblem:
        return p if p.coupling is None else replace(p, coupling=change(p.coupling))

    return {"pose": pose}


def floored(_: ContactProblem, p: ContactProblem) -> ContactProblem:
    return replace(p, spacing=max(p.spacing, 1e-6), spacing_y=max(p.spacings[1], 1e-6))


def small_c0(c: Coupling) -> Coupling:
    return replace(c, shear_compliance=c.shear_compliance * (abs(c.shear_compliance) >= 1e-11))


def positive_sine(c: Coupling) -> Coupling:
    return replace(c, sliding_direction=float(np.arccos(np.cos(c.sliding_direction))))


TABLE: dict[str, tuple[str, dict[str, Any]]] = {
    "60 iterations": ("oblong-05", {"limit": lambda p, n: 60}),
    "100 iterations": ("oblong-05", {"limit": lambda p, n: 100}),
    "c0 below 1e-11 taken for none": ("sliding-03", friction(small_c0)),
    "pressures below 1 kPa dropped": ("oblong-04", {"pressure": lambda p, f: np.where(f < 1e3, 0, f)}),
    "spacing floored at 1 um": ("oblong-04", {"pose": floored}),
    "sine from the root": ("sliding-04", friction(positive_sine)),
    "beta capped at 1": ("sliding-02", friction(lambda c: replace(c, beta=min(c.beta, 1.0)))),
    "tau lost above 32 elements": ("sliding-35", friction(lambda c: replace(c, tau=0.0))),
}
"""Problem that catches a fault, and the fault."""


@pytest.mark.parametrize("name", TABLE)
def test_a_fault_of_the_table_fails(name: str) -> None:
    slug, hooks = TABLE[name]
    (case,) = select([f"contestant/design-{slug}"])
    assert case.case(compact.solve).run().status == "pass"
    verdict = case.case(compact.with_hooks(**hooks)).run()
    # pressures that were all dropped hold no energy to judge by: an error, and no pass
    assert verdict.status == "fail" or "hold no elastic energy" in verdict.note
