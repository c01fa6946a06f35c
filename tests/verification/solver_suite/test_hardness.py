"""The ability ``hardness``: its residual by hand, its bound on the error, the peers that have it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from verification.adapters import contactmechanics, tamaas
from verification.adapters.published_code import Peer
from verification.cases.contact import capped_peers
from verification.solver_suite import own, reference_solution
from verification.solver_suite.check import COMPLIANCE, MODULUS
from verification.solver_suite.gaps import rough_bump
from verification.solver_suite.protocol import Abilities, ContactProblem, Coupling, Unsupported
from verification.solver_suite.suite import run

PEERS = [
    pytest.param(
        peer,
        id=peer.extra,
        marks=pytest.mark.skipif(peer.installed is None, reason=f"{peer.distribution} is not installed"),
    )
    for peer in (tamaas.solve, contactmechanics.solve)
]


def capped(coupling: Coupling | None = None) -> ContactProblem:
    """A rough bump some of whose contact is at the hardness."""
    gap = rough_bump(12, seed=71)
    return ContactProblem(
        gap - gap.min(), 1 / 12, MODULUS, load=0.02 * MODULUS, coupling=coupling, hardness=0.1 * MODULUS
    )


def test_the_gap_of_both_bounds_by_hand() -> None:
    """H = 4, d = 2 by the one pressure between: 4 (3 - 2)+ over, (4 - 1)(0) at it, (4 - 0)(2 - 1) under."""
    f, v = np.array([[4.0, 1.0, 0.0, 4.0]]), np.array([[3.0, 2.0, 1.0, 1.0]])
    assert reference_solution._two_sided_gap(f, v, 4.0, None) == 4.0 + 4.0
    assert reference_solution._two_sided_gap(f, v, 4.0, 2.5) == 4 * 0.5 + 3 * 0.5 + 4 * 1.5
    ends = np.array([[4.0, 4.0, 0.0]])  # none between: d is the middle of 1 and 2
    assert reference_solution._two_sided_gap(ends, np.array([[1.0, 0.0, 2.0]]), 4.0, None) == 0.0
    assert (
        reference_solution._two_sided_gap(ends, np.array([[2.0, 0.0, 1.0]]), 4.0, None) == 4 * 0.5 + 4 * 0.5
    )


@pytest.mark.parametrize("coupling", [None, Coupling(0.0, 0.4, COMPLIANCE, 0.5)], ids=["still", "sliding"])
def test_the_energy_norm_error_is_bounded_by_the_gap_of_both_bounds(coupling: Coupling | None) -> None:
    posed = capped(coupling)
    H = posed.hardness
    assert H is not None
    exact, random = np.asarray(own.dense(posed).pressure), np.random.default_rng(73)
    assert 0.1 < np.mean(exact[exact > 0] >= H) < 0.9
    for size in (1e-6, 1e-3, 0.3):
        f = np.clip(exact * (1 + size * random.standard_normal(exact.shape)), 0, H)
        between = (f > 0) & (f < H)
        f[between] *= 1 + (exact.sum() - f.sum()) / f[between].sum()
        if f.max() > H or f.min() < 0:
            continue
        found = reference_solution.residual(posed, f)
        assert found.balance < 1e-13
        scale = reference_solution.energy(posed, exact) / reference_solution.energy(posed, f)
        assert 0 < reference_solution.misfit(posed, f, exact) * scale <= found.gap
    assert reference_solution.residual(posed, exact).worst < 1e-12


def test_an_excess_over_the_hardness_counts_as_tension_does() -> None:
    posed = capped()
    pressure = np.asarray(own.dense(posed).pressure)
    top = np.unravel_index(np.argmax(pressure), pressure.shape)
    pressure[top] *= 1.001
    assert reference_solution.residual(posed, pressure).tension == pytest.approx(0.001 / 1.001, rel=1e-9)


def test_a_solver_without_the_ability_is_not_asked() -> None:
    def refusing(problem: ContactProblem) -> np.ndarray:
        raise AssertionError("it was asked")

    refusing.abilities = Abilities(coupling=True)  # type: ignore[attr-defined]  # as solvers carry them
    results = run(refusing, ["contestant/capped-*", "contestant/plastic-limit"])
    assert {r.status for r in results} == {"unavailable"}
    assert {r.note for r in results} == {"the solver does not offer: hardness"}


@pytest.mark.parametrize("peer", PEERS)
def test_other_codes_find_the_same_capped_pressures(peer: Peer) -> None:
    assert capped_peers.agreement(peer).value < 1e-9  # of the hardness; measured 6e-11


@pytest.mark.parametrize("peer", PEERS)
def test_peers_refuse_an_approach_with_a_hardness(peer: Peer) -> None:
    with pytest.raises(Unsupported, match="with a hardness"):
        peer(replace(capped(), load=None, approach=0.05))


@pytest.mark.skipif(tamaas.solve.installed is None, reason="tamaas is not installed")
def test_negative_control_tamaas_saturated_in_pascal_stays_at_the_uniform_pressure() -> None:
    heights = rough_bump(12, seed=71)
    posed = replace(capped(), gap=heights - heights.min(), periodic=True)
    in_pascal, right = tamaas._saturated(posed, 1.0), tamaas.solve(posed)
    assert in_pascal.converged is True
    assert np.ptp(np.asarray(in_pascal.pressure)) < 1e-3 * np.ptp(np.asarray(right.pressure))
