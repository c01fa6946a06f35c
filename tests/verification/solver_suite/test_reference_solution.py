"""The reference that answers are judged by: displacements, residuals, elimination and their bounds."""

from __future__ import annotations

from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array
from refimpl.model.certificate import certify
from refimpl.model.problem import Terms
from refimpl.model.slopes import Slopes
from refimpl.scene.discretise import discretise
from verification.exact.dense_influence import DenseInfluence
from verification.exact.kernel_reference import normal, tangential
from verification.exact.textbook import normal_offsets, shear_offsets
from verification.solver_suite import own, reference_solution
from verification.solver_suite.check import COMPLIANCE, MODULUS
from verification.solver_suite.gaps import rough_bump
from verification.solver_suite.pin_arrays import integrals
from verification.solver_suite.protocol import ContactProblem, Coupling
from verification.solver_suite.reference_solution import displacement, eliminated, energy, misfit, residual

LOADED = ContactProblem(rough_bump(5, 71) - rough_bump(5, 71).min(), 0.2, MODULUS, load=0.05 * MODULUS)
AT_APPROACH = replace(LOADED, load=None, approach=0.08)
CAPPED = replace(
    LOADED, gap=rough_bump(12, 71) - rough_bump(12, 71).min(), spacing=1 / 12, load=0.02 * MODULUS,
    hardness=0.1 * MODULUS,
)  # fmt: skip
SLIDING = Coupling(0.0, 0.4, COMPLIANCE, 0.5)


def test_displacement_is_the_sum_over_elements() -> None:
    coupling = Coupling(0.02 * MODULUS, 0.3, COMPLIANCE, sliding_direction=1.1)
    f = np.random.default_rng(72).uniform(0, 1, (5, 5)) * 1e-2 * MODULUS
    f[2, 3] = 0.0
    u = mp.mpf(0)
    for i, j in np.ndindex(5, 5):
        x, y, h = (1 - i) * 0.2, (4 - j) * 0.2, 0.2
        r = coupling.tau * (f[i, j] > 0) + coupling.beta * f[i, j]
        along = mp.cos(1.1) * tangential(x, y, h, h) + mp.sin(1.1) * tangential(y, x, h, h)
        u += f[i, j] * normal(x, y, h, h) / (mp.pi * MODULUS) + r * COMPLIANCE * along
    assert abs(displacement(replace(LOADED, coupling=coupling), f)[1, 4] / float(u) - 1) < 1e-13


def test_the_convolution_for_large_squares_is_the_dense_product(monkeypatch: pytest.MonkeyPatch) -> None:
    posed = replace(CAPPED, coupling=Coupling(0.3, 0.4, COMPLIANCE, 0.9))
    f = np.random.default_rng(8).random(posed.shape)
    f[2:5, 3] = 0.0
    dense = reference_solution.by_pressure(posed, f), displacement(posed, f)
    monkeypatch.setattr(reference_solution, "LARGEST", 8)
    np.testing.assert_allclose(reference_solution.by_pressure(posed, f), dense[0], rtol=1e-13)
    np.testing.assert_allclose(displacement(posed, f), dense[1], rtol=1e-13)
    normals, shears = normal_offsets((160, 160)), shear_offsets((160, 160), 0.0)
    for i, j in ((159, 159), (-159, 100), (3, -158), (-1, 1), (0, 0)):
        exact = integrals(i, j)
        assert normals[i + 159, j + 159] == pytest.approx(exact[0], rel=2e-11)
        assert shears[i + 159, j + 159] == pytest.approx(exact[1], rel=3e-9, abs=1e-15)


def perturbed(exact: Array, size: float, random: np.random.Generator, hardness: float | None) -> Array | None:
    """Pressures of the same load, off by a share; None where they leave the bounds."""
    if hardness is None:
        f = np.abs(exact * (1 + size * random.standard_normal(exact.shape)))
        f += size * exact.max() * (random.random(exact.shape) < 0.2)
        return np.asarray(f * (exact.sum() / f.sum()))
    f = np.clip(exact * (1 + size * random.standard_normal(exact.shape)), 0, hardness)
    between = (f > 0) & (f < hardness)
    f[between] *= 1 + (exact.sum() - f.sum()) / f[between].sum()
    return f if f.min() >= 0 and f.max() <= hardness else None


@pytest.mark.parametrize("posed", [LOADED, CAPPED], ids=["elastic", "capped"])
@pytest.mark.parametrize("coupling", [None, SLIDING], ids=["still", "sliding"])
def test_the_energy_norm_error_is_bounded_by_the_gap(
    posed: ContactProblem, coupling: Coupling | None
) -> None:
    posed = replace(posed, coupling=coupling)
    random, H = np.random.default_rng(73), posed.hardness
    exact = eliminated(posed) if H is None else np.asarray(own.dense(posed).pressure)
    for size in (1e-6, 1e-3, 0.3):
        if (f := perturbed(exact, size, random, H)) is not None:
            found = residual(posed, f)
            assert found.balance < 1e-13
            scale = energy(posed, exact) / energy(posed, f)
            assert 0 < misfit(posed, f, exact) * scale <= found.gap
    assert residual(posed, exact).worst < (1e-13 if H is None else 1e-12)
    if H is not None:
        assert 0.1 < np.mean(exact[exact > 0] >= H) < 0.9


