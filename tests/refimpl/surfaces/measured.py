"""Measured surfaces to write and read back, for the tests of files and of what becomes of their heights."""

from __future__ import annotations

import warnings
import zipfile
from pathlib import Path

import numpy as np

from refimpl.grid import Grid
from refimpl.measured import MeasuredSurface
from refimpl.surfaces import Surface, SurfaceWarning

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
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
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
    x = (NX * DX - grid.lengths[0]) / 2 + grid.x + offset[0]
    y = (NY * DY - grid.lengths[1]) / 2 + grid.y + offset[1]
    return x[:, None], y[None, :]


def quietly(surface: Surface, grid: Grid, offset: tuple[float, float] = (0.0, 0.0)) -> np.ndarray:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SurfaceWarning)
        return surface.heights(grid, offset)
