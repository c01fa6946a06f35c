"""Result files: JSON documents, and the compact form in which the repository keeps them.

`read_result` takes both forms; `write_result` writes the compact one. ``python -m reports.result_files FILE``
rewrites a file in place. The compact form loses nothing. It is JSON with markers, in the place of

- a list of short records with the same keys: ``{"$table": {key: [value of each record]}}``;
- short records with the same keys, by name: ``{"$names": [name of each], "$table": ...}``;
- equal numbers, texts or None in succession, in a list: ``{"$times": [how many, value]}``;
- a long text or list that stands there again: ``{"$same": name}``, its value under ``shared``.

Line breaks stand where a line would be too long, so that `git diff` shows single values. What is longer than
`MOST_BYTES` continues in ``NAME.2.json``, ``NAME.3.json``, by entries of the document's longest list.
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

LAYOUT = "rough-friction compact result file, version 2"
_READ = (LAYOUT, "rough-friction compact result file, version 1")  # which has no names
MOST_BYTES = 500_000
"""Largest file that the repository keeps."""

_LINE = 110  # characters; longer values are broken into lines
_RECORD = 600  # characters; a longer record keeps its keys, so that its numbers stand together
_SHARED = 40  # characters; a reference needs 23
_MOST_ENTRIES = 2_000_000  # entries of a document: a corrupt count or nested references must not fill memory
TABLE, NAMES, TIMES, SAME = "$table", "$names", "$times", "$same"


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
    if _digest(text) != digest:
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
    plain = json.loads(_text(document))  # tuples are lists, keys are texts
    texts = [_first(plain, None, [])]
    if len(texts[0].encode()) > most_bytes and isinstance(plain, dict):
        lists = {key: value for key, value in plain.items() if isinstance(value, list) and value}
        longest = max(lists, key=lambda key: len(_text(lists[key])), default=None)
        if longest is not None:
            texts = _split(plain, longest, most_bytes)
    if _text(_joined(texts)) != _text(plain):
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
    return [first(taken, [_digest(text) for text in more]), *more]


def _fitting(made: Callable[[int], str], total: int, most_bytes: int) -> int:
    """The largest count of entries whose file is not too large, at least 1, by bisection."""
    low, high = 1, total
    while low < high:
        middle = (low + high + 1) // 2
        low, high = (middle, high) if len(made(middle).encode()) <= most_bytes else (low, middle - 1)
    return low


def _first(plain: Any, continued: str | None, digests: Sequence[str]) -> str:
    packed, shared = _packed(plain)
    head = {"layout": LAYOUT, "continued": {"list": continued, "digests": list(digests)}}
    return _lines(head | {"document": packed, "shared": shared}) + "\n"


def _continuation(entries: list[Any]) -> str:
    packed, shared = _packed(entries)
    return _lines({"layout": LAYOUT, "document": packed, "shared": shared}) + "\n"


def _joined(texts: Sequence[str]) -> Any:
    """The document of the texts."""
    found = [_loaded(text) for text in texts]
    document = _document(found[0])
    for part in found[1:]:
        document[found[0]["continued"]["list"]] += _document(part)
    return document


def _document(file: Mapping[str, Any]) -> Any:
    try:
        return _Expansion(file["shared"]).of(file["document"])
    except (AttributeError, KeyError, OverflowError, TypeError, ValueError) as broken:
        raise LayoutError(f"a wrong marker ({broken!r})") from broken


class _Expansion:
    """Values without markers, of at most `_MOST_ENTRIES` entries in all, counted with their repetitions."""

    def __init__(self, shared: Mapping[str, Any]) -> None:
        self._shared, self._left = shared, _MOST_ENTRIES

    def of(self, value: Any, within: tuple[str, ...] = (), copies: int = 1) -> Any:
        """The value; ``within`` names the shared values that it is part of, ``copies`` of it stand there."""
        self._left -= copies
        if self._left < 0:
            raise ValueError(f"more than {_MOST_ENTRIES} entries")
        if isinstance(value, list):
            return list(self._entries(value, within, copies))
        if not isinstance(value, dict):
            return value
        if SAME in value:
            name = value[SAME]
            if name in within:
                raise ValueError(f"{name!r} holds itself")
            return self.of(self._shared[name], (*within, name), copies)
        if TABLE in value:
            columns = {key: self.of(column, within, copies) for key, column in value[TABLE].items()}
            rows = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
            if NAMES not in value:
                return rows
            return dict(zip(self.of(value[NAMES], within, copies), rows, strict=True))
        return {key: self.of(entry, within, copies) for key, entry in value.items()}

    def _entries(self, values: list[Any], within: tuple[str, ...], copies: int) -> Iterator[Any]:
        for value in values:
            if isinstance(value, dict) and TIMES in value:
                count, repeated = value[TIMES]
                if not isinstance(count, int) or count < 1:
                    raise ValueError(f"{count!r} entries")
                yield from [self.of(repeated, within, copies * count)] * count
            else:
                yield self.of(value, within, copies)


def _packed(plain: Any) -> tuple[Any, dict[str, Any]]:
    """The value with markers, and the shared values by name, in the order of their names."""
    value = _tables(plain)
    counts: Counter[str] = Counter()
    _count(value, counts)
    shared: dict[str, Any] = {}
    packed = _references(value, counts, shared)
    return packed, dict(sorted(shared.items()))


def _tables(value: Any) -> Any:
    """The value with ``$table`` and ``$times``."""
    if isinstance(value, dict):
        if any(key.startswith("$") for key in value):
            raise ValueError(f"a key that begins with '$': {sorted(value)[0]!r}")
        records = list(value.values())
        if _is_table(records):
            return {NAMES: list(value), TABLE: _columns(records)}
        return {key: _tables(entry) for key, entry in value.items()}
    if not isinstance(value, list):
        return value
    if _is_table(value):
        return {TABLE: _columns(value)}
    return _runs([_tables(entry) for entry in value])


def _columns(records: list[Any]) -> dict[str, Any]:
    return {key: _tables([record[key] for record in records]) for key in records[0]}


def _is_table(values: list[Any]) -> bool:
    if len(values) < 2 or not all(isinstance(value, dict) and value for value in values):
        return False
    same_keys = len({tuple(value) for value in values}) == 1
    return same_keys and len(_text(values)) <= _RECORD * len(values)


def _runs(values: list[Any]) -> list[Any]:
    found: list[Any] = []
    for _, equal in groupby(values, key=_text):  # by text: 0.0, -0.0, 0 and false differ
        run = list(equal)
        marked: list[Any] = [{TIMES: [len(run), run[0]]}]
        plain = isinstance(run[0], dict | list) or len(_text(run)) <= len(_text(marked))
        found += run if plain else marked
    return found


def _count(value: Any, counts: Counter[str]) -> None:
    """Count long values; the parts of one that was counted before are not counted again."""
    if _is_long(value):
        text = _text(value)
        counts[text] += 1
        if counts[text] > 1:
            return
    for entry in _parts(value):
        _count(entry, counts)


def _references(value: Any, counts: Counter[str], shared: dict[str, Any], *, whole: bool = False) -> Any:
    """The value with ``$same`` for what counts more than once; the ``whole`` itself is not replaced."""
    if not whole and _is_long(value):
        text = _text(value)
        if counts[text] > 1:
            name = _digest(text)
            if name not in shared:
                shared[name] = _references(value, counts, shared, whole=True)
            return {SAME: name}
    if isinstance(value, list):
        return [_references(entry, counts, shared) for entry in value]
    if not isinstance(value, dict):
        return value
    if TIMES in value:
        count, repeated = value[TIMES]
        return {TIMES: [count, _references(repeated, counts, shared)]}
    if TABLE in value:
        columns = {key: _references(column, counts, shared) for key, column in value[TABLE].items()}
        names = {NAMES: _references(value[NAMES], counts, shared)} if NAMES in value else {}
        return names | {TABLE: columns}
    return {key: _references(entry, counts, shared) for key, entry in value.items()}


def _is_long(value: Any) -> bool:
    """Whether a reference would be shorter than the value."""
    if isinstance(value, dict) and TIMES in value:
        return False  # its list must see the marker
    return isinstance(value, dict | list | str) and len(_text(value)) >= _SHARED


def _parts(value: Any) -> Sequence[Any]:
    if isinstance(value, list):
        return value
    if not isinstance(value, dict):
        return ()
    if TIMES in value:
        return [value[TIMES][1]]
    if TABLE in value:
        return [*([value[NAMES]] if NAMES in value else []), *value[TABLE].values()]
    return list(value.values())


def _lines(value: Any) -> str:
    """JSON, one entry a line where the value is longer than a line; lists of numbers fill their lines."""
    text = _text(value)
    if len(text) <= _LINE or not isinstance(value, dict | list):
        return text
    if isinstance(value, dict):
        entries = [f"{_text(key)}:{_lines(entry)}" for key, entry in value.items()]
        return "{\n" + ",\n".join(entries) + "\n}"
    if any(isinstance(entry, str) or len(_text(entry)) > _LINE for entry in value):
        return "[\n" + ",\n".join(map(_lines, value)) + "\n]"
    lines: list[str] = []
    for entry in map(_text, value):
        if lines and len(lines[-1]) + len(entry) < _LINE:
            lines[-1] += f",{entry}"
        else:
            lines.append(entry)
    return "[\n" + ",\n".join(lines) + "\n]"


def _text(value: Any) -> str:
    return json.dumps(value, separators=(",", ":"), allow_nan=False, ensure_ascii=False)


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:10]


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
