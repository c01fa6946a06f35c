"""The answer at a contact set that stays, and the motion of its edge."""

from __future__ import annotations

from copy import copy
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.driver.reference import solve_reference
from refimpl.grid import Array, Grid, Mask
from refimpl.scene.discretise import discretise
from refimpl.sensitivities.fixed_contact import EdgeMotion, FixedContact
from tests.refimpl.sensitivities.test_sensitivity import sliding

M = 48


def fixed_contact(scene: rf.Scene) -> FixedContact:
    s = rf.solve(scene, M)
    return FixedContact(s.details.problem, s.pressure, s.contact & ~s.details.excluded, s.slopes)


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


def with_contact(contact: Mask, pressure: Array, *, periodic: bool = False) -> FixedContact:
    """A fixed contact with another set and other pressures."""
    s = rf.solve(replace(rf.read_scene("table1-rough"), periodic=periodic), 16)
    fixed = copy(FixedContact(s.details.problem, s.pressure, s.contact, s.slopes))
    fixed.contact, fixed.pressure = contact, np.where(contact, pressure, 0.0)
    return fixed


def hertz_disc(x: float = 0.0, y: float = 0.0) -> tuple[Array, Array]:
    """Squared distances from a point over the squared radius, 15.2 elements; Hertz's pressure there."""
    i, j = np.indices((41, 37))
    inside = ((i - 20 - x) ** 2 + (j - 18 - y) ** 2) / 15.2**2
    return inside, np.sqrt(np.maximum(1 - inside, 0.0))


def test_the_edge_of_a_disc_moves_as_its_pressure_says() -> None:
    """d sqrt(1 - (x/a)^2 - (y/b)^2) by both axes for the load, then by one alone: half the area's growth."""
    inside, pressure = hertz_disc()
    contact = inside < 1
    slope = np.divide(1, pressure, where=contact, out=np.zeros_like(pressure)) / 15.2
    edge = EdgeMotion(with_contact(contact, pressure), (2 * np.pi * 15.2, 3.0), slope * inside)
    along = slope * ((np.indices(inside.shape)[0] - 20) / 15.2) ** 2
    growth, scatter = edge.derivative(along)
    assert growth == pytest.approx(np.pi * 15.2, rel=0.03)
    assert scatter == pytest.approx(1.5, rel=0.2)  # half the load's, and what 9 x 9 elements find otherwise
    assert edge.derivative(pressure) == pytest.approx((0.0, 0.0), abs=1e-10)  # as they are, only more
    assert edge.derivative(slope * inside) == pytest.approx((2 * np.pi * 15.2, 3.0))


@pytest.mark.parametrize("periodic", [False, True])
def test_the_edge_is_where_a_neighbour_is_open(periodic: bool) -> None:
    """Outside a free square all is open; a periodic one has neighbours all round."""
    contact = np.ones((5, 5), dtype=bool)
    contact[0, 2] = False
    expected = (
        ["xx.xx", "x.x.x", "x...x", "x...x", "xxxxx"]
        if not periodic
        else [".x.x.", "..x..", *["....."] * 2, "..x.."]
    )
    edge = EdgeMotion(with_contact(contact, np.ones((5, 5)), periodic=periodic), (1.0, 0.0), np.ones((5, 5)))
    assert ["".join(".x"[mark] for mark in row) for row in edge.elements.astype(int)] == expected
