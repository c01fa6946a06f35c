"""Invariants that relate states: reciprocity, energy and work, monotony, and limits in the friction law."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import refimpl as rf
from verification.exact.textbook import normal_matrix
from verification.properties.registry import Solver, invariant, require
from verification.properties.samples import Sample, samples
from verification.properties.states import RESIDUAL, compliances, displacement, from_first_contact, solved

FOUR_CORNERS = Sample(bumps=((2, 0, 2), (0, 0, 0), (2, 0, 2)), beta=1)
"""Symmetric without friction: slopes tip no element then, and the plan neglects their 1e-7 of pressures."""

SMALL = 2.0**-30
"""A friction law this many times weaker must change the state by about as little."""


def heavier(sample: Sample) -> Sample:
    """Return the scene under 3/2 of the load, and a little more."""
    return replace(sample, pressure=sample.pressure * 3 // 2 + 1)


@invariant("two loads' pressures do equal work on each other's displacements", samples(friction=False))
def reciprocity(solver: Solver, sample: Sample) -> None:
    """Maxwell and Betti: f1 . u2 = f2 . u1."""
    one, two = (solved(solver, s, oblique=False) for s in (sample, heavier(sample)))
    there = float(np.vdot(one.pressure, displacement(heavier(sample), two)))
    back = float(np.vdot(two.pressure, displacement(sample, one)))
    scale = float(np.vdot(two.pressure, np.abs(displacement(heavier(sample), two))))
    require(abs(there - back) <= 1e-10 * scale)


@invariant("elastic energy is positive", samples(tau=False))
def positive_energy(solver: Solver, sample: Sample) -> None:
    """f . u > 0: the skew c contributes nothing, and a f is positive. A periodic mean does no work."""
    solution = solved(solver, sample)
    if sample.periodic and np.ptp(solution.pressure) <= RESIDUAL * solution.max_pressure:
        return
    require(float(np.vdot(solution.pressure, displacement(sample, solution))) > 0)


@invariant("shear by beta f does no work on the pressure", samples(tau=False, periodic=False))
def skew_coupling(solver: Solver, sample: Sample) -> None:
    """f . (C f) = 0: all of f . u is the work of a f alone."""
    solution = solved(solver, sample)
    f = solution.pressure.ravel()
    a, _ = compliances(sample.scene)
    by_pressure = a * float(f @ normal_matrix(sample.grid) @ f)
    require(abs(float(f @ displacement(sample, solution).ravel()) - by_pressure) <= 1e-10 * by_pressure)


@invariant("energy grows by the work of the load", samples(friction=False, periodic=False))
def energy_is_work(solver: Solver, sample: Sample) -> None:
    """W(delta) is convex with dW/d delta = P: P1 (d2 - d1) <= W2 - W1 <= P2 (d2 - d1), exactly."""
    states = [(s, solved(solver, s, oblique=False)) for s in (sample, heavier(sample))]
    energy = [float(np.vdot(s.pressure, displacement(which, s))) / 2 for which, s in states]
    force = [float(s.pressure.sum()) for _, s in states]
    path = states[1][1].approach - states[0][1].approach
    gained, slack = energy[1] - energy[0], 1e-10 * energy[1]
    require(force[0] * path - slack <= gained <= force[1] * path + slack)


@invariant("a larger load presses deeper and on no less area", samples(friction=False))
def monotone_in_load(solver: Solver, sample: Sample) -> None:
    """Approach, contact set and pressure of every element grow with the load."""
    light, heavy = solved(solver, sample, oblique=False), solved(solver, heavier(sample), oblique=False)
    require(from_first_contact(sample, heavy) >= from_first_contact(sample, light) * (1 - RESIDUAL))
    require(not np.any(light.contact & ~heavy.contact))
    require(np.all(heavy.pressure >= light.pressure - RESIDUAL * light.max_pressure))


@invariant("a deeper approach takes a larger load", samples(friction=False, periodic=False))
def monotone_in_approach(solver: Solver, sample: Sample) -> None:
    """Load and contact set grow with a prescribed approach."""
    first = solved(solver, sample, oblique=False)
    deeper = solver(sample.scene, sample.shape, approach=1.25 * first.approach, oblique=False)
    require(deeper.converged)
    require(deeper.normal_force > first.normal_force)
    require(not np.any(first.contact & ~deeper.contact))


@invariant(
    "friction that vanishes leaves the frictionless state", samples(friction=True), found=(FOUR_CORNERS,)
)
def weak_friction(solver: Solver, sample: Sample) -> None:
    """tau, beta -> 0: at 1e-9 of the friction the pressure differs by as little.

    With slopes in both: a plan may neglect them in the frictionless state alone, and say so.
    """
    friction = sample.scene.friction
    weak = replace(sample.scene, friction=rf.Friction(tau=SMALL * friction.tau, beta=SMALL * friction.beta))
    none = replace(sample.scene, friction=rf.Friction())
    faint, still = (solver(scene, sample.shape, oblique=True) for scene in (weak, none))
    require(faint.converged)
    require(still.converged)
    # tau is at most 0.6 of the mean pressure, and c at most half of a: amplified at most by the grid's
    # condition number, which is below 100
    require(np.abs(faint.pressure - still.pressure).max() <= (100 * SMALL + RESIDUAL) * still.max_pressure)
    require(abs(faint.friction_force - still.friction_force) <= 100 * SMALL * sample.scene.load + RESIDUAL)


@invariant("identical materials do not couple", samples())
def identical_materials(solver: Solver, sample: Sample) -> None:
    """Without slopes, friction then changes no pressure at all."""
    alike = replace(sample, E=sample.E[:1] * 2, nu=sample.nu[:1] * 2)
    rubbed = solved(solver, alike, oblique=False)
    still = solved(solver, replace(alike, tau=0, beta=0), oblique=False)
    require(np.array_equal(rubbed.contact, still.contact))
    require(np.abs(rubbed.pressure - still.pressure).max() <= RESIDUAL * still.max_pressure)
