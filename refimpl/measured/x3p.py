"""X3P files (ISO 25178-72) of any writer, rewritten in memory as SurfaceTopography 1.27.1 reads them.

It takes one revision, links to binary data, and main.xml at the top; it reads dates and numbers that the map
does not need.
"""

from __future__ import annotations

import hashlib
import io
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from refimpl.errors import printable
from refimpl.measured.reading import unreadable

_REVISION = "ISO5436 - 2000"  # the one text that the library takes
_DATA = "bindata/data.bin"
_LINKS = (("PointDataLink", "MD5ChecksumPointData"), ("ValidPointsLink", "MD5ChecksumValidPoints"))
_MAP = {
    "Record1/FeatureType": "SUR",
    "Record1/Axes/CX/AxisType": "I",
    "Record1/Axes/CY/AxisType": "I",
    "Record3/MatrixDimension/SizeZ": "1",
}


def rewritten(path: Path) -> tuple[str | io.BytesIO, tuple[str, ...]]:
    """Return the archive for the library, and a note of changes; `InputError` for damaged data, no map."""
    copy = io.BytesIO()
    with zipfile.ZipFile(path) as archive, zipfile.ZipFile(copy, "w", compresslevel=1) as target:
        members = {member.filename.replace("\\", "/"): member for member in archive.infolist()}
        mains = [m for m in members if m.rpartition("/")[2].lower() == "main.xml"]
        if not mains:
            return str(path), ()
        main = min(mains, key=len)
        root, changed = _bare(archive.read(members[main])), []
        _refuse_others(path, root)
        revision = root.find("Record1/Revision")
        if revision is not None and revision.text != _REVISION:
            changed, revision.text = [f"revision {printable(revision.text or '')!r}"], _REVISION
        if (listed := root.find("Record3/DataList")) is not None:
            changed.append("its heights in main.xml")
            target.writestr(_DATA, _linked(root, listed))
        folder = main[: -len("main.xml")]
        changed += [f"folder {folder!r} in the archive"] if folder else []
        for link, checksum in _LINKS:
            name = root.findtext(f"Record3/DataLink/{link}") or ""
            if name and (member := members.get(folder + name)) is not None:
                content = archive.read(member)
                _refuse_changed(path, content, root.findtext(f"Record3/DataLink/{checksum}") or "", link)
                target.writestr(name, content, member.compress_type)  # packed again, for memory
        target.writestr("main.xml", ElementTree.tostring(root))
    copy.seek(0)
    return copy, (f"X3P with {', '.join(changed)}",) if changed else ()


def _bare(text: bytes) -> ElementTree.Element:
    """Return the elements that say what the map is: no name spaces, no empty numbers, no Record2."""
    root = ElementTree.fromstring(text)
    for parent in list(root.iter()):
        parent.tag, parent.text = parent.tag.rpartition("}")[2], (parent.text or "").strip()
        if parent.tag.endswith("Link"):
            parent.text = parent.text.replace("\\", "/")
        for child in list(parent):
            name = str(child.tag).rpartition("}")[2]
            if name == "Record2" or (name in ("Increment", "Offset") and not (child.text or "").strip()):
                parent.remove(child)
    return root


def _refuse_others(path: Path, root: ElementTree.Element) -> None:
    """Raise `InputError` for profiles, clouds of points, irregular grids and layers."""
    found = {key: root.findtext(key) or "none" for key in _MAP}
    if found != _MAP:
        said = ", ".join(f"{'/'.join(key.split('/')[-2:])} is {printable(v)!r}" for key, v in found.items())
        raise unreadable(path, f"X3P of one map of heights on a regular grid ({said})")


def _refuse_changed(path: Path, content: bytes, stated: str, link: str) -> None:
    found = hashlib.md5(content, usedforsecurity=False).hexdigest()
    if len(stated) == len(found) and found != stated.lower():
        raise unreadable(path, f"data of the checksum that main.xml states ({link})")


def _linked(root: ElementTree.Element, listed: ElementTree.Element) -> bytes:
    """Replace a list of heights by a link to doubles, missing ones NaN, and return these."""
    record = root.find("Record3")
    assert record is not None  # it has the list
    record.remove(listed)
    ElementTree.SubElement(ElementTree.SubElement(record, "DataLink"), "PointDataLink").text = _DATA
    for kind in root.iterfind("Record1/Axes/CZ/DataType"):
        kind.text = "D"
    return np.array([float(v.text) if v.text else np.nan for v in listed], dtype="<f8").tobytes()
