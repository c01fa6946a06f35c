"""Scenes as TOML: reading with every field checked, writing, and the scenes that ship with the package.

Units and meanings of the keys are data, ``data/scene_keys.toml``. Types, defaults and limits stand in the
classes; `refimpl.scene.keys.scene_keys` refuses a key that its class does not have, or one that is missing.
"""

from __future__ import annotations

import math
import os
import re
import tomllib
from collections.abc import Iterable, Mapping
from importlib import resources
from pathlib import Path
from typing import Any

import tomli_w

from refimpl.errors import InputError, within
from refimpl.model.friction import Friction
from refimpl.model.materials import Material
from refimpl.scene.parameters import check_tolerances
from refimpl.scene.scene import Body, Scene
from refimpl.surfaces import ArraySurface, SurfaceSum, surface_from_dict
from refimpl.surfaces.from_table import KINDS

Texts = dict[str, tuple[str, str]]
"""Unit and meaning by key."""

_TEXTS = tomllib.loads(resources.files("refimpl").joinpath("data", "scene_keys.toml").read_text("utf-8"))


def _texts(table: Mapping[str, Any]) -> Texts:
    return {key: (unit, meaning) for key, (unit, meaning) in table.items()}


SCENE, BODY = _texts(_TEXTS["scene"]), _texts(_TEXTS["body"])
MATERIAL, FRICTION = _texts(_TEXTS["material"]), _texts(_TEXTS["friction"])
SURFACES = {kind: _texts(table) for kind, table in _TEXTS["surface"].items()}
"""Texts by a surface's ``kind``."""
_PLACES: dict[str, Iterable[str]] = {
    "the top of a scene": SCENE,
    "a body's table": BODY,
    "a body's [material]": MATERIAL,
    "[friction]": FRICTION,
    **{f"a [[surface]] of kind {kind}": keys for kind, keys in SURFACES.items()},
}

_MAX_BYTES = 1_000_000  # a scene is a page of text; anything larger is not a scene
_MAX_PARTS = 32  # parts of a dotted key: parse time grows with their square
_PART = r"""(?:[\w-]+|"[^"\n]*"|'[^'\n]*')"""
_LONG_KEY = re.compile(rf"(?<![\w-]){_PART}(?:[ \t]*\.[ \t]*{_PART}){{{_MAX_PARTS}}}")
_TABLES = ("upper", "lower", "friction", "tolerances")
_OPTIONAL_KEYS = tuple(key for key in SCENE if key not in ("load", *_TABLES))
_RIGID = "rigid"  # E of a rigid body


def read_scene(path: str | Path) -> Scene:
    """Return the scene of a TOML file, or a shipped scene by its name (see `shipped_scenes`).

    Paths of measured surfaces are relative to the file. Raises `InputError` naming the field.
    """
    table, folder = _read(path)
    return scene_from_dict(table, folder)


def read_tolerances(path: str | Path) -> dict[str, float]:
    """Return a scene file's ``[tolerances]``: relative half-widths (95 %) by parameter."""
    table, folder = _read(path)
    return _tolerances(table, scene_from_dict(table, folder))


def _read(name: str | Path) -> tuple[dict[str, Any], Path]:
    """Return the parsed file, or shipped scene, and the folder that its paths are relative to."""
    if not isinstance(name, str | os.PathLike):
        raise InputError("scene", name, "the path of a TOML file, or the name of a shipped scene")
    path = Path(name)
    if not os.path.isfile(path):  # a name may have any length
        if str(path) in shipped_scenes():
            path = Path(str(resources.files("refimpl").joinpath("data", "scenes", f"{path}.toml")))
        else:
            raise InputError("scene", str(path), f"a TOML file, or one of {', '.join(shipped_scenes())}")
    return read_toml(path, "scene"), path.parent


def read_toml(path: Path, field: str) -> dict[str, Any]:
    """Return the parsed file; `InputError`, naming ``field``, for one too large or no TOML."""
    try:
        if path.stat().st_size > _MAX_BYTES:
            raise InputError(field, str(path), f"a TOML file of at most {_MAX_BYTES} bytes")
        text = path.read_text(encoding="utf-8-sig")
        if _LONG_KEY.search(text):
            raise InputError(field, str(path), f"dotted keys of at most {_MAX_PARTS} parts")
        return tomllib.loads(text)
    except InputError:
        raise
    except OSError as refused:
        raise InputError(field, str(path), f"a file that can be read ({refused.strerror})") from refused
    except (ValueError, RecursionError) as error:  # TOML, UTF-8, or a number of thousands of digits
        raise InputError(field, str(path), f"valid TOML ({error})") from error


def shipped_scenes() -> tuple[str, ...]:
    """Return the names of the scenes that ship as package data."""
    folder = resources.files("refimpl").joinpath("data", "scenes")
    files = (Path(item.name) for item in folder.iterdir())
    return tuple(sorted(file.stem for file in files if file.suffix == ".toml"))


