"""Tables of measured friction: what is read, and what is refused in one line."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

import refimpl as rf
from refimpl.errors import InputError
from refimpl.identification import Row, read_rows
from refimpl.identification.data_table import check_rows
from refimpl.scene.scene_file import read_scene


def _written(folder: Path, text: str) -> Path:
    path = folder / "data.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_forces_become_coefficients_with_their_uncertainty(tmp_path: Path) -> None:
    text = "# pin on disc\nload,friction_force,u_friction_force,sliding_offset\n10,2,0.5,\n20,3,1,1e-6\n"
    rows = read_rows(_written(tmp_path, text))
    assert rows == (Row(10.0, 0.2, 0.05), Row(20.0, 0.15, 0.05, sliding_offset=1e-6))


@pytest.mark.parametrize("separator", [";", "\t"])
def test_semicolons_and_tabs_with_decimal_commas(tmp_path: Path, separator: str) -> None:
    text = "load;mu;u_mu;lower_file\n10,5;0,2;0,05;a,b.npy\n20;0.15;1e-2;\n".replace(";", separator)
    rows = read_rows(_written(tmp_path, text))
    assert rows == (Row(10.5, 0.2, 0.05, lower_file=str(tmp_path / "a,b.npy")), Row(20.0, 0.15, 0.01))
    with pytest.raises(InputError, match=r"line 2: load = '1.000.5'"):
        read_rows(_written(tmp_path, text.replace("10,5", "1.000,5")))


@pytest.mark.parametrize("first", [0, 1])
@pytest.mark.parametrize("mark", ["", '"'])
def test_an_index_column_of_r_or_pandas_is_dropped_with_a_note(tmp_path: Path, first: int, mark: str) -> None:
    body = "".join(f"{mark}{k + first}{mark},{5 + k},0.2,0.01\n" for k in range(3))
    with pytest.warns(UserWarning, match="unnamed first column, which counts the rows, was dropped"):
        rows = read_rows(_written(tmp_path, f"{mark}{mark},load,mu,u_mu\n{body}"))
    assert [row.load for row in rows] == [5, 6, 7]
    with pytest.raises(InputError, match="data column = ''"):  # of something else
        read_rows(_written(tmp_path, ",load,mu,u_mu\n" + "3,5,0.2,0.01\n1,6,0.2,0.01\n"))


def test_marks_that_can_be_decimal_ones_alone(tmp_path: Path) -> None:
    text = "load;mu;u_mu\n1,320;0,126;0,012\n2,345;0,125;0,012\n"
    for table in (text, text.replace(",", ".")):
        assert [row.load for row in read_rows(_written(tmp_path, table))] == [1.320, 2.345]


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
        ("load,mu,u_mu\n5,0.1,0.01\n5,0.11,0.01\n", "at least two different loads"),
        ("load,mu\n5,0.1\n9,0.1\n", "u_mu, the standard uncertainty"),
        ("load,mu,u_mu\n-5,0.1,0.01\n9,0.1,0.01\n", "line 2: load = -5.0: expected a positive number"),
        ("load,mu,u_mu\n5,0.1,0\n9,0.1,0.01\n", "line 2: u_mu"),
        ("load,mu,u_mu\n5,0.1,1e300\n9,0.1,0.01\n", "data line 2: u_mu = 1e+300"),
        ("load,mu,u_mu\n5,1e300,0.01\n9,0.1,0.01\n", "data line 2: mu = 1e+300"),
        ("load,mu,u_mu\n5,-0.1,0.01\n9,0.1,0.01\n", "not negative"),
        ("load,mu,u_mu\n5,high,0.01\n9,0.1,0.01\n", "line 2: mu = 'high': expected a finite number"),
        ("load,mu,u_mu\n5 kN,0.1,0.01\n9,0.1,0.01\n", "in N, without its unit"),
        ("load,mu,u_mu\n5,0.1,0.01,7\n9,0.1,0.01\n", "data line 2 = '5,0.1,0.01,7': expected 3 cells"),
        ("load [kN],mu,u_mu\n5,0.1,0.01\n", "in SI units"),
        ("load,load,mu,u_mu\n5,5,0.1,0.01\n", "once"),
        ("load,mu,u_mu\n0.005,0.1,0.01\n9,0.1,0.01\n", "kN mixed"),
        ("load,friction_force,u_friction_force\n1,150,1\n5,600,4\n", "friction and load in N"),
        ("load,mu,u_mu\n1,0.15,2\n5,0.12,2\n", "in per cent"),
        (
            "load,mu,u_mu\n0.2,5,0.01\n0.16,20,0.01\n0.15,80,0.01\n",
            "data: load and mu = 'load 0.15 to 0.2, mu 5 to 80': expected mu below 2 (are the columns "
            "load and mu exchanged?",
        ),
        ("load,u_mu,mu\n1,0.15,0.02\n5,0.12,0.02\n", "columns swapped?"),
        ("load,friction_force,u_friction_force\n1,0.15,0.01\n60,0.14,0.01\n", "a number under mu"),
        ("load,mu,u_mu\n5,0,0,15,0,01\n9,0,0,14,0,01\n", "decimal commas need ;"),
        ("load,friction_force,u_friction_force\n5,0.5,0.1\n9,0.0009,0.0001\n", "N and kN mixed"),
        ('load,mu,u_mu\n"5,0.1,0.01\n', "CSV"),
        ("load,mu,u_mu\n" + "5,0.1,0.1\n" * 1001, "'1001 rows': expected at most 1000"),
        (
            "\nload,friction_force,u_friction_force\n5,1_0,1\n",
            "line 3: friction_force = '1_0': expected a fin",
        ),
        ("load,mu,u_mu,sliding_direction\n5,1,1,x\n", "a finite number in rad, without"),
        ("load,mu,u_mu\n1,0.3,1\n301,0.3,1\n", "data: load = 'row 2 (301 N), 301 times from the next'"),
        ("load,mu,u_mu\n0.3,2,0.1\n0.1,0.3,0.01\n", "mu rises"),
        ("load,mu,u_mu\n0.147,1,0.1\n0.142,16,0.1\n0.141,40,0.1\n", "friction falls"),
        ("load,mu,u_mu\n1,0.3,1\n2,0.0059,1\n", "data: mu = '0.0059 to 0.3'"),
        ("load,mu,u_mu\n5,0.1,1\n\uff19,0.1,1\n", "line 3: load = '\uff19': expected a finite number"),
        ("load;mu;u_mu\n1,320;1;1\n987;1;1\n", "line 2 = '1,320': expected a decimal point, and no mark"),
    ],
)
def test_bad_tables_are_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError) as refused:
        read_rows(_written(tmp_path, text))
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


def test_soft_bodies_under_light_loads_have_a_mu_beyond_2(tmp_path: Path) -> None:
    rows = read_rows(_written(tmp_path, "load,mu,u_mu\n0.05,6,0.1\n0.5,2.8,0.1\n1.5,2.1,0.1\n"))
    assert [row.mu for row in rows] == [6.0, 2.8, 2.1]


def test_no_file_and_no_text(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="can be read"):
        read_rows(tmp_path / "none.csv")
    (tmp_path / "x.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="UTF-8"):
        read_rows(tmp_path / "x.csv")


def test_every_column_of_a_table(tmp_path: Path) -> None:
    """After a byte order mark, with comments, an empty line, empty cells; paths start at the table."""
    text = (
        "\ufeff# pin\n\n u_mu, mu ,load,lower_file,sliding_offset,upper_file,sliding_direction\n"
        "0.1,0,4,a.npy,-1e-6,,\n  # second\n0.2,0.3,5,,,sub/b.npy,-0.5\n"
    )
    assert read_rows(_written(tmp_path, text)) == (
        Row(4.0, 0.0, 0.1, sliding_offset=-1e-6, lower_file=str(tmp_path / "a.npy")),
        Row(5.0, 0.3, 0.2, sliding_direction=-0.5, upper_file=str(tmp_path / "sub" / "b.npy")),
    )


def test_a_file_replaces_the_map_of_its_body_alone() -> None:
    hertz, ball = read_scene("hertz"), rf.Sphere(0.1)
    old, new = (rf.MeasuredSurface(name, level="mean") for name in ("old.npy", "new.npy"))
    scene = replace(hertz, upper=rf.Body(hertz.upper.material, ball + old))
    found = Row(9.0, 0.1, 0.01, upper_file="new.npy").of(scene)
    assert found.upper.surface == rf.SurfaceSum((ball, new))
    assert found.lower is hertz.lower


def test_the_widest_tables_and_the_least_rows() -> None:
    """Neighbouring loads 300 apart and mu 50 apart; a direction makes another case."""
    check_rows([Row(1.0, 0.01, 0.1), Row(300.0, 0.5, 0.1), Row(90e3, 0.0, 0.1)], 3)
    check_rows([Row(1.0, 0.3, 0.1), Row(1.0, 0.3, 0.1, sliding_direction=1.0)])


COLUMNS = {
    "load": [5, 80.5], "mu": [0.2, 0.15], "u_mu": [0.02, 1e-2], "sliding_offset": [float("nan"), 1e-6],
    "lower_file": [None, "b.npy"],
}  # fmt: skip


@pytest.mark.parametrize("frame", ["dict", "pandas"])
def test_a_data_frame_has_the_rows_of_its_file(tmp_path: Path, frame: str) -> None:
    table = COLUMNS if frame == "dict" else pytest.importorskip("pandas").DataFrame(COLUMNS)
    text = f"load,mu,u_mu,sliding_offset,lower_file\n5,0.2,0.02,,\n80.5,0.15,0.01,1e-6,{tmp_path}/b.npy\n"
    expected = read_rows(_written(tmp_path, text))
    assert read_rows(table) == (expected[0], replace(expected[1], lower_file="b.npy"))


@pytest.mark.parametrize(
    ("table", "said"),
    [
        (COLUMNS | {"load": [5, "80 N"]}, "data row 2: load = '80 N': expected a finite number in N"),
        (COLUMNS | {"load": [None, 80]}, "data row 1: load = '': expected a finite number in N"),
        (COLUMNS | {"force": [1, 2]}, "data column = 'force': expected columns load,mu,u_mu or"),
        ([5, 80], "data = 'list': expected a CSV file's path, or a data frame"),
        (3.0, "data = 'float': expected a CSV file's path, or a data frame"),
    ],
)
def test_what_a_data_frame_lacks_is_named_by_its_row(table: object, said: str) -> None:
    with pytest.raises(InputError, match=f"^{re.escape(said)}"):
        read_rows(table)


def test_an_identification_takes_rows_alone() -> None:
    with pytest.raises(InputError, match=r"'dict': expected at most 1000 rows as of read_rows"):
        check_rows(COLUMNS)  # type: ignore[arg-type]  # a table, in place of its rows
