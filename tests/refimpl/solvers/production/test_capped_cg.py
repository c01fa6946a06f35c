"""CG with two bounds on elements that do not influence one another: ``a = 1``, numbers by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from refimpl.grid import Array
from refimpl.solvers.production.capped_cg import CappedCG, filled_up


def capped_cg(
    pressure: list[float], gap: list[float], *, approach: float | None, cap: float = 4.0
) -> CappedCG:
    """Under the pressures' own load, or at an approach."""
    f = np.array([pressure])
    cg = CappedCG(lambda p: 1.0 * p, lambda r: 1.0 * r, f, cap)
    target = float(f.sum()) if approach is None else None
    cg.set_problem(np.array([gap]), np.broadcast_to(1.0, f.shape), target=target, approach=approach)
    return cg


def test_the_gap_of_both_bounds() -> None:
    """v = f + h = 5, 3, 2.5, 4.5 at d = 3: 4 (5 - 3) at the cap, 0, 4 (3 - 2.5) without pressure, 0."""
    cg = capped_cg([4.0, 2.0, 0.0, 0.0], [1.0, 1.0, 2.5, 4.5], approach=3.0)
    energy = 0.5 * (16 + 4)
    gap, penetration = cg.residuals()
    assert gap == pytest.approx((8 + 2) / energy, rel=1e-14)
    assert penetration == pytest.approx(0.5 / 3.0, rel=1e-14)


def test_without_free_elements_the_approach_is_the_middle() -> None:
    """Between 4 + 1 at the cap and 9 without pressure; without the latter it is 5."""
    assert capped_cg([4.0, 4.0, 0.0], [0.5, 1.0, 9.0], approach=None).approach == 7.0
    assert capped_cg([4.0, 4.0], [0.5, 1.0], approach=None).approach == 5.0


@pytest.mark.parametrize(("pressure", "certain"), [(1.0, True), (3.7, False), (4.0, False)])
def test_contact_is_certain_only_well_below_the_cap(pressure: float, certain: bool) -> None:
    cg = capped_cg([pressure, 0.0], [1.0, 50.0], approach=pressure + 1.0)
    assert cg.contact_is_certain(1.0) is certain


@pytest.mark.parametrize(("gap", "free", "capped"), [(1.5, True, False), (0.5, False, True)])
def test_an_element_leaves_the_cap_where_it_would_have_to_pull(gap: float, free: bool, capped: bool) -> None:
    """At d = 5 the pressure sought is 5 - h: 3.5 below the cap, 4.5 beyond it."""
    cg = capped_cg([4.0, 1.0], [gap, 4.0], approach=5.0)
    cg.iterate()
    assert (bool(cg.free[0, 0]), bool(cg.capped[0, 0])) == (free, capped)
    for _ in range(5):
        cg.iterate()
    np.testing.assert_allclose(cg.pressure, [[min(4.0, 5.0 - gap), 1.0]], rtol=1e-12)


def test_under_a_load_the_free_elements_bear_what_the_capped_ones_leave() -> None:
    """h = 0, 2, 3 under 8: 4 at the cap, and d - 2 and d - 3 bear the other 4: d = 4.5."""
    cg = capped_cg([8 / 3] * 3, [0.0, 2.0, 3.0], approach=None)
    for _ in range(30):
        cg.iterate()
    np.testing.assert_allclose(cg.pressure, [[4.0, 2.5, 1.5]], rtol=1e-10)
    assert cg.approach == pytest.approx(4.5, rel=1e-10)
    assert max(cg.residuals()) < 1e-10


def test_pressures_are_filled_up_to_the_load_and_no_farther_than_the_cap() -> None:
    ones: Array = np.ones((1, 3))
    np.testing.assert_allclose(filled_up(np.array([[1.0, 2.0, 3.0]]), ones, 9.0, 4.0), [[5 / 3, 10 / 3, 4.0]])
    full = filled_up(np.array([[1.0, 2.0, 0.0]]), ones, 9.0, 4.0)
    np.testing.assert_array_equal(full, [[4.0, 4.0, 0.0]])
    assert not math.isinf(full.max())


def test_load_that_no_element_can_bear_is_a_residual() -> None:
    """Eight of ten, and both elements as deep as the approach: a fifth is missing, nothing else."""
    cg = capped_cg([4.0, 4.0], [1.0, 1.0], approach=None)
    cg.set_problem(np.array([[1.0, 1.0]]), np.ones((1, 2)), target=10.0, approach=None)
    gap, penetration = cg.residuals()
    assert gap == pytest.approx(0.2, rel=1e-12)
    assert penetration == 0.0
