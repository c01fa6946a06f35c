"""Warnings of inputs that are seldom meant: moduli in GPa, a strength above the hardness, a length in um.

None of them is an error: the theory has no scale, and what is unusual may be right.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager

from refimpl.errors import InputError
from refimpl.measured.areal_parameters import implausible_slope
from refimpl.model.friction import friction_coefficient_at
from refimpl.model.materials import Material
from refimpl.planning.plan import Plan
from refimpl.scene.scene import Scene
from refimpl.solution.evidence import Evidence
from refimpl.solution.model_warning import Limit, ModelWarning, Notice
from refimpl.surfaces import GaussianRoughness, SelfAffineRoughness, Sphere

MODULI = (1e6, 2e12)  # Pa: from soft gels to twice diamond
_STRONG = 10.0  # tau over the mean contact pressure
_WEAK = 1e-3  # tau's share of mu
_FULL_TURN = 6.2832  # rad: 2 pi, rounded up
_STEEP = 2.0  # beta: mu of most dry contacts is below
_LARGE = 0.1  # m: beyond the maps of profilometers
_HUGE = 100.0  # domain over the radius of a ball: um taken for m is 1e6
_SOFTER = 5.0  # E over the hardness: 20 to 500 of metals, 10 to 20 of ceramics, 6 to 10 of hard carbon
_INDEX = 1e3  # plasticity index
_NUMBERS = ("load", "approach", "friction.tau", "lower.surface", "upper.surface")
_LENGTHS = ("correlation_length", "short_cut")  # roughness of longer ones is a smooth surface on the domain


def notes(solved: Evidence) -> tuple[ModelWarning | Notice, ...]:
    """Return warnings of implausible inputs, and notes of surfaces but those with a warning of their own."""
    scene, grid = solved.scene, solved.problem.grid
    parts = (*scene.lower.surface.parts, *scene.upper.surface.parts)
    rough = (part for part in parts if part.detail(max(grid.spacings)) is not None)
    named = {line for part in rough for line in part.notes(grid)}
    surfaces = (Notice(line) for line in scene.notes(grid) if line not in named)
    return (*implausible(scene, solved.plan), *surfaces)


def implausible(scene: Scene, plan: Plan) -> Iterator[ModelWarning]:
    """Yield a warning for each input beyond its usual range; contact pressures are the expected ones."""
    yield from _unusual(scene)
    mean, tau = plan.contact.mean_pressure, scene.friction.jump
    if mean > 0 and tau > _STRONG * mean:
        large = max(scene.lengths) > _LARGE
        unit = "are lengths in m (1 mm is 1e-3)" if large else "did you mean MPa (15 MPa is 15e6)"
        text = (
            f"tau, {tau:.4g} Pa, is {tau / mean:.3g} times the mean contact pressure to be expected: "
            f"{unit}, and is the load, {scene.load:.4g} N, right?"
        )
        yield _warning(tau, _STRONG * mean, text)
    expected = friction_coefficient_at(scene.friction, mean) * mean if mean > 0 else 0.0
    if 0 < tau < _WEAK * expected:
        less = f"tau, {tau:.4g} Pa, is less than {_WEAK:.1%} of the friction to be expected"
        yield _warning(tau, _WEAK * expected, f"{less}: did you mean MPa (60 MPa is 60e6)?")
    yield from _index(scene)


@contextmanager
def doubting(scene: object) -> Iterator[None]:
    """Make refusals of a scene's numbers name the inputs beyond their usual ranges, often the cause."""
    try:
        yield
    except InputError as refused:
        doubts = _unusual(scene) if isinstance(scene, Scene) and refused.field in _NUMBERS else ()
        allowed = "; ".join((refused.allowed, *doubts))
        raise InputError(refused.field, refused.value, allowed) from refused.__cause__


