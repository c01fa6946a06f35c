"""Every key of a scene file: type, unit, default, allowed values and meaning.

Names, types and defaults are read from the classes that a file becomes. What is allowed is the text of the
refusal that a wrong value gets, so that the reference and the messages cannot differ.
"""

from __future__ import annotations

import types
from collections.abc import Callable, Mapping
from dataclasses import MISSING, Field, dataclass, fields
from functools import partial
from pathlib import Path
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

from refimpl.errors import InputError
from refimpl.model.friction import Friction
from refimpl.model.materials import Material
from refimpl.scene import scene_file
from refimpl.scene.scene import Body, Scene
from refimpl.scene.scene_file import scene_from_dict
from refimpl.surfaces.from_table import KINDS, surface_from_dict

Table = dict[str, Any]

REQUIRED = "required"
_WRONG = "?"  # no number, no truth value, none of any list of words
_WORDS: dict[object, str] = {
    float: "number",
    int: "whole number",
    bool: "true or false",
    str: "text",
    Path: "text",
    Body: "table",
    Friction: "table",
}
NAMED = {"path": 0, "channel": 1.5}
"""Wrong values of keys that take any text."""

_METAL = {"material": {"E": 200e9, "nu": 0.3, "hardness": 2e9}}
_WAVES: Table = {"hurst": 0.8, "roll_off": 2e-4, "long_cut": 4e-4, "short_cut": 5e-5, "seed": 1, "lay": 0.5}
SAMPLES: dict[str, tuple[Table, ...]] = {
    "flat": ({},),
    "sphere": ({"radius": 0.01},),
    "gaussian": ({"rms": 1e-6, "correlation_length": 1e-4, "seed": 1, "lay": 0.5},),
    "self_affine": (_WAVES | {"rms": 1e-6}, _WAVES | {"rms_gradient": 0.05}),
    "measured": ({"path": "map.npy"},),
}
"""Tables of each kind of surface, without the kind: one for each choice between its keys."""


@dataclass(frozen=True)
class Key:
    """One key of a table.

    name, kind, unit : as written in the file; type in words; empty where there is no unit
    default : as TOML; "required", or "-" where nothing is set
    allowed : what a refusal of a wrong value says
    """

    name: str
    kind: str
    unit: str
    default: str
    allowed: str
    meaning: str


def scene_keys() -> dict[str, tuple[Key, ...]]:
    """Return the keys of every table of a scene file: scene, body, material, friction, surfaces by kind."""
    tables = {
        "scene": _scene(),
        "body": _body(),
        "material": _of(Material, scene_file.MATERIAL, _material),
        "friction": _of(Friction, scene_file.FRICTION, _friction),
    }
    surfaces = _complete("surface", scene_file.SURFACES, list(KINDS))
    for kind, made in KINDS.items():
        tables[f"surface, {kind}"] = _of(made, surfaces[kind], partial(_surface, kind))
    return tables


def sample_scene(kind: str = "flat", choice: int = 0) -> Table:
    """Return the table of a scene with a surface of that kind, of `SAMPLES`, on the lower body."""
    lower = _METAL | {"surface": [{"kind": kind, **SAMPLES[kind][choice]}]}
    return {"load": 1.0, "side": 1e-3, "upper": _METAL, "lower": lower, "friction": {"tau": 1e6, "beta": 0.1}}


def allowed_by(read: Callable[[Table], object], table: Table, key: str, wrong: object = _WRONG) -> str:
    """Return what the refusal of a wrong value allows; LookupError where there is no such refusal."""
    try:
        read(table | {key: wrong})
    except InputError as refused:
        if refused.field.rpartition(".")[2] == key:
            return refused.allowed
    raise LookupError(f"{key}: no refusal of {wrong!r}")


def type_in_words(hint: object) -> str:
    """Return an annotated type in words.

    >>> type_in_words(float | tuple[float, float] | None)
    'number or [number, number]'
    """
    if get_origin(hint) in (Union, types.UnionType):
        words = [type_in_words(one) for one in get_args(hint) if one not in (type(None), Any)]
        return " or ".join(dict.fromkeys(words))
    if get_origin(hint) is tuple:
        return f"[{', '.join(type_in_words(one) for one in get_args(hint))}]"
    return _WORDS[str if get_origin(hint) is Literal else hint]


def as_toml(value: object) -> str:
    """Return a default as it stands in a file: "-" for None.

    >>> as_toml(True), as_toml("fill"), as_toml(0.05), as_toml(None)
    ('true', '"fill"', '0.05', '-')
    """
    if value is None:
        return "-"
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else repr(value)


def _scene() -> tuple[Key, ...]:
    texts, hints = scene_file.SCENE, get_type_hints(Scene)
    found = {f.name: f for f in fields(Scene)}
    keys = []
    for name in _complete("scene", texts, [*found, "tolerances"]):
        kind = type_in_words(hints[name]) if name in hints else "table"
        field = found.get(name)
        default = "-" if field is None or name == "friction" else default_of(field)
        base = sample_scene()
        if name == "size":
            del base["side"]
        unit, meaning = texts[name]
        keys.append(Key(name, kind, unit, default, allowed_by(_read, base, name), meaning))
    return tuple(keys)


def _body() -> tuple[Key, ...]:
    kinds = {"material": ("table", REQUIRED), "surface": ("list of tables", "flat")}
    return tuple(
        Key(name, *kinds[name][:1], unit, kinds[name][1], allowed_by(_upper, dict(_METAL), name), meaning)
        for name, (unit, meaning) in scene_file.BODY.items()
    )


def _of(made: type, texts: scene_file.Texts, allowed: Callable[[str], str]) -> tuple[Key, ...]:
    hints = get_type_hints(made)
    found = {f.name: f for f in fields(made) if f.init}
    _complete(made.__name__, texts, list(found))
    return tuple(
        Key(name, type_in_words(hints[name]), unit, default_of(found[name]), allowed(name), meaning)
        for name, (unit, meaning) in texts.items()
    )


def default_of(field: Field[Any]) -> str:
    """Return the default of a dataclass's field, as TOML."""
    return REQUIRED if field.default is MISSING else as_toml(field.default)


def _complete(table: str, texts: Mapping[str, object], names: list[str]) -> Any:
    """Return the texts, if they are of exactly these keys; else LookupError."""
    if set(texts) != set(names):
        raise LookupError(f"{table}: no text, or no key, for {sorted(set(texts) ^ set(names))}")
    return texts


def _read(table: Table) -> Scene:
    return scene_from_dict(table, Path())


def _upper(body: Table) -> Scene:
    return _read(sample_scene() | {"upper": body})


def _material(key: str) -> str:
    return allowed_by(lambda table: _upper({"material": table}), _METAL["material"], key)


def _friction(key: str) -> str:
    return allowed_by(lambda table: _read(sample_scene() | {"friction": table}), {}, key)


def _surface(kind: str, key: str) -> str:
    sample = next((table for table in SAMPLES[kind] if key in table), SAMPLES[kind][0])
    return allowed_by(surface_from_dict, {"kind": kind, **sample}, key, NAMED.get(key, _WRONG))
