"""The rounding of the paper's printed inputs: scaling laws and bounds by hand."""

from __future__ import annotations

import math

import pytest

from verification.reproduction import inputs
from verification.reproduction.printed import TABLE3

ROUGH = TABLE3[1]


@pytest.fixture
def sensitivities(monkeypatch: pytest.MonkeyPatch) -> dict[str, dict[str, float]]:
    """Those of made-up differences: A goes with P^0.9 and R^0.1, p_max with P^0.2 and R^-0.1."""
    made = {"load": (0.9, 0.2), "R": (0.1, -0.1)}
    monkeypatch.setattr(inputs, "differences", lambda column, name, mesh, realisations: made[name])
    return inputs.sensitivities(ROUGH, 16, 1)


def test_sensitivities_obey_the_scaling_of_the_elastic_half_space(
    sensitivities: dict[str, dict[str, float]],
) -> None:
    for name, lengths, pressure in (("A", 2.0, 0.0), ("p_max", 0.0, 1.0)):
        s = sensitivities[name]
        rms = s["sigma, flat"] + s["sigma, ball"]
        modulus = s["E, ball"] + s["E, flat"]
        sums = (
            s["load"] + modulus,  # load and E*
            s["load"] + rms - s["R"],  # heights and load
            2 * s["load"] + s["R"] + rms + s["l"],  # lengths, and the load with their square
        )
        assert sums == pytest.approx((pressure, pressure, lengths), abs=1e-12)


def test_a_smooth_column_has_no_roughness(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(inputs, "differences", lambda *_: (2 / 3, 1 / 3))
    found = inputs.sensitivities(TABLE3[0], 16, 1)["A"]
    assert [found[name] for name in ("sigma, flat", "sigma, ball", "l", "side")] == [0.0] * 4


def test_friction_follows_the_area_by_eq_10(sensitivities: dict[str, dict[str, float]]) -> None:
    """tau A / (P mu) = 1 - 0.08 / 0.106 of mu goes with A / P."""
    share = 1 - 0.08 / 0.106
    found = inputs.of_friction(sensitivities["A"], ROUGH)
    assert (found["R"], found["load"]) == pytest.approx((share * 0.1, share * (0.9 - 1.0)))


def test_half_widths_are_of_the_last_digit_or_less() -> None:
    """P = 2/3 pi 0.4525^2 163.95 = 70.31 N at most."""
    found = inputs.half_widths(ROUGH)
    assert found["R"] == pytest.approx(0.0357, rel=1e-2)
    assert found["load"] == pytest.approx(2 * math.pi / 3 * 0.4525**2 * 163.95 / 70 - 1)
    assert found["sigma, flat"] == pytest.approx(0.0005 / 0.504)


def test_friction_law_is_bounded_by_the_printed_table() -> None:
    """No column's mu can depart from Eq. (10) by more than its digits, A's digits and 0.2 %, twice."""
    for column, bound in zip(TABLE3, inputs.law_bounds(), strict=True):
        slack = 5e-4 + 15e6 * 5e-10 / 70 + 0.002 * column.friction_coefficient[-1]
        assert 0 < bound <= 2 * slack / column.friction_coefficient[-1]
