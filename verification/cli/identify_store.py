"""Finished solves of `rough-friction identify` in a JSON file, so that a stopped fit goes on."""

from __future__ import annotations

import hashlib
import json
import os
from collections import UserDict
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from refimpl.identification.forward import response_from_dict
from refimpl.scene.scene import Scene
from refimpl.scene.scene_file import scene_to_dict
from verification.cli.output import files_of, read_or_refuse, refusal
from verification.output.files import to_json, write_text
from verification.sweep.run import code_digest, file_digest
from verification.sweep.store import checksum, damaged_row

FORMAT = "rough-friction identify 2"


class SolveStore(UserDict[str, Mapping[str, Any]]):
    """Responses by key with checksums, rewritten in one step; InputError for a damaged or other file."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._path, self.data = path, _read(path) if os.path.exists(path) else {}

    def __setitem__(self, key: str, value: Mapping[str, Any]) -> None:
        super().__setitem__(key, json.loads(json.dumps(value)))
        solves = {k: {"response": v, "checksum": checksum([k, v])} for k, v in self.data.items()}
        write_text(to_json({"format": FORMAT, "solves": solves}), self._path)


def _read(path: Path) -> dict[str, Any]:
    document = read_or_refuse("store", path)
    try:
        if document["format"] != FORMAT:
            raise refusal("store", str(path), f"a store of 'identify' ({FORMAT}), or a new file")
        for key, row in document["solves"].items():
            if checksum([key, row["response"]]) != row["checksum"]:
                raise damaged_row(path, key)
            response_from_dict(row["response"])
        return {key: row["response"] for key, row in document["solves"].items()}
    except (TypeError, KeyError, AttributeError) as damaged:
        allowed = "a store of 'identify', or a new file: this one is damaged"
        raise refusal("store", str(path), allowed) from damaged


def key(scene: Scene, settings: Mapping[str, Any]) -> str:
    """Return the digest of a scene, its files, the settings and the code."""
    files = [file_digest(path) for path in files_of(scene)]
    inputs = {"scene": scene_to_dict(scene), "settings": settings, "files": files, "code": code_digest()}
    text = json.dumps(inputs, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:32]
