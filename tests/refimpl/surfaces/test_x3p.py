"""X3P files as other writers have them: packed, revised, with heights in the XML; what is no map."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path

import numpy as np
import pytest

from refimpl.errors import InputError
from refimpl.measured.readers import read
from tests.refimpl.surfaces import instrument_writers as write
from tests.refimpl.surfaces.instrument_writers import COMPLETE, MAP, PIXEL, same


def x3p_of(path: Path, *changes: tuple[str, str], folder: str = "") -> Path:
    """An X3P file as other writers pack it: patterns of main.xml replaced, each found at least once."""
    write.write_x3p(path, MAP)
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    main = members["main.xml"].decode()
    for old, new in changes:
        main, count = re.subn(old, new, main)
        assert count
    members["main.xml"] = main.encode()
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in members.items():
            archive.writestr(folder + name, content)
    return path


REVISED = ("ISO5436 - 2000", "ISO 25178-72:2017")
X3P = [
    ("", [], ()),
    ("scan 7/", [], ("X3P with folder 'scan 7/' in the archive",)),
    ("", [REVISED], ("X3P with revision 'ISO 25178-72:2017'",)),
    (
        "a/b/",
        [("ISO5436 - 2000", "ISO5436-2"), ("bindata/", r"bindata\\")],
        ("X3P with revision 'ISO5436-2', folder 'a/b/' in the archive",),
    ),
    ("", [("</CZ>", "<Offset/></CZ>")], ()),  # x3ptools, fix3p
    ("", [("<Date>[^<]*", "<Date>N/A")], ()),
    ("", [("xmlns:p=", 'xmlns="of all" xmlns:p=')], ()),
    ("", [("<MD5ChecksumPointData>[^<]*", "<MD5ChecksumPointData>unknown")], ()),
]


@pytest.mark.parametrize(("folder", "changes", "notes"), X3P)
def test_x3p_of_other_writers(
    tmp_path: Path, folder: str, changes: list[tuple[str, str]], notes: tuple[str, ...]
) -> None:
    reading = read(x3p_of(tmp_path / "map.x3p", *changes, folder=folder))
    same(reading.heights)
    assert reading.notes == notes


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("<MD5ChecksumPointData>[^<]*", "<MD5ChecksumPointData>" + 32 * "0", "checksum that main.xml states"),
        ("<FeatureType>SUR", "<FeatureType>PRF", "regular grid .*FeatureType is 'PRF'"),
        ("(<CY>.*?)<AxisType>I", r"\1<AxisType>A", "regular grid .*CY/AxisType is 'A'"),
        ("<SizeZ>1", "<SizeZ>3", "regular grid .*SizeZ is '3'"),
    ],
)
def test_x3p_of_no_map_and_of_changed_data_are_refused(tmp_path: Path, old: str, new: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        read(x3p_of(tmp_path / "map.x3p", ("(?s)" + old, new)))


@pytest.mark.parametrize(("kind", "missing"), [("D", True), ("I", False)])
def test_x3p_with_its_heights_in_the_xml(tmp_path: Path, kind: str, missing: bool) -> None:
    """As the standard's own samples: a Datum for each point; whole numbers with increment and offset."""
    z = MAP if missing else COMPLETE
    write.write_x3p(tmp_path / "map.x3p", z)
    with zipfile.ZipFile(tmp_path / "map.x3p") as archive:
        main = archive.read("main.xml").decode()
    step, low = (1.0, 0.0) if kind == "D" else (1e-9, 1e-8)
    shown = [f"{(v - low) / step:.17g}" if kind == "D" else f"{(v - low) / step:.0f}" for v in z.T.ravel()]
    listed = "".join("<Datum/>" if v == "nan" else f"<Datum> {v}\n</Datum>" for v in shown)
    head, rest = main.split("<DataLink>")
    scale = f"<DataType>{kind}</DataType><Increment>{step}</Increment><Offset>{low}</Offset>\n</CZ>"
    head = head[: head.index("<DataType>", head.index("<CZ>"))] + scale + head[head.index("</CZ>") + 5 :]
    comment = "<!-- <DataLink> <Datum>9</Datum> -->"
    main = f"{head}{comment}<DataList>{listed}</DataList>{rest.split('</DataLink>')[1]}"
    with zipfile.ZipFile(tmp_path / "map.x3p", "w") as archive:
        archive.writestr("main.xml", main)
    reading = read(tmp_path / "map.x3p")
    np.testing.assert_allclose(reading.heights, z, rtol=0, atol=1e-20)
    np.testing.assert_allclose(reading.pixel, PIXEL, rtol=1e-12)
    assert reading.notes == ("X3P with its heights in main.xml",)
