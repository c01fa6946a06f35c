"""The map of coefficient errors: small table computed, written, read, looked up; pairs."""

import json
import math
from dataclasses import replace
from importlib.resources import as_file, files

import numpy as np
import pytest

from appendix_a.errors import InputError
from appendix_a.fem.coefficient_map import CoefficientMap, interpolation_error
from appendix_a.fem.departure import departure
from appendix_a.fem.geometry import sinusoid_boundary
from appendix_a.fem.halfplane import pressed_strip
from appendix_a.fem.map2d import OFFSETS, compute
from appendix_a.fem.sinusoid import departures, setup_for
from appendix_a.leading_order import coupling


def invented(seed=4):
    """A table of random numbers with all axes long enough to interpolate."""
    slopes, wavelengths = (5.0, 10.0, 20.0, 30.0), (8.0, 16.0, 32.0, 64.0)
    axes = slopes, wavelengths, (0.0, 0.125, 0.25, 0.375, 0.5), (-4.0, -2.0, 2.0, 4.0)
    shape = tuple(map(len, axes))
    rng = np.random.default_rng(seed)
    parts = rng.uniform(-1, 1, (2, *shape))
    for end in (0, -1):  # crest and valley are symmetric
        parts[..., end, :] += parts[..., end, ::-1].copy()
    return CoefficientMap(*axes, *parts, rng.uniform(0, 0.02, shape[:3]))


def test_a_computed_entry_is_the_solve_it_came_from():
    table = compute((10.0,), (32.0,), (0.125,), workers=1)
    direct = departures(10.0, 32.0, 0.125, OFFSETS, (0, 1, 2))
    square = np.tan(np.radians(10.0)) ** 2
    amplitude = np.tan(np.radians(10.0)) * 32.0 / (2 * np.pi)
    ends = np.sign(OFFSETS) / 32.0 + 0.125
    climb = amplitude * (np.cos(2 * np.pi * 0.125) - np.cos(2 * np.pi * ends))
    for nu in (0.0, 0.2, 0.4999):
        rest = square * (1 + nu) * ((3 - 4 * nu) * table.kappa_part + table.constant_part)[0, 0, 0]
        assert rest - coupling(nu) * climb == pytest.approx(direct.meshes[-1].at(nu), abs=1e-12)
    assert 0.0 < table.error_percentage_points.max() < 0.02


@pytest.mark.parametrize("axis", ["slopes_deg", "wavelengths", "positions"])
@pytest.mark.parametrize("values", [(4.0, 4.0), (8.0, 4.0), ()])
def test_axes_that_do_not_ascend_are_refused(axis, values):
    axes = {"slopes_deg": (10.0,), "wavelengths": (32.0,), "positions": (0.25,)} | {axis: values}
    with pytest.raises(InputError) as refused:
        compute(**axes, workers=1)
    assert (refused.value.field, refused.value.value) == (axis, values)


def test_written_table_reads_back(tmp_path):
    table = invented()
    table.write(tmp_path / "map.json")
    again = CoefficientMap.read(tmp_path / "map.json")
    assert again.offset == table.offset
    found, kept = (t.departure(12.0, 20.0, 0.3, 0.3) for t in (again, table))
    assert found == pytest.approx(kept, abs=1e-4)  # five decimals are written
    text = (tmp_path / "map.json").read_text()
    (tmp_path / "map.json").write_text(text.replace('"version": 1', '"version": 99'))
    with pytest.raises(InputError):
        CoefficientMap.read(tmp_path / "map.json")


@pytest.mark.parametrize(
    ("field", "spoiled"),
    [
        ("wavelength", lambda old: old[::-1]),
        ("offset", lambda old: []),
        ("position", lambda old: [math.nan, *old[1:]]),
        ("constant_part", lambda old: old[:-1]),
        ("error_percentage_points", lambda old: old[0]),
    ],
)
def test_a_file_whose_axes_are_none_is_refused(tmp_path, field, spoiled):
    path = tmp_path / "map.json"
    invented().write(path)
    document = json.loads(path.read_text())
    document[field] = spoiled(document[field])
    path.write_text(json.dumps(document))
    with pytest.raises(InputError) as refused:
        CoefficientMap.read(path)
    assert refused.value.field == field


def test_lookup_meets_the_nodes_and_mirrors():
    table = invented()
    nu, tangent = 0.3, np.tan(np.radians(10.0))
    node = tangent**2 * (1 + nu) * ((3 - 4 * nu) * table.kappa_part + table.constant_part)[1, 2, 0]
    crest = table.departure(10.0, 32.0, 0.0, nu)
    climb = tangent * 32.0 / (2 * np.pi) * (1 - np.cos(2 * np.pi / 32.0))
    assert crest == pytest.approx(node - coupling(nu) * climb, abs=1e-12)
    downhill, uphill = table.departure(10.0, 32.0, 0.2, nu), table.departure(10.0, 32.0, 0.8, nu)
    assert uphill == pytest.approx(downhill[::-1], abs=1e-12)


