"""The answer at a contact set that stays: how many products it takes, and what starts it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.fixed_set import FixedSet
from refimpl.grid import Array
from tests.refimpl.test_sensitivity import sliding

M = 48


def fixed_set(scene: rf.Scene, oblique: bool | None = None) -> FixedSet:
    s = rf.solve(scene, M, oblique=oblique)
    return FixedSet(s.problem, s.pressure, s.contact & ~s.withheld, s.slopes)


def change(fixed: FixedSet) -> Array:
    """Of the equations when the load grows by one part: the last one alone misses."""
    return np.append(np.zeros(np.count_nonzero(fixed.contact)), -1.0)


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("tau", [0.0, 2e6])
def test_an_answer_takes_a_dozen_products(
    tau: float, periodic: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On rough surfaces, with friction on slopes; 25 to 27 without the inverse that it starts from."""
    fixed = fixed_set(sliding(tau, periodic))
    applied = []
    jacobian = FixedSet._jacobian

    def counted(self: FixedSet, x: Array) -> Array:
        applied.append(x)
        return jacobian(self, x)

    monkeypatch.setattr(FixedSet, "_jacobian", counted)
    found = fixed.response(change(fixed))
    assert found.residual <= 1e-6
    assert len(applied) <= 12


@pytest.mark.parametrize("periodic", [False, True])
def test_the_plain_inverse_carries_the_load_exactly(periodic: bool) -> None:
    fixed = fixed_set(sliding(periodic=periodic))
    load = fixed.problem.load
    assert load is not None
    x = np.append(np.random.default_rng(1).normal(size=np.count_nonzero(fixed.contact)), 0.3)
    found = fixed._plain_inverse(x)
    carried = fixed.peak * found[:-1].sum() * fixed.problem.grid.element_area
    assert carried == pytest.approx(0.3 * load, rel=1e-10)


def test_without_friction_and_slopes_it_is_nearly_the_inverse() -> None:
    """Within the spectrum of the preconditioner, 0.93 to 1.34."""
    scene = replace(sliding(), friction=rf.Friction())
    fixed = fixed_set(scene, oblique=False)
    size = np.count_nonzero(fixed.contact)
    rows = np.array([fixed._plain_inverse(fixed._jacobian(x)) for x in np.eye(size + 1)])
    values = np.linalg.eigvals(rows)
    assert np.abs(values.imag).max() < 1e-3
    assert values.real.min() > 0.9
    assert values.real.max() < 1.5


def test_at_an_approach_the_force_found_is_the_scale() -> None:
    s = rf.solve(sliding(), M, approach=rf.solve(sliding(), M).approach)
    fixed = FixedSet(s.problem, s.pressure, s.contact, s.slopes)
    assert fixed.problem.load is None
    found = fixed._plain_inverse(change(fixed))
    assert found[:-1].sum() * fixed.peak == pytest.approx(-s.pressure.sum(), rel=1e-10)
