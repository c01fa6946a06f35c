"""The answer at a contact set that stays: how many products it takes, and what starts it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.driver.reference import solve_reference
from refimpl.grid import Array, Grid
from refimpl.scene.discretise import discretise
from refimpl.sensitivities.fixed_contact import FixedContact
from tests.refimpl.sensitivities.test_sensitivity import sliding

M = 48


def fixed_contact(scene: rf.Scene) -> FixedContact:
    s = rf.solve(scene, M)
    return FixedContact(s.problem, s.pressure, s.contact & ~s.excluded, s.slopes)


def change(fixed: FixedContact) -> Array:
    """Of the equations when the load grows by one part: the last one alone misses."""
    return np.append(np.zeros(np.count_nonzero(fixed.contact)), -1.0)


@pytest.mark.parametrize(("tau", "periodic"), [(0.0, True), (2e6, False)])
def test_an_answer_takes_a_dozen_products(
    tau: float, periodic: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On rough surfaces, with friction on slopes; 25 to 27 without the inverse that it starts from."""
    fixed = fixed_contact(sliding(tau, periodic))
    applied = []
    jacobian = FixedContact.jacobian

    def counted(self: FixedContact, x: Array) -> Array:
        applied.append(x)
        return jacobian(self, x)

    monkeypatch.setattr(FixedContact, "jacobian", counted)
    found = fixed.response(change(fixed))
    assert found.residual <= 1e-6
    assert len(applied) <= 12


def test_no_change_has_no_answer_and_leaves_nothing() -> None:
    fixed = fixed_contact(sliding())
    found = fixed.response(0 * change(fixed))
    assert not found.pressure.any()
    assert (found.approach, found.residual) == (0.0, 0.0)


@pytest.mark.parametrize(
    "grid",
    [Grid((24, 16), (1.6e-3, 8e-4)), Grid((15, 24), (1e-3, 1.6e-3)), Grid((20, 12), (1.6e-3, 8e-4), True)],
    ids=str,
)
def test_the_answer_to_the_load_is_that_of_two_solves_on_rectangles_as_well(grid: Grid) -> None:
    """By the dense reference, whose contact set stays; and forces by the same pressures."""
    problem, step = discretise(replace(sliding(periodic=grid.periodic), load=5.0), grid), 1e-5
    assert problem.load is not None
    low, base, high = (
        solve_reference(replace(problem, load=problem.load * factor))[1]
        for factor in (1 - step, 1.0, 1 + step)
    )
    assert np.array_equal(low.contact, high.contact)
    fixed = FixedContact(problem, base.pressure, base.contact, base.slopes)
    assert fixed.approach == pytest.approx(base.approach, rel=1e-10)
    found = fixed.response(change(fixed))
    exact = (high.pressure - low.pressure)[fixed.window.slices] / (2 * step)
    assert np.abs(found.pressure - exact).max() <= 2e-4 * np.abs(exact).max()
    assert found.approach == pytest.approx((high.approach - low.approach) / (2 * step), rel=2e-4)
    forces = fixed.forces(fixed.problem, fixed.pressure, fixed.approach)
    assert forces == pytest.approx(base.forces, rel=1e-10)
