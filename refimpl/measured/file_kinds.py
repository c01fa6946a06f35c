"""Files that hold no map of heights that can be read here, named by their first bytes, with the remedy."""

from __future__ import annotations

import struct
import zipfile
from pathlib import Path

_PICTURE = "its brightness is not heights: export heights as text, .sur, .x3p or .gwy"
_TABLE = "save the sheet as CSV"
_MESH = "resample it on a grid and save points x, y, z as text"
_MARKS = (
    (b"\x89PNG", "a PNG picture", _PICTURE),
    (b"\xff\xd8\xff", "a JPEG picture", _PICTURE),
    (b"GIF8", "a GIF picture", _PICTURE),
    (b"BM", "a BMP picture", _PICTURE),
    (b"II*\0", "a TIFF picture", _PICTURE),
    (b"MM\0*", "a TIFF picture", _PICTURE),
    (b"%PDF", "a PDF document", "export heights as text, .sur, .x3p or .gwy"),
    (b"\xd0\xcf\x11\xe0", "an Excel or OLE file", _TABLE),
    (b"Gwyddion Simple Field", "a Gwyddion simple field (GSF)", "save it in Gwyddion as .gwy or as text"),
    (b"solid ", "an STL mesh", _MESH),
    (b"ply", "a PLY mesh", _MESH),
    (b"\x1f\x8b", "a gzip archive", "unpack it"),
    (b"7z\xbc\xaf", "a 7-Zip archive", "unpack it"),
    (b"Rar!", "a RAR archive", "unpack it"),
)
_MEMBERS = (("xl/", "an Excel file (XLSX)", _TABLE), ("word/", "a Word file (DOCX)", _TABLE))
_STL = 80, "<I", 50  # bytes of header, count of facets, bytes of each


def kind_of(path: Path, head: bytes) -> str | None:
    """What the file is and what to do, or None."""
    found = next((row[1:] for row in _MARKS if head.startswith(row[0])), None)
    if found is None and zipfile.is_zipfile(path):
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
        others = ("a ZIP archive of other files", "unpack it") if path.suffix.lower() == ".zip" else None
        found = next((row[1:] for row in _MEMBERS if any(n.startswith(row[0]) for n in names)), others)
    header, count, facet = _STL
    size = header + struct.calcsize(count)
    if found is None and len(head) > size:
        (facets,) = struct.unpack_from(count, head, header)
        found = ("an STL mesh", _MESH) if path.stat().st_size == size + facet * facets else None
    return None if found is None else f"a map of heights: this is {found[0]}; {found[1]}"