def test_first_order_cancels_in_a_pair_of_equal_materials_and_is_lower_minus_upper():
    table = invented()
    no_rest = {"kappa_part": 0 * table.kappa_part, "constant_part": 0 * table.constant_part}
    flat_table = replace(table, **no_rest)
    body = (2.0, 0.3)
    assert flat_table.pair_percent(6.0, 20.0, 0.25, body, body) == pytest.approx(0.0, abs=1e-12)
    alone = flat_table.percent(6.0, 20.0, 0.25, 0.3)
    stiff_upper = flat_table.pair_percent(6.0, 20.0, 0.25, body, (1e12, 0.2))
    stiff_lower = flat_table.pair_percent(6.0, 20.0, 0.25, (1e12, 0.2), body)
    assert stiff_upper == pytest.approx(alone, rel=1e-9)  # a rigid upper body leaves the lower one's error
    assert stiff_lower == pytest.approx(-alone, rel=1e-9)


def test_outside_the_table_is_refused():
    for arguments in ((31.0, 20.0), (-1.0, 20.0), (5.0, 7.0), (5.0, float("nan"))):
        with pytest.raises(InputError):
            invented().departure(*arguments, 0.25, 0.3)


@pytest.mark.parametrize(
    ("field", "changed"),
    [
        ("slope_deg", {"slope_deg": (2.5, 6.5)}),
        ("wavelength", {"wavelength": (50.0,)}),
        ("position", {"position": (0.0, 0.25)}),
    ],
)
def test_a_map_too_short_to_interpolate_is_refused(field: str, changed: dict[str, tuple[float, ...]]) -> None:
    axes = {"slope_deg": (1.0, 2.0, 3.0, 4.0), "wavelength": (8.0, 16.0, 32.0, 64.0), "position": (0.0, 0.5)}
    axes |= {"offset": (-2.0, 2.0)} | changed
    shape = tuple(len(values) for values in axes.values())
    table = CoefficientMap(**axes, **dict.fromkeys(("kappa_part", "constant_part"), np.zeros(shape)),
                           error_percentage_points=np.zeros(shape[:3]))  # fmt: skip
    with pytest.raises(InputError, match=field):
        table.percent(2.0, 20.0, 0.1, 0.3)


@pytest.mark.parametrize(
    ("field", "kept"),
    [("slope_deg", slice(0, 2)), ("wavelength", slice(0, 1)), ("position", slice(0, 3))],
)
def test_a_file_with_incomplete_axes_is_refused_on_reading(tmp_path, field, kept):
    table = invented()
    number = ("slope_deg", "wavelength", "position").index(field)
    where = tuple(kept if k == number else slice(None) for k in range(3))
    parts = {name: getattr(table, name)[where] for name in ("kappa_part", "constant_part")}
    short = replace(
        table,
        **{field: getattr(table, field)[kept]},
        **parts,
        error_percentage_points=table.error_percentage_points[where],
    )
    short.write(tmp_path / "map.json")
    with pytest.raises(InputError) as refused:
        CoefficientMap.read(tmp_path / "map.json")
    assert refused.value.field == field


def shipped():
    with as_file(files("refimpl") / "data" / "coefficient_error.json") as path:
        return CoefficientMap.read(path)


@pytest.mark.parametrize("where", [(25.0, 11.0, 0.07, 0.45), (23.17, 10.1, 0.31, 0.2)])
def test_the_shipped_map_holds_between_its_nodes_on_short_waves(where):
    """The first point was 0.44 percentage points off on a map of wavelengths a factor of two apart."""
    slope, wavelength, position, nu = where
    table = shipped()
    offsets = np.array(table.offset)
    boundary = sinusoid_boundary(slope, wavelength, position, 40.0)
    fresh = departure(setup_for(wavelength, 40.0), 1, boundary, offsets).at(nu)
    error = 100 * np.abs((table.departure(*where) - fresh) / pressed_strip(offsets, nu))
    near, everywhere = interpolation_error(slope)
    assert error[np.abs(offsets) == 2.0].max() < near
    assert error.max() < everywhere


def test_the_stated_interpolation_error_is_small_and_grows_with_the_slope():
    steep, gentle = interpolation_error(25.0), interpolation_error(6.5)
    assert gentle < steep
    assert steep[0] < steep[1] < 0.07
