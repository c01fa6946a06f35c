"""Compliances in exact numbers, and the friction law of Eqs (1), (8) and (10)."""

from __future__ import annotations

import math

import numpy as np
import pytest

from refimpl.errors import InputError
from refimpl.model.friction import (
    Friction,
    friction_coefficient_at,
    friction_per_area,
    is_frictionless,
    shear_at,
)
from refimpl.model.materials import Material


def test_hand_made_numbers() -> None:
    # nu = 1/4: 1 - nu^2 = 15/16; (1 + nu)(1 - 2 nu) / 2 = 5/16
    body = Material(E=1 / math.pi, nu=0.25)
    assert body.normal_compliance == pytest.approx(15 / 16, rel=1e-15)
    assert body.shear_compliance == pytest.approx(5 / 16, rel=1e-15)
    assert body.plane_strain_modulus == pytest.approx(16 / 15 / math.pi, rel=1e-15)


LAW = Friction(tau=5.0, beta=0.5)
PRESSURE, ACTIVE = np.array([0.0, 2.0, 3.0]), np.array([False, True, False])


def test_the_traction_is_eq_8() -> None:
    np.testing.assert_array_equal(LAW.traction(PRESSURE, ACTIVE), [0.0, 6.0, 1.5])


def test_the_held_traction_is_what_is_no_multiple_of_the_pressure() -> None:
    held = LAW.held_traction(PRESSURE, ACTIVE)
    np.testing.assert_array_equal(held, [0.0, 5.0, 0.0])
    np.testing.assert_array_equal(LAW.traction(PRESSURE, ACTIVE), held + LAW.slope * PRESSURE)
    assert (LAW.jump, LAW.slope, LAW.is_linear) == (5.0, 0.5, True)


@pytest.mark.parametrize(
    ("law", "expected"), [(Friction(), True), (Friction(tau=1e-9), False), (Friction(beta=1e-9), False)]
)
def test_a_law_without_shear(law: Friction, expected: bool) -> None:
    assert is_frictionless(law) is expected


def test_of_smooth_contact_mu_follows_from_the_mean_pressure() -> None:
    """Eq. (10), ``mu = tau / f_m + beta``, and its derivative with the area, ``tau / N``."""
    law = Friction(tau=15e6, beta=0.08)
    assert shear_at(law, 1e8) == pytest.approx(23e6, rel=1e-15)
    assert friction_coefficient_at(law, 1e8) == pytest.approx(0.23, rel=1e-15)
    load, area, step = 70.0, 1e-6, 1e-9
    slope = friction_coefficient_at(law, load / (area + step)) - friction_coefficient_at(law, load / area)
    assert friction_per_area(law, load) == pytest.approx(slope / step, rel=1e-6)
    assert friction_per_area(law, 0.0) == 0


@pytest.mark.parametrize(
    ("field", "value"), [("tau", -1.0), ("tau", np.inf), ("tau", "1"), ("beta", -0.1), ("beta", np.nan)]
)
def test_parameters_out_of_range_are_refused(field: str, value: float) -> None:
    with pytest.raises(InputError, match=rf"^friction\.{field} = "):
        Friction(**{field: value})
