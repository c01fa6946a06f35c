"""Measured surfaces: files, window, gaps, level, refusals. All files are written here."""

from __future__ import annotations

import os
import sys
import time
import warnings
import zipfile
from pathlib import Path

import numpy as np
import pytest

from refimpl.errors import InputError
from refimpl.grid import Grid
from refimpl.surfaces import MeasuredSurface, SurfaceWarning, readers
from refimpl.surfaces.gaps import fill
from refimpl.surfaces.levelling import DEGREES, fit

DX, DY = 1.5e-7, 3.1e-7  # pixels that are not square
NX, NY = 60, 50
SIDE = 8e-6  # the area is 9.0 x 15.5 um
RNG = np.random.default_rng(5)
ROUGH = 1e-8 * RNG.normal(size=(NX, NY))

XML = """<?xml version="1.0" encoding="UTF-8"?>
<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2"><Record1><Revision>ISO5436 - 2000</Revision>
<FeatureType>SUR</FeatureType><Axes>
<CX><AxisType>I</AxisType><DataType>L</DataType><Increment>{dx}</Increment><Offset>0</Offset></CX>
<CY><AxisType>I</AxisType><DataType>L</DataType><Increment>{dy}</Increment><Offset>0</Offset></CY>
<CZ><AxisType>A</AxisType><DataType>D</DataType></CZ></Axes></Record1>
<Record3><MatrixDimension><SizeX>{nx}</SizeX><SizeY>{ny}</SizeY><SizeZ>1</SizeZ></MatrixDimension>
<DataLink><PointDataLink>bindata/data.bin</PointDataLink></DataLink></Record3></p:ISO5436_2>"""


def write_x3p(path: Path, z: np.ndarray, dx: object = DX, dy: object = DY, data: bytes | None = None) -> Path:
    """An X3P file as ISO 25178-72 has it: x runs fastest."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("main.xml", XML.format(dx=dx, dy=dy, nx=z.shape[0], ny=z.shape[1]))
        archive.writestr("bindata/data.bin", z.T.astype("<f8").tobytes() if data is None else data)
    return path


def write_npy(path: Path, z: np.ndarray) -> MeasuredSurface:
    np.save(path, z)
    return MeasuredSurface(path, unit="m", pixel_size=(DX, DY), level="none")


def points() -> tuple[np.ndarray, np.ndarray]:
    """Where the pixels' centres are (m)."""
    return (np.arange(NX)[:, None] + 0.5) * DX, (np.arange(NY)[None, :] + 0.5) * DY


def elements(grid: Grid, offset: tuple[float, float] = (0.0, 0.0)) -> tuple[np.ndarray, np.ndarray]:
    """Where the central window's element centres are (m), from the same corner."""
    x = (NX * DX - grid.side) / 2 + grid.centres + offset[0]
    y = (NY * DY - grid.side) / 2 + grid.centres + offset[1]
    return x[:, None], y[None, :]


def quietly(surface: MeasuredSurface, grid: Grid, offset: tuple[float, float] = (0.0, 0.0)) -> np.ndarray:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SurfaceWarning)
        return surface.heights(grid, offset)


# --- files ---


