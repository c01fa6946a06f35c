"""Every key of a study's file, in the form of `refimpl.scene.keys`; the texts are in ``study_keys.toml``."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import get_type_hints

from refimpl.driver.options import Options
from refimpl.model.problem import Terms
from refimpl.scene.keys import (
    REQUIRED,
    SAMPLES,
    Key,
    Table,
    allowed_by,
    as_toml,
    default_of,
    sample_scene,
    type_in_words,
)  # fmt: skip
from refimpl.scene.parameters import differentiable_parameters, parameters
from refimpl.scene.scene_file import FRICTION, SCENE, scene_from_dict
from verification.sweep.study import AXES
from verification.sweep.study_file import KEYS, TEXTS, study_from_dict, varied_names

_BASE: Table = {"scene": "table1-rough", "vary": {"grid": [8]}, "solve": {}}


def study_keys() -> dict[str, tuple[Key, ...]]:
    """Return the keys of the tables of a study's file: study, vary, solve."""
    return {"study": _study(), "vary": _vary(), "solve": _solve()}


def uses(kind: str) -> dict[str, str]:
    """Return by full name, whether a study may vary a parameter and whether it may have a tolerance.

    The scene has that kind of surface on its lower body, and no number that is zero.

    >>> uses("sphere")["lower.surface[0].radius"], uses("gaussian")["lower.surface[0].seed"]
    ('vary, tolerances', 'vary')
    """
    found = {}
    for choice in range(len(SAMPLES[kind])):
        scene = scene_from_dict(sample_scene(kind, choice), Path())
        tables = {"vary": set(varied_names(scene)), "tolerances": set(differentiable_parameters(scene))}
        for name in dict.fromkeys((*parameters(scene), *varied_names(scene))):
            found[name] = ", ".join(table for table, names in tables.items() if name in names)
    return found


def _study() -> tuple[Key, ...]:
    """Return the file's own keys; defaults are those of the study that two lines become."""
    made = study_from_dict({"scene": _BASE["scene"], "vary": _BASE["vary"]})
    defaults = {name: as_toml(getattr(made, name)) for name in ("realisations", "first_seed", "normalise")}
    defaults |= {"scene": REQUIRED, "vary": "-", "solve": "-"}
    allowed = {name: allowed_by(study_from_dict, _BASE, name, 0 if name == "scene" else "?") for name in KEYS}
    return tuple(
        Key(name, kind, "", defaults[name], allowed[name], meaning)
        for name, (kind, meaning) in TEXTS["study"].items()
    )


def _vary() -> tuple[Key, ...]:
    texts = SCENE | FRICTION | TEXTS["vary"]
    return tuple(
        Key(name, "number or list of numbers", texts[name][0], "-", _refusal("vary", name), texts[name][1])
        for name in AXES
    )


def _solve() -> tuple[Key, ...]:
    found = {f.name: f for made in (Terms, Options) for f in fields(made)}
    hints: dict[str, object] = get_type_hints(Options) | get_type_hints(Terms)
    return tuple(
        Key(name, type_in_words(hints[name]), "", default_of(found[name]), _refusal("solve", name), meaning)
        for name, meaning in TEXTS["solve"].items()
    )


def _refusal(table: str, key: str) -> str:
    """Return what the refusal of a wrong entry of a table of the study allows."""
    known = {"accuracy": 0.1} if key == "quantity" else {}
    base = {} if known else _BASE["vary"]

    def read(entries: Table) -> object:
        changed = {"vary": base, "solve": known} | {table: (base if table == "vary" else known) | entries}
        return study_from_dict(_BASE | changed)

    return allowed_by(read, {}, key)
