"""Each seeded fault makes the check fail that is named beside it; without a fault, none of them fails."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import refimpl as rf
from verification.exact.manufactured import manufacture
from verification.matrix.faults import FAULTS
from verification.properties import INVARIANTS, Sample

SAMPLES = (
    Sample(
        bumps=((3, 0, 7, 2, 0), (0, 9, 1, 0, 4), (5, 0, 0, 12, 0), (0, 2, 6, 0, 1), (8, 0, 3, 0, 0)),
        bowl=20, E=(5, 70), nu=(10, 40), pressure=40, tau=40, beta=20, angle=40,
    ),
    Sample(
        bumps=((0, 14, 0, 1), (2, 0, 0, 11), (0, 6, 3, 0), (13, 0, 5, 2)),
        bowl=5, E=(120, 30), nu=(-20, 30), pressure=15, tau=30, beta=30, angle=200,
    ),
)  # fmt: skip
SOLVERS = {method: partial(rf.solve, method=method, tolerance=1e-12) for method in ("fft", "dense")}
STATES = {"friction": (False, False), "oblique": (True, False), "slope-correction": (True, True)}


FITTED: dict[str, dict[str, bool | int]] = {
    "periodic_translation": {"periodic": True},
    "skew_coupling": {"tau": 0},
    "positive_energy": {"tau": 0},
    "load_and_approach": {"tau": 0},
    **{
        name: {"tau": 0, "beta": 0}
        for name in ("reciprocity", "energy_is_work", "monotone_in_load", "monotone_in_approach")
    },
}
"""What an invariant asks of its samples."""


def invariant(name: str) -> None:
    for sample in SAMPLES:
        for solver in SOLVERS.values():
            INVARIANTS[name].check(solver, replace(sample, **FITTED.get(name, {})))


def manufactured(kind: str) -> None:
    state = manufacture(8, 1, 0.7, *STATES[kind])
    for solver in SOLVERS.values():
        found = solver(state.scene, state.M, oblique=state.oblique, slope_correction=state.slope_correction)
        assert np.array_equal(found.contact, state.pressure > 0)
        assert np.abs(found.pressure - state.pressure).max() <= 1e-11 * state.pressure.max()
        assert abs(found.approach / state.approach - 1) <= 1e-11


def cross_check() -> None:
    for sample in SAMPLES:
        dense, fft = (SOLVERS[name](sample.scene, sample.shape) for name in ("dense", "fft"))
        assert dense.status is fft.status is rf.Status.CONVERGED
        assert np.array_equal(dense.contact, fft.contact)
        assert np.abs(dense.pressure - fft.pressure).max() <= 1e-9 * dense.max_pressure


CHECKS: dict[str, Callable[[], None]] = {
    **{name: partial(invariant, name) for name in INVARIANTS},
    **{f"manufactured-{kind}": partial(manufactured, kind) for kind in STATES},
    "cross-check": cross_check,
}


@pytest.mark.parametrize("name", CHECKS)
def test_no_check_fails_without_a_fault(name: str) -> None:
    CHECKS[name]()


@pytest.mark.parametrize("name", FAULTS)
def test_the_fault_is_seen(name: str) -> None:
    for kind in STATES:  # made beforehand, from sums that share nothing with the solvers
        manufacture(8, 1, 0.7, *STATES[kind])
    with FAULTS[name].injected(), pytest.raises(AssertionError):
        CHECKS[FAULTS[name].seen_by]()


def test_a_fault_ends_with_its_context() -> None:
    before = SOLVERS["fft"](SAMPLES[0].scene, 5).pressure
    for fault in FAULTS.values():
        with fault.injected():
            pass
    assert np.array_equal(SOLVERS["fft"](SAMPLES[0].scene, 5).pressure, before)
