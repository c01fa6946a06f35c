"""Surfaces from and to the plain tables of a scene file."""

from __future__ import annotations

from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

from refimpl.errors import InputError
from refimpl.surfaces.base import Surface, SurfaceSum
from refimpl.surfaces.gaussian import GaussianRoughness
from refimpl.surfaces.measured import MeasuredSurface
from refimpl.surfaces.shapes import Flat, Sphere

KINDS: dict[str, type[Surface]] = {c.kind: c for c in (Flat, Sphere, GaussianRoughness, MeasuredSurface)}


def surface_from_dict(table: dict[str, Any], folder: Path = Path()) -> Surface:
    """The surface of one table ``{"kind": ..., ...}``; paths in it are relative to ``folder``.

    Raises InputError naming the key that is unknown, missing or out of range.

    >>> surface_from_dict({"kind": "sphere", "radius": 0.14})
    Sphere(radius=0.14)
    """
    if not isinstance(table, dict):
        raise InputError("surface", table, 'a table with a "kind"')
    parameters = dict(table)
    kind = parameters.pop("kind", None)
    if kind == SurfaceSum.kind:
        return _sum_from_dict(parameters, folder)
    if not isinstance(kind, str) or kind not in KINDS:
        raise InputError("surface.kind", kind, "one of " + ", ".join(KINDS))
    known = [f for f in fields(KINDS[kind]) if f.init]  # type: ignore[arg-type]  # all are dataclasses
    for key, value in parameters.items():
        if key not in (f.name for f in known):
            raise InputError(f"surface.{key}", value, f"a key of kind {kind}: {_names(known)}")
    for f in known:
        if f.name not in parameters and f.default is MISSING:
            raise InputError(f"surface.{f.name}", None, f"a value: kind {kind} needs {f.name}")
    return KINDS[kind].from_table(parameters, folder)


def surface_from_tables(tables: list[dict[str, Any]], folder: Path = Path()) -> Surface:
    """The sum of the surfaces of several tables, as ``[[upper.surface]]`` in a scene file; none is ``Flat()``."""
    if not isinstance(tables, list):
        raise InputError("surface", tables, "a list of tables ([[...surface]] in TOML)")
    parts = tuple(part for table in tables for part in surface_from_dict(table, folder).parts)
    if not parts:
        return Flat()
    return parts[0] if len(parts) == 1 else SurfaceSum(parts)


def surface_to_tables(surface: Surface) -> list[dict[str, Any]]:
    """The tables ``surface_from_tables`` reads back; raises InputError for arrays, which have none."""
    return [part.to_dict() for part in surface.parts]


def _sum_from_dict(parameters: dict[str, Any], folder: Path) -> Surface:
    for key in parameters:
        if key != "terms":
            raise InputError(f"surface.{key}", parameters[key], "a key of kind sum: terms")
    return surface_from_tables(parameters.get("terms", []), folder)


def _names(known: list[Any]) -> str:
    return ", ".join(f.name for f in known) or "none"
