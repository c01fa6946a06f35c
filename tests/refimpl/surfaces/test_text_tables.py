"""Tables of text: points, missing ones, units, what stands above them, and what is refused."""

from __future__ import annotations

import math
import tempfile
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from hypothesis import event, settings
from hypothesis import given as drawn
from hypothesis import strategies as st

import refimpl as rf
from refimpl.errors import InputError
from refimpl.measured.readers import read
from refimpl.measured.reading import IMAGE
from refimpl.measured.text_lines import NOT_MEASURED
from refimpl.measured.text_tables import read_table
from tests.refimpl.surfaces import instrument_writers as write
from tests.refimpl.surfaces.instrument_writers import BOTH, MAP, NX, NY, PIXEL, same


@pytest.mark.parametrize("name", ["map.xyz", "map.txt"])
def test_the_pitch_of_points_is_their_own(tmp_path: Path, name: str) -> None:
    write.write_xyz(tmp_path / name, MAP)
    reading = read(tmp_path / name, unit="um")
    np.testing.assert_allclose(reading.pixel, PIXEL, rtol=1e-12)
    in_mm = read(tmp_path / name, unit="um", pixel_size=(2e-3, 3e-3))
    assert in_mm.notes == ("a pixel of 0.002 x 0.003 m is used; the file states 2e-06 x 3e-06 m",)
    assert read(tmp_path / name, unit="um", pixel_size=(2.01e-6, 3e-6)).pixel == (2.01e-6, 3e-6)
    for other in ((1e-6, 1e-6), (2.03e-6, 3e-6), (2e-6, 3e-3)):
        with pytest.raises(InputError, match=r"pixel_size = .*, 2e-06 x 3e-06 m \(in one of the units\)"):
            read(tmp_path / name, unit="um", pixel_size=other)
    with pytest.raises(InputError, match=r"holds points x, y, z and states no unit .*--unit um"):
        read(tmp_path / name)


def test_a_missing_row_of_points_is_missing_points(tmp_path: Path) -> None:
    i, j = np.nonzero(np.arange(NY) != 5 * np.ones((NX, 1)))
    points = np.stack([i * 2.0, j * 3.0, (i - 2 * j) / 10], axis=1)
    np.savetxt(tmp_path / "map.xyz", points)
    heights = read(tmp_path / "map.xyz", unit="um").heights
    assert heights.shape == (NX, NY)
    assert np.isnan(heights[:, 5]).all()
    assert np.isnan(heights).sum() == NX


def test_points_off_a_grid_are_refused_with_a_number(tmp_path: Path) -> None:
    points = np.random.default_rng(3).random((200, 3))
    np.savetxt(tmp_path / "map.xyz", points)
    with pytest.raises(InputError, match="x, y, z on a regular grid"):
        read(tmp_path / "map.xyz", unit="um")
    grid = np.array([(x, y, 1.0) for x in range(5) for y in range(5)])
    grid[7, 0] += 0.3
    np.savetxt(tmp_path / "map.xyz", grid)
    with pytest.raises(InputError, match="of the pitch in x off it"):
        read(tmp_path / "map.xyz", unit="um")
    np.savetxt(tmp_path / "map.xyz", np.vstack([grid, grid])[:, :3] * [0, 1, 1])
    with pytest.raises(InputError, match="a line scan: all points have one x"):
        read(tmp_path / "map.xyz", unit="um")


