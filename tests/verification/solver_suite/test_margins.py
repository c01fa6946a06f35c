"""Room that the suite's problems leave an honest solver: what its reasons for tolerances say is computed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from refimpl.grid import Array
from tests.verification.solver_suite.asked import watching
from verification.solver_suite import own, reference_solution
from verification.solver_suite.isolated import Limited
from verification.solver_suite.protocol import LARGEST_PRECISION, ContactProblem
from verification.solver_suite.suite import run


def posed_by(name: str) -> list[tuple[ContactProblem, Array]]:
    """The problems of a case with our pressures, sought to a hundredth of the claim."""
    solver, posed = watching(
        lambda p: np.asarray(own.solve(replace(p, tolerance=1e-2 * p.tolerance)).pressure)
    )
    (result,) = run(solver, [f"solver/{name}"])
    assert result.status == "pass"
    return posed


@pytest.mark.parametrize("name", ["periodic-approach", "periodic-sheared-pins-approach"])
def test_an_honest_answer_at_its_claim_passes_with_its_mean_counted(name: str) -> None:
    """Errors of the contact's level, the worst there are, as large as the claim lets them be."""

    def lax(asked: ContactProblem) -> Array:
        exact = np.asarray(own.solve(replace(asked, tolerance=1e-12)).pressure)
        low, high = 1e-14, 1.0
        for _ in range(50):
            share = float(np.sqrt(low * high))
            residual = reference_solution.residual(asked, exact + share * exact.mean() * (exact > 0)).worst
            low, high = (share, high) if residual <= asked.tolerance else (low, share)
        return np.asarray(exact + low * exact.mean() * (exact > 0))

    for precision in (1e-8, 1e-6):
        (result,) = run(Limited(lax, replace(own.solve.abilities, precision=precision)), [f"solver/{name}"])
        assert result.error is not None
        assert 0 < result.error < 0.01  # of 2 claims: an error's energy is of second order


def sides(posed: ContactProblem, f: Array) -> tuple[float, float]:
    """Least pressure in contact over the peak, and least clearance beside it over the approach from touch."""
    v, on = reference_solution.displacement(posed, f) + posed.gap, f > 0
    level = float(np.vdot(f, v) / f.sum())
    return float(f[on].min() / f.max()), float(v[~on].min() / level) - 1


def test_friction_in_turn_leaves_every_element_well_on_its_side() -> None:
    """tau acts or does not: with less room to its sign there could be a second solution, or none."""
    answers = posed_by("memory-coupling")
    rubbed = [
        sides(posed, f) for posed, f in answers if posed.coupling is not None and posed.coupling.tau > 0
    ]
    assert len(rubbed) == 2
    assert min(pressure for pressure, _ in rubbed) > 0.03
    assert min(clearance for _, clearance in rubbed) > 0.002


@pytest.mark.parametrize("name", ["contact-set", "contact-set-periodic"])
def test_no_element_can_change_sides_within_the_laxest_claim(name: str) -> None:
    """With ``e' a e <= g E``: ``e_i^2 <= (a^-1)_ii e' a e``, and ``(a e)_i^2 <= a_ii e' a e``, under a load
    with as much again for the level. Periodic pressures beside the contact are errors of its neighbours."""
    ((posed, f),) = posed_by(name)
    matrix, on = reference_solution._flexibility(posed), f > 0
    stored = 0.5 * float(np.vdot(f, reference_solution.by_pressure(posed, f)))
    if posed.periodic:
        on = on | np.any([np.roll(f > 0, step, axis) for step in (1, -1) for axis in (0, 1)], axis=0)
    where = np.flatnonzero(on if posed.periodic else np.ones_like(on))
    inverse = np.linalg.inv(matrix[np.ix_(where, where)])
    level = float(np.vdot(f, reference_solution.by_pressure(posed, f) + posed.gap) / f.sum())
    out = np.sqrt(stored * np.diag(inverse).max()) / f.max()
    into = (1.0 if posed.periodic else 2.0) * np.sqrt(stored * np.diag(matrix).max()) / level
    assert out < 10
    assert into < 4
    pressure, clearance = sides(posed, f)
    assert pressure > 10 * np.sqrt(LARGEST_PRECISION)
    assert clearance > 4 * np.sqrt(LARGEST_PRECISION)