def scene_from_dict(table: Mapping[str, Any], folder: Path) -> Scene:
    """Return the scene of a parsed TOML table; unknown and missing keys raise `InputError`."""
    refuse_unknown("scene", table, SCENE)
    friction = _table(table, "friction", {})
    refuse_unknown("friction", friction, FRICTION)
    optional = {key: table[key] for key in _OPTIONAL_KEYS if key in table}
    scene = Scene(
        upper=_body(table, "upper", folder),
        lower=_body(table, "lower", folder),
        friction=Friction(**friction),
        load=_required(table, "load", "a normal load in N"),
        **optional,
    )
    _tolerances(table, scene)
    return scene


def scene_to_dict(scene: Scene) -> dict[str, Any]:
    """Return the scene as a plain table; `InputError` for arrays, and surfaces and laws of one's own."""
    if not isinstance(scene, Scene):
        raise InputError("scene", scene, "a Scene")
    if type(scene.friction) is not Friction:
        raise InputError("friction", scene.friction, "a Friction: scene files have no other law")
    bodies = {name: _body_to_dict(getattr(scene, name)) for name in ("upper", "lower")}
    table = _given(scene, ("load", *_OPTIONAL_KEYS)) | {"friction": _given(scene.friction, FRICTION)} | bodies
    return table if scene.size is None else table | {"size": list(scene.size)}


def scene_to_toml(scene: Scene) -> str:
    """Return the scene as TOML text that `read_scene` reads back."""
    return tomli_w.dumps(scene_to_dict(scene))


def _tolerances(table: Mapping[str, Any], scene: Scene) -> dict[str, float]:
    tolerances = dict(_table(table, "tolerances", {}))
    check_tolerances(scene, tolerances)
    return tolerances


def _body(table: Mapping[str, Any], name: str, folder: Path) -> Body:
    body = _table(table, name, None)
    refuse_unknown(name, body, BODY)
    material = _table(body, "material", None, prefix=f"{name}.")
    refuse_unknown(f"{name}.material", material, MATERIAL)
    parts = body.get("surface", [{"kind": "flat"}])
    if isinstance(parts, Mapping):
        parts = [parts]
    if not isinstance(parts, list) or not parts or not all(isinstance(part, Mapping) for part in parts):
        raise InputError(f"{name}.surface", parts, "one or more [[...surface]] tables")
    surfaces = [surface_from_dict(dict(part), folder, f"{name}.surface[{k}]") for k, part in enumerate(parts)]
    modulus = _required(material, "E", "Young's modulus in Pa", prefix=f"{name}.material.")
    ratio = _required(material, "nu", "Poisson's ratio", prefix=f"{name}.material.")
    with within(f"{name}.material"):
        matter = Material(math.inf if modulus == _RIGID else modulus, ratio, material.get("hardness"))
    return Body(matter, sum(surfaces[1:], start=surfaces[0]))


def _body_to_dict(body: Body) -> dict[str, Any]:
    parts = body.surface.parts if isinstance(body.surface, SurfaceSum) else (body.surface,)
    for part in parts:
        if type(part) is not KINDS.get(part.kind, ArraySurface):  # an array says itself what to do
            raise InputError("surface", part.label, f"a surface of scene files: {', '.join(KINDS)}")
    rigid = {"E": _RIGID} if body.material.is_rigid else {}
    return {
        "material": _given(body.material, MATERIAL) | rigid,
        "surface": [part.to_dict() for part in parts],
    }


def _given(made: object, keys: Iterable[str]) -> dict[str, Any]:
    values = {key: getattr(made, key) for key in keys}
    return {key: value for key, value in values.items() if value is not None}


def _table(table: Mapping[str, Any], name: str, default: Any, prefix: str = "") -> Mapping[str, Any]:
    value = table.get(name, default)
    if not isinstance(value, Mapping):
        raise InputError(f"{prefix}{name}", value, f"a [{prefix}{name}] table")
    return value


def _required(table: Mapping[str, Any], name: str, allowed: str, prefix: str = "") -> Any:
    if name not in table:
        raise InputError(f"{prefix}{name}", None, allowed)
    return table[name]


def refuse_unknown(
    name: str,
    table: Mapping[str, Any],
    known: Iterable[str],
    others: Mapping[str, Iterable[str]] | None = None,
) -> None:
    """Raise `InputError` for a key that is none of the known, with the other tables that have it."""
    for key, value in table.items():
        if key not in known:
            places = {**(others or {}), **_PLACES}
            where = ", ".join(place for place, keys in places.items() if key in keys)
            here = f" here, it is one of {where}" if where else ""
            raise InputError(f"{name}.{key}", value, f"no such key{here}; known are {', '.join(known)}")