@pytest.mark.parametrize("columns", [600, 3])
def test_a_table_of_text_takes_at_most_four_times_its_numbers(columns: int, tmp_path: Path) -> None:
    numbers = np.arange(360_000.0).reshape(-1, columns) % 977 / 8
    np.savetxt(tmp_path / "a.csv", numbers, fmt="%.3f", delimiter=";")
    tracemalloc.start()
    found = read_table(tmp_path / "a.csv").rows
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert np.array_equal(found, numbers)
    assert peak <= 4 * numbers.nbytes


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("x;z\n" + "\n".join(f"{k};{k * k},5" for k in range(20)), "a line scan: 20 rows of 1 columns"),
        ("\n".join(f"{k / 7} {k / 3}" for k in range(20)), "a map .a line scan: 20 rows of 2 columns"),
        ("no numbers\nat all\n", "rows of numbers .*it begins with 'no numbers'"),
        ("1 2 3 4 5\n1 2 3 4 5\n1 2 3\n", "rows of one length and kind .line 3 has 3, the first row 5"),
    ],
)
def test_a_refusal_says_what_was_found(tmp_path: Path, content: str, said: str) -> None:
    (tmp_path / "a.csv").write_text(content)
    with pytest.raises(InputError, match=said):
        read(tmp_path / "a.csv", unit="um", pixel_size=PIXEL)


