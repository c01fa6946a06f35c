"""Parameters that are fitted beside tau and beta: a hardness, or the height of a roughness."""

from __future__ import annotations

from collections.abc import Sequence

from refimpl.errors import InputError
from refimpl.scene.parameters import BODIES, moving
from refimpl.scene.scene import Scene

SHORT = ("hardness", "roughness")
_KEYS = {"hardness": (".hardness",), "roughness": (".rms", ".rms_gradient")}


def further_parameters(scene: Scene, names: Sequence[str]) -> tuple[str, ...]:
    """Return the parameters' whole names; "hardness" is the softer body's, "roughness" the only rms.

    Raises `InputError` for a name that is none, or stands for several parameters, or stands twice.
    """
    if isinstance(names, str):
        raise InputError("fit", names, "a list of names")
    found = tuple(_whole(scene, name) for name in names)
    if len(set(found)) < len(found):
        raise InputError("fit", ", ".join(found), "each parameter once")
    return found


def _whole(scene: Scene, name: str) -> str:
    """The name of one parameter of the scene."""
    kinds = {short: _candidates(scene, short) for short in SHORT}
    every = [one for names in kinds.values() for one in names]
    if name not in SHORT and name not in every:
        allowed = ", ".join([*SHORT, *every])
        raise InputError("fit", name, f"one of {allowed}")
    meant = kinds.get(name, [name])
    if not meant:
        raise InputError("fit", name, f"a scene with a {name}: its value is the first guess")
    if len(kinds["hardness"]) > 1 and meant[0] in kinds["hardness"]:
        raise InputError("fit", name, "two hardnesses that differ, or one: the smaller of them is fitted")
    if len(meant) > 1:
        raise InputError("fit", name, f"one of {', '.join(meant)}")
    return meant[0]


def _candidates(scene: Scene, short: str) -> list[str]:
    """Parameters of a kind that change friction: of two hardnesses the smaller one, or both equal ones."""
    names = [name for name in moving(scene) if name.endswith(_KEYS[short])]
    softest = scene.materials.softer_hardness
    if short == "hardness":
        names = [f"{b}.material.hardness" for b in BODIES if getattr(scene, b).material.hardness == softest]
        return names if softest is not None else []
    return names
