"""A ball on a flat, posed with and without coupling, and the solver of one of its grids."""

from __future__ import annotations

from dataclasses import replace

import refimpl as rf
from refimpl.grid import Array
from refimpl.grid.window import Window
from refimpl.model.problem import Problem, Terms, pose
from refimpl.operators.fft import Counter
from refimpl.operators.preconditioner import SpectralPreconditioner
from refimpl.solvers.production.coarse_grids import foundation_pressure
from refimpl.solvers.production.contact_vectors import Support
from refimpl.solvers.production.level import LevelSolver, influence
from refimpl.solvers.production.projected_cg import ProjectedCG

BALL = rf.Scene(
    upper=rf.Body(rf.Material(E=200e9, nu=0.3), rf.Sphere(radius=0.05)),
    lower=rf.Body(rf.Material(E=2.5e9, nu=0.2), rf.Flat()),
    friction=rf.Friction(tau=0.0, beta=0.1),
    load=1.0,
    side=2e-3,
)


def coupled(sigma: float, tau: float = 0.0) -> rf.Scene:
    """The ball with such a beta that ``beta c f`` is up to ``sigma`` times ``a f``."""
    pair = BALL.materials
    beta = sigma * pair.normal_compliance / abs(pair.shear_compliance)
    return replace(BALL, friction=rf.Friction(tau, beta))


def posed(scene: rf.Scene, M: int, *, oblique: bool = False, approach: float | None = None) -> Problem:
    terms = Terms(coupled=True, oblique=oblique, slope_correction=False)
    return pose(scene, rf.Grid(scene.side, M), terms, approach)


def level_solver(problem: Problem, window: Window | None = None) -> LevelSolver:
    window = window or Window.full(problem.grid.M)
    start = foundation_pressure(problem)[window.slices]
    operator = influence(problem, window, Counter())
    return LevelSolver(
        problem, operator, SpectralPreconditioner(operator, problem.pair.normal_compliance), start
    )


def press(cg: ProjectedCG, pressure: Array) -> None:
    """Put CG at another pressure, as if it had come there."""
    cg._support = Support(pressure > 0)
    cg._pressing = cg._support.of(pressure)
