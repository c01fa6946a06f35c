"""From a scene to a solution: plan, discretise, solve, certify, error bars, record."""

from __future__ import annotations

import numpy as np

from refimpl.driver.limits import Limits
from refimpl.driver.on_grid import Progress, initial_guess, solve_on_grid
from refimpl.driver.options import Options
from refimpl.driver.refined import refined
from refimpl.errors import InputError
from refimpl.model.problem import Terms
from refimpl.planning.plan import Method
from refimpl.scene.discretise import Discretiser
from refimpl.scene.scene import Scene
from refimpl.solution.plausibility import doubting
from refimpl.solution.solution import Solution, assemble


# Long by the meaning of its options: what it does are the last 20 lines.
@np.errstate(under="ignore")  # whatever the caller's settings
def solve(
    scene: Scene,
    grid: int | tuple[int, int] | None = None,
    *,
    method: Method = "fft",
    accuracy: float | None = None,
    quantity: str | None = None,
    approach: float | None = None,
    oblique: bool | None = None,
    slope_correction: bool = False,
    coupled: bool | None = None,
    tilted: bool | None = None,
    plastic: bool | None = None,
    tolerance: float | None = None,
    start: Solution | None = None,
    max_grid: int | None = None,
    max_seconds: float | None = None,
    max_memory: float | None = None,
    progress: Progress | None = None,
) -> Solution:
    """Solve a scene on a grid of elements, or to a relative ``accuracy``.

    Parameters
    ----------
    grid : elements along the longer side, the other number chosen for elements nearest to square; or both,
        ``(Mx, My)``; by default, without an accuracy, a measured map's own points, up to 512 along the longer
        side, and 256 of formulas (`Scene.default_grid`)
    method : "fft" the production solver, "dense" the plain reference for small grids, "paper" the
        paper's own scheme
    accuracy : refine until the error bar of ``quantity`` is this share of its value, on grids of one element
        ratio
    quantity : "friction_coefficient_corrected" (the default with friction), "contact_area" (without),
        "friction_coefficient",
        "contact_area_corrected" or "max_pressure"
    approach : prescribe the approach (m) instead of the scene's load
    oblique : False neglects every slope term: the classical small-slope theory that other codes solve; None
        lets the scene decide
    slope_correction : exact facet tractions in Eq. (7): `refimpl.model.forces`
    coupled, tilted : request or exclude what shear does to the gap, and to the slopes of the common surface;
        None lets the scene decide
    max_grid, max_seconds, max_memory : with ``accuracy``: the largest number of elements along a side,
        seconds in all, bytes of the whole process; beyond them the status is `ACCURACY_NOT_REACHED`, with
        the finest grid within them. An interrupt (KeyboardInterrupt) has the last finished grid's solution as
        its argument
    plastic : True caps pressures at the hardness of the softer body, False never does; None takes the
        scene's own choice, and without one the cap enters where pressures reach a given hardness
    tolerance : what every residual of the certificate must meet for status `CONVERGED`; by default
        1e-8 (with ``accuracy``, a share of it), and for "paper" its own load tolerance of 1e-4
        (its pressure tolerance is a tenth of it)
    start : a certified solution on a grid of the same lengths that is not finer, for "fft" to start from:
        nested grids no finer are skipped, and the solution is the same. Best this scene's own on a coarser
        grid; after another load the nested grids are faster
    progress : called with a line of text at every step of the work

    Raises
    ------
    InputError
        input out of range, before anything large is allocated
    ArithmeticError
        by "dense" alone: singular equations of a problem on its way; other methods end with a status
    """
    if progress is not None and not callable(progress):
        raise InputError("progress", progress, "a function of one line of text")
    with doubting(scene):
        options = Options(
            scene=scene,
            grid=grid,
            method=method,
            accuracy=accuracy,
            quantity=quantity,
            approach=approach,
            requested=Terms(coupled, oblique, tilted, slope_correction, plastic),
            tolerance=tolerance,
            start=start,
            limits=Limits(max_grid, max_seconds, max_memory),
        )
        return _solved(options, progress)


def _solved(options: Options, progress: Progress | None) -> Solution:
    discretiser, start = Discretiser(options.scene, options.approach), options.start
    plan = options.plan(discretiser)
    if options.accuracy is not None:
        return refined(options, plan, discretiser, progress)
    guess = None
    if start is not None:
        guess = initial_guess(start.details.problem, start.pressure, start.details.clearance, start.approach)
    solved = solve_on_grid(plan, discretiser, options.residual_tolerance, progress, guess)
    return assemble(solved)
