"""A sliding contact on three nested meshes, fine at its ends: values and their discretisation errors."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from appendix_a.contact_fem.bodies import MeshPlan, Surface, wavy_surface
from appendix_a.contact_fem.contact import Contact, Friction, press
from appendix_a.contact_fem.scene import WavyPair

Array = NDArray[np.float64]
QUANTITIES = ("approach", "normal", "friction", "friction_coefficient", "length")
BASE_CELLS = 6.0  # at least, in the contact, at level 0 and away from its ends
MARGIN = 1.35  # meshed zone over the expected half-length


@dataclass(frozen=True)
class Estimate:
    """A quantity on the finest mesh, the bound on its discretisation error, and the observed order, if any.

    The bound is the last change where the observed order is 1 or more, for then no more is missing.  Where it
    is not, the larger of the last change and half the one before: a first-order series with scatter.
    """

    value: float
    error: float
    order: float | None

    @classmethod
    def of(cls, coarse: float, middle: float, fine: float) -> Estimate:
        """Extrapolate from values on meshes each twice as fine as the one before.

        >>> round(Estimate.of(1.16, 1.04, 1.01).error, 6)
        0.03
        """
        first, last = middle - coarse, fine - middle
        order = math.log2(first / last) if first * last > 0 else None
        orderly = order is not None and order >= 1.0
        return cls(fine, abs(last) if orderly else max(abs(last), abs(first) / 2.0), order)


def plans(pair: WavyPair, load: float, level: int = 0, depth: float = 1.5) -> tuple[MeshPlan, MeshPlan]:
    """Return both bodies' meshes before the ends are known: Westergaard's half-length."""
    share = min(load / pair.full_contact_pressure, 0.6)
    half = math.asin(math.sqrt(share)) / math.pi
    cells = 2 ** math.ceil(math.log2(BASE_CELLS / (2.0 * half)))
    plan = MeshPlan(cells, min(MARGIN * half + 4.0 / cells, 0.45), level, depth=depth)
    return plan, plan


def surfaces(
    pair: WavyPair, meshes: tuple[MeshPlan, MeshPlan], *, straight: bool = False
) -> tuple[Surface, Surface]:
    """Return the lower and upper surface with their compliances."""
    half = pair.shift / 2.0
    lower = wavy_surface(pair.amplitude, -half, pair.lower, meshes[0], upper=False, straight=straight)
    return lower, wavy_surface(pair.amplitude, half, pair.upper, meshes[1], upper=True, straight=straight)


def slide(
    pair: WavyPair, load: float, meshes: tuple[MeshPlan, MeshPlan], *, straight: bool = False
) -> Contact:
    """Solve the pair under `load` per wavelength and thickness on given meshes; raises NotConverged."""
    lower, upper = surfaces(pair, meshes, straight=straight)
    return press(lower, upper, pair.gap_amplitude, load, Friction(pair.tau, pair.beta, pair.coupling))


def graded_plans(
    pair: WavyPair, load: float, *, depth: float = 1.5, straight: bool = False
) -> tuple[MeshPlan, MeshPlan]:
    """Return the meshes with cells that shrink to the contact's ends, as a first solve finds them."""
    meshes = plans(pair, load, depth=depth)
    found = slide(pair, load, plans(pair, load, level=1, depth=depth), straight=straight)
    lower, upper = (
        MeshPlan(plan.cells, plan.zone, marks=ends, depth=depth)
        for plan, ends in zip(meshes, found.material_ends, strict=True)
    )
    return lower, upper


@dataclass(frozen=True)
class Sequence:
    """`contacts` on meshes each twice as fine as the one before."""

    contacts: tuple[Contact, ...]

    def estimate(self, quantity: str) -> Estimate:
        """Return one of QUANTITIES with its discretisation error."""
        coarse, middle, fine = (float(getattr(contact, quantity)) for contact in self.contacts[-3:])
        return Estimate.of(coarse, middle, fine)


def slide_on_three_meshes(
    pair: WavyPair, load: float, *, levels: tuple[int, int, int] = (0, 1, 2), straight: bool = False
) -> Sequence:
    """Solve the pair under `load` on three uniform refinements of one graded mesh; raises NotConverged."""
    lower, upper = graded_plans(pair, load, straight=straight)
    refined = [
        (
            MeshPlan(lower.cells, lower.zone, level, lower.marks),
            MeshPlan(upper.cells, upper.zone, level, upper.marks),
        )
        for level in levels
    ]
    return Sequence(tuple(slide(pair, load, meshes, straight=straight) for meshes in refined))
