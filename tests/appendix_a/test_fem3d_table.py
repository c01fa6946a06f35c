"""The three-dimensional table: extrapolation and its bound, rows, pairs, the shipped file."""

from __future__ import annotations

import json
from importlib.resources import as_file, files
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from appendix_a.errors import InputError
from appendix_a.fem3d import coefficients as module
from appendix_a.fem3d.coefficients import (
    LABELS,
    coefficients,
)
from appendix_a.fem3d.leading_order import waves
from appendix_a.fem3d.patch import normal_coefficient
from appendix_a.fem3d.surface import Sample, X, Y
from appendix_a.fem3d.table import Series, Table3D, condensed, main
from appendix_a.fem3d.wavy import Kind, Waviness
from verification.output.result_files import committed

EXACT = normal_coefficient(X, Y, 0.2)
ODD = 0.01 * np.arange(10.0)


def test_meshes_and_boxes_are_taken_to_their_limits(monkeypatch: pytest.MonkeyPatch) -> None:
    """Errors of 0.1 / level^3 and 0.02 / radius^2 about 0.3 and more, beside a flat surface 1 % too deep."""

    def made(radius: float, level: int) -> Any:
        return 1.31 + ODD + 0.1 / level**3 + 0.02 / (radius / 20.0) ** 2

    def wavy(surface: Waviness, nu: float, radius: float, level: int, edges: object) -> Sample:
        return Sample(EXACT * made(radius, level), 100 * level, 7, 1e-9 * level)

    def flat(wavelength: float, kind: Kind, nu: float, radius: float, level: int) -> Sample:
        return Sample(1.01 * EXACT, 50, 7, 1e-10)

    monkeypatch.setattr(module, "sample", wavy)
    monkeypatch.setattr(module, "flat_sample", flat)
    found = coefficients(10.0, 20.0, 0.25, 0.2)
    assert found.flat == pytest.approx(EXACT)
    assert found.flat_error == pytest.approx(np.full(10, 0.01))
    assert found.error == pytest.approx(0.3 + ODD, abs=1e-9)
    # the last of three meshes lacks 0.1 / 27; limits of both pairs agree; 1.25 is Roache's factor
    assert found.discretisation == pytest.approx(np.full(10, 1.25 * 0.1 / 27), rel=1e-6)
    assert found.truncation == pytest.approx(np.full(10, 1.25 * 0.02 / 9), rel=1e-6)
    assert (found.residual, found.elements) == (pytest.approx(3e-9), 300)
    assert found.antisymmetric == pytest.approx([-0.015] * 3, abs=1e-9)  # +x 1 to 3 are 1, 2, 3 %, -x 4, 5, 6
    assert (found.self_error, found.across[2]) == (pytest.approx(0.3), pytest.approx(0.39))


def test_plane_waves_add_up_to_the_surface() -> None:
    x, y = np.array([0.0, 1.3, -4.0, 7.0]), np.array([0.4, -2.0, 3.0, 9.0])
    for kind in Kind:
        surface = Waviness(12.0, 18.0, 0.15, kind)
        phase = 2 * np.pi * surface.position
        total = sum(a * np.cos(kx * x + ky * y + phase) for a, kx, ky in waves(surface))
        assert total == pytest.approx(surface.height(x, y), rel=1e-12, abs=1e-15)


def test_of_a_point_the_least_uncertain_row_is_kept() -> None:
    point = {"slope_deg": 5.0, "wavelength": 20.0, "position": 0.25, "nu": 0.3}
    point |= {"kind": "ridge", "width": "projected"}
    rows = [
        {**point, "error": [value] * 10, "discretisation": [part] * 10, "truncation": [0.001] * 10}
        for value, part in ((0.1, 0.02), (0.2, 0.01234), (0.3, 0.03))
    ]
    assert condensed(rows) == [{**point, "error": [0.2] * 10, "uncertainty": 0.013}]


def test_what_is_a_crest_to_one_body_is_a_valley_to_the_other() -> None:
    """Errors of 0.1 on a crest, 0.4 in a valley; compliances 0.75 / 3 and 1 / 2: a third and two thirds."""
    table = Table3D(
        {
            Series(20.0, place, nu): {5.0: np.full(10, error), 10.0: np.full(10, 2 * error)}
            for nu in (0.5, 0.0)
            for place, error in ((0.0, 0.1), (0.5, 0.4))
        },
        {},
    )
    crest = Series(20.0, 0.0, 0.3)
    found = table.pair_error(crest, 5.0, lower=(3.0, 0.5), upper=(2.0, 0.0))
    assert found == pytest.approx(np.full(10, (0.1 + 2 * 0.4) / 3))


FLANK = Series(20.0, 0.25, 0.3)


@pytest.fixture(scope="module")
def table() -> Table3D:
    with as_file(files("refimpl") / "data" / "coefficient_error_3d.json") as path:
        return Table3D.read(path)


def test_the_shipped_table_is_the_committed_study(tmp_path: Path) -> None:
    study_file, made = tmp_path / "study.json", tmp_path / "table.json"
    study_file.write_text(json.dumps(committed("appendix_a_3d")))
    assert main([str(study_file), str(made)]) == 0
    shipped = files("refimpl") / "data" / "coefficient_error_3d.json"
    assert made.read_text() == shipped.read_text(encoding="utf-8")


def test_tabulated_slopes_are_met_and_those_between_lie_between(table: Table3D) -> None:
    rows = {
        row["slope_deg"]: row["error"]
        for row in condensed(committed("appendix_a_3d")["points"])
        if at_flank(row)
    }
    for slope, error in rows.items():
        assert table.error(FLANK, slope) == pytest.approx(error, rel=1e-12)
    slopes = np.array([0.0, 8.0, 10.0])
    found = table.error(FLANK, slopes)
    assert found.shape == (3, len(LABELS))
    assert np.all(found[0] == 0)
    assert found[2, 1] < found[1, 1] < rows[6.5][1]


def at_flank(row: dict[str, object]) -> bool:
    series = Series(row["wavelength"], row["position"], row["nu"], row["kind"], row["width"])  # type: ignore[arg-type]  # JSON
    return series == FLANK


def test_refuses_series_and_files_that_it_does_not_hold(table: Table3D, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="series"):
        table.error(Series(21.0, 0.25, 0.3), 5.0)
    other = tmp_path / "other.json"
    other.write_text('{"table": "other"}')
    with pytest.raises(InputError, match="table"):
        Table3D.read(other)
