"""Small writers of instruments' formats, from the formats' descriptions: one asymmetric map in each.

``MAP[i, j]`` (m) is what a reader must return: x to the right along i, y up along j. Formats that store
images get its lines from the top.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import SurfaceTopography
from scipy.io import savemat

NX, NY = 20, 12
PIXEL = (2e-6, 3e-6)
BOTH = {"unit": "um", "pixel_size": PIXEL}
MISSING = (3, 8)
_STEPS = 10 * np.arange(NX)[:, None] - 7 * np.arange(NY)[None, :] + (np.arange(NX)[:, None] > 14) * 40
MAP = 1e-8 * _STEPS.astype(float)  # steps of 10 nm: integer formats hold them exactly
MAP[MISSING] = np.nan
COMPLETE = np.where(np.isnan(MAP), np.nanmin(MAP), MAP)

Writer = Callable[[Path, np.ndarray], None]


def same(heights: np.ndarray, error: float = 1e-20) -> None:
    np.testing.assert_allclose(heights, MAP, rtol=0, atol=error)


def steps(z: np.ndarray, missing: float) -> np.ndarray:
    """The map in steps of 10 nm, with a mark for the missing point, lines from the top."""
    return np.where(np.isnan(z), missing, np.rint(np.nan_to_num(z) / 1e-8)).T[::-1]


def top_down(z: np.ndarray) -> np.ndarray:
    return z.T[::-1]


def write_npy(path: Path, z: np.ndarray) -> None:
    np.save(path, z * 1e6)


def write_npz(path: Path, z: np.ndarray) -> None:
    np.savez(path, z=z * 1e6)


def write_mat(path: Path, z: np.ndarray) -> None:
    savemat(path, {"Z": z * 1e6})


def write_h5(path: Path, z: np.ndarray) -> None:
    with h5py.File(path, "w") as file:
        file["surface"] = z * 1e6


def write_csv(path: Path, z: np.ndarray) -> None:
    """As a profiler exports it: a header, semicolons, decimal commas, an index column, empty = missing."""
    lines = ["Instrument;profiler", "Date;2024-05-01", "", ";".join(["", *map(str, range(NX))])]
    for k, row in enumerate(top_down(z * 1e6)):
        cells = ["" if np.isnan(v) else f"{v:.4f}".replace(".", ",") for v in row]
        lines.append(";".join([str(k), *cells]))
    path.write_text("\n".join(lines) + "\n")


def write_plain_csv(path: Path, z: np.ndarray) -> None:
    np.savetxt(path, z * 1e6, delimiter=",")


def write_txt(path: Path, z: np.ndarray) -> None:
    """As Gwyddion exports it, with the micro sign in Latin-1."""
    head = (
        f"# Channel: Topography\n# Width: {NX * PIXEL[0] * 1e6:.1f} µm\n"
        f"# Height: {NY * PIXEL[1] * 1e6:.1f} µm\n# Value units: m\n"
    )
    rows = "\n".join("\t".join(f"{v:.9g}" for v in row) for row in top_down(z))
    path.write_bytes((head + rows + "\n").encode("latin-1"))


def write_xyz(path: Path, z: np.ndarray) -> None:
    """Measured points alone, in um: the missing one has no line."""
    i, j = np.nonzero(np.isfinite(z))
    points = np.stack([i * PIXEL[0] * 1e6, j * PIXEL[1] * 1e6, z[i, j] * 1e6], axis=1)
    np.savetxt(path, points[np.random.default_rng(1).permutation(len(points))], fmt="%.6f")


def sur_bytes(z: np.ndarray, unit: bytes = b"\xb5m", packed: bool = False) -> bytes:
    """Digital Surf's SUR: a header of 512 bytes, 16-bit heights, the missing mark two below the lowest."""
    low = int(np.nanmin(z) / 1e-8 - 0.5)
    data = steps(z, low - 2).astype("<i2").tobytes()
    nx, ny = z.shape
    head = struct.pack(
        "<12sHHHH30s30sHHHHH8sHiiiiIfff",
        b"DSCOMPRESSED" if packed else b"DIGITAL SURF", 0, 1, 1, 2, b"map", b"test", 0, 0, 0, 1, 1, bytes(8),
        16, low, int(np.nanmax(z) / 1e-8 + 0.5), nx, ny, nx * ny, PIXEL[0] * 1e6, PIXEL[1] * 1e6, 0.01,
    )  # fmt: skip
    head += b"".join(name.ljust(16, b"\0") for name in (b"X", b"Y", b"Z", *[unit] * 6))
    head += struct.pack("<fffHHH", 1.0, 1.0, 1.0, 0, 0, 0)
    if packed:
        stream = zlib.compress(data)
        data = struct.pack("<III", 1, len(data), len(stream)) + stream
    return head.ljust(512, b"\0") + data


def write_sur(path: Path, z: np.ndarray) -> None:
    path.write_bytes(sur_bytes(z))


