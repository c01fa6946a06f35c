"""Rectangular domains and oblong elements: one solution by all solvers, whichever axis is the longer."""

from __future__ import annotations

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
    "coarser grids": Grid((64, 40), (1.6e-3, 1.2e-3)),
    "strip": Grid((60, 5), (1.6e-3, 2e-4)),
    "row": Grid((24, 1), (1.6e-3, 1e-4)),
    "two columns": Grid((2, 30), (1e-4, 1.6e-3)),
}
on_grids = pytest.mark.parametrize("name", GRIDS)
of_topologies = pytest.mark.parametrize("periodic", [False, True])


def heights(grid: Grid, seed: int = 3) -> Array:
    """Smooth random waves that repeat on the domain, of half a micrometre."""
    random, found = np.random.default_rng(seed), grid.zeros
    x, y = grid.x[:, None] / grid.lengths[0], grid.y[None, :] / grid.lengths[1]
    for k, m in ((1, 0), (0, 1), (1, 2), (2, -1), (3, 1)):
        found += random.normal() * np.cos(2 * np.pi * (k * x + m * y) + random.uniform(0, 6))
    return 5e-7 * found


def problem_on(grid: Grid) -> Problem:
    upper = rf.Flat() if grid.periodic else SCENE.upper.surface
    lower = rf.ArraySurface(heights(grid), pixel=grid.spacings)
    rough = replace(SCENE, upper=rf.Body(HARD, upper), lower=rf.Body(SOFT, lower), periodic=grid.periodic)
    load = SCENE.load * grid.nominal_area / SCENE.side**2  # the same mean pressure on every domain
    return replace(discretise(rough, grid, Terms()), load=load)


@on_grids
@of_topologies
def test_the_reference_and_the_production_solver_agree(name: str, periodic: bool) -> None:
    """On grids of one or two rows and with coarser ones, which the random scenes of `test_plain` lack."""
    problem = problem_on(replace(GRIDS[name], periodic=periodic))
    (dense, exact), (fft, state) = solve_reference(problem), solve_fft(problem, TOLERANCE, Counter())
    assert fft.status is dense.status
    assert np.array_equal(fft.excluded, dense.excluded)
    assert np.abs(fft.pressure - dense.pressure).max() <= SAME * dense.pressure.max()
    assert state.certificate.satisfies(TOLERANCE)
    assert state.contact_area == exact.contact_area > 0
    assert state.friction_coefficient == pytest.approx(exact.friction_coefficient, rel=1e-9)


@on_grids
def test_the_papers_scheme_agrees_too(name: str) -> None:
    problem = problem_on(GRIDS[name])
    dense, _ = solve_reference(problem)
    paper, _, _ = solve_paper(problem, 1e-9, Counter())
    # pressure steps end at 1e-10 of the pressure; 100 of them for what steepest descent still had to go
    assert np.abs(paper.pressure - dense.pressure).max() <= 1e-8 * dense.pressure.max()
    assert paper.status is dense.status


def test_oblong_elements_converge_to_the_same_contact() -> None:
    """Of Hertz's ball: A and mu on square and on oblong elements differ by the grids' own error."""
    numbers = []
    for shape in ((96, 96), (128, 72), (64, 144)):
        problem = discretise(replace(SCENE, load=20.0), Grid(shape, (1.6e-3, 1.6e-3)), Terms(oblique=False))
        _, state = solve_fft(problem, 1e-8, Counter())
        numbers.append((state.contact_area_corrected, state.max_pressure, state.approach))
    for found in numbers[1:]:
        assert found == pytest.approx(numbers[0], rel=0.01)
