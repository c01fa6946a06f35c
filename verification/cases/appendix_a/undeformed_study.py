"""Contacts of wavy and rough profiles by finite elements, for the half-space's error in the plane.

A contact is drawn from a seed: slopes from 1 to 20 degrees, crests, flanks, three waves; pairs from equal to
rigid on soft. One seed served to build the estimate of `refimpl.half_space.model_form`, others judge it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

import refimpl as rf
from appendix_a.contact_fem.bodies import Harmonics, MeshPlan, wave_height, wavy_surface
from appendix_a.contact_fem.contact import Contact, Friction, press
from appendix_a.contact_fem.ends import contact_ends
from appendix_a.contact_fem.scene import WAVENUMBER, Material
from refimpl.grid import Array
from refimpl.half_space.model_form import FINITE_STRAIN, SECOND_ORDER, steepness
from refimpl.sensitivities.half_space import half_space_error

BUILT_FROM, JUDGED_ON, WARNED_ON = 39, 40, 41
"""Seeds: of the constants; of the statements' judgement; of the warning's, whose rest was set after a look at
the second."""
KINDS = ("crest on crest", "crest on flat", "flank", "three waves")
ZONE = 0.45  # half-width of the meshed zone, in wavelengths
LEVELS = (0, 1)  # uniform refinements, of a first solve and of the solve that judges
CELLS = 32  # on the surface per wavelength at level 0
TOLERANCE = 1e-6  # largest residual of the model's certificate
NO_FRICTION = 1e-6  # mu below it is none: its relative error means nothing
ACROSS = 4  # elements of the model across the waves, where nothing changes


@dataclass(frozen=True)
class Profiles:
    """A contact of two profiles, lengths in wavelengths; z upwards, the upper body slides along +x.

    `slopes`: tangents k a of the (lower, upper) first wave; `shift` between crests, `share` of the load over
    p* of the first waves, `tau` over p*.
    """

    kind: str
    slopes: tuple[float, float]
    shift: float
    harmonics: Harmonics
    lower: Material
    upper: Material
    share: float
    tau: float
    beta: float

    @property
    def amplitudes(self) -> tuple[float, float]:
        """First waves' amplitudes (lower, upper)."""
        return self.slopes[0] / WAVENUMBER, self.slopes[1] / WAVENUMBER

    def heights(self, x: Array) -> tuple[Array, Array]:
        """Return (lower, upper) heights about their mean planes."""
        low, high = self.amplitudes
        lower = wave_height(x + self.shift / 2, low, self.harmonics)
        return lower, -wave_height(x - self.shift / 2, high)

    @property
    def distance(self) -> float:
        """Distance of the mean planes at first contact."""
        lower, upper = self.heights(np.linspace(-0.5, 0.5, 20001))
        return float((lower - upper).max())

    @property
    def reduced_modulus(self) -> float:
        """E*."""
        return 1 / sum((1 - m.nu**2) / m.E for m in (self.lower, self.upper))

    @property
    def full_contact_pressure(self) -> float:
        """p* = pi E* Delta / lambda of the first waves' gap, 2 Delta from crest to trough."""
        low, high = self.amplitudes
        gap = abs(low * np.exp(1j * math.pi * self.shift) + high * np.exp(-1j * math.pi * self.shift))
        return math.pi * self.reduced_modulus * float(gap)

    @property
    def load(self) -> float:
        """Per wavelength and unit thickness."""
        return self.share * self.full_contact_pressure

    @property
    def friction(self) -> Friction:
        """tau in the moduli's unit, beta, and Dundurs' constant."""
        by = ((1 + m.nu) * (1 - 2 * m.nu) / (2 * m.E) for m in (self.lower, self.upper))
        lower, upper = by
        return Friction(
            self.tau * self.full_contact_pressure, self.beta, self.reduced_modulus * (lower - upper)
        )


def drawn(seed: int, count: int) -> list[Profiles]:
    """Return `count` contacts of a seed, kinds in turn."""
    random = np.random.default_rng(seed)
    return [_draw(random, KINDS[i % len(KINDS)]) for i in range(count)]


def _draw(random: np.random.Generator, kind: str) -> Profiles:
    steep = math.tan(math.radians(random.uniform(1.0, 20.0)))
    nus = random.choice([0.0, 0.15, 0.3, 0.45], 2)
    ratio = float(random.choice([1.0, 1.7, 5.0, 1e6]))
    lower, upper = Material(1.0, float(nus[0])), Material(ratio, float(nus[1]))
    low = high = steep
    shift = 0.0
    harmonics: Harmonics = ()
    if kind == "crest on flat":
        high = 0.0
    if kind == "flank":
        shift = float(random.choice([-1, 1]) * random.uniform(0.05, 0.3))
    if kind == "three waves":
        # shorter waves leave room for one patch of contact: curvatures 0.02 9 and 0.01 25 of the first wave's
        high = steep * float(random.choice([0.0, 0.5]))
        harmonics = tuple((n, s, float(random.uniform(0, 2 * np.pi))) for n, s in ((3, 0.03), (5, 0.01)))
    beta, tau = float(random.choice([0.0, 0.08, 0.2])), float(random.choice([0.0, 0.02]))
    share = float(random.uniform(0.05, 0.35))
    return Profiles(kind, (low, high), shift, harmonics, lower, upper, share, tau, beta)


