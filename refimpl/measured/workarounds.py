"""Files that SurfaceTopography refuses or reads wrongly, rewritten in memory so that it reads them right.

As of version 1.27.1: X3P (ISO 25178-72) of other writers than its own, of which it takes one revision, links
to binary data, and main.xml at the top; compressed SUR, the lateral unit of NMS, Wyko's text, Gwyddion's
fields without units.
"""

from __future__ import annotations

import hashlib
import io
import re
import struct
import zipfile
import zlib
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from refimpl.errors import printable
from refimpl.measured.reading import MAX_BYTES, UNITS, Overrides, unreadable

Source = str | io.BytesIO

NMS_UNIT = 1e-6  # its spacing is in nm (surfalize reads it so); the library takes it for mm
_GWY_UNITS = b"si_unit_xy", b"si_unit_z"
_GWY_FIELD = re.compile(rb"/\d+/data\0oGwyDataField\0(.{4})", re.DOTALL)
_SUR_HEADER, _SUR_COMMENT = 512, "<hh"
_SUR_LENGTHS_AT = 314  # bytes: lengths of comment and private zone
_REVISION = "ISO5436 - 2000"  # the one text that the library takes
_DATA = "bindata/data.bin"
_LINKS = (("PointDataLink", "MD5ChecksumPointData"), ("ValidPointsLink", "MD5ChecksumValidPoints"))
_MAP = {
    "Record1/FeatureType": "SUR",
    "Record1/Axes/CX/AxisType": "I",
    "Record1/Axes/CY/AxisType": "I",
    "Record3/MatrixDimension/SizeZ": "1",
}


def rewritten(path: Path, name: str | None, given: Overrides) -> tuple[Source, tuple[str, ...]]:
    """Return what to hand to the library for a file of format ``name``, and a note of what was changed."""
    if name == "x3p":
        return _x3p(path)
    if name == "sur":
        return _sur(path.read_bytes(), path)
    if name == "gwy":
        return _gwy(path.read_bytes(), path, given)
    return str(path), ()


def _sur(raw: bytes, path: Path) -> tuple[Source, tuple[str, ...]]:
    """Rewrite units in UTF-8 as Latin-1. Compressed: a directory of streams (count; raw and packed length of
    each), then the zlib streams."""
    raw = raw[:_SUR_HEADER].replace("µm\0".encode(), "µm\0\0".encode("latin-1")) + raw[_SUR_HEADER:]
    if not raw.startswith(b"DSCOMPRESSED"):
        return io.BytesIO(raw), ()
    comment, private = struct.unpack_from(_SUR_COMMENT, raw, _SUR_LENGTHS_AT)
    at = _SUR_HEADER + comment + private
    (count,) = struct.unpack_from("<I", raw, at)
    if count > 1024:
        raise unreadable(path, f"a compressed SUR file of at most 1024 streams (this: {count})")
    lengths = [struct.unpack_from("<II", raw, at + 4 + 8 * k) for k in range(count)]
    if sum(length for length, _ in lengths) > MAX_BYTES:
        raise unreadable(path, f"at most {MAX_BYTES} bytes unpacked")
    at += 4 + 8 * count
    data = []
    for length, packed in lengths:
        data.append(zlib.decompressobj().decompress(raw[at : at + packed], length))
        at += packed
    plain = b"DIGITAL SURF" + raw[12 : _SUR_HEADER + comment + private] + b"".join(data)
    return io.BytesIO(plain), ("compressed SUR, unpacked here",)


def _gwy(raw: bytes, path: Path, given: Overrides) -> tuple[Source, tuple[str, ...]]:
    """Give fields that lack a unit the given one and the given pixel, unless another field states its own."""
    fields = [(m.end(), m.end() + int.from_bytes(m[1], "little")) for m in _GWY_FIELD.finditer(raw)]
    stated = [[_gwy_unit(raw[begin:end], key) for key in _GWY_UNITS] for begin, end in fields]
    if all(map(all, stated)) or any(set(units) <= set(UNITS) for units in stated):
        return str(path), ()
    unit, pixel, _ = given.resolve(path.name, None, None)
    for (begin, end), units in zip(reversed(fields), reversed(stated), strict=True):
        if all(units):
            continue
        own, added = units[1] or unit, b""
        for key, axis, edge in zip(_GWY_UNITS, b"xy", pixel, strict=True):
            text = f"unitstr\0s{own}\0".encode()
            counted = re.search(b"%cres\0i(.{4})" % axis, raw[begin:end], re.DOTALL)
            length = edge / UNITS.get(own, 1.0) * int.from_bytes(counted[1] if counted else b"", "little")
            added += key + b"\0oGwySIUnit\0" + struct.pack("<I", len(text)) + text
            added += b"%creal\0d" % axis + struct.pack("<d", length)
        size = struct.pack("<I", end - begin + len(added))
        raw = raw[: begin - 4] + size + raw[begin:end] + added + raw[end:]
    head = raw.index(b"\0") + 1
    return io.BytesIO(raw[:head] + struct.pack("<I", len(raw) - head - 4) + raw[head + 4 :]), ()


def _gwy_unit(field: bytes, key: bytes) -> str:
    found = re.search(rb"%b\0oGwySIUnit\0.{4}unitstr\0s([^\0]*)" % key, field, re.DOTALL)
    return found[1].decode("utf-8", "replace") if found else ""


def wyko_header(path: Path, header: tuple[str, ...]) -> tuple[str, ...]:
    """Return Wyko's header with all numbers as type 7, which the library sees, and a Mult.

    Heights are in nm if the second flag of the first line is 1, else in Wavelength / Mult nm.
    """
    named = {line.split()[0] for line in header}
    if "Wavelength" not in named and header[0].split()[-2] != "1":
        raise unreadable(path, "Wyko's text with a Wavelength, which scales its heights")
    number = re.compile(r"^(Mult|Wavelength|Aspect|Pixel_size)\s+\d+\s")
    typed = tuple(number.sub(r"\1 7 ", line) for line in header)
    return typed if "Mult" in named else (typed[0], "Mult 7 2 1", *typed[1:])


def _x3p(path: Path) -> tuple[str | io.BytesIO, tuple[str, ...]]:
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