def write_packed_sur(path: Path, z: np.ndarray) -> None:
    path.write_bytes(sur_bytes(z, packed=True))


def write_opd(path: Path, z: np.ndarray) -> None:
    """Wyko: a directory of blocks; heights in nm times Mult / Wavelength, columns from below."""
    nx, ny = z.shape
    raw = np.where(np.isnan(z), 32767, np.rint(np.nan_to_num(z) / 1e-9)).astype("<i2")
    blocks = [
        (b"RAW DATA", 3, struct.pack("<HHH", nx, ny, 2) + raw.tobytes()),
        (b"Wavelength", 7, struct.pack("<f", 1.0)),
        (b"Mult", 6, struct.pack("<h", 1)),
        (b"Aspect", 7, struct.pack("<f", PIXEL[1] / PIXEL[0])),
        (b"Pixel_size", 7, struct.pack("<f", PIXEL[0] * 1e3)),
    ]
    entries = [(b"Directory", 1, 24 * (len(blocks) + 1)), *((n, t, len(d)) for n, t, d in blocks)]
    directory = b"".join(struct.pack("<16shlH", *entry, 0) for entry in entries)
    path.write_bytes(b"\x01\x00" + directory + b"".join(data for *_, data in blocks))


def write_wyko_text(path: Path, z: np.ndarray) -> None:
    """Wyko's ASCII: 2-byte Mult, lines of one x from below in units of 633 nm / 5, another array before."""
    nx, ny = z.shape
    head = "Wyko ASCII Data File Format 0\t0\t1\nX Size\t{}\nY Size\t{}\nBlock Name\tType\tLength\tValue\n"
    text = head.format(nx, ny) + f"Pixel_size\t7\t4\t{PIXEL[0] * 1e3}\nAspect\t7\t4\t{PIXEL[1] / PIXEL[0]}\n"
    text += f"Intensity\t3\t{2 * nx * ny}\t\n" + "\n".join("\t".join(["7"] * ny) for _ in range(nx))
    text += f"\nTitle\t5\t20\tplate\nMult\t6\t2\t5\nWavelength\t7\t4\t633.0\nRAW_DATA\t3\t{4 * nx * ny}\t\n"
    rows = [["Bad" if np.isnan(v) else f"{v / 633e-9 * 5:.17g}" for v in row] for row in z]
    path.write_text(text + "\n".join("\t".join(row) for row in rows) + "\n")


def write_plu(path: Path, z: np.ndarray) -> None:
    """Sensofar: lines from the top in um, 1000001 for a missing point."""
    nx, ny = z.shape
    data = np.where(np.isnan(z), 1000001.0, z * 1e6).T[::-1].astype("<f4")
    path.write_bytes(
        struct.pack("<128sI256s", b"Wed May 01 12:00:00 2024", 0, b"")
        + struct.pack("<IIIfffffff", ny, nx, 1, 1, PIXEL[0] * 1e6, PIXEL[1] * 1e6, 0, 0, 1, 0)
        + struct.pack("<IIIII", 3, 0, 0, 0, 0)
        + struct.pack("<IIIIIdfII", nx, ny, nx, ny, 0, 0.0, 0.0, 0, 0)
        + struct.pack("<BBBB B3BI", 0, 1, 0xFA, 0, 0, 0, 0, 0, 0)
        + struct.pack("<II", ny, nx) + data.tobytes() + struct.pack("<ff", 0, 0)
    )  # fmt: skip


def write_di(path: Path, z: np.ndarray) -> None:
    """Nanoscope: a text header, then lines from below in steps of the scanner; it has no missing points."""
    nx, ny = z.shape
    data = np.rint(np.nan_to_num(z) / 1e-8).T.astype("<i2")
    size = f"{nx * PIXEL[0] * 1e6:g} {ny * PIXEL[1] * 1e6:g} ~m"
    head = "\r\n".join(
        [
            r"\*File list", r"\Version: 0x04320003", r"\*Scanner list",
            r"\@Sens. Zscan: V 10 nm/V", r"\*Ciao scan list", rf"\Scan size: {size}",
            r"\*Ciao image list", r"\Data offset: 4096", rf"\Data length: {2 * nx * ny}",
            r"\Bytes/pixel: 2", rf"\Samps/line: {nx}", rf"\Number of lines: {ny}", rf"\Scan size: {size}",
            r"\@2:Image Data: S [Height] " + '"Height"',
            r"\@2:Z scale: V [Sens. Zscan] (1 V/LSB) 65536 V", r"\*File list end", "",
        ]
    )  # fmt: skip
    path.write_bytes(head.encode("latin-1").ljust(4096, b"\0") + data.tobytes())


