"""Surfaces from and to the plain tables of a scene file."""

from __future__ import annotations

from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

from refimpl.errors import InputError, within
from refimpl.surfaces.gaussian import GaussianRoughness
from refimpl.surfaces.self_affine import SelfAffineRoughness
from refimpl.surfaces.shapes import Flat, Sphere
from refimpl.surfaces.surface import Surface, SurfaceSum

KINDS: dict[str, type[Surface]] = {c.kind: c for c in (Flat, Sphere, GaussianRoughness, SelfAffineRoughness)}
"""Surfaces by their ``kind``; `refimpl.measured` adds its own."""


def surface_from_dict(table: dict[str, Any], folder: Path = Path(), place: str = "surface") -> Surface:
    """Return the surface of one table ``{"kind": ..., ...}``; paths in it are relative to ``folder``.

    Raises InputError naming the key that is unknown, missing or out of range, after the table's ``place``.
    """
    if not isinstance(table, dict):
        raise InputError(place, table, 'a table with a "kind"')
    parameters = dict(table)
    kind = parameters.pop("kind", None)
    if kind == SurfaceSum.kind:
        return _sum_from_dict(parameters, folder, place)
    if not isinstance(kind, str) or kind not in KINDS:
        raise InputError(f"{place}.kind", kind, "one of " + ", ".join((*KINDS, SurfaceSum.kind)))
    known = [f for f in fields(KINDS[kind]) if f.init]  # type: ignore[arg-type]  # all are dataclasses
    for key, value in parameters.items():
        if key not in (f.name for f in known):
            names = ", ".join(f.name for f in known) or "none"
            raise InputError(f"{place}.{key}", value, f"a key of kind {kind}: {names}")
    for f in known:
        if f.name not in parameters and f.default is MISSING:
            raise InputError(f"{place}.{f.name}", None, f"a value: kind {kind} needs {f.name}")
    with within(place):
        return KINDS[kind].from_table(parameters, folder)


def _sum_from_dict(parameters: dict[str, Any], folder: Path, place: str) -> SurfaceSum:
    terms = parameters.pop("terms", None)
    for key, value in parameters.items():
        raise InputError(f"{place}.{key}", value, "a key of kind sum: terms")
    if not isinstance(terms, list) or not terms:
        raise InputError(f"{place}.terms", terms, "a list of surface tables")
    surfaces = [surface_from_dict(term, folder, f"{place}.terms[{k}]") for k, term in enumerate(terms)]
    return SurfaceSum(tuple(part for surface in surfaces for part in surface.parts))
