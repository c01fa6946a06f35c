"""Exports read back: every row, in the study's order, every digit."""

from __future__ import annotations

import csv
import io
import sys
from pathlib import Path

import pytest

from refimpl.errors import InputError
from verification.sweep.export import header, require_parquet, to_csv, to_dataframe, write_csv, write_parquet
from verification.sweep.run import Row
from verification.sweep.store import COLUMNS


def rows() -> list[Row]:
    values = (("b", 1 / 3, None), ("a", 1e-300, 2.0))
    return [
        dict.fromkeys(COLUMNS)
        | {"key": key, "contact_area": area, "correlation_length": length, "status": "converged"}
        for key, area, length in values
    ]


def test_csv_reads_back_exactly_and_in_order(tmp_path: Path) -> None:
    write_csv(rows(), tmp_path / "t.csv")
    found = list(csv.DictReader(io.StringIO((tmp_path / "t.csv").read_text())))
    assert [name.partition(" [")[0] for name in found[0]] == [*COLUMNS, "seconds"]
    assert [(r["key"], float(r["contact_area [m^2]"])) for r in found] == [("b", 1 / 3), ("a", 1e-300)]
    assert [r["correlation_length [m]"] for r in found] == ["", "2.0"]
    assert to_csv(rows()[::-1]) != to_csv(rows())


def test_parquet_reads_back_exactly(tmp_path: Path) -> None:
    from pyarrow import parquet

    write_parquet(rows(), tmp_path / "t.parquet")
    found = parquet.read_table(tmp_path / "t.parquet").to_pylist()
    plain = [{name.partition(" [")[0]: value for name, value in row.items()} for row in found]
    assert plain == [row | {"seconds": None} for row in rows()]
    assert list(found[0]) == [header(name) for name in plain[0]]


def test_without_pyarrow_parquet_is_refused_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", None)
    with pytest.raises(InputError, match="--csv instead"):
        require_parquet(Path("t.parquet"))


def test_a_frame_has_units_and_named_parameters_as_columns() -> None:
    pytest.importorskip("pandas")
    (first, second) = rows()
    frame = to_dataframe([first | {"parameters": '{"lower.material.E": 2e9}'}, second])
    assert frame["lower.material.E"][0] == 2e9
    assert frame["contact_area"].tolist() == [1 / 3, 1e-300]
    assert frame.attrs["units"]["contact_area_error"] == "m^2"


def test_headers_state_units_of_what_is_varied() -> None:
    assert [header(name) for name in ("sliding_direction", "sliding_offset", "tau", "upper_rms")] == [
        "sliding_direction [rad]", "sliding_offset [m]", "tau [Pa]", "upper_rms [m]"
    ]  # fmt: skip
