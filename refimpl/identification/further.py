"""Parameters that are fitted beside tau and beta: a hardness.

The height of a random roughness is none of them. Friction hardly determines it where the surface is known by
its statistics: on twins of rough balls its 95 % interval spans a factor of about 3 either way, over which mu
is not linear, and intervals of tau that rest on it are too short. A measured height with its tolerance is an
input (`identify(..., tolerances=...)`).
"""

from __future__ import annotations

from collections.abc import Sequence

from refimpl.errors import InputError
from refimpl.scene.parameters import BODIES
from refimpl.scene.scene import Scene

_ROUGHNESS = (".rms", ".rms_gradient")


def further_parameters(scene: Scene, names: Sequence[str]) -> tuple[str, ...]:
    """Return the parameters' whole names; `InputError` for none, for two parameters, for repetition."""
    if isinstance(names, str):
        raise InputError("fit", names, "a list of names")
    found = tuple(_whole(scene, name) for name in names)
    if len(set(found)) < len(found):
        raise InputError("fit", ", ".join(found), "each parameter once")
    return found


def _whole(scene: Scene, name: str) -> str:
    softest = scene.materials.softer_hardness
    hardnesses = [
        f"{body}.material.hardness"
        for body in BODIES
        if softest is not None and getattr(scene, body).material.hardness == softest
    ]
    if name == "roughness" or name.endswith(_ROUGHNESS):
        raise InputError(
            "fit", name, "no height of a roughness, which friction hardly determines; give it in [tolerances]"
        )
    if name != "hardness" and name not in hardnesses:
        raise InputError("fit", name, f"one of {', '.join(['hardness', *hardnesses])}")
    if not hardnesses:
        raise InputError("fit", name, "a scene with a hardness: its value is the first guess")
    if len(hardnesses) > 1:
        raise InputError("fit", name, "two hardnesses that differ, or one: the smaller of them is fitted")
    return hardnesses[0]
