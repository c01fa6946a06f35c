"""Whatever is no number is refused by name, as a number out of range is: no TypeError comes out."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from appendix_a import strip, wedge, wedge_tip
from appendix_a.contact_fem.scene import Material, WavyPair
from appendix_a.errors import InputError, real, reals
from appendix_a.fem import sinusoid
from appendix_a.fem.axisymmetric import asperity
from appendix_a.fem.wedge_fem import wedge_tip as tip_by_elements
from appendix_a.fem3d.coefficients import coefficients

NO_NUMBERS: tuple[Any, ...] = ("0.1", None, True, "x", float("nan"), [0.1], 1j)
CALLS: dict[str, tuple[Callable[..., Any], dict[str, Any]]] = {
    "wedge stresses": (wedge.stresses, {"r": 1.0, "theta": 0.0, "gamma": 0.1, "half_width": 1.0}),
    "wedge displacements": (wedge.displacements, {"r": 1.0, "theta": 0.0, "gamma": 0.1, "nu": 0.3}),
    "wedge tip": (
        wedge_tip.tip_displacement,
        {"x": 2.0, "gamma": 0.1, "nu": 0.3, "half_base": 8.0, "datum": 0.0},
    ),
    "sinusoid": (
        sinusoid,
        {"slope_deg": 5.0, "wavelength": 20.0, "position": 0.25, "nu": 0.3, "offsets": [3.0]},
    ),
    "asperity": (
        asperity,
        {"shape": "cone", "slope_deg": 5.0, "half_base": 8.0, "nu": 0.3, "offsets": [3.0]},
    ),
    "wedge by finite elements": (
        tip_by_elements,
        {"slope_deg": 5.0, "half_base": 8.0, "nu": 0.3, "offsets": [3.0]},
    ),
    "first order": (
        strip.first_order,
        {"slope_deg": 5.0, "wavelength": 20.0, "position": 0.25, "nu": 0.3, "offsets": [3.0]},
    ),
    "printed": (strip.printed, {"slope_deg": 5.0, "wavelength": 20.0, "nu": 0.3, "offsets": [3.0]}),
    "material": (Material, {"E": 1.0, "nu": 0.3}),
    "wavy pair": (
        WavyPair,
        {"slope_deg": 5.0, "shift": 0.1, "lower": Material(1.0, 0.3), "upper": Material(1.0, 0.3)},
    ),
}
LISTS = ("offsets", "r", "theta", "x")
NUMBERS = [
    (name, field)
    for name, (_, given) in CALLS.items()
    for field, value in given.items()
    if isinstance(value, float | list) and field != "datum"
]


@pytest.mark.parametrize(("name", "field"), NUMBERS)
def test_what_is_no_number_is_refused_by_name(name: str, field: str) -> None:
    call, given = CALLS[name]
    refusable = [v for v in NO_NUMBERS if not (field in LISTS and (v == [0.1] or v != v))]
    for value in refusable:
        with pytest.raises(InputError) as refused:
            call(**given | {field: value})
        assert field in refused.value.field


def test_numbers_of_every_kind_are_taken() -> None:
    one, _ = strip.first_order(5, np.float32(20), np.int64(0), 0.25, offsets=[3])
    other, _ = strip.first_order(5.0, 20.0, 0.0, 0.25, offsets=np.array([3.0]))
    np.testing.assert_array_equal(one, other)
    assert real(10**400) == -real(-(10**400)) == np.inf
    assert reals("x", [10**30, 0.5], "numbers").tolist() == [1e30, 0.5]
    assert reals("x", [], "numbers").shape == (0,)
    with pytest.raises(InputError):
        reals("x", [[1.0], [1.0, 2.0]], "numbers")


@pytest.mark.parametrize("field", ["slope_deg", "wavelength", "position", "nu"])
def test_the_three_dimensional_study_refuses_texts(field: str) -> None:
    given: dict[str, Any] = {"slope_deg": 5.0, "wavelength": 50.0, "position": 0.0, "nu": 0.3}
    with pytest.raises(InputError, match=field):
        coefficients(**given | {field: "5"})
