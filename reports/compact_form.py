"""The compact form of result files, which loses nothing: documents are packed with markers, and unpacked.

It is JSON with markers, in the place of

- a list of short records with the same keys: ``{"$table": {key: [value of each record]}}``;
- short records with the same keys, by name: ``{"$names": [name of each], "$table": ...}``;
- equal numbers, texts or None in succession, in a list: ``{"$times": [how many, value]}``;
- a long text or list that stands there again: ``{"$same": name}``, its value under ``shared``.
"""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any

_LINE = 110  # characters; longer values are broken into lines
_RECORD = 600  # characters; a longer record keeps its keys, so that its numbers stand together
_SHARED = 40  # characters; a reference needs 23
_MOST_ENTRIES = 2_000_000  # entries of a document: a corrupt count or nested references must not fill memory
TABLE, NAMES, TIMES, SAME = "$table", "$names", "$times", "$same"


def unpacked(packed: Any, shared: Mapping[str, Any]) -> Any:
    """Return the value without markers.

    Raises AttributeError, KeyError, OverflowError, TypeError or ValueError for markers that are wrong.
    """
    return _Expansion(shared).of(packed)


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


def pack(plain: Any) -> tuple[Any, dict[str, Any]]:
    """Return the value with markers, and the shared values by name, in the order of their names."""
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
    return same_keys and len(text_of(values)) <= _RECORD * len(values)


def _runs(values: list[Any]) -> list[Any]:
    found: list[Any] = []
    for _, equal in groupby(values, key=text_of):  # by text: 0.0, -0.0, 0 and false differ
        run = list(equal)
        marked: list[Any] = [{TIMES: [len(run), run[0]]}]
        plain = isinstance(run[0], dict | list) or len(text_of(run)) <= len(text_of(marked))
        found += run if plain else marked
    return found


def _count(value: Any, counts: Counter[str]) -> None:
    """Count long values; the parts of one that was counted before are not counted again."""
    if _is_long(value):
        text = text_of(value)
        counts[text] += 1
        if counts[text] > 1:
            return
    for entry in _parts(value):
        _count(entry, counts)


def _references(value: Any, counts: Counter[str], shared: dict[str, Any], *, whole: bool = False) -> Any:
    """The value with ``$same`` for what counts more than once; the ``whole`` itself is not replaced."""
    if not whole and _is_long(value):
        text = text_of(value)
        if counts[text] > 1:
            name = digest_of(text)
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
    return isinstance(value, dict | list | str) and len(text_of(value)) >= _SHARED


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


def as_lines(value: Any) -> str:
    """Return JSON, one entry a line where the value is longer than a line; lists of numbers fill theirs."""
    text = text_of(value)
    if len(text) <= _LINE or not isinstance(value, dict | list):
        return text
    if isinstance(value, dict):
        entries = [f"{text_of(key)}:{as_lines(entry)}" for key, entry in value.items()]
        return "{\n" + ",\n".join(entries) + "\n}"
    if any(isinstance(entry, str) or len(text_of(entry)) > _LINE for entry in value):
        return "[\n" + ",\n".join(map(as_lines, value)) + "\n]"
    lines: list[str] = []
    for entry in map(text_of, value):
        if lines and len(lines[-1]) + len(entry) < _LINE:
            lines[-1] += f",{entry}"
        else:
            lines.append(entry)
    return "[\n" + ",\n".join(lines) + "\n]"


def text_of(value: Any) -> str:
    """Return JSON without blanks; raises ValueError for NaN and infinity."""
    return json.dumps(value, separators=(",", ":"), allow_nan=False, ensure_ascii=False)


def digest_of(text: str) -> str:
    """Return ten hexadecimal digits of the SHA-256 of a text."""
    return hashlib.sha256(text.encode()).hexdigest()[:10]
