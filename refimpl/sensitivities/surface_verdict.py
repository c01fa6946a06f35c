"""Verdict on the half-space for one surface: local coefficient errors, every number, advice."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from refimpl.driver.solve import solve
from refimpl.errors import NotConverged, require_number
from refimpl.grid import Array
from refimpl.half_space.influence_error import constant_along_an_axis
from refimpl.half_space.local_error import local_error, share_above, short_wave_share
from refimpl.half_space.model_form import steepness
from refimpl.model.friction import Friction
from refimpl.model.materials import Material
from refimpl.scene.discretise import discretise
from refimpl.scene.scene import Body, Scene
from refimpl.sensitivities.half_space import (
    ACCEPTED,
    JUDGED_TO,
    HalfSpaceError,
    advice,
    half_space_error,
)
from refimpl.solution.solution import Solution
from refimpl.surfaces import Flat

NUMBERS = (
    "friction_coefficient_corrected",
    "friction_coefficient",
    "contact_area",
    "max_pressure",
    "approach",
    "normal_force",
)
LIGHT = 0.05  # mean pressure over E* Sdq by default: about a tenth of the area is in contact
_SHORT = 0.1  # largest share of the mean square slope at short waves without a sentence


@dataclass(frozen=True, eq=False)
class SurfaceVerdict:
    """The half-space judged on a scene's own surfaces.

    solution : the scene as solved
    error : of its numbers, by solving twice more with the surfaces' recession
    local : coefficient error at each element's undeformed slopes (relative), the grid's shape
    share_above : share of the area where it exceeds 2 %
    short_waves : share of the mean square slope at wavelengths that the coefficient tables do not reach
    advice : for each number one of three: keep, correct, finite elements
    evidence : slopes, contacts and limits behind the advice
    """

    solution: Solution
    error: HalfSpaceError
    local: Array
    share_above: float
    short_waves: float
    advice: str
    evidence: str

    def numbers(self) -> dict[str, dict[str, float]]:
        """Return value, corrected value and stated error by number; N at the approach, others under load."""
        error = self.error
        found = {}
        for name in NUMBERS:
            value = float(getattr(self.solution, name))
            found[name] = {
                "value": value,
                "corrected": value + error.first_order[name],
                "stated": error.stated(name),
                "second_order": error.second_order[name],
                "finite_strain": error.finite_strain[name],
            }
        return found


def surface_verdict(scene: Scene, grid: int | tuple[int, int] | None = None) -> SurfaceVerdict:
    """Solve a scene three times and judge the half-space on it. Raises as `solve`, or `NotConverged`."""
    solution = solve(scene, grid)
    if not solution.converged:
        raise NotConverged(f"the solve ended as {solution.status.value}")
    problem = solution.details.problem
    error = half_space_error(scene, solution)
    local = local_error(problem)
    short = short_wave_share(problem)
    return SurfaceVerdict(
        solution=solution,
        error=error,
        local=local,
        share_above=share_above(local, ACCEPTED),
        short_waves=short,
        advice=advice(error, solution),
        evidence=_evidence(solution, short),
    )


def _evidence(solution: Solution, short: float) -> str:
    problem = solution.details.problem
    slope = math.degrees(math.atan(math.sqrt(steepness(problem, solution.contact))))
    if constant_along_an_axis(*problem.heights):
        judged = "56 plane contacts solved by finite elements, slopes of 1 to 20 degrees"
    else:
        judged = "56 plane contacts and 6 pairs of asperities in space, by finite elements"
    found = f"slopes of {slope:.2g} degrees; the rule rests on {judged} (docs/half-space-limits.md)"
    if slope > JUDGED_TO:
        found += f"; nothing was judged beyond {JUDGED_TO:g} degrees"
    if short > _SHORT:
        found += (
            f"; {short:.0%} of the mean square slope is at wavelengths below ten elements, which the "
            "coefficient tables do not have: take a finer grid"
        )
    return found


def pressed_on_a_flat(
    surface: Any,
    material: Material,
    *,
    grid: int | None = None,
    pressure: float | None = None,
    friction: Friction | None = None,
) -> Scene:
    """Return the scene of one surface alone: its body below a rigid flat, where no error cancels.

    Parameters
    ----------
    surface : a `Surface` that covers an area by itself, such as a `MeasuredSurface`
    material : of its body, elastic
    grid : elements along the longer side, for the slopes; as in `solve` by default
    pressure : nominal pressure over the area (Pa); by default a twentieth of ``E* Sdq``, which brings about a
        tenth of the area into contact
    friction : none by default

    Raises
    ------
    InputError
        input out of range
    """
    upper, lower = Body(Material(math.inf, material.nu), Flat()), Body(material, surface)
    friction = friction or Friction()
    probe = Scene(upper, lower, friction, load=1.0)
    if pressure is None:
        problem = discretise(probe, probe.grid(probe.default_grid if grid is None else grid))
        along_x, along_y = problem.grid.gradient(problem.heights[0])
        gradient = math.sqrt(float(np.mean(along_x**2 + along_y**2)))
        pressure = LIGHT * material.E / (1 - material.nu**2) * gradient
        require_number("surface", pressure, "a surface that is not flat, or a pressure (Pa)", above=0)
    else:
        require_number("pressure", pressure, "a nominal pressure in Pa", above=0)
    return Scene(upper, lower, friction, load=pressure * math.prod(probe.lengths))
