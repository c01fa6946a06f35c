"""Input that is no number, or a number out of range, is refused by its name: no TypeError comes out."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from appendix_a import strip, wedge, wedge_tip
from appendix_a.contact_fem.scene import Material, WavyPair
from appendix_a.errors import InputError
from appendix_a.fem import sinusoid
from appendix_a.fem.axisymmetric import asperity
from appendix_a.fem.coefficient_map import CoefficientMap
from appendix_a.fem.map2d import compute
from appendix_a.fem.wedge_fem import wedge_tip as tip_by_elements
from appendix_a.fem3d.coefficients import coefficients
from appendix_a.wedge import fast
from tests.appendix_a.made_up import invented

NO_NUMBERS: tuple[Any, ...] = ("0.1", None, True, "x", math.nan, [0.1], 1j)
WAVE = {"slope_deg": 5.0, "wavelength": 20.0, "position": 0.25, "nu": 0.3, "offsets": [3.0]}
ASPERITY = {"slope_deg": 5.0, "half_base": 8.0, "nu": 0.3, "offsets": [3.0]}
STEEL = Material(1.0, 0.3)
Calls = dict[str, tuple[Callable[..., Any], dict[str, Any]]]
CALLS: Calls = {
    "wedge stresses": (wedge.stresses, {"r": 1.0, "theta": 0.0, "gamma": 0.1, "half_width": 1.0}),
    "wedge displacements": (wedge.displacements, {"r": 1.0, "theta": 0.0, "gamma": 0.1, "nu": 0.3}),
    "wedge tip": (
        wedge_tip.tip_displacement,
        {"x": 2.0, "gamma": 0.1, "nu": 0.3, "half_base": 8.0, "datum": 0.0},
    ),
    "sinusoid": (sinusoid, WAVE),
    "asperity": (asperity, {"shape": "cone"} | ASPERITY),
    "wedge by finite elements": (tip_by_elements, ASPERITY),
    "first order": (strip.first_order, WAVE),
    "printed": (strip.printed, {"slope_deg": 5.0, "wavelength": 20.0, "nu": 0.3, "offsets": [3.0]}),
    "material": (Material, {"E": 1.0, "nu": 0.3}),
    "wavy pair": (WavyPair, {"slope_deg": 5.0, "shift": 0.1, "lower": STEEL, "upper": STEEL}),
}
SOLID: Calls = {
    "coefficients": (coefficients, {"slope_deg": 10.0, "wavelength": 20.0, "position": 0.0, "nu": 0.3})
}
MAP: Calls = {
    "map": (compute, {"slopes_deg": (10.0,), "wavelengths": (32.0,), "positions": (0.25,), "workers": 1})
}
LISTS = ("offsets", "r", "theta", "x")
NUMBERS = [
    (name, field)
    for name, (_, given) in (CALLS | SOLID).items()
    for field, value in given.items()
    if isinstance(value, float | list) and field != "datum"
]


@pytest.mark.parametrize(("name", "field"), NUMBERS)
def test_what_is_no_number_is_refused_by_name(name: str, field: str) -> None:
    call, given = (CALLS | SOLID)[name]
    refusable = [v for v in NO_NUMBERS if not (field in LISTS and (v == [0.1] or v != v))]
    for value in refusable:
        with pytest.raises(InputError) as refused:
            call(**given | {field: value})
        assert field in refused.value.field


FACE = np.pi / 2 - 0.1
OUT_OF_RANGE: dict[str, dict[str, tuple[Any, ...]]] = {
    "wedge stresses": {
        "gamma": (-0.1, 2.0),
        "r": (0.0, 0.9e-300, 1.1e300),
        "theta": (1.5, FACE + 1.1e-12, math.nan),
        "half_width": (0.0, math.inf),
    },
    "wedge displacements": {"nu": (-0.01, 0.51)},
    "wedge tip": {"half_base": (0.5,)},
    "sinusoid": {"slope_deg": (-1.0, 45.1), "wavelength": (3.9, 10001.0), "offsets": ([[1.0]], [-10001.0])},
    "asperity": {"half_base": (7.0,)},
    "first order": {"slope_deg": (90.0,), "wavelength": (0.0,), "position": (math.inf,), "nu": (-1.0,)},
    "material": {"E": (-1.0,), "nu": (0.5,)},
    "wavy pair": {"slope_deg": (0.0, 20.1), "shift": (0.5,), "tau": (-1.0,)},
    "coefficients": {"slope_deg": (60.0,), "wavelength": (3.0,), "nu": (0.5,), "kind": ("bumpy",)},
    "map": {"slopes_deg": ((4.0, 4.0),), "positions": ((),)},
}


@pytest.mark.parametrize(
    ("name", "field", "value"),
    [(n, field, v) for n, fields in OUT_OF_RANGE.items() for field, values in fields.items() for v in values],
)
def test_a_number_out_of_range_is_refused_by_name(name: str, field: str, value: Any) -> None:
    call, given = (CALLS | SOLID | MAP)[name]
    with pytest.raises(InputError) as refused:
        call(**given | {field: value})
    assert field in refused.value.field.split(", ")


def test_limits_of_the_wedges_input() -> None:
    """Both ends of the range of r, a face that its rounding puts outside, the first of several angles."""
    assert np.isfinite(wedge.stresses([1e-300, 1e300], 0.0, 0.1)).all()
    on_the_face = wedge.stresses(0.5, FACE, 0.1)
    np.testing.assert_array_equal(wedge.stresses(0.5, FACE + wedge.FACE_SLACK, 0.1), on_the_face)
    with pytest.raises(InputError) as refused:
        wedge.stresses(0.5, np.array([0.1, 1.6, -1.7]), 0.1)
    assert refused.value.value == 1.6
    with pytest.raises(InputError, match="r = "):
        wedge.stresses(1e299, 0.0, 0.1, 0.01)


def test_a_wedge_that_is_too_narrow_is_told_how_wide_it_must_be() -> None:
    """All angles within 1.18e-3 rad of the load's line take 500,000 nodes; the message rounds that."""
    with pytest.raises(InputError, match=r"a wedge of at least 0\.0012 rad"):
        wedge.stresses(1.0, 0.0, np.pi / 2 - 0.99 * 1.1765e-3 / 2)
    assert fast.line_for(np.zeros(1), np.pi / 2 - 1.01 * 1.1765e-3 / 2).n <= fast.MOST_NODES