def test_the_gap_of_both_bounds_known_values() -> None:
    """H = 4, d = 2 by the one pressure between: 4 (3 - 2)+ over, (4 - 1)(0) at it, (4 - 0)(2 - 1) under."""
    gap = reference_solution._two_sided_gap
    f, v = np.array([[4.0, 1.0, 0.0, 4.0]]), np.array([[3.0, 2.0, 1.0, 1.0]])
    assert gap(f, v, 4.0, None) == 4.0 + 4.0
    assert gap(f, v, 4.0, 2.5) == 4 * 0.5 + 3 * 0.5 + 4 * 1.5
    ends = np.array([[4.0, 4.0, 0.0]])  # none between: d is the middle of 1 and 2
    assert gap(ends, np.array([[1.0, 0.0, 2.0]]), 4.0, None) == 0.0
    assert gap(ends, np.array([[2.0, 0.0, 1.0]]), 4.0, None) == 4 * 0.5 + 4 * 0.5


def test_an_excess_over_the_hardness_counts_as_tension_does() -> None:
    pressure = np.array(own.dense(CAPPED).pressure)
    pressure[np.unravel_index(np.argmax(pressure), pressure.shape)] *= 1.001
    assert residual(CAPPED, pressure).tension == pytest.approx(0.001 / 1.001, rel=1e-9)


def test_elimination_agrees_with_our_dense_reference() -> None:
    for posed in (LOADED, AT_APPROACH, replace(LOADED, periodic=True)):
        found = rf.solve(own.scene(posed), posed.M, method="dense", oblique=False, approach=posed.approach)
        np.testing.assert_allclose(eliminated(posed), found.pressure, atol=1e-9 * found.max_pressure)


@pytest.mark.parametrize("length", [1.0, 1e-7])
def test_elimination_takes_back_elements_that_it_dropped_too_soon(length: float) -> None:
    # On this plane two rounds of it are needed: without them elements would penetrate.
    gap = np.random.default_rng(0).uniform(0, length, (8, 8))
    posed = ContactProblem(gap - gap.min(), 0.2, MODULUS, approach=-0.02 * length, periodic=True)
    assert residual(posed, eliminated(posed)).worst < 1e-13


@pytest.mark.parametrize("posed", [LOADED, AT_APPROACH], ids=["load", "approach"])
def test_an_element_left_out_is_seen_by_its_penetration(posed: ContactProblem) -> None:
    exact = eliminated(posed)
    others = exact > 0
    others[np.unravel_index(np.argmin(np.where(others, exact, np.inf)), exact.shape)] = False
    matrix = reference_solution._flexibility(posed)
    f, _ = reference_solution._on(posed, matrix, others.ravel())
    found = residual(posed, f.reshape(exact.shape))
    assert found.balance < 1e-13
    assert found.gap > 1e-5


@pytest.mark.parametrize(("periodic", "approach"), [(False, 0.08), (True, -0.02)])
def test_the_approach_of_a_solution_is_counted_as_the_problem_counts_it(
    periodic: bool, approach: float
) -> None:
    posed = replace(AT_APPROACH, approach=approach, periodic=periodic)
    assert reference_solution.approach_of(posed, eliminated(posed)) == pytest.approx(approach, rel=1e-12)


def test_the_suites_gap_at_an_approach_is_at_most_three_times_our_certificates() -> None:
    """Whatever the pressures: our adapter's `WORK` rests on it, and is no larger than it takes."""
    exact, scene = eliminated(AT_APPROACH), own.scene(AT_APPROACH)
    draw, ratios = np.random.default_rng(5), []
    judged = discretise(scene, scene.grid(AT_APPROACH.M), Terms(oblique=False), AT_APPROACH.approach)
    for _ in range(200):
        off = exact * draw.normal(size=exact.shape) + draw.uniform(-0.5, 0.5) * exact
        pressure = np.maximum(exact + 10 ** draw.uniform(-6, 0) * off, 0.0)
        slopes = Slopes.flat(exact.shape)
        state = certify(judged, DenseInfluence(judged.grid, 0.0), pressure, 0 * pressure, slopes)
        ours = max(state.certificate.gap, state.certificate.load_error)
        ratios.append(residual(AT_APPROACH, pressure).gap / ours)
    assert 0.8 * own.WORK <= max(ratios) <= own.WORK * (1 + 1e-6)