def topography(z: np.ndarray) -> SurfaceTopography.Topography:
    """The map as the library's object, in nm, to be written by its own writers."""
    heights = np.ma.masked_invalid(z * 1e9)
    sizes = (z.shape[0] * PIXEL[0] * 1e9, z.shape[1] * PIXEL[1] * 1e9)
    return SurfaceTopography.Topography(heights, sizes, unit="nm")


def write_gwy(path: Path, z: np.ndarray) -> None:
    topography(z[:, ::-1]).to_gwy(str(path))


def write_x3p(path: Path, z: np.ndarray) -> None:
    topography(z).to_x3p(str(path))


def write_nc(path: Path, z: np.ndarray) -> None:
    topography(z).to_netcdf(str(path))


def write_nms(path: Path, z: np.ndarray) -> None:
    """Nanofocus: 16-bit heights between two bounds (um), spacing in nm; it marks no missing point."""
    nx, ny = z.shape
    low, high = np.nanmin(z) * 1e6, np.nanmax(z) * 1e6
    raw = np.rint((np.nan_to_num(z * 1e6, nan=low) - low) / (high - low) * (2**16 - 2)).T[::-1]
    head = bytearray(3468)
    struct.pack_into("<2d", head, 16, low, high)
    struct.pack_into("<2I2d", head, 1368, nx, ny, PIXEL[0] * 1e9, PIXEL[1] * 1e9)
    path.write_bytes(bytes(head) + raw.astype("<u2").tobytes())


def write_sdf(path: Path, z: np.ndarray) -> None:
    """ISO 25178-71, as text: profiles in the order of y."""
    nx, ny = z.shape
    head = (
        f"aISO-1.0\nManufacID = test\nCreateDate = 010520241200\nModDate = 010520241200\nNumPoints = {nx}\n"
        f"NumProfiles = {ny}\nXscale = {PIXEL[0]}\nYscale = {PIXEL[1]}\nZscale = 1E-9\nZresolution = -1\n"
        "Compression = 0\nDataType = 7\nCheckType = 0\n*\n"
    )
    rows = "\n".join(" ".join("BAD" if np.isnan(v) else f"{v * 1e9:.6f}" for v in row) for row in z.T)
    path.write_text(head + rows + "\n*\n")


def write_bcr(path: Path, z: np.ndarray) -> None:
    """BCR-STM: a text header of 2048 characters, 16-bit lines from the top, 32767 for a missing point."""
    nx, ny = z.shape
    keys = {"fileformat": "bcrstm", "headersize": 2048, "xpixels": nx, "ypixels": ny,
            "xlength": nx * PIXEL[0] * 1e9, "ylength": ny * PIXEL[1] * 1e9, "xunit": "nm", "yunit": "nm",
            "zunit": "nm", "bit2nm": 10, "intelmode": 1}  # fmt: skip
    head = "".join(f"{key} = {value}\n" for key, value in keys.items())
    path.write_bytes(head.encode().ljust(2048, b"\0") + steps(z, 32767).astype("<i2").tobytes())


def write_tmd(path: Path, z: np.ndarray) -> None:
    """TrueMap: lengths and heights in mm, single precision, lines from the top."""
    nx, ny = z.shape
    head = b"Binary TrueMap Data File v2.0\r\n\0" + b"Created by TrueMap v6\r\n\0"
    head += struct.pack("<IIffff", nx, ny, nx * PIXEL[0] * 1e3, ny * PIXEL[1] * 1e3, 0, 0)
    path.write_bytes(head + (top_down(z) * 1e3).astype("<f4").tobytes())


def write_os3d(path: Path, z: np.ndarray) -> None:
    """OmniSurf3D: lines from the top in um, the lowest single-precision number for a missing point."""
    nx, ny = z.shape
    head = b"OmniSurf3D" + struct.pack("<iii4si4siidddd", 1, 0, 4, b"test", 4, b"date", nx, ny,
                                       PIXEL[0] * 1e6, PIXEL[1] * 1e6, 0.0, 0.0)  # fmt: skip
    path.write_bytes(head + np.nan_to_num(top_down(z) * 1e6, nan=-3.4e38).astype("<f4").tobytes())


def write_al3d(path: Path, z: np.ndarray) -> None:
    """Alicona: a list of tags, then lines from the top in m, padded to 8 bytes; NaN for a missing point."""
    nx, ny = z.shape
    tags = {"Version": 1, "TagCount": 6, "Cols": nx, "Rows": ny, "PixelSizeXMeter": PIXEL[0],
            "PixelSizeYMeter": PIXEL[1], "InvalidPixelValue": "NaN", "DepthImageOffset": 1024}  # fmt: skip
    head = b"AliconaImaging\0\r\n"
    head += b"".join(struct.pack("<20s30s2s", k.encode(), str(v).encode(), b"\r\n") for k, v in tags.items())
    path.write_bytes(head.ljust(1024, b"\0") + top_down(z).astype("<f4").tobytes())


def write_asc(path: Path, z: np.ndarray) -> None:
    topography(z[:, ::-1]).to_matrix(str(path))