# --- tables on disk ---


@pytest.mark.parametrize(
    ("field", "spoiled"),
    [
        ("version", lambda old: 99),
        ("wavelength", lambda old: old[::-1]),
        ("position", lambda old: [math.nan, *old[1:]]),
        ("constant_part", lambda old: old[:-1]),
        ("error_percentage_points", lambda old: old[0]),
    ],
)
def test_a_map_whose_axes_are_none_is_refused(
    field: str, spoiled: Callable[[Any], Any], tmp_path: Path
) -> None:
    path = tmp_path / "map.json"
    invented().write(path)
    document = json.loads(path.read_text())
    document[field] = spoiled(document[field])
    path.write_text(json.dumps(document))
    with pytest.raises(InputError) as refused:
        CoefficientMap.read(path)
    assert refused.value.field == field


def test_a_map_too_short_to_interpolate_is_refused(tmp_path: Path) -> None:
    table = invented()
    parts = ("kappa_part", "constant_part", "error_percentage_points")
    short = replace(
        table, slope_deg=table.slope_deg[:2], **{name: getattr(table, name)[:2] for name in parts}
    )
    short.write(tmp_path / "map.json")
    with pytest.raises(InputError, match="slope_deg"):
        short.percent(7.0, 20.0, 0.1, 0.3)
    with pytest.raises(InputError, match="slope_deg"):
        CoefficientMap.read(tmp_path / "map.json")
