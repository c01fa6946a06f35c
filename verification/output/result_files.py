"""Result files: JSON documents, which the repository keeps compressed with gzip as ``NAME.json.gz``.

The same document gives the same bytes. ``python -m verification.output.result_files FILE.json`` compresses a
plain file before it is committed.
"""

from __future__ import annotations

import gzip
import json
import sys
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from verification.output.files import replacing

FOLDER = Path(__file__).parents[2] / "reports" / "results"
"""The committed result files."""
SUFFIX = ".json.gz"
_MAGIC = b"\x1f\x8b"  # first bytes of a gzip file (RFC 1952)
_LEVEL = 9  # fixed: the bytes depend on it
MOST_BYTES = 50_000_000
"""Most bytes of a document: a small file that expands beyond it is refused."""


def read_result(path: Path) -> Any:
    """Return the document, plain or compressed. Raises OSError, or ValueError if damaged or not JSON."""
    with path.open("rb") as file:
        content = file.read(MOST_BYTES + 1)  # a device has no end
    if len(content) > MOST_BYTES:
        raise ValueError(f"more than {MOST_BYTES} bytes")
    if content.startswith(_MAGIC):
        content = _decompressed(content)
    return parsed(content.decode())


def parsed(text: str) -> Any:
    """Return the document of a JSON text. Raises ValueError for no JSON, NaN, infinity or a key twice."""
    return json.loads(text, parse_constant=_refuse, object_pairs_hook=_once)


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"the key {twice[:40]!r} is there twice")
    return found


def _decompressed(content: bytes) -> bytes:
    expander = zlib.decompressobj(wbits=zlib.MAX_WBITS | 16)  # 16: with the header of gzip
    try:
        found = expander.decompress(content, MOST_BYTES)
    except zlib.error as broken:
        raise ValueError(f"damaged gzip data ({broken})") from broken
    if expander.unconsumed_tail:
        raise ValueError(f"more than {MOST_BYTES} bytes")
    if not expander.eof or expander.unused_data:
        raise ValueError("gzip data without their end, or with more behind it")
    return found


def _refuse(constant: str) -> float:
    raise ValueError(f"{constant} is not JSON")


def committed(name: str) -> Any:
    """Return the document of the committed result file NAME.json.gz."""
    return read_result(FOLDER / f"{name}{SUFFIX}")


def result_paths(folder: Path) -> list[Path]:
    """Return the result files of a folder. Raises ValueError for a name both plain and compressed."""
    paths = sorted([*folder.glob("*.json"), *folder.glob(f"*{SUFFIX}")])
    names = [name_of(path) for path in paths]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise ValueError(f"{twice}.json and {twice}{SUFFIX} beside each other")
    return paths


def name_of(path: Path) -> str:
    """Return the name of a result file without its suffixes.

    >>> name_of(Path("results/quick.json.gz")), name_of(Path("quick.json"))
    ('quick', 'quick')
    """
    return path.name.removesuffix(".gz").removesuffix(".json")


def read_results(folder: Path) -> dict[str, Any]:
    """Return all documents of a folder by name."""
    return {name_of(path): read_result(path) for path in result_paths(folder)}


def encoded(document: object, path: Path) -> bytes:
    """Return a result file's content: JSON, for ``.gz`` compressed. Raises ValueError for NaN, infinity."""
    text = json.dumps(document, separators=(",", ":"), allow_nan=False, ensure_ascii=False)
    content = f"{text}\n".encode()
    return gzip.compress(content, _LEVEL, mtime=0) if path.suffix == ".gz" else content


def write_result(document: object, path: Path) -> None:
    """Write the document in one step; raises ValueError as `encoded` does."""
    content = encoded(document, path)
    with replacing(path) as temporary:
        temporary.write_bytes(content)


def main(arguments: Sequence[str] | None = None) -> None:
    """Compress the named result files: NAME.json becomes NAME.json.gz."""
    for path in map(Path, sys.argv[1:] if arguments is None else arguments):
        write_result(read_result(path), path.with_name(name_of(path) + SUFFIX))
        if path.suffix != ".gz":
            path.unlink()


if __name__ == "__main__":
    main()
