"""Result files: JSON documents, and the compact form in which the repository keeps them.

`read_result` takes both forms; `write_result` writes the compact one. ``python -m reports.result_files FILE``
rewrites a file in place. The compact form (`reports.compact_form`) loses nothing. Line breaks stand where a
line would be too long, so that `git diff` shows single values. What is longer than `MOST_BYTES` continues in
``NAME.2.json``, ``NAME.3.json``, by entries of the document's longest list.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from reports.compact_form import as_lines, digest_of, pack, text_of, unpacked

LAYOUT = "rough-friction compact result file, version 2"
_READ = (LAYOUT, "rough-friction compact result file, version 1")  # which has no names
MOST_BYTES = 500_000
"""Largest file that the repository keeps."""


class LayoutError(ValueError):
    """The file claims the compact form and does not follow it."""


def read_result(path: Path) -> Any:
    """Return the document of a result file, compact or plain JSON.

    Raises OSError for a file that cannot be read, ValueError for one that is not JSON, and LayoutError.
    """
    text = path.read_text(encoding="utf-8")
    found = _loaded(text)
    if not isinstance(found, dict) or found.get("layout") not in _READ:
        return found
    document = _document(found)
    try:
        for number, digest in enumerate(found["continued"]["digests"], 2):
            document[found["continued"]["list"]] += _document(_loaded(_continuing(path, number, digest)))
    except (KeyError, TypeError) as broken:
        raise LayoutError(f"a wrong list of continuations ({broken})") from broken
    return document


def _loaded(text: str) -> Any:
    """The JSON value; raises ValueError for NaN and infinity, which Python's reader takes."""

    def refused(constant: str) -> float:
        raise ValueError(f"{constant} is not JSON")

    return json.loads(text, parse_constant=refused)


def _continuing(path: Path, number: int, digest: str) -> str:
    """The text of a continuation, if it was written together with the file at ``path``."""
    part = _part(path, number)
    try:
        text = part.read_text(encoding="utf-8")
    except FileNotFoundError as missing:
        raise LayoutError(f"{path.name} continues in {part.name}, which is missing") from missing
    if digest_of(text) != digest:
        raise LayoutError(f"{part.name} does not belong to {path.name}: they were not written together")
    return text


def read_results(folder: Path) -> dict[str, Any]:
    """Return all documents of a folder by name without suffix; continuations are part of theirs."""
    return {path.stem: read_result(path) for path in result_paths(folder)}


def result_paths(folder: Path) -> list[Path]:
    """The result files of a folder, without continuations."""
    return [path for path in sorted(folder.glob("*.json")) if not Path(path.stem).suffix[1:].isdigit()]


def write_result(
    document: object,
    path: Path,
    write_text: Callable[[str, Path], object] | None = None,
    most_bytes: int = MOST_BYTES,
) -> None:
    """Write the document in the compact form and remove continuations that it no longer has.

    Raises ValueError for NaN and infinity, which JSON does not have, and for keys that begin with "$".
    """
    put = write_text or _write_text
    first, *more = compact(document, most_bytes)
    for number, text in enumerate(more, 2):
        put(text, _part(path, number))
    put(first, path)
    number = len(more) + 2
    while _part(path, number).is_file():
        _part(path, number).unlink()
        number += 1


def compact(document: object, most_bytes: int = MOST_BYTES) -> list[str]:
    """The texts of the document's files: the first, and its continuations.

    >>> print(compact({"rows": [{"x": 1, "y": 0.5}, {"x": 2, "y": 0.5}, {"x": 3, "y": 0.5}]})[0])
    {
    "layout":"rough-friction compact result file, version 2",
    "continued":{"list":null,"digests":[]},
    "document":{"rows":{"$table":{"x":[1,2,3],"y":[0.5,0.5,0.5]}}},
    "shared":{}
    }
    <BLANKLINE>
    """
    plain = json.loads(text_of(document))  # tuples are lists, keys are texts
    texts = [_first(plain, None, [])]
    if len(texts[0].encode()) > most_bytes and isinstance(plain, dict):
        lists = {key: value for key, value in plain.items() if isinstance(value, list) and value}
        longest = max(lists, key=lambda key: len(text_of(lists[key])), default=None)
        if longest is not None:
            texts = _split(plain, longest, most_bytes)
    if text_of(_joined(texts)) != text_of(plain):
        raise ValueError("the compact form does not lead back to the document")
    return texts


def _split(plain: dict[str, Any], longest: str, most_bytes: int) -> list[str]:
    """As many entries as fit into the first file, then into each continuation; at least one."""
    entries, placeholders = plain[longest], 9 * ["0" * 10]

    def first(count: int, digests: Sequence[str] = placeholders) -> str:
        return _first(plain | {longest: entries[:count]}, longest, digests)

    start = taken = _fitting(first, len(entries), most_bytes)
    more: list[str] = []
    while start < len(entries):

        def part(count: int, start: int = start) -> str:
            return _continuation(entries[start : start + count])

        count = _fitting(part, len(entries) - start, most_bytes)
        more.append(part(count))
        start += count
    return [first(taken, [digest_of(text) for text in more]), *more]


def _fitting(made: Callable[[int], str], total: int, most_bytes: int) -> int:
    """The largest count of entries whose file is not too large, at least 1, by bisection."""
    low, high = 1, total
    while low < high:
        middle = (low + high + 1) // 2
        low, high = (middle, high) if len(made(middle).encode()) <= most_bytes else (low, middle - 1)
    return low


def _first(plain: Any, continued: str | None, digests: Sequence[str]) -> str:
    packed, shared = pack(plain)
    head = {"layout": LAYOUT, "continued": {"list": continued, "digests": list(digests)}}
    return as_lines(head | {"document": packed, "shared": shared}) + "\n"


def _continuation(entries: list[Any]) -> str:
    packed, shared = pack(entries)
    return as_lines({"layout": LAYOUT, "document": packed, "shared": shared}) + "\n"


def _joined(texts: Sequence[str]) -> Any:
    """The document of the texts."""
    found = [_loaded(text) for text in texts]
    document = _document(found[0])
    for part in found[1:]:
        document[found[0]["continued"]["list"]] += _document(part)
    return document


def _document(file: Mapping[str, Any]) -> Any:
    try:
        return unpacked(file["document"], file["shared"])
    except (AttributeError, KeyError, OverflowError, TypeError, ValueError) as broken:
        raise LayoutError(f"a wrong marker ({broken!r})") from broken


def _part(path: Path, number: int) -> Path:
    return path.with_name(f"{path.stem}.{number}{path.suffix}")


def _write_text(text: str, path: Path) -> None:
    temporary = path.with_name(f".{path.name}.new")
    temporary.write_text(text, encoding="utf-8")
    os.replace(temporary, path)


def main(arguments: Sequence[str] | None = None) -> None:
    """Rewrite the named result files in the compact form."""
    for name in sys.argv[1:] if arguments is None else arguments:
        write_result(read_result(Path(name)), Path(name))


if __name__ == "__main__":
    main()