@pytest.mark.parametrize("name", ["a.npy", "a.csv", "a.asc", "a.txt"])
def test_plain_tables_are_indexed_along_x_then_y(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    if name.endswith("npy"):
        np.save(path, ROUGH * 1e9)
    else:
        np.savetxt(path, ROUGH * 1e9, fmt="%.17g", delimiter="," if name.endswith("csv") else " ")
    reading = MeasuredSurface(path, unit="nm", pixel_size=[DX, DY]).reading  # type: ignore[arg-type]  # as in TOML
    np.testing.assert_allclose(reading.heights, ROUGH, rtol=1e-15, atol=0)
    assert reading.pixel == (DX, DY)


def test_x3p_keeps_its_oblong_pixels_and_its_axes(tmp_path: Path) -> None:
    surface = MeasuredSurface(write_x3p(tmp_path / "a.x3p", ROUGH))
    np.testing.assert_array_equal(surface.reading.heights, ROUGH)
    np.testing.assert_allclose(surface.reading.pixel, (DX, DY), rtol=1e-15)
    assert "x3p" in surface.describe(Grid(SIDE, 16))[0]


def test_text_with_an_instruments_header_is_scaled_by_it(tmp_path: Path) -> None:
    """Header: rows of constant y, a conversion factor of the heights."""
    path = tmp_path / "a.asc"
    header = (
        f"h={NY} w={NX}\npixel size=1.500000e-007 m\ndata unit=rad\nheight conversion factor (-> m)=2.5e-8\n"
    )
    rows = "\n".join(" ".join(f"{v:.17g}" for v in row) for row in (ROUGH / 2.5e-8).T)
    path.write_text(header + rows + "\n")
    reading = MeasuredSurface(path).reading
    np.testing.assert_allclose(reading.heights, ROUGH, rtol=1e-14, atol=0)
    np.testing.assert_allclose(reading.pixel, (1.5e-7, 1.5e-7), rtol=1e-14)
    with pytest.raises(InputError, match="states its own"):
        MeasuredSurface(path, unit="um").reading  # noqa: B018  # reading is what raises


def test_files_that_state_no_unit_need_one(tmp_path: Path) -> None:
    for name in ("a.npy", "a.csv", "a.dat"):
        path = tmp_path / name
        np.save(path, ROUGH) if name.endswith("npy") else np.savetxt(path, ROUGH, delimiter=",")
        if name.endswith("dat"):
            np.savetxt(path, ROUGH, fmt="%.17g")
        with pytest.raises(InputError, match="unit, pixel_size = \\('um', None\\): expected both"):
            MeasuredSurface(path, unit="um").reading  # noqa: B018  # likewise
    instrument = MeasuredSurface(tmp_path / "a.dat", unit="um", pixel_size=DX).reading
    np.testing.assert_allclose(instrument.heights, ROUGH.T * 1e-6, rtol=1e-15, atol=0)


def test_the_missing_optional_package_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "SurfaceTopography", None)
    with pytest.raises(InputError, match=r"rough-friction\[instrument\]"):
        MeasuredSurface(write_x3p(tmp_path / "a.x3p", ROUGH)).reading  # noqa: B018  # likewise
    write_npy(tmp_path / "a.npy", ROUGH).heights(Grid(SIDE, 16))  # and is not missed where it is not needed


def test_files_are_read_once_and_late(tmp_path: Path) -> None:
    surface = MeasuredSurface(tmp_path / "late.npy", unit="m", pixel_size=(DX, DY))
    write_npy(tmp_path / "late.npy", ROUGH)
    first = surface.heights(Grid(SIDE, 16))
    (tmp_path / "late.npy").unlink()
    np.testing.assert_array_equal(surface.heights(Grid(SIDE, 16)), first)


class Trap:
    """Unpickled, it would leave a file behind."""

    def __init__(self, sprung: Path) -> None:
        self.sprung = sprung

    def __reduce__(self) -> tuple[object, ...]:
        return os.mkdir, (str(self.sprung),)