def by_elements(profiles: Profiles) -> Contact:
    """Return the contact on a mesh fine at the ends that a first solve finds. Raises NotConverged."""
    plain = MeshPlan(CELLS, ZONE, LEVELS[0])
    marks = _pressed(profiles, plain, plain).material_ends
    return _pressed(profiles, *(MeshPlan(CELLS, ZONE, LEVELS[1], ends) for ends in marks))


def _pressed(profiles: Profiles, below: MeshPlan, above: MeshPlan) -> Contact:
    low, high = profiles.amplitudes
    half = profiles.shift / 2
    lower = wavy_surface(low, -half, profiles.lower, below, upper=False, harmonics=profiles.harmonics)
    upper = wavy_surface(high, half, profiles.upper, above, upper=True)
    return press(lower, upper, profiles.distance, profiles.load, profiles.friction)


def scene_of(profiles: Profiles, M: int) -> rf.Scene:
    """Return the model's scene on M elements along x, periodic and constant across: plane strain."""
    x = (np.arange(M) + 0.5) / M - 0.5
    lower, upper = (np.repeat(z[:, None], ACROSS, 1) for z in profiles.heights(x))
    width = ACROSS / M
    return rf.Scene(
        upper=rf.Body(rf.Material(profiles.upper.E, profiles.upper.nu), upper),
        lower=rf.Body(rf.Material(profiles.lower.E, profiles.lower.nu), lower),
        friction=rf.Friction(tau=profiles.friction.tau, beta=profiles.beta),
        load=profiles.load * width,
        size=(1.0, width),
        periodic=True,
    )


def numbers(profiles: Profiles, solution: rf.Solution) -> dict[str, float]:
    """Return mu, A and p_max, the contact's ends found between elements, as by finite elements."""
    M = solution.grid.shape[0]
    width, x = ACROSS / M, (np.arange(M) + 0.5) / M - 0.5
    friction = profiles.friction
    left, right = contact_ends(x, solution.pressure[:, 0], friction.coupling * friction.beta, 2)
    force = solution.friction_force + friction.tau * (width * (right - left) - solution.contact_area)
    return {
        "friction_coefficient": force / solution.normal_force,
        "contact_area": right - left,
        "max_pressure": solution.max_pressure,
    }


@dataclass(frozen=True)
class Judged:
    """One contact: relative errors by quantity (true, stated, of first order), whether ``warned``."""

    true: dict[str, float]
    stated: dict[str, float]
    warned: bool
    first_order: dict[str, float] = field(default_factory=dict)


def judged(profiles: Profiles, M: int = 384) -> Judged:
    """Return the model's error against finite elements, and what it states of it.

    N's is at the finite elements' approach, all others' under the load. Areas and friction are taken with
    ends found between elements. Raises NotConverged.
    """
    fine = by_elements(profiles)
    scene = scene_of(profiles, M)
    solution = rf.solve(scene, grid=(M, ACROSS), tolerance=TOLERANCE)
    error = half_space_error(scene, solution)
    datum = solution.details.problem.datum
    first = solution.approach + datum
    at = rf.solve(scene, grid=(M, ACROSS), tolerance=TOLERANCE, approach=fine.approach - datum)
    true = {"approach": fine.approach / first - 1, "normal_force": scene.load / at.normal_force - 1}
    change = {
        "approach": error.first_order["approach"] / first,
        "normal_force": error.first_order["normal_force"] / scene.load,
    }
    own, receded = numbers(profiles, solution), numbers(profiles, error.corrected)
    by_fem = {
        "friction_coefficient": fine.friction_coefficient,
        "contact_area": fine.length,
        "max_pressure": float(fine.pressure.max()),
    }
    for name, value in own.items():
        if abs(value) > NO_FRICTION:
            true[name] = by_fem[name] / value - 1
            change[name] = receded[name] / value - 1
    steep = steepness(solution.details.problem, solution.contact)
    stated = {q: (1 + FINITE_STRAIN) * abs(c) + SECOND_ORDER[q] * steep for q, c in change.items()}
    warned = any(getattr(w, "limit", None) == "half-space" for w in solution.warnings)
    return Judged(true, stated, warned, change)
