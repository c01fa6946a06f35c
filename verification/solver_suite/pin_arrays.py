"""Beds of pins: pressures are chosen element by element, and the gap that they solve follows.

The other elements are out of reach, so displacements are needed between pins alone, and on any grid they are
sums of 50-digit integrals. Periodic ones are sums of the exact symbols (`reference_solution`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from refimpl.grid import Array, Mask
from verification.exact import kernel_reference
from verification.solver_suite import reference_solution
from verification.solver_suite.check import MODULUS, Entrant, Pressed
from verification.solver_suite.protocol import ContactProblem, Coupling

PEAK = 1e-3 * MODULUS
"""Maximum pressure (Pa) of an array."""
HARDNESS = 0.6 * PEAK
"""Hardness (Pa) of pins that yield: some half of them are at it."""
FAR = 0.5
"""Gap (m) of the elements out of reach, on a square of 1 m: a thousand times what an array gives way."""
PINS = ((0, 0), (0, -1), (-1, 0), (-1, -1), (0, 5), (4, 0), (-1, 7), (8, -1), (2, 3), (2, 4), (5, 5), (6, 5))
"""All corners, an element of each edge, two neighbours along y and two along x: offsets from one element to
the whole square, both ways along both axes."""


def standing(M: int) -> Mask:
    """Return the mask of the `PINS` on ``M`` elements a side."""
    contact = np.zeros((M, M), dtype=bool)
    contact[tuple(zip(*PINS, strict=True))] = True
    return contact


def uneven(contact: Mask, seed: int) -> Array:
    """Return random pressures (Pa) from 0.3 of the peak up."""
    return np.where(contact, PEAK * np.random.default_rng(seed).uniform(0.3, 1.0, contact.shape), 0.0)


def graded(contact: Mask, seed: int) -> Array:
    """Return the pressures (Pa) from 0.3 % of the peak up, evenly in their logarithm, in random order.

    With much less, or much more tau than in these checks, a barely loaded pin can stand or not, both being
    solutions: the shear of the pin itself moves its neighbours, and they move it.
    """
    shares = 10 ** np.linspace(-2.5, 0.0, np.count_nonzero(contact))
    pressure = np.zeros(contact.shape)
    pressure[contact] = PEAK * np.random.default_rng(seed).permutation(shares)
    return pressure


@lru_cache(maxsize=4096)
def integrals(i: int, j: int) -> tuple[float, float]:
    """Return ``I[1/rho]`` and ``I[x/rho^2]`` of a unit element at a whole offset, from 50 digits."""
    at = float(abs(i)), float(abs(j)), 1.0, 1.0
    return float(kernel_reference.normal(*at)), float(np.sign(i) * kernel_reference.tangential(*at))


def displacement(pressure: Array, coupling: Coupling | None, modulus: float) -> Array:
    """Return the loaded elements' displacement (m) in a free square of 1 m, summed singly."""
    pins, M = np.argwhere(pressure > 0), len(pressure)
    u = np.zeros_like(pressure)
    for to in pins:
        for source in pins:
            (i, j), f = (int(n) for n in to - source), pressure[tuple(source)]
            u[tuple(to)] += f / (np.pi * modulus) * integrals(i, j)[0]
            if coupling is not None:
                along = np.cos(coupling.sliding_direction) * integrals(i, j)[1]
                along += np.sin(coupling.sliding_direction) * integrals(j, i)[1]
                u[tuple(to)] += coupling.shear_compliance * (coupling.tau + coupling.beta * f) * along
    return u / M


@dataclass(frozen=True, eq=False)
class PinArray:
    """A square of 1 m whose exact ``pressure`` (Pa), shape ``(M, M)``, is known: zero on all but the pins.

    With a ``hardness`` (Pa) the bodies overlap by random depths where the pressure is at it.
    """

    pressure: Array
    coupling: Coupling | None = None
    periodic: bool = False
    modulus: float = MODULUS
    hardness: float | None = None

    @classmethod
    def yielding(cls, pressure: Array, coupling: Coupling | None = None) -> PinArray:
        """Return the free array of pressures that end at `HARDNESS`."""
        return cls(np.minimum(pressure, HARDNESS), coupling, hardness=HARDNESS)

    @property
    def load(self) -> float:
        """Load of the pressures (N)."""
        return float(self.pressure.mean())

    @property
    def moved(self) -> Array:
        """Displacement (m) where pins stand; elsewhere of no consequence."""
        if not self.periodic:
            return displacement(self.pressure, self.coupling, self.modulus)
        M = len(self.pressure)
        flat = ContactProblem(np.zeros((M, M)), 1 / M, self.modulus, load=1.0, periodic=True)
        return reference_solution.displacement(replace(flat, coupling=self.coupling), self.pressure)

    @property
    def touch(self) -> float:
        """Approach (m) from first contact: what the first pin to be touched gives way."""
        return float(self.moved[self.pressure > 0].max())

    @property
    def gap(self) -> Array:
        """The gap (m) that the pressures close, less the overlaps at the hardness; `FAR` off the pins."""
        gap = np.where(self.pressure > 0, self.touch - self.moved, FAR)
        if self.hardness is None:
            return gap
        depths = np.random.default_rng(7).uniform(0.05, 0.5, self.pressure.shape) * self.touch
        return gap - np.where(self.pressure >= self.hardness, depths, 0.0)

    def under_load(self, entrant: Entrant) -> tuple[Pressed, Array]:
        """Return the solver's answer under the load of the pressures, and the pressures."""
        return self._pressed(entrant, load=self.load), self.pressure

    def at_approach(self, entrant: Entrant) -> tuple[Pressed, Array]:
        """Return the solver's answer at the approach of the pressures, and the pressures."""
        approach = self.touch - (float(self.gap.mean()) if self.periodic else 0.0)
        return self._pressed(entrant, approach=approach), self.pressure

    def _pressed(self, entrant: Entrant, **control: float) -> Pressed:
        return entrant.press(
            self.gap,
            periodic=self.periodic,
            coupling=self.coupling,
            modulus=self.modulus,
            hardness=self.hardness,
            **control,
        )
