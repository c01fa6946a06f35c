"""Printed numbers against ours: differences and uncertainties by hand."""

from __future__ import annotations

import math
from typing import Any

import pytest

from reports.agreement import bias_and_scatter, by_quantity, fine, numbers


def case(**data: Any) -> dict[str, Any]:
    return {"id": "x", "value": None, "error": None, "data": data}


CASES = {
    "reproduction/table3-area": case(
        **{
            "sigma_e (um)": [0.0, 1.68, 1.68],
            "mesh": [512, 256, 512],
            "printed": [0.64e-6, 0.21e-6, 0.2e-6],
            "ours": [0.65e-6, 0.22e-6, 0.19e-6],
            "half width 95 %": [0.0, 3e-9, 4e-9],
        }
    ),
    "reproduction/section8-scatter": case(**{"scatter of mu": [0.011, 0.02, 0.03], "scatter of A": "no"}),
}


def test_means_of_two_ensembles_scatter_both() -> None:
    """Of 4e-9 m^2 either, 5.66e-3 mm^2 together; the smooth ball has the rounding alone, 5e-4 mm^2."""
    ball, coarse, rough = (n for n in numbers(CASES) if n.part == "Table 3")
    assert (rough.printed, rough.computed, rough.unit) == (pytest.approx(0.2), pytest.approx(0.19), "mm²")
    assert rough.uncertainty == pytest.approx(math.hypot(4e-3 * math.sqrt(2), 0.0005))
    assert ball.uncertainty == pytest.approx(0.0005)
    assert (rough.difference, rough.within, ball.within) == (pytest.approx(-0.01), False, False)
    assert rough.ratio == pytest.approx(0.95)
    assert (coarse.label, rough.label) == ("σ_e 1.68 µm, 256²", "σ_e 1.68 µm, 512²")
    assert fine([ball, coarse, rough]) == [ball, rough]


def test_a_scatter_of_75_surfaces_is_known_to_a_sixth() -> None:
    """2 / sqrt(2 * 74) = 0.1644 of it; numbers that a case lacks are left out."""
    found = [n for n in numbers(CASES) if n.quantity == "scatter of μ"]
    assert [n.computed for n in found] == pytest.approx([1.1, 2.0, 3.0])
    assert [n.half_width for n in found] == pytest.approx([0.1808, 0.3288, 0.4932], rel=1e-3)
    assert [n.within for n in found] == [True, False, False]  # 1.0 is printed, to a tenth
    assert list(by_quantity(numbers(CASES))) == ["scatter of μ", "A, Table 3"]


def test_bias_and_scatter_of_one_number() -> None:
    (one,) = [n for n in numbers(CASES) if n.label == "σ_e 1.68 µm, 512²"]
    assert bias_and_scatter([one]) == (pytest.approx(math.log(0.95)), None)
