"""Instances of any dataclass with all fields set to something that is not their default, for round trips.

Values follow from the annotations, so that a new field is covered by itself; fields whose range is narrower
than their type are listed by the test that needs them.
"""

from __future__ import annotations

import types
from collections.abc import Mapping
from dataclasses import MISSING, Field, fields, is_dataclass
from pathlib import Path
from typing import Any, Union, get_args, get_origin, get_type_hints

from hypothesis import strategies as st

Known = Mapping[tuple[str, str], st.SearchStrategy[Any]]
WORDS = st.text("abcdefghijk", min_size=1, max_size=6)


def instances(cls: type, known: Known = types.MappingProxyType({})) -> st.SearchStrategy[Any]:
    """Instances of a dataclass; ``known`` are strategies by the names of class and field."""
    hints = get_type_hints(cls)

    def of(field: Field[Any]) -> st.SearchStrategy[Any]:
        listed = known.get((cls.__name__, field.name))
        if listed is not None:
            return listed
        found = values(hints[field.name], known)
        return found if field.default is MISSING else found.filter(lambda value: value != field.default)

    return st.builds(cls, **{field.name: of(field) for field in fields(cls) if field.init})


def values(hint: Any, known: Known) -> st.SearchStrategy[Any]:
    """Values of an annotated type: numbers are neither 0 nor 1, mappings and tuples not empty."""
    simple = {
        bool: st.booleans(),
        int: st.integers(2, 10**6),
        float: st.floats(-1e9, 1e9).filter(lambda x: x not in (0.0, 1.0)),
        str: WORDS,
        Path: WORDS.map(lambda name: Path("/nowhere") / name),
        object: st.integers(2, 9),
        Any: st.integers(2, 9),
    }
    if hint in simple:
        return simple[hint]
    if is_dataclass(hint) and isinstance(hint, type):
        return instances(hint, known)
    if isinstance(hint, type) and hasattr(hint, "_fields"):  # a named tuple
        return st.builds(hint, *(values(one, known) for one in get_type_hints(hint).values()))
    origin, inner = get_origin(hint), get_args(hint)
    if origin in (Union, types.UnionType):
        return st.one_of(*(values(one, known) for one in inner if one is not type(None)))
    if origin is tuple and inner[-1:] == (Ellipsis,):
        return st.lists(values(inner[0], known), min_size=2, max_size=3).map(tuple)
    if origin is tuple:
        return st.tuples(*(values(one, known) for one in inner))
    if origin is not None and issubclass(origin, Mapping):
        return st.dictionaries(WORDS, values(inner[1], known), min_size=1, max_size=3)
    raise NotImplementedError(f"no values for {hint}: list the field")


def plain(item: object) -> object:
    """All fields of dataclasses, at any depth, as tables: what is lost on the way is seen."""
    if is_dataclass(item) and not isinstance(item, type):
        named = {field.name: plain(getattr(item, field.name)) for field in fields(item)}
        return {"class": type(item).__name__, **named}
    if isinstance(item, Mapping):
        return {key: plain(value) for key, value in item.items()}
    if isinstance(item, list | tuple):
        return [plain(value) for value in item]
    return str(item) if isinstance(item, Path) else item
