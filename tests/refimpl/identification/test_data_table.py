"""Tables of measured friction: what is read, and what is refused in one line."""

from __future__ import annotations

from pathlib import Path

import pytest

from refimpl.errors import InputError
from refimpl.identification import Row, read_rows
from refimpl.scene.scene_file import read_scene


def _written(folder: Path, text: str) -> Path:
    path = folder / "data.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_forces_become_coefficients_with_their_uncertainty(tmp_path: Path) -> None:
    text = "# pin on disc\nload,friction_force,u_friction_force,sliding_offset\n10,2,0.5,\n20,3,1,1e-6\n"
    rows = read_rows(_written(tmp_path, text))
    assert rows == (Row(10.0, 0.2, 0.05), Row(20.0, 0.15, 0.05, sliding_offset=1e-6))


def test_a_row_overrides_the_scene() -> None:
    scene = Row(9.0, 0.1, 0.01, sliding_direction=0.5, sliding_offset=2e-6).of(read_scene("hertz"))
    assert (scene.load, scene.sliding_direction, scene.sliding_offset) == (9.0, 0.5, 2e-6)
    back = Row(9.0, 0.1, 0.01, sliding_direction=0.0, sliding_offset=0.0).of(scene)
    assert (back.sliding_direction, back.sliding_offset) == (0.0, 0.0)
    assert Row(8.0, 0.1, 0.01).of(scene).sliding_direction == 0.5


def test_a_file_needs_a_measured_surface() -> None:
    with pytest.raises(InputError, match="0 measured surfaces"):
        Row(9.0, 0.1, 0.01, lower_file="a.x3p").of(read_scene("hertz"))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "empty"),
        ("load,mu,u_mu\n", "at least two different loads"),
        ("load,mu,u_mu\n5,0.1,0.01\n", "at least two different loads"),
        ("load,mu,u_mu\n5,0.1,0.01\n5,0.11,0.01\n", "at least two different loads"),
        ("load,mu\n5,0.1\n9,0.1\n", "u_mu, the standard uncertainty"),
        ("mu,u_mu\n0.1,0.1\n", "load"),
        ("load,mu,u_mu\n-5,0.1,0.01\n9,0.1,0.01\n", "line 2: load = -5.0: expected a positive number"),
        ("load,mu,u_mu\n5,0.1,0\n9,0.1,0.01\n", "line 2: u_mu"),
        ("load,mu,u_mu\n5,0.1,\n9,0.1,0.01\n", "line 2: u_mu"),
        ("load,mu,u_mu\n5,-0.1,0.01\n9,0.1,0.01\n", "not negative"),
        ("load,mu,u_mu\n5,high,0.01\n9,0.1,0.01\n", "line 2: mu = 'high': expected a finite number"),
        ("load,mu,u_mu\n5 kN,0.1,0.01\n9,0.1,0.01\n", "in N, without its unit"),
        ("load,mu,u_mu\nnan,0.1,0.01\n9,0.1,0.01\n", "finite number"),
        ("load,mu,u_mu\n5,0.1,0.01,7\n9,0.1,0.01\n", "data line 2 = '5,0.1,0.01,7': expected 3 cells"),
        ("load [kN],mu,u_mu\n5,0.1,0.01\n", "in SI units"),
        ("load,load,mu,u_mu\n5,5,0.1,0.01\n", "once"),
        ("load,mu,u_mu\n0.005,0.1,0.01\n9,0.1,0.01\n", "kN mixed"),
        ("load,friction_force,u_friction_force\n5,0.5,0.1\n9,0.0009,0.0001\n", "N and kN mixed"),
        ('load,mu,u_mu\n"5,0.1,0.01\n', "CSV"),
    ],
)
def test_bad_tables_are_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError) as refused:
        read_rows(_written(tmp_path, text))
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


def test_no_file_and_no_text(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="can be read"):
        read_rows(tmp_path / "none.csv")
    (tmp_path / "x.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="UTF-8"):
        read_rows(tmp_path / "x.csv")
