"""The edge's motion from pressures: of discs whose motion is known, turned, moved, with nothing to tell."""

from __future__ import annotations

from copy import copy
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Mask
from refimpl.sensitivities.edge_motion import EdgeMotion
from refimpl.sensitivities.fixed_contact import FixedContact


def fixed_contact(contact: Mask, pressure: Array, *, periodic: bool = False) -> FixedContact:
    """A fixed contact with another set and other pressures."""
    s = rf.solve(replace(rf.read_scene("table1-rough"), periodic=periodic), 16)
    fixed = copy(FixedContact(s.problem, s.pressure, s.contact, s.slopes))
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
    edge = EdgeMotion(fixed_contact(contact, pressure), (2 * np.pi * 15.2, 3.0), slope * inside)
    along = slope * ((np.indices(inside.shape)[0] - 20) / 15.2) ** 2
    growth, scatter = edge.derivative(along)
    assert growth == pytest.approx(np.pi * 15.2, rel=0.03)
    assert scatter == pytest.approx(1.5, rel=0.2)  # half the load's, and what 9 x 9 elements find otherwise
    assert edge.derivative(pressure) == pytest.approx((0.0, 0.0), abs=1e-10)  # as they are, only more
    assert edge.derivative(slope * inside) == pytest.approx((2 * np.pi * 15.2, 3.0))


def test_an_edge_moves_alike_however_the_square_is_turned() -> None:
    inside, pressure = hertz_disc(0.3, -0.4)
    contact = inside < 1
    contact[18:21, 20] = False
    moved = np.where(contact, np.random.default_rng(3).random(contact.shape), 0.0)
    loaded = contact / np.maximum(pressure, 0.1)
    found = [
        EdgeMotion(fixed_contact(turn(contact), turn(pressure)), (5.0, 0.1), turn(loaded)).derivative(
            turn(moved)
        )
        for turn in (np.array, np.flipud, np.fliplr, np.transpose)
    ]
    for turned in found[1:]:
        assert turned == pytest.approx(found[0], rel=1e-9)


def test_an_edge_moves_alike_wherever_a_periodic_square_begins() -> None:
    inside, pressure = hertz_disc()
    inside, pressure = inside[:37], pressure[:37]
    moved = np.where(inside < 1, np.random.default_rng(3).random(inside.shape), 0.0)
    found = []
    for shift in (0, 9, 20):
        contact, level, change = (np.roll(a, (shift, -shift), (0, 1)) for a in (inside < 1, pressure, moved))
        fixed = fixed_contact(contact, level, periodic=True)
        found.append(EdgeMotion(fixed, (5.0, 0.1), contact / np.maximum(level, 0.1)).derivative(change))
    assert found[1] == pytest.approx(found[0], rel=1e-9)
    assert found[2] == pytest.approx(found[0], rel=1e-9)


def test_a_load_that_moves_no_edge_foretells_none() -> None:
    inside, pressure = hertz_disc()
    edge = EdgeMotion(fixed_contact(inside < 1, pressure), (5.0, 0.1), np.zeros_like(pressure))
    assert edge.derivative(inside) == (0.0, 0.0)


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
    edge = EdgeMotion(fixed_contact(contact, np.ones((5, 5)), periodic=periodic), (1.0, 0.0), np.ones((5, 5)))
    assert ["".join(".x"[mark] for mark in row) for row in edge.elements.astype(int)] == expected
