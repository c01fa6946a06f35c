"""Random scenes on which the plan's estimates are compared with what neglecting each term really changes.

Smooth balls (on a flat or in a cup), balls on roughness, rough planes (free or periodic), two rough bodies;
rms slopes of 3e-4 to 0.1, contact over 1 % to 50 % of a plane. The effect is the difference of two solves on
one grid, of mu over local friction and of A; without friction, of mu itself.
"""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass

import numpy as np

import refimpl as rf
from refimpl.model.problem import Problem, Terms
from refimpl.operators.fft import Counter
from refimpl.planning.plan import Plan, make_plan
from refimpl.planning.term_effects import ESTIMATES, NONE, Effect, Scales
from refimpl.planning.terms import LABELS
from refimpl.scene.discretise import discretise
from refimpl.solvers.production.nested_solver import solve_fft

SIDE = 1e-3
TOLERANCE = 1e-9  # tolerance of each solve: a thousandth of the smallest effects that are judged
RMS_SLOPE_PER_RMS = math.sqrt(2 * 2.3)  # Eq. (9): rms slope = this times rms over length

WITHOUT = {
    "coupled": Terms(coupled=False),
    "tilted": Terms(tilted=False),
    "oblique": Terms(oblique=False),
}
WITH = {"slope_correction": Terms(slope_correction=True)}  # added: Eq. (7) is printed without it
CORRECTION = LABELS["slope_correction"]


@dataclass(frozen=True)
class Trial:
    """One term, by its label, in one scene: estimate, effect, and whether the plan neglects it."""

    scene: int
    term: str
    estimate: Effect
    effect: Effect
    neglected: bool

    @property
    def bounded(self) -> bool:
        """True if all estimates hold; two solves to `TOLERANCE` can differ by that."""
        effect, estimate = astuple(self.effect), astuple(self.estimate)
        return all(e <= max(bound, TOLERANCE) for e, bound in zip(effect, estimate, strict=True))


def random_scene(rng: np.random.Generator) -> rf.Scene:
    """Return one scene of the four kinds."""
    lower, upper = _materials(rng)
    modulus = 1 / (1 / lower.plane_strain_modulus + 1 / upper.plane_strain_modulus)
    kind = rng.choice(["smooth", "rough", "planes", "both rough"])
    length = SIDE * rng.uniform(0.06, 0.25)
    slope = 10 ** rng.uniform(-3.5, -1)
    seed = int(rng.integers(1_000_000_000))
    roughness = rf.GaussianRoughness(slope * length / RMS_SLOPE_PER_RMS, length, seed)
    other = rf.GaussianRoughness(
        roughness.rms * 10 ** rng.uniform(-1, 0.5), length * rng.uniform(0.7, 1.5), seed + 1
    )
    radius, contact_radius = SIDE * 10 ** rng.uniform(1, 3), SIDE * rng.uniform(0.1, 0.35)
    load = 4 / 3 * modulus * contact_radius**3 / radius
    pressure = max(load / (math.pi * contact_radius**2), 0.7 * modulus * slope)
    bottom: rf.Surface = roughness
    top: rf.Surface = rf.Sphere(radius)
    if kind == "smooth":
        pressure = load / (math.pi * contact_radius**2)
        bottom = rf.Sphere(-radius * rng.uniform(1, 5)) if rng.random() < 0.3 else rf.Flat()
    elif kind == "planes":
        pressure = 0.7 * modulus * slope
        load = 10 ** rng.uniform(-2, -0.3) * pressure * SIDE**2
        top = other if rng.random() < 0.5 else rf.Flat()
    elif kind == "both rough":
        top = top + other
    tau = rng.integers(2) * pressure * 10 ** rng.uniform(-2.5, -0.5)
    beta = rng.integers(2) * 10 ** rng.uniform(-2, -0.4)
    return rf.Scene(
        upper=rf.Body(upper, top),
        lower=rf.Body(lower, bottom),
        friction=rf.Friction(float(tau), float(beta)),
        load=float(load),
        side=SIDE,
        sliding_direction=float(rng.uniform(0, 2 * math.pi)) if rng.random() < 0.5 else 0.0,
        periodic=bool(kind == "planes" and rng.random() < 0.5),
    )


def _materials(rng: np.random.Generator) -> tuple[rf.Material, rf.Material]:
    moduli, ratios = 10 ** rng.uniform(9, 11.5, 2), rng.uniform(0, 0.5, 2)
    lot = rng.random()
    if lot < 0.25:
        moduli[1], ratios[1] = moduli[0], ratios[0]
    elif lot < 0.6:
        moduli[1] = moduli[0] * 10 ** rng.uniform(-0.3, 0.3)
    first, second = (rf.Material(float(E), float(nu)) for E, nu in zip(moduli, ratios, strict=True))
    return first, second


def trials(seed: int, scenes: int, M: int, accuracy: float) -> list[Trial]:
    """Return every term that is not exactly zero, in each scene, with the plan's word at the accuracy."""
    rng = np.random.default_rng(seed)
    found: list[Trial] = []
    for number in range(scenes):
        scene = random_scene(rng)
        problem = discretise(scene, scene.grid(M))
        found += _trials_of(number, problem, make_plan(problem, demand=accuracy))
    return found


def _trials_of(number: int, problem: Problem, plan: Plan) -> list[Trial]:
    scales = Scales(plan.contact, problem.pair, problem.friction)
    whole = _mu_and_area(problem)
    result = []
    for name, terms in {**WITHOUT, **WITH}.items():
        estimate = ESTIMATES[name](scales)
        if estimate == NONE and name in WITHOUT:  # exactly zero: the plan has no choice
            continue
        mu, area = _mu_and_area(problem.with_terms(terms))
        change, larger = abs(mu - whole[0]), abs(area - whole[1]) / whole[1]
        effect = Effect(change / scales.mu, larger) if scales.mu else Effect(0.0, larger, bare=change)
        out = name in WITHOUT and not plan.includes(name)
        result.append(Trial(number, LABELS[name], estimate, effect, out))
    return result


def _mu_and_area(problem: Problem) -> tuple[float, float]:
    """Return the friction coefficient and contact area (m^2); raises `RuntimeError` without convergence."""
    state = solve_fft(problem, TOLERANCE, Counter())
    if not state.certificate.satisfies(10 * TOLERANCE):
        raise RuntimeError(f"{state.status.value}: {state.certificate.largest:.1e}")
    return state.friction_coefficient, state.contact_area
