"""The condensed three-dimensional table: made of the study's rows, mirrored and paired rightly."""

from __future__ import annotations

import json
from importlib.resources import as_file, files
from pathlib import Path

import numpy as np
import pytest

from appendix_a.errors import InputError
from appendix_a.fem3d.coefficients import LABELS
from appendix_a.fem3d.table import Series, Table3D, condensed, main
from reports.result_files import committed

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


def test_every_point_is_known_to_two_tenths_of_a_percent(table: Table3D) -> None:
    assert max(value for rows in table.uncertainty.values() for value in rows.values()) <= 0.002


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


def test_mirrored_position_changes_the_neighbours(table: Table3D) -> None:
    here, there = table.error(FLANK, 10.0), table.error(Series(20.0, 0.75, 0.3), 10.0)
    assert there[1:4].tolist() == here[4:7].tolist()
    assert there[7:].tolist() == here[7:].tolist()


def test_a_pair_of_one_material_loses_the_antisymmetric_part(table: Table3D) -> None:
    steel = (200e9, 0.3)
    pair, one = table.pair_error(FLANK, 10.0, steel, steel), table.error(FLANK, 10.0)
    assert pair[1] == pytest.approx(pair[4], rel=1e-12)
    assert pair[1] == pytest.approx(0.5 * (one[1] + one[4]), rel=1e-12)
    rigid = table.pair_error(FLANK, 10.0, steel, (1e30, 0.3))
    assert rigid == pytest.approx(one, rel=1e-9)


@pytest.mark.parametrize("slope", [-1.0, 31.0])
def test_refuses_slopes_beyond_the_table(table: Table3D, slope: float) -> None:
    with pytest.raises(InputError, match="slope_deg"):
        table.error(FLANK, slope)


def test_refuses_series_and_files_that_it_does_not_hold(table: Table3D, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="series"):
        table.error(Series(21.0, 0.25, 0.3), 5.0)
    other = tmp_path / "other.json"
    other.write_text('{"table": "other"}')
    with pytest.raises(InputError, match="table"):
        Table3D.read(other)
