"""A ball on a flat as a scene, as a problem of one grid, and the solver of that grid."""

from __future__ import annotations

from dataclasses import replace

import refimpl as rf
from refimpl.grid import Array, Window
from refimpl.model.problem import Problem, Terms
from refimpl.operators.influence import window_influence
from refimpl.operators.preconditioner import SpectralPreconditioner
from refimpl.scene.discretise import discretise
from refimpl.solvers.production.coarse_grids import winkler_pressure
from refimpl.solvers.production.level import LevelSolver

BALL = rf.Scene(
    upper=rf.Body(rf.Material(E=200e9, nu=0.3), rf.Sphere(radius=0.05)),
    lower=rf.Body(rf.Material(E=2.5e9, nu=0.2), rf.Flat()),
    friction=rf.Friction(tau=0.0, beta=0.1),
    load=1.0,
    side=2e-3,
)

FAINT = replace(
    BALL,
    upper=rf.Body(rf.Material(E=18e9, nu=0.37), rf.Sphere(radius=0.165)),
    lower=rf.Body(rf.Material(E=4.5e9, nu=0.17), rf.Flat()),
    friction=rf.Friction(tau=8e6, beta=0.5),
    load=0.1,
    side=1.6e-3,
)
"""Tau moves the contact of so faint a load far about, from one of its states to the next."""


def coupled(strength: float, tau: float = 0.0) -> rf.Scene:
    """Return the ball with such a beta that ``beta c f`` is up to ``strength`` times ``a f``."""
    return replace(BALL, friction=rf.Friction(tau, strength / abs(BALL.materials.coupling_ratio)))


def problem_of(
    scene: rf.Scene, M: int, *, oblique: bool = False, approach: float | None = None, **terms: bool
) -> Problem:
    return discretise(scene, scene.grid(M), Terms(oblique=oblique, **terms), approach)


def level_solver(
    problem: Problem,
    window: Window | None = None,
    *,
    pressure: Array | None = None,
    needs_mixing: bool = False,
) -> LevelSolver:
    """Return the solver of a problem's grid on a window, from a pressure or a Winkler foundation's."""
    window = window or problem.grid.window
    operator = window_influence(problem.grid, problem.direction, window)
    precondition = SpectralPreconditioner(operator, problem.elasticity.symbol(operator.symbol))
    start = winkler_pressure(problem)[window.slices] if pressure is None else pressure
    return LevelSolver(problem, operator, precondition, start, needs_mixing=needs_mixing)
