"""The numbers a scene is made of, by name: read them, and make the same scene with one of them changed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import is_dataclass, replace

from refimpl.errors import InputError, require_number, require_one_of
from refimpl.scene.scene import Body, Scene

BODIES = ("upper", "lower")
_TOLERANCE = "a relative tolerance between 0 and 1 (half-width, 95 %)"


def parameters(scene: Scene) -> dict[str, float]:
    """Return all parameters with their values, SI; a surface's parts count from 0.

    ``load``, ``friction.tau``, ``friction.beta``, ``upper.material.E``, ``upper.material.nu``,
    ``upper.material.hardness`` where one is given, ``upper.surface[0].rms`` and so on; of two correlation
    lengths ``lower.surface[0].correlation_length[1]``.
    """
    law = vars(scene.friction) if is_dataclass(scene.friction) else {}
    found = {"load": scene.load}
    numbers = {name: number for name, number in law.items() if isinstance(number, float)}
    found |= {f"friction.{name}": number for name, number in numbers.items() if math.isfinite(number)}
    for name in BODIES:
        body = getattr(scene, name)
        found |= {f"{name}.material.E": body.material.E, f"{name}.material.nu": body.material.nu}
        if body.material.hardness is not None:
            found[f"{name}.material.hardness"] = body.material.hardness
        for k, part in enumerate(body.surface.parts):
            found |= {f"{name}.surface[{k}].{key}": value for key, value in part.parameters().items()}
    return found


def with_parameter(scene: Scene, name: str, value: float) -> Scene:
    """Return the scene with one parameter changed; `InputError` for an unknown one or a bad value."""
    require_one_of("parameter", name, parameters(scene))
    head, _, key = name.rpartition(".")
    if not head:
        return replace(scene, load=value)
    if head == "friction":
        return replace(scene, friction=replace(scene.friction, **{key: value}))
    which, _, place = head.partition(".")
    body: Body = getattr(scene, which)
    if place == "material":
        body = Body(replace(body.material, **{key: value}), body.surface)
    else:
        parts = list(body.surface.parts)
        k = int(place[len("surface[") : -1])
        parts[k] = parts[k].with_parameter(key, value)
        body = body.with_parts(parts)
    return replace(scene, upper=body) if which == "upper" else replace(scene, lower=body)


def differentiable_parameters(scene: Scene) -> dict[str, float]:
    """Return the parameters that have derivatives; ``[tolerances]`` refuses all others.

    No derivatives have those that are zero, E and nu of a rigid body, and those that make another realisation
    of a surface: seeds, wavelengths of a spectrum (in a periodic scene its anisotropy and lay too), and the
    correlation length of an isotropic surface in a periodic scene.
    """
    found = parameters(scene)
    for name in BODIES:
        body: Body = getattr(scene, name)
        if body.material.is_rigid:
            del found[f"{name}.material.E"], found[f"{name}.material.nu"]
        for k, part in enumerate(body.surface.parts):
            for key in part.parameters().keys() - set(part.same_realisation(scene.periodic)):
                del found[f"{name}.surface[{k}].{key}"]
    return {name: value for name, value in found.items() if value != 0}


def check_tolerances(scene: Scene, tolerances: Mapping[str, float]) -> None:
    """Raise `InputError` unless every name is a parameter that moves and every tolerance is relative."""
    if tolerances and not scene.friction.is_linear:
        raise InputError("friction", scene.friction, "a law that is linear, for derivatives (of tolerances)")
    known = differentiable_parameters(scene) if tolerances else {}
    for name, tolerance in tolerances.items():
        if name not in known:
            raise InputError(f"tolerances.{name!r}", tolerance, f"one of {', '.join(known)}")
        require_number(f"tolerances.{name!r}", tolerance, _TOLERANCE, at_least=0, below=1)
