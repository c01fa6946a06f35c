"""The contact problem as the variational principle states it: minimise the complementary energy over f >= 0.

Kalker and van Randen 1972; Tian and Bhushan 1996, the competitor of Table 2. Without friction and at a
prescribed approach the total complementary energy of the discrete half-space is

    V*(f) = (1/2 f . a f - f . (approach - h)) dA,    f >= 0,

and its minimum is the contact. Only elements of kinematic interference, h < approach, can be loaded: a is
positive, so elsewhere dV*/df > 0 whatever the pressure is. They are the unknowns here.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

import refimpl as rf
from refimpl.grid import Array, Mask
from refimpl.model.certificate import State, certify
from refimpl.model.problem import Problem, Terms
from refimpl.model.slopes import Slopes
from refimpl.operators.fft import Counter, FFTInfluence
from refimpl.operators.kernel_tables import unit_table
from refimpl.scene.discretise import discretise

FRICTIONLESS = Terms(coupled=False, oblique=False)


def table2_scene() -> rf.Scene:
    """Table 2's contact as far as the paper tells it: "a half-space and a sphere with a rough surface".

    Sphere, moduli, load and side are those of Table 1, the roughness is the only one that the paper gives
    its sphere, 0.084 um; the half-space is smooth, and there is no friction ("static contact").
    """
    roughness = rf.GaussianRoughness(rms=0.084e-6, correlation_length=104e-6, seed=1)
    return rf.Scene(
        upper=rf.Body(rf.Material(E=200e9, nu=0.30), rf.Sphere(radius=0.14) + roughness),
        lower=rf.Body(rf.Material(E=118e9, nu=0.30), rf.Flat()),
        friction=rf.Friction(),
        load=70.0,
        side=1.61e-3,
    )


@dataclass(frozen=True, eq=False)
class Energy:
    """V* in units of its own: lengths in approaches, pressures in ``approach / (compliance spacing)``.

    ``problem`` has a prescribed approach and no friction. Unknowns ``x``, shape ``(n,)``, are the pressures
    on ``interference``, row by row; then ``V* = 1/2 x.Ax - x.depth`` with ``A`` of unit elements.
    """

    problem: Problem

    @cached_property
    def interference(self) -> Mask:
        """The elements that may be loaded, ``(M, M)``: Table 2's initial contact points."""
        return self.problem.gap < self.approach

    @property
    def approach(self) -> float:
        """The prescribed approach (m)."""
        assert self.problem.approach is not None
        return self.problem.approach

    @cached_property
    def depth(self) -> Array:
        """``(approach - h) / approach`` on the interference, ``(n,)``."""
        depth: Array = 1 - self.problem.gap[self.interference] / self.approach
        return depth

    def matrix(self) -> Array:
        """``I[1/rho]`` of unit elements between all pairs of unknowns, ``(n, n)``."""
        table = unit_table("normal", self.problem.grid.shape)
        i, j = np.nonzero(self.interference)
        pairs = np.empty((len(i), len(i)))
        for k in range(len(i)):
            pairs[k] = table[np.abs(i - i[k]), np.abs(j - j[k])]
        return pairs

    def apply(self, x: Array) -> Array:
        """``A x`` by FFT, ``(n,)``."""
        displacement: Array = self._operator.normal(self._spread(x))[self.interference]
        return displacement / self.problem.grid.element_size

    def pressure(self, x: Array) -> Array:
        """Pressures on the whole grid, ``(M, M)`` (Pa)."""
        problem = self.problem
        unit = self.approach / (problem.pair.normal_compliance * problem.grid.element_size)
        return unit * self._spread(x)

    @property
    def counter(self) -> Counter:
        """What the FFT operator has counted."""
        return self._operator.counter

    @cached_property
    def _operator(self) -> FFTInfluence:
        return FFTInfluence(self.problem.grid, self.problem.direction)

    def _spread(self, x: Array) -> Array:
        whole = np.zeros(self.problem.gap.shape)
        whole[self.interference] = x
        return whole


def frictionless(scene: rf.Scene, M: int, approach: float | None = None) -> Problem:
    """The scene on ``M x M`` elements without slopes and coupling, under its load or at an approach (m)."""
    return discretise(scene, scene.grid(M), FRICTIONLESS, approach)


def certified(problem: Problem, pressure: Array) -> State:
    """The state of a pressure ``(M, M)`` (Pa) of the frictionless problem, with its residuals."""
    operator = FFTInfluence(problem.grid, problem.direction)
    none = np.zeros_like(pressure)
    return certify(problem, operator, pressure, none, Slopes.flat(pressure.shape))