def test_a_first_row_of_one_height_is_no_axis(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("0\t0\t0\t0\n7\t0\t-1\tnan\n2\t5\t1\t3\n")
    assert read_table(tmp_path / "a.txt").rows.shape == (3, 4)


def test_a_line_that_is_cut_off_gets_a_note(tmp_path: Path) -> None:
    z = np.random.default_rng(3).normal(size=(6, 5))
    np.savetxt(tmp_path / "whole.csv", z, fmt="%.3f", delimiter=";")
    assert read_table(tmp_path / "whole.csv").notes == ()
    lines = (tmp_path / "whole.csv").read_text().splitlines()
    (tmp_path / "cut.csv").write_text("\n".join([*lines[:4], "0.1;0.2"]))
    (note,) = read_table(tmp_path / "cut.csv").notes
    assert note == "lines with fewer entries than the first row: 1, from line 5 on; is the file cut off?"


def test_a_text_of_two_images_gives_either(tmp_path: Path) -> None:
    write.write_txt(tmp_path / "one.txt", MAP)
    one = (tmp_path / "one.txt").read_bytes().decode("latin-1")
    write.write_txt(tmp_path / "one.txt", 2 * MAP)
    other = (tmp_path / "one.txt").read_bytes().decode("latin-1").replace("Topography", "Retrace")
    (tmp_path / "two.txt").write_text(one + other)
    same(read(tmp_path / "two.txt").heights)
    second = read(tmp_path / "two.txt", channel="Retrace")
    same(second.heights / 2)
    assert second.channels == ("Topography", "Retrace")
    (tmp_path / "two.txt").write_text(one + one)
    with pytest.raises(InputError, match="one image, or images with names"):
        read(tmp_path / "two.txt", **BOTH)


@pytest.mark.parametrize("encoding", ["latin-1", "utf-8", "utf-8-sig", "utf-16"])
def test_a_micro_sign_in_any_encoding(tmp_path: Path, encoding: str) -> None:
    write.write_txt(tmp_path / "map.txt", MAP)
    text = (tmp_path / "map.txt").read_bytes().decode("latin-1")
    (tmp_path / "map.txt").write_bytes(text.encode(encoding))
    reading = read(tmp_path / "map.txt")
    same(reading.heights)
    np.testing.assert_allclose(reading.pixel, PIXEL, rtol=1e-12)


@pytest.mark.parametrize("separator", [",", "\t", ";", " "])
def test_an_unknown_spelling_that_begins_like_a_comment_is_refused(tmp_path: Path, separator: str) -> None:
    rows = [separator.join(["1.5", "2.25", "0.5", "3.5", "#lost", "4.5"])] * 6
    (tmp_path / "a.txt").write_text("\n".join(rows))
    with pytest.raises(InputError, match=r"comments that begin a line or follow a row .line 1:"):
        read_table(tmp_path / "a.txt")


@pytest.mark.parametrize(
    ("mark", "size", "noted"),
    [(-9999, 1, True), (-999, 300, True), (-1e6, 1, True), (-4, 1, False), (-4, 0, False), (-9999, 0, True)],
)
def test_points_far_outside_all_others_get_a_note(
    tmp_path: Path, mark: float, size: float, noted: bool
) -> None:
    z = size * np.random.default_rng(3).uniform(-1, 1, (30, 20))
    z[3:5, 4:9] = mark
    np.save(tmp_path / "a.npy", z)
    notes = rf.inspect_surface(tmp_path / "a.npy", unit="um", pixel_size=1e-6).document()["notes"]
    told = [note for note in notes if "far outside all others" in note]
    assert len(told) == noted
    assert all(note.startswith(f"10 points are at {mark:.6g} um") for note in told)
    assert all(note.endswith("write nan there") for note in told)


@pytest.mark.parametrize(
    "head",
    [
        "# Kanal: z\n# Breite: {0},0 µm\n# Höhe: {1},0 µm\n# Werteeinheit: nm\n",
        "Breite;{0},00;um\nHöhe;{1},00;um\nZ-Einheit;nm\n",
        "Breite [µm]: {0},0\nHoehe [µm]: {1},0\nWerteinheit: nm\n",
        "# Canal : z\n# Largeur : {0},0 µm\n# Hauteur : {1},0 µm\n# Unités des valeurs : nm\n",
        "Largeur\t{0},0\tµm\nHauteur\t{1},0\tµm\nUnité de valeur\tnm\n",
        "# Anchura: {0},0 µm\n# Altura: {1},0 µm\n# Unidades de valor: nm\n",
        "ANCHO = {0},0 um\nALTO = {1},0 um\nUnidad de los valores = nm\n",
        "Width (um): {0}.0\nHeight (um): {1}.0\nValue unit: nm\n",
    ],
)
def test_headers_in_german_french_and_spanish_are_read_as_english_ones(tmp_path: Path, head: str) -> None:
    edges = round(1e6 * NX * PIXEL[0]), round(1e6 * NY * PIXEL[1])
    z = np.where(np.isnan(MAP), 0.0, MAP)
    rows = [";".join(f"{1e9 * v:.2f}" for v in line) for line in z.T[::-1]]
    text = head.format(*edges) + "\n".join(rows).replace(".", ",")
    (tmp_path / "map.txt").write_text(text)
    found = read(tmp_path / "map.txt")
    np.testing.assert_allclose(found.heights, z, rtol=0, atol=1e-20)
    np.testing.assert_allclose(found.pixel, PIXEL, rtol=1e-12)
    assert (found.unit, found.orientation) == ("nm", IMAGE)


@pytest.mark.parametrize("width", ["1,024", "1.024,5", "1,024.5"])
def test_edges_that_may_have_thousands_are_refused(tmp_path: Path, width: str) -> None:
    head = f"Width: {width} um\nHeight: 12,5 um\nValue units: um\n"
    (tmp_path / "a.txt").write_text(head + "1.5 2.5 0.5 3.5\n" * 5)
    with pytest.raises(InputError, match="unit, pixel_size"):
        read(tmp_path / "a.txt")


def test_an_image_of_three_columns_is_no_table_of_points(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("# Breite: 3,0 um\n# Höhe: 4,0 um\n" + "1 2 3\n" * 4)
    with pytest.raises(InputError, match="at least 4 an axis"):
        read(tmp_path / "a.txt", unit="um")


@pytest.mark.parametrize("separator", [",", "\t", ";", " "])
@pytest.mark.parametrize("mark", ["1.#QNAN", "#N/A"])
def test_missing_points_that_begin_like_comments_keep_their_row(
    tmp_path: Path, separator: str, mark: str
) -> None:
    """In all rows and in one; a comment follows the last number of a row or begins a line."""
    for missing in ((range(5), 2), ([3], 0), ([1, 2], 4)):
        z = 0.1 * np.arange(25.0).reshape(5, 5) % 0.7 + 0.11
        z[missing] = np.nan
        rows = [separator.join(mark if np.isnan(v) else f"{v:.2f}" for v in row) for row in z]
        rows[1] += " # at 20 C"
        (tmp_path / "a.txt").write_text("\n".join([*rows[:4], "# a comment, 5", rows[4]]))
        np.testing.assert_allclose(read_table(tmp_path / "a.txt").rows, z, rtol=0, atol=1e-15)


@drawn(st.data())
@settings(deadline=None, max_examples=60)
def test_random_tables_give_their_numbers_or_a_refusal(data: st.DataObject) -> None:
    """Separators, missing marks, decimal commas, headers: the numbers, but for an empty first or last column.

    Such a column is no other than a separator at the ends of all lines; it goes with a note. Even first rows
    and columns are coordinates; numbers that may be of thousands are refused.
    """
    separator = data.draw(st.sampled_from(["\t", ";", ",", " ", ", "]))
    comma = data.draw(st.booleans()) if "," not in separator else False
    marks = [*NOT_MEASURED, "NaN", "BAD", "void", *([""] if separator != " " else [])]
    shape = data.draw(st.integers(2, 7)), data.draw(st.integers(4, 7))
    mark = data.draw(st.sampled_from(marks))
    entry = st.floats(-1e3, 1e3, width=32).map(lambda v: round(v, 3)) | st.sampled_from([math.nan] * 3)
    z = np.array([[data.draw(entry) for _ in range(shape[1])] for _ in range(shape[0])])
    head = data.draw(
        st.sampled_from(["", "Sample: plate 7\n", "# Width: 4 um\n\n", "a;b\nunit;um\n", "a b c d\n"])
    )
    lines = [separator.join(mark if math.isnan(v) else repr(float(v)) for v in row) for row in z]
    text = "\n".join(line.replace(".", ",") if comma else line for line in lines)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.txt"
        path.write_text(head + text + data.draw(st.sampled_from(["", "\n", "\n\n# end\n"])))
        try:
            found = read_table(path)
        except InputError as refused:
            event("refused")
            if any(
                word in str(refused)
                for word in ("a thousand times as much", "their coordinates", "second column", "on a grid")
            ):
                return
            assert mark == "void" or (np.isfinite(z).sum(axis=1) == 0).any() or not _paired(z)
            return
    if any("are x and y" in note for note in found.notes):
        np.testing.assert_array_equal(found.rows[:, 2], z[1:, 1:].ravel())
        return
    event("read")
    for side, column in (("last", -1), ("first", 0)):
        if any(side in note for note in found.notes):
            assert mark == ""
            assert np.isnan(z[:, column]).all()
            z = np.delete(z, column, axis=1)
    np.testing.assert_array_equal(found.rows, z)


def _paired(z: np.ndarray) -> bool:
    """Two lines of numbers one after the other, or one at the end: where a table is seen to begin."""
    some = np.isfinite(z).any(axis=1)
    return bool((some[1:] & some[:-1]).any() or some[-1])


@pytest.mark.parametrize("side", ["first row", "first column"])
def test_uneven_coordinates_alone_are_refused(tmp_path: Path, side: str) -> None:
    """Ten of them or more that rise steadily, beside heights that do not."""
    rng = np.random.default_rng(5)
    z = rng.normal(size=(14, 13))
    at = np.cumsum(rng.uniform(0.5, 2.0, 14))[::-1]
    np.savetxt(tmp_path / "plain.csv", z, fmt="%.3f", delimiter=",")
    assert read_table(tmp_path / "plain.csv").rows.shape == (14, 13)
    table = np.column_stack([at, z])
    np.savetxt(tmp_path / "a.csv", table.T if side == "first row" else table, fmt="%.3f", delimiter=",")
    with pytest.raises(InputError, match=f"heights without their coordinates .*{side}"):
        read_table(tmp_path / "a.csv")


def test_blank_lines_between_blocks_of_points_are_no_end(tmp_path: Path) -> None:
    blocks = ["\n".join(f"{i} {j} {i - 2 * j}" for j in range(6)) for i in range(5)]
    (tmp_path / "map.xyz").write_text("\n\n".join(blocks) + "\n")
    assert read(tmp_path / "map.xyz", unit="um").heights.shape == (5, 6)