def hostile(folder: Path) -> dict[str, Path]:
    whole = write_x3p(folder / "whole.x3p", ROUGH).read_bytes()
    files = {
        "truncated.x3p": whole[: len(whole) // 2],
        "short.x3p": whole[:40],
        "empty.x3p": b"",
        "noise.x3p": RNG.bytes(4096),
        "noise.dat": RNG.bytes(4096),
        "words.asc": b"no numbers here\n" * 1000,
        "ragged.asc": b"h=2 w=5\npixel size=1e-7 m\n1 2 3 4 5\n1 2\n",
        "ragged.csv": b"1,2,3,4\n1,2\n",
        "words.csv": b"a,b,c,d\n" * 5,
        "bytes.csv": RNG.bytes(999),
        "few.csv": b"1,2\n3,4\n",
        "promise.npy": b"\x93NUMPY\x01\x00v\x00"
        + b"{'descr': '<f8', 'fortran_order': False, 'shape': (1000000, 1000000), }".ljust(117)
        + b"\n1234",
        "header.npy": b"\x93NUMPY\x02\x00\xff\xff\xff\x7f" + b"(" * 9999,
    }
    for name, content in files.items():
        (folder / name).write_bytes(content)
    np.save(folder / "complex.npy", np.zeros((5, 5), complex))
    np.save(folder / "cube.npy", np.zeros((5, 5, 5)))
    traps = np.full((4, 4), Trap(folder / "sprung"), dtype=object)
    np.save(folder / "pickle.npy", traps, allow_pickle=True)
    np.savez(folder / "pickle.npz", z=traps)
    (folder / "pickle.x3p").write_bytes((folder / "pickle.npz").read_bytes())
    write_x3p(folder / "huge.x3p", np.empty((2**20, 0)), data=b"").write_bytes(
        write_x3p(folder / "nodata.x3p", ROUGH, data=b"").read_bytes()
    )
    write_x3p(folder / "negative.x3p", ROUGH, dx=-DX)
    write_x3p(folder / "nan.x3p", ROUGH, dx="nan")
    (folder / "folder.x3p").mkdir()
    return {path.name: path for path in folder.iterdir() if path.name != "whole.x3p"}


def test_broken_and_hostile_files_get_one_clear_line(tmp_path: Path) -> None:
    files = hostile(tmp_path)
    assert len(files) >= 20
    for name, path in {**files, "absent.x3p": tmp_path / "absent.x3p"}.items():
        given = {"unit": "m", "pixel_size": DX} if path.suffix in (".npy", ".csv") else {}
        with pytest.raises(InputError) as refusal:
            MeasuredSurface(path, **given).heights(Grid(SIDE, 16))  # type: ignore[arg-type]  # mixed dict
        assert "\n" not in str(refusal.value), name
        assert len(str(refusal.value)) < 500, name
    assert not (tmp_path / "sprung").exists()


def test_zip_bombs_are_not_unpacked(tmp_path: Path) -> None:
    bomb = write_x3p(tmp_path / "bomb.x3p", ROUGH, data=bytes(readers.MAX_BYTES + 1))
    assert bomb.stat().st_size < readers.MAX_BYTES / 500
    with pytest.raises(InputError, match="unpacked"):
        MeasuredSurface(bomb).reading  # noqa: B018  # reading is what raises


def test_large_junk_is_refused_at_once(tmp_path: Path) -> None:
    path = tmp_path / "junk.asc"
    path.write_bytes(b"junk\n" * 4_000_000)
    start = time.process_time()
    with pytest.raises(InputError, match="rows of numbers"):
        MeasuredSurface(path).reading  # noqa: B018  # likewise
    assert time.process_time() - start < 5  # 20 MB in CPU seconds; the text reader itself needs 18


# --- window and resampling ---


@pytest.mark.parametrize("offset", [(0.0, 0.0), (4e-7, -3.3e-6), (-5e-7, 3.75e-6)])
@pytest.mark.parametrize("M", [7, 24])
def test_the_window_is_central_moves_and_is_exact_for_cubics(
    tmp_path: Path, offset: tuple[float, float], M: int
) -> None:
    def shape(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.asarray(
            (x / 1e-5) ** 3 * 1e-7 + 2e-8 * (x / 1e-5) * (y / 1e-5) ** 2 - 3e-8 * (y / 1e-5) ** 3
        )

    surface, grid = write_npy(tmp_path / "a.npy", shape(*points())), Grid(SIDE, M)
    expected = shape(*elements(grid, offset))
    np.testing.assert_allclose(
        quietly(surface, grid, offset), expected, rtol=0, atol=1e-13 * np.ptp(expected)
    )


def test_the_whole_measured_width_can_be_used(tmp_path: Path) -> None:
    x, y = points()
    surface, grid = write_npy(tmp_path / "a.npy", x**2 - x * y), Grid(NX * DX, 2 * NX)
    for offset in (
        (0.0, 0.0),
        (0.0, 3.25e-6),
        (0.0, -3.25e-6),
    ):  # to either end of y, half a pixel past the points
        x, y = elements(grid, offset)
        np.testing.assert_allclose(quietly(surface, grid, offset), x**2 - x * y, rtol=0, atol=1e-12 * 1e-10)


def test_a_surface_that_is_too_small_is_refused_with_both_sizes(tmp_path: Path) -> None:
    surface = write_npy(tmp_path / "a.npy", ROUGH)
    with pytest.raises(InputError, match=r"side = 9.1e-06: expected at most the measured 9e-06 x 1.55e-05 m"):
        surface.heights(Grid(9.1e-6, 16))
    with pytest.raises(InputError, match="at least 4 pixels"):
        quietly(surface, Grid(2 * DY, 16))
    with pytest.raises(InputError, match=r"offset.*at most 5e-07 x 3.75e-06 m"):
        surface.heights(Grid(SIDE, 16), (5.1e-7, 0.0))
    with pytest.raises(InputError, match="periodic"):
        surface.heights(Grid(SIDE, 16), periodic=True)


def test_finer_than_measured_warns(tmp_path: Path) -> None:
    surface = write_npy(tmp_path / "a.npy", ROUGH)
    with pytest.warns(SurfaceWarning, match="finer than the measured pixel"):
        surface.heights(Grid(SIDE, 26))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        surface.heights(Grid(SIDE, 25))  # 3.2e-7 m


# --- gaps ---


def holed(z: np.ndarray) -> np.ndarray:
    holes = z.copy()
    holes[20:24, 20:25] = np.nan
    holes[35, 30] = holes[3, 3] = np.nan
    return holes


def test_gaps_are_filled_and_counted(tmp_path: Path) -> None:
    x, y = points()
    harmonic = 1e-8 * ((x / DX) ** 2 * (DX / DY) ** 2 - (y / DY) ** 2) / 100 + x / 50
    surface = write_npy(tmp_path / "a.npy", holed(harmonic))
    grid = Grid(SIDE, 24)
    with pytest.warns(SurfaceWarning, match="21 of 1404 points in the window are missing"):
        z = surface.heights(grid)
    assert np.all(np.isfinite(z))
    full = quietly(write_npy(tmp_path / "b.npy", harmonic), grid)
    # x^2 / dx^2 ... solves the five-point equation on these pixels exactly: filling restores it
    np.testing.assert_allclose(z, full, rtol=0, atol=1e-12 * np.ptp(full))
    assert "21 of" in surface.describe(grid)[-1]


def test_filled_heights_obey_the_maximum_principle() -> None:
    z = RNG.normal(size=(30, 20))
    gaps = RNG.random(z.shape) < 0.3
    z[gaps] = np.nan
    filled = fill(z, (1.0, 3.0))
    np.testing.assert_array_equal(filled[~gaps], z[~gaps])
    assert np.nanmin(z) <= filled.min()
    assert filled.max() <= np.nanmax(z)
    laplace = np.zeros(z.shape)
    for axis, weight in ((0, 1.0), (1, 1.0 / 9.0)):
        difference = np.diff(filled, axis=axis) * weight
        edge = [(0, 0), (0, 0)]
        edge[axis] = (1, 1)
        laplace += np.diff(np.pad(difference, edge), axis=axis)  # no flow across the border
    np.testing.assert_allclose(laplace[gaps], 0.0, atol=1e-13)


def test_too_many_gaps_are_refused(tmp_path: Path) -> None:
    z = ROUGH.copy()
    z[10:14, 15:40] = np.nan
    surface = write_npy(tmp_path / "a.npy", z)
    grid = Grid(SIDE, 16)
    with pytest.raises(InputError, match=r"92 of 1404 .*at most a fraction of 0.05"):
        surface.heights(grid)
    generous = MeasuredSurface(surface.path, unit="m", pixel_size=(DX, DY), max_missing=0.1)
    assert np.all(np.isfinite(quietly(generous, grid)))
    strict = MeasuredSurface(surface.path, unit="m", pixel_size=(DX, DY), missing="refuse", max_missing=0.1)
    with pytest.raises(InputError, match="fraction of 0"):
        strict.heights(grid)
    z[:] = np.nan
    with pytest.raises(InputError, match="1404 of 1404"):
        write_npy(tmp_path / "b.npy", z).heights(grid)


def test_masked_points_of_instrument_files_are_missing_points(tmp_path: Path) -> None:
    surface = MeasuredSurface(write_x3p(tmp_path / "a.x3p", holed(ROUGH)))
    np.testing.assert_array_equal(np.isnan(surface.reading.heights), np.isnan(holed(ROUGH)))


# --- level ---


@pytest.mark.parametrize("level", ["mean", "plane", "paraboloid"])
def test_levelling_takes_off_its_form_and_nothing_else(tmp_path: Path, level: str) -> None:
    x, y = (p / 1e-5 for p in points())
    one = np.ones_like(x * y)
    forms = [1.7 * one, 0.4 * x - 0.9 * y, 3 * x**2 - x * y + 0.2 * y**2]
    form = sum(1e-6 * f for f in forms[: DEGREES[level] + 1])
    kwargs = {"unit": "m", "pixel_size": (DX, DY), "level": level}
    np.save(tmp_path / "a.npy", ROUGH)
    np.save(tmp_path / "b.npy", ROUGH + form)
    plain, tilted = (MeasuredSurface(tmp_path / f, **kwargs) for f in ("a.npy", "b.npy"))  # type: ignore[arg-type]
    for offset in ((0.0, 0.0), (3e-7, -2e-6)):  # one form for all offsets: a rigid surface
        np.testing.assert_allclose(
            quietly(tilted, Grid(SIDE, 20), offset),
            quietly(plain, Grid(SIDE, 20), offset),
            rtol=0,
            atol=1e-20,
        )


def test_level_is_fitted_in_the_window_only(tmp_path: Path) -> None:
    z = np.full((NX, NY), 5e-6)
    z[:, 13:37] = (np.arange(NX) * 1e-9)[:, None]  # all that a window of 7.2 um holds
    surface = MeasuredSurface(write_npy(tmp_path / "a.npy", z).path, unit="m", pixel_size=(DX, DY))
    level = surface.describe(Grid(7.2e-6, 16))[2]
    assert "'plane'" in level
    slope_x, slope_y = (
        float(word.strip("()")) for word in level.split("slopes ")[1].split(")")[0].split(" x ")
    )
    assert abs(slope_x * DX / 1e-9 - 1) < 1e-5  # as printed
    assert abs(slope_y) < 1e-12
    assert level.endswith("m after")
    assert float(level.split()[-3]) < 1e-20


@pytest.mark.parametrize("level", list(DEGREES))
def test_fit_is_the_least_squares_polynomial(level: str) -> None:
    degree = DEGREES[level]
    x, y, z = np.arange(3.0, 20.0), np.arange(-4.0, 8.0), RNG.normal(size=(17, 12))
    columns = [
        np.outer(x**a, y**b).ravel() for a in range(degree + 1) for b in range(degree + 1) if a + b <= degree
    ]
    expected = np.zeros(z.size)
    if columns:
        design = np.stack(columns, axis=1)
        expected = design @ np.linalg.lstsq(design, z.ravel(), rcond=None)[0]
    np.testing.assert_allclose(fit(x, y, z, degree)(x, y).ravel(), expected, rtol=0, atol=1e-12)
