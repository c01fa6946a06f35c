"""Model-form error of the half-space, from both bodies' undeformed surfaces, without another solve.

At a given load the surfaces' recession (`refimpl.half_space.boundary_perturbation`) raises the approach by
its mean, weighted by dp/dN: the pressure of a flat punch on the contact. On a Hertzian patch that is
``1 / p``; so it is taken here everywhere, with at least a twentieth of p_max for p. At a given approach N
falls by the same times the contact's stiffness. By Thomson's principle this is at least ``N / (2 U / N)``, U
being the elastic energy, for a flat punch's pressure has the least energy; contacts that grow are stiffer.
`refimpl.sensitivities.half_space_error` solves again instead, and has every number.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from refimpl.grid import Array, Mask
from refimpl.half_space.boundary_perturbation import Contact, gap_changes
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes

FINITE_STRAIN = (
    0.2  # share of the first order: neo-Hookean waves, 0.12 to 0.14 measured (case model-form/finite-strain)
)
STIFFENING = 1.4  # stiffness of contacts that grow, over N / (2 U / N): 1.2 to 1.37 measured on 24 waves
_LEAST = 0.05  # share of p_max: 1 / p grows beyond bounds at the edges, where whole elements are coarse
SECOND_ORDER = {  # times tan^2 of the steepest slopes: what 24 finite-element contacts left above the rest
    "approach": 0.1,
    "normal_force": 0.2,
    "friction_coefficient_corrected": 0.2,
    "friction_coefficient": 0.2,
    "contact_area": 0.5,
    "max_pressure": 0.2,
    "binormal_force": 0.2,
}


@dataclass(frozen=True)
class ModelForm:
    """Stated relative errors of approach (under the load) and of N (at the approach)."""

    approach: float
    normal_force: float


def contact_of(
    problem: Problem, pressure: Array, traction: Array, displacements: tuple[Array, Array]
) -> Contact:
    """Return what the perturbation needs of a solved problem; ``displacements`` into both bodies (m)."""
    common = problem.mean_surface + 0.5 * (displacements[1] - displacements[0])
    return Contact(
        grid=problem.grid,
        pair=problem.pair,
        heights=problem.heights,
        displacements=displacements,
        pressure=pressure,
        traction=traction,
        slopes=Slopes.of_surface(common, problem.grid, problem.direction),
        direction=problem.direction,
        facets_solved=problem.terms.slope_correction,
    )


def steepness(problem: Problem, contact: Mask) -> float:
    """Return twice the mean square gradient about the contact, weighted by compliances: a wave's tan^2."""
    grid, pair = problem.grid, problem.pair
    near, wider = (grid.window_around(contact, margin=margin) for margin in (1, 2))
    place = (
        slice(near.i0 - wider.i0, near.i1 - wider.i0),
        slice(near.j0 - wider.j0, near.j1 - wider.j0),
    )
    total = 0.0
    shares = 1 - pair.upper_share, pair.upper_share
    for share, heights in zip(shares, problem.windowed(wider).heights, strict=True):
        along_x, along_y = (along[place] for along in grid.gradient(heights))
        total += share * float(np.mean(along_x**2 + along_y**2))
    return 2 * total


def model_form(
    problem: Problem,
    pressure: Array,
    traction: Array,
    displacements: tuple[Array, Array],
    approach: float,
) -> ModelForm:
    """Return the stated relative errors of approach and N; zero without contact.

    ``approach`` counts from first contact (m); ``displacements`` are into the (lower, upper) body (m).
    """
    contact = pressure > 0
    if not contact.any():
        return ModelForm(0.0, 0.0)
    lower, upper = gap_changes(replace(contact_of(problem, pressure, traction, displacements), near=True))
    shares = pressure / pressure.sum()
    grown = contact / np.maximum(pressure, _LEAST * pressure.max())
    sunk = abs(float(np.sum(grown * (lower + upper)) / np.sum(grown)))
    elastic = abs(float(np.sum(shares * (displacements[0] + displacements[1]))))  # 2 U / N
    left = steepness(problem, contact)
    by_approach = sunk / abs(approach) if approach else 0.0
    by_force = STIFFENING * sunk / elastic if elastic else 0.0
    return ModelForm(
        (1 + FINITE_STRAIN) * by_approach + SECOND_ORDER["approach"] * left,
        (1 + FINITE_STRAIN) * by_force + SECOND_ORDER["normal_force"] * left,
    )
