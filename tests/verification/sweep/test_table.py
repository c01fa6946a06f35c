"""Rows of a sweep: keys, columns with their units, exports, error bars against scatter, curves."""

from __future__ import annotations

import json
import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

import refimpl as rf
from refimpl.errors import InputError
from refimpl.solution.model_warning import Limit, ModelWarning
from tests.changed import changed
from verification.cli import plot_curves
from verification.sweep import export, run
from verification.sweep.curves import Point, curves
from verification.sweep.export import header, write_parquet
from verification.sweep.quality import points_of, quality_of, warnings_of
from verification.sweep.run import COORDINATES, Row, outcome
from verification.sweep.store import COLUMNS

STEEL = rf.Material(200e9, 0.3)
SEED, PATH = "lower.surface[0].seed", "lower.surface[0].path"


# --- keys and outcomes ---


def digest(monkeypatch: pytest.MonkeyPatch, root: Path, versions: dict[str, str]) -> str:
    """The digest of a package at ``root`` beside those versions of libraries."""
    monkeypatch.setattr(rf, "__file__", str(root / "__init__.py"))
    monkeypatch.setattr(run, "version", versions.__getitem__)
    return run.code_digest.__wrapped__()  # type: ignore[attr-defined]  # without its cache


def test_a_key_depends_on_every_file_of_the_code_and_every_library(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    files = ("__init__.py", "errors.py", "solvers/dense.py", "solvers/production/level.py")
    for name in files:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(f"{name} = 1\n")
    versions = {"numpy": "2.1", "scipy": "1.15", "ducc0": "0.36"}
    found = [digest(monkeypatch, tmp_path, versions)]
    assert digest(monkeypatch, tmp_path, versions) == found[0]
    for name in files:
        (tmp_path / name).write_text(f"{name} = 2\n")
        found.append(digest(monkeypatch, tmp_path, versions))
    (tmp_path / "solvers/dense.py").rename(tmp_path / "solvers/plain.py")
    found.append(digest(monkeypatch, tmp_path, versions))
    found += [digest(monkeypatch, tmp_path, versions | {name: "9"}) for name in versions]
    assert len(set(found)) == len(found) == 1 + 4 + 1 + 3


def test_each_outcome_of_a_row() -> None:
    """Flats of 5 x 5 elements touch everywhere: 16 on the border. Slopes by their angles."""
    flats = rf.Scene(rf.Body(STEEL, rf.Flat()), rf.Body(STEEL, rf.Flat()), rf.Friction(), 2.0, 1e-3)
    assert outcome(rf.solve(flats, 5), flats)["border_elements"] == 16
    rough = rf.Body(rf.Material(1e7, 0.3), rf.GaussianRoughness(3e-5, 2e-4, seed=2))
    scene = replace(flats, lower=rough, friction=rf.Friction(tau=1e4, beta=0.2), load=0.2)
    s = rf.solve(scene, 16)
    parts = {
        "friction_coefficient": {"active set": 0.25, "iteration": 0.5},
        "contact_area": {"active set": 2.0},
    }
    row = outcome(changed(s, uncertainty=parts, certificate=replace(s.certificate, gap=0.125)), scene)
    same = "friction_coefficient contact_area contact_area_corrected max_pressure approach normal_force"
    same += " friction_force binormal_force friction_coefficient_corrected friction_force_corrected"
    pushed = s.pressure * np.sin(s.slopes.theta_x) * np.cos(s.slopes.theta_y)
    border = np.ones((16, 16), dtype=bool)
    border[1:-1, 1:-1] = False
    expected = {name: getattr(s, name) for name in same.split()} | {
        "status": s.status.value,
        "elastic_friction": pytest.approx(float(pushed.sum()) * (1e-3 / 16) ** 2, rel=1e-10),
        "residual": 0.125,
        "friction_coefficient_error": 0.75,
        "friction_coefficient_cycle": 0.25,
        "contact_area_cycle": 2.0,
        "border_elements": int(s.contact[border].sum()),
    }
    assert {name: row[name] for name in expected} == expected
    assert abs(np.cos(s.slopes.theta_y)[s.contact] - 1).max() > 1e-4


def test_further_outcomes_of_an_oblong_row() -> None:
    """Slopes of 0.03 and 0.04: their root mean square is sqrt(0.00125); E* / H is 1 / 0.91."""
    tilt = 1e-3 * np.add.outer(0.03 * np.arange(12) / 6, 0.04 * np.arange(6) / 6)
    lower = rf.Body(rf.Material(1e9, 0.3, hardness=1e9), rf.ArraySurface(tilt))
    upper = rf.Body(rf.Material(float("inf"), 0.3), rf.Flat())
    scene = rf.Scene(upper, lower, rf.Friction(), 2.0, size=(2e-3, 1e-3))
    warned = [ModelWarning(Limit(x), 1, 2, "") for x in ("border", "half-space", "border")]
    s = changed(rf.solve(scene, (12, 6)), contact_area=5e-7, plastic_area=1e-7, warnings=tuple(warned))
    p = np.arange(72.0).reshape(12, 6)
    found = replace(s.details.state, pressure=p, v=p + 72, approach=0.0)
    row = outcome(changed(s, state=found), scene)
    assert row["plasticity_index"] == pytest.approx(0.00125**0.5 / 0.91)
    assert (row["plastic_area"], row["plastic_share"], row["contact_area_share"]) == (1e-7, 0.2, 0.25)
    assert (row["mean_pressure"], row["mean_gap"], row["elements_x"], row["elements_y"]) == (36, 107.5, 12, 6)
    assert row["warnings"] == "border; half-space"


# --- exports ---


def exported() -> list[Row]:
    values = (("b", 1 / 3, None), ("a", 1e-300, 2.0))
    return [
        dict.fromkeys(COLUMNS)
        | {"key": key, "contact_area": area, "correlation_length": length, "status": "converged"}
        for key, area, length in values
    ]


def test_parquet_reads_back_exactly(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from pyarrow import parquet

    write_parquet(exported(), tmp_path / "t.parquet")
    found = parquet.read_table(tmp_path / "t.parquet").to_pylist()
    plain = [{name.partition(" [")[0]: value for name, value in row.items()} for row in found]
    assert plain == exported()
    assert list(found[0]) == [header(name) for name in plain[0]]
    for name in ("pyarrow", "pyarrow.parquet"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(InputError, match="--csv instead"):
        export.require_parquet(Path("t.parquet"))


def test_a_frame_has_units_and_named_parameters_as_columns() -> None:
    pytest.importorskip("pandas")
    first, second = exported()
    frame = export.to_dataframe([first | {"parameters": '{"lower.material.E": 2e9}'}, second])
    assert frame["lower.material.E"][0] == 2e9
    assert frame["contact_area"].tolist() == [1 / 3, 1e-300]
    assert frame.attrs["units"]["contact_area_error"] == "m^2"


# --- error bars, scatter, curves ---


MU, AREA = "friction_coefficient_corrected", "contact_area_corrected"


def row(realisation: int, mu: float, area: float = 1.0, **others: object) -> Row:
    """A row whose errors are 0.01 of mu and unbounded for A."""
    made = {"realisation": realisation, "status": "converged", MU: mu, "warnings": ""}
    made |= {f"{MU}_error": 0.01, AREA: area, f"{AREA}_error": math.inf}
    return dict.fromkeys(COORDINATES) | made | others


def test_error_and_scatter() -> None:
    # mu 0.1 and 0.3: mean 0.2, sd sqrt(0.02) = 0.1414, relative 0.7071; errors 0.1 and 0.0333, median 0.0667
    mu, area = quality_of([row(0, 0.1), row(1, 0.3), row(2, 9.0, 9.0, status="stagnated")])
    assert mu.scatter == pytest.approx(math.sqrt(0.5), rel=1e-12)
    assert mu.error == pytest.approx((0.1 + 1 / 30) / 2, rel=1e-12)
    assert (mu.points, mu.biased) == (1, 0)
    assert (area.error, area.scatter, area.biased) == (math.inf, 0.0, 1)
    assert [found.scatter for found in quality_of([row(0, 0.1)])] == [None, None]
    assert (
        quality_of([row(0, 0.1, contact_area_corrected_error=None)])[1].error == math.inf
    )  # as a store keeps it


@pytest.mark.parametrize(("wide", "narrow"), [(2, 1), (1, 2)])
def test_points_whose_error_exceeds_their_scatter_are_counted(wide: int, narrow: int) -> None:
    """Errors of 10 % at all points; scatter of 71 % at the wide ones and none at the narrow ones."""
    pairs = [(0.1, 0.3)] * wide + [(0.1, 0.1)] * narrow
    mu, _ = quality_of([row(k, m, load=load) for load, both in enumerate(pairs) for k, m in enumerate(both)])
    assert (mu.points, mu.biased) == (wide + narrow, narrow)


def test_seeds_are_realisations_of_one_point_and_warnings_are_counted() -> None:
    parameters = ({SEED: 5}, {SEED: 6}, {SEED: 6, "lower.material.E": 1.0})
    rows = [row(0, 0.1, parameters=json.dumps(own)) for own in parameters]
    assert [len(group) for group in points_of(rows).values()] == [2, 1]
    warned = [row(0, 0.1, warnings="border; contact radius"), row(1, 0.1, warnings="border")]
    assert warnings_of(warned) == {"border": 2, "contact radius": 1}


def test_points_of_a_curve() -> None:
    rows = [
        row(0, 0.1, load=1.0),
        row(1, 0.3, load=1.0, **{f"{MU}_error": 0.03}),
        row(0, 0.2, load=2.0),
    ]
    first, second = curves(rows, "load", MU)[None]
    assert (first.x, first.realisations, second.realisations) == (1.0, 2, 1)
    assert (first.mean, first.scatter, first.error) == pytest.approx((0.2, math.sqrt(0.02), 0.02))
    assert second == Point(2.0, 0.2, 0.0, 0.01, 1)
    assert curves(rows, "load", AREA)[None][0].error == math.inf
    unbounded = [one | {f"{MU}_error": None} for one in rows]  # as a store keeps it
    assert curves(unbounded, "load", MU)[None][1].error == math.inf
    with pytest.raises(InputError, match="--x"):
        curves(rows, "status", AREA)


def test_means_bars_and_bands_are_in_the_units_of_the_axes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """2 +- 0.25 and 3 mm^2, with a band of 0.5 mm^2, over 1 and 4 um; the second has no bar."""
    drawn: list[Figure] = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, *_, **__: drawn.append(figure))
    points = [Point(1e-6, 2e-6, 0.5e-6, 0.25e-6, 3), Point(4e-6, 3e-6, 0.5e-6, math.inf, 3)]
    plot_curves.draw_sweep({14.0: points}, "lower_rms", "contact_area", "load", tmp_path / "a.png")
    (axes,) = drawn[0].axes
    line, _, (bars,) = axes.containers[0]
    assert line.get_xydata().tolist() == [pytest.approx([1, 2]), pytest.approx([4, 3])]
    assert bars.get_segments()[0][:, 1] == pytest.approx([1.75, 2.25])
    band = axes.collections[-1].get_paths()[0].vertices
    assert (band[:, 1].min(), band[:, 1].max()) == (pytest.approx(1.5), pytest.approx(3.5))
    assert axes.get_legend().get_texts()[0].get_text() == "load = 14 N"
    assert "1 error bars unbounded" in axes.get_title(loc="left")
    assert plot_curves.label("sliding_offset") == "sliding distance (µm)"


@pytest.mark.parametrize(
    ("by", "value", "entry"),
    [
        ("lower_rms", 1.68e-6, "lower rms = 1.68 µm"),
        ("beta", 0.1, "beta = 0.1"),
        (PATH, "/far/away/b.npy", f"{PATH} = b.npy"),
        ("lower.material.hardness", 4e8, "lower.material.hardness = 400 MPa"),
        (None, 0.1, None),
    ],
)
def test_a_legend_has_the_units_of_the_axes(by: str | None, value: object, entry: str | None) -> None:
    assert plot_curves._entry(by, value) == entry
