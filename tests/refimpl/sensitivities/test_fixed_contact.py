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


def fixed_contact(scene: rf.Scene, oblique: bool | None = None) -> FixedContact:
    s = rf.solve(scene, M, oblique=oblique)
    return FixedContact(s.problem, s.pressure, s.contact & ~s.excluded, s.slopes)


def change(fixed: FixedContact) -> Array:
    """Of the equations when the load grows by one part: the last one alone misses."""
    return np.append(np.zeros(np.count_nonzero(fixed.contact)), -1.0)


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("tau", [0.0, 2e6])
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


@pytest.mark.parametrize("periodic", [False, True])
def test_the_plain_inverse_carries_the_load_exactly(periodic: bool) -> None:
    fixed = fixed_contact(sliding(periodic=periodic))
    load = fixed.problem.load
    assert load is not None
    x = np.append(np.random.default_rng(1).normal(size=np.count_nonzero(fixed.contact)), 0.3)
    found = fixed.plain_inverse(x)
    carried = fixed.peak * found[:-1].sum() * fixed.problem.grid.element_area
    assert carried == pytest.approx(0.3 * load, rel=1e-10)


def test_without_friction_and_slopes_it_is_nearly_the_inverse() -> None:
    """Within the spectrum of the preconditioner, 0.93 to 1.34."""
    scene = replace(sliding(), friction=rf.Friction())
    fixed = fixed_contact(scene, oblique=False)
    size = np.count_nonzero(fixed.contact)
    rows = np.array([fixed.plain_inverse(fixed.jacobian(x)) for x in np.eye(size + 1)])
    values = np.linalg.eigvals(rows)
    assert np.abs(values.imag).max() < 1e-3
    assert values.real.min() > 0.9
    assert values.real.max() < 1.5


def test_at_an_approach_the_force_found_is_the_scale() -> None:
    s = rf.solve(sliding(), M, approach=rf.solve(sliding(), M).approach)
    fixed = FixedContact(s.problem, s.pressure, s.contact, s.slopes)
    assert fixed.problem.load is None
    found = fixed.plain_inverse(change(fixed))
    assert found[:-1].sum() * fixed.peak == pytest.approx(-s.pressure.sum(), rel=1e-10)


def test_the_window_is_the_contact_and_its_neighbours() -> None:
    """Products are of the contact's size, not of the domain's."""
    s = rf.solve(sliding(), M)
    fixed = FixedContact(s.problem, 1e-9 * s.pressure, s.contact, s.slopes)  # of nothing beside a pascal
    contact = np.argwhere(s.contact)
    (first_row, first_column), (last_row, last_column) = contact.min(axis=0), contact.max(axis=0)
    rows, columns = fixed.window.slices
    assert (rows.start, rows.stop) == (first_row - 2, last_row + 3)
    assert (columns.start, columns.stop) == (first_column - 2, last_column + 3)
    assert fixed.contact.shape == fixed.operator.source.shape


def test_no_change_has_no_answer_and_leaves_nothing() -> None:
    fixed = fixed_contact(sliding())
    found = fixed.response(0 * change(fixed))
    assert not found.pressure.any()
    assert (found.approach, found.residual) == (0.0, 0.0)


@pytest.mark.parametrize("oblique", [True, False])
def test_a_solved_state_misses_nothing(oblique: bool) -> None:
    """Neither Eq. (6) on the set, by approaches, nor the load, by loads."""
    fixed = fixed_contact(sliding(), oblique)
    missed = fixed.residual(fixed.problem, fixed.pressure, fixed.approach)
    assert np.abs(missed).max() < 1e-5
    more = fixed.residual(replace(fixed.problem, load=16.0), fixed.pressure, fixed.approach)
    assert more[-1] == pytest.approx(0.25, abs=1e-5)


@pytest.mark.parametrize("product", ["jacobian", "plain_inverse"])
def test_products_take_the_columns_that_operators_hand_on(product: str) -> None:
    fixed = fixed_contact(sliding())
    x = np.random.default_rng(2).normal(size=np.count_nonzero(fixed.contact) + 1)
    apply = getattr(fixed, product)
    assert np.array_equal(apply(x[:, None]), apply(x))


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
        solve_reference(replace(problem, load=problem.load * factor)) for factor in (1 - step, 1.0, 1 + step)
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