def _unusual(scene: Scene) -> Iterator[ModelWarning]:
    """Yield the warnings that need no expected contact."""
    for name, body in (("lower", scene.lower), ("upper", scene.upper)):
        yield from _material(name, body.material, scene.friction.jump)
        yield from _surface(name, scene)
    yield from _angle("sliding_direction", scene.sliding_direction)
    beta = scene.friction.slope
    if beta > _STEEP:
        text = f"beta, {beta:.4g}, is above {_STEEP:g}: per cent, or tau (the order is Friction(tau, beta))?"
        yield _warning(beta, _STEEP, text)


def _angle(name: str, angle: float) -> Iterator[ModelWarning]:
    if abs(angle) > _FULL_TURN:
        text = f"{name}, {angle:.4g} rad, is beyond a full turn: did you mean degrees"
        yield _warning(abs(angle), _FULL_TURN, f"{text} (45 degrees are 0.785 rad)?")


def _warning(number: float, allowed: float, text: str) -> ModelWarning:
    return ModelWarning(Limit.INPUT, number, allowed, text)


def _material(name: str, material: Material, tau: float) -> Iterator[ModelWarning]:
    least, most = MODULI
    if not material.is_rigid and not least <= material.E <= most:
        said = f"{name}.E, {material.E:.4g} Pa, is outside {least:g} to {most:g} Pa"
        unit = "did you mean GPa or MPa (200 GPa is 200e9)?"
        text = f"{said}: {unit if least > material.E else 'a rigid body is E = rigid'}"
        yield _warning(material.E, least if least > material.E else most, text)
    hardness = material.hardness
    if hardness is None:
        return
    said = f"{name}.hardness, {hardness:.4g} Pa, is"
    if hardness > material.E / _SOFTER:
        text = f"{said} above a fifth of E, {material.E:.4g} Pa: are both in Pa?"
        yield _warning(hardness, material.E / _SOFTER, text)
    if hardness < tau:
        yield _warning(hardness, tau, f"{said} below tau, {tau:.4g} Pa: are both in Pa?")


def _surface(name: str, scene: Scene) -> Iterator[ModelWarning]:
    shorter, longer = min(scene.lengths), max(scene.lengths)
    for part in scene.parts(name):
        if part.pitch(scene.lengths) is not None:
            z, pixel = part.data_points(scene.grid(scene.default_grid))
            for slope, bound, text in implausible_slope(z, pixel):
                yield _warning(slope, bound, f"{name}: {part.label}: {text}")
        if isinstance(part, Sphere) and abs(part.radius) < longer:
            said = f"{name}: radius {part.radius:.4g} m is below the domain's {longer:.4g} m: "
            unit = "is pixel_size, or the domain's size, in m (1 um is 1e-6)?"
            said += unit if longer > _HUGE * abs(part.radius) else "a paraboloid is no sphere there"
            yield _warning(abs(part.radius), longer, said)
        if isinstance(part, GaussianRoughness | SelfAffineRoughness):
            for label, length in part.parameters().items():
                if label.startswith(_LENGTHS) and length > shorter:
                    text = f"{name}: {label} {length:.4g} m is beyond the domain's {shorter:.4g} m"
                    yield _warning(length, shorter, f"{text}: did you mean um (100 um is 100e-6)?")
            yield from _angle(f"{name}: lay", part.parameters().get("lay", 0.0))
            rms = part.parameters().get("rms", 0.0)
            if rms > shorter:
                text = f"{name}: rms {rms:.4g} m is beyond the domain's {shorter:.4g} m: did you mean um?"
                yield _warning(rms, shorter, text)


def _index(scene: Scene) -> Iterator[ModelWarning]:
    """Yield the plasticity index of Eq. (12), by the expected contact's slopes of random roughness."""
    hardness, parts = scene.materials.softer_hardness, (*scene.parts("lower"), *scene.parts("upper"))
    rough = [part for part in parts if isinstance(part, GaussianRoughness | SelfAffineRoughness)]
    if hardness is None:
        return
    index = scene.materials.reduced_modulus / hardness * math.hypot(*(part.rms_slope for part in rough))
    if index > _INDEX:
        text = f"plasticity index {index:.3g} is beyond {_INDEX:g}: units of E, hardness, rms and correlation"
        yield _warning(index, _INDEX, f"{text} length?")
