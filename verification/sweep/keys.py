"""Every key of a study's file, in the form of `refimpl.scene.keys`."""

from __future__ import annotations

from collections.abc import Mapping
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
from verification.sweep.study_file import KEYS, SOLVE_KEYS, study_from_dict, varied_names

_BASE: Table = {"scene": "table1-rough", "vary": {"grid": [8]}, "solve": {}}
_TEXTS: Mapping[str, tuple[str, str]] = {
    "scene": (
        "text",
        "the scene that is varied: the name of a shipped one, or a file relative to that of the study",
    ),
    "realisations": (
        "whole number",
        "number of random surfaces (seeds) that are solved for each combination of values",
    ),
    "first_seed": (
        "whole number",
        "seed of the upper body in the first realisation; the lower body has the next number, and the next "
        "realisation the next two. Not set: 1, or with a single realisation the seeds of the scene",
    ),
    "normalise": ("true or false", "`normalise` of all Gaussian surfaces; not set: as in the scene"),
    "vary": ("table", "keys that vary, with their values; every combination is solved"),
    "solve": ("table", "settings of the solver, the same for all runs"),
}
"""Type and meaning of each key."""
_AXES: Mapping[str, tuple[str, str]] = {
    "grid": ("", "elements along the longer side; not set: 256, or each map's own points, up to 512"),
    "upper_rms": ("m", "rms height of the upper body's roughness; 0 removes that roughness"),
    "lower_rms": ("m", "rms height of the lower body's roughness; 0 removes that roughness"),
    "correlation_length": ("m", "`correlation_length` of all Gaussian surfaces"),
    **{name: SCENE[name] for name in ("load", "sliding_direction", "sliding_offset")},
    **FRICTION,
}
_SETTINGS: Mapping[str, str] = {
    "method": "`fft`: the solver of `solve`; `dense`: a plain reference for small grids; `paper`: the "
    "scheme of the paper",
    "oblique": "`true` includes the slopes in the balance of forces, `false` neglects them; not set: the "
    "program decides by the scene",
    "slope_correction": "`true` corrects the displacements in Eq. (7) for sloping elements",
    "tolerance": "largest residual of a converged result; not set: 1e-8, with the method `paper` 1e-4",
    "accuracy": "refines the grid of each run until the error bar of `quantity` is at most this share of it; "
    "replaces `grid`",
    "quantity": "number that `accuracy` means; not set: `friction_coefficient_corrected`, "
    "without friction `contact_area`",
}


def study_keys() -> dict[str, tuple[Key, ...]]:
    """Return the keys of the tables of a study's file: study, vary, solve."""
    for table, texts, names in (
        ("study", set(_TEXTS), KEYS), ("vary", set(_AXES), AXES), ("solve", set(_SETTINGS), SOLVE_KEYS),
    ):  # fmt: skip
        if texts != set(names):
            raise LookupError(f"{table}: no text, or no key, for {sorted(texts ^ set(names))}")
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
        for name, (kind, meaning) in _TEXTS.items()
    )


def _vary() -> tuple[Key, ...]:
    return tuple(
        Key(name, "number or list of numbers", unit, "-", _refusal("vary", name), meaning)
        for name, (unit, meaning) in _AXES.items()
    )


def _solve() -> tuple[Key, ...]:
    found = {f.name: f for made in (Terms, Options) for f in fields(made)}
    hints: dict[str, object] = get_type_hints(Options) | get_type_hints(Terms)
    return tuple(
        Key(name, type_in_words(hints[name]), "", default_of(found[name]), _refusal("solve", name), meaning)
        for name, meaning in _SETTINGS.items()
    )


def _refusal(table: str, key: str) -> str:
    """Return what the refusal of a wrong entry of a table of the study allows."""
    known = {"accuracy": 0.1} if key == "quantity" else {}
    base = {} if known else _BASE["vary"]

    def read(entries: Table) -> object:
        changed = {"vary": base, "solve": known} | {table: (base if table == "vary" else known) | entries}
        return study_from_dict(_BASE | changed)

    return allowed_by(read, {}, key)
