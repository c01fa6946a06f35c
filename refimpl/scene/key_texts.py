"""The keys of scene files with units and meanings, by table: data, read from ``data/scene_keys.toml``.

What reads, writes and explains scene files takes the keys from here; types, defaults and limits stand in the
classes. `refimpl.scene.keys.scene_keys` refuses a key that its class does not have, or one that is missing.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from importlib import resources
from typing import Any

Texts = dict[str, tuple[str, str]]
"""Unit and meaning by key."""

_TABLES = tomllib.loads(resources.files("refimpl").joinpath("data", "scene_keys.toml").read_text("utf-8"))


def _texts(table: Mapping[str, Any]) -> Texts:
    return {key: (unit, meaning) for key, (unit, meaning) in table.items()}


SCENE, BODY = _texts(_TABLES["scene"]), _texts(_TABLES["body"])
MATERIAL, FRICTION = _texts(_TABLES["material"]), _texts(_TABLES["friction"])
SURFACES = {kind: _texts(table) for kind, table in _TABLES["surface"].items()}
"""Texts by a surface's ``kind``."""
