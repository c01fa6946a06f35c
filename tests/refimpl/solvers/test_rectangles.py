"""Rectangular domains and oblong elements: one solution by all solvers, whichever axis is the longer."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.driver.reference import solve_reference
from refimpl.grid import Array, Grid
from refimpl.model.problem import Problem, Terms
from refimpl.operators.fft import Counter
from refimpl.scene.discretise import discretise
from refimpl.solvers.paper import solve_paper
from refimpl.solvers.production.nested_solver import solve_fft

TOLERANCE = 1e-12
SAME = 1e-10
"""Of the largest pressure."""

SOFT, HARD = rf.Material(E=2.5e9, nu=0.2), rf.Material(E=200e9, nu=0.3)
SCENE = rf.Scene(
    upper=rf.Body(HARD, rf.Sphere(radius=0.02)),
    lower=rf.Body(SOFT, rf.Flat()),
    friction=rf.Friction(tau=3e5, beta=0.2),
    load=2.0,
    side=1.6e-3,
    sliding_direction=0.7,
)
GRIDS = {
    "square domain": Grid((28, 17), (1.6e-3, 1.6e-3)),
    "square elements": Grid((30, 20), (1.8e-3, 1.2e-3)),
    "oblong elements along a longer side": Grid((18, 24), (2.4e-3, 1.2e-3)),
    "coarser grids": Grid((64, 40), (1.6e-3, 1.2e-3)),
    "strip": Grid((60, 5), (1.6e-3, 2e-4)),
    "row": Grid((24, 1), (1.6e-3, 1e-4)),
    "two columns": Grid((2, 30), (1e-4, 1.6e-3)),
}
on_grids = pytest.mark.parametrize("name", GRIDS)
of_topologies = pytest.mark.parametrize("periodic", [False, True])
with_terms = pytest.mark.parametrize(
    "terms", [Terms(), Terms(oblique=False), Terms(slope_correction=True)], ids=["oblique", "level", "facets"]
)


def heights(grid: Grid, seed: int = 3) -> Array:
    """Smooth random waves that repeat on the domain, of half a micrometre."""
    random, found = np.random.default_rng(seed), grid.zeros
    x, y = grid.x[:, None] / grid.lengths[0], grid.y[None, :] / grid.lengths[1]
    for k, m in ((1, 0), (0, 1), (1, 2), (2, -1), (3, 1)):
        found += random.normal() * np.cos(2 * np.pi * (k * x + m * y) + random.uniform(0, 6))
    return 5e-7 * found


def problem_on(grid: Grid, terms: Terms | None = None) -> Problem:
    upper = rf.Flat() if grid.periodic else SCENE.upper.surface
    lower = rf.ArraySurface(heights(grid), pixel=grid.spacings)
    rough = replace(SCENE, upper=rf.Body(HARD, upper), lower=rf.Body(SOFT, lower), periodic=grid.periodic)
    load = SCENE.load * grid.nominal_area / SCENE.side**2  # the same mean pressure on every domain
    return replace(discretise(rough, grid, terms), load=load)


@on_grids
@of_topologies
@with_terms
def test_the_reference_and_the_production_solver_agree(name: str, periodic: bool, terms: Terms) -> None:
    problem = problem_on(replace(GRIDS[name], periodic=periodic), terms)
    dense, fft = solve_reference(problem), solve_fft(problem, TOLERANCE, Counter())
    assert fft.status is dense.status
    assert np.array_equal(fft.excluded, dense.excluded)
    assert np.abs(fft.pressure - dense.pressure).max() <= SAME * dense.pressure.max()
    assert fft.certificate.satisfies(TOLERANCE)
    assert fft.contact_area == dense.contact_area > 0
    assert fft.friction_coefficient == pytest.approx(dense.friction_coefficient, rel=1e-9)


@on_grids
@of_topologies
def test_at_the_approach_found_under_a_load_is_the_same_state(name: str, periodic: bool) -> None:
    problem = problem_on(replace(GRIDS[name], periodic=periodic))
    dense = solve_reference(problem)
    again = replace(problem, load=None, approach=dense.approach)
    fft = solve_fft(again, TOLERANCE, Counter())
    assert np.abs(fft.pressure - dense.pressure).max() <= 1e-8 * dense.pressure.max()
    assert fft.forces.normal == pytest.approx(problem.load, rel=1e-8)


@on_grids
def test_the_papers_scheme_agrees_too(name: str) -> None:
    problem = problem_on(GRIDS[name])
    dense = solve_reference(problem)
    paper, _ = solve_paper(problem, 1e-9, Counter())
    # pressure steps end at 1e-10 of the pressure; 100 of them for what steepest descent still had to go
    assert np.abs(paper.pressure - dense.pressure).max() <= 1e-8 * dense.pressure.max()
    assert paper.status is dense.status


@on_grids
@of_topologies
def test_a_transposed_domain_has_the_transposed_solution(name: str, periodic: bool) -> None:
    """Mirrored across the diagonal, with the transverse force of the other sign."""
    problem = problem_on(replace(GRIDS[name], periodic=periodic))
    grid = problem.grid
    other = replace(
        problem,
        grid=Grid(grid.shape[::-1], grid.lengths[::-1], periodic),
        gap=problem.gap.T.copy(),
        mean_surface=problem.mean_surface.T.copy(),
        direction=math.pi / 2 - problem.direction,
    )
    here, there = (solve_fft(p, TOLERANCE, Counter()) for p in (problem, other))
    assert np.abs(there.pressure.T - here.pressure).max() <= SAME * here.pressure.max()
    assert there.forces.friction == pytest.approx(here.forces.friction, rel=1e-9)
    bound = 1e-9 * here.forces.normal
    assert there.forces.binormal == pytest.approx(-here.forces.binormal, abs=bound)


def test_oblong_elements_converge_to_the_same_contact() -> None:
    """Of Hertz's ball: A and mu on square and on oblong elements differ by the grids' own error."""
    numbers = []
    for shape in ((96, 96), (128, 72), (64, 144)):
        problem = discretise(replace(SCENE, load=20.0), Grid(shape, (1.6e-3, 1.6e-3)), Terms(oblique=False))
        state = solve_fft(problem, 1e-8, Counter())
        numbers.append((state.contact_area_corrected, state.max_pressure, state.approach))
    for found in numbers[1:]:
        assert found == pytest.approx(numbers[0], rel=0.01)
