"""Fields on a contact set: lists where it is small, windows where it is not, and one solution by either."""

from __future__ import annotations

import numpy as np
import pytest

import refimpl as rf
from refimpl.solvers.production import contact_vectors
from refimpl.solvers.production.contact_vectors import ContactVectors

RANDOM = np.random.default_rng(8)
FIELD = RANDOM.normal(size=(5, 8))


def contact(count: int) -> np.ndarray:
    mask = np.zeros(40, dtype=bool)
    mask[RANDOM.permutation(40)[:count]] = True
    return mask.reshape(5, 8)


@pytest.mark.parametrize("count", [0, 1, 14, 15, 40])
def test_of_a_field_only_the_contact_is_kept(count: int) -> None:
    mask = contact(count)
    on = ContactVectors(mask)
    expected = np.where(mask, FIELD, 0.0)
    assert np.array_equal(on.scatter(on.gather(FIELD)), expected)
    assert np.array_equal(on.scatter(on.gather_view(expected)), expected)
    assert np.array_equal(on.scatter(on.ones()), mask)
    marked = on.gather(FIELD) > 0.3
    assert np.array_equal(on.scatter_mask(marked), expected > 0.3)


@pytest.mark.parametrize(("count", "shape"), [(14, (1, 14)), (15, (5, 8))])
def test_lists_up_to_a_share_of_the_window(count: int, shape: tuple[int, int]) -> None:
    on = ContactVectors(contact(count))
    assert on.gather(FIELD).shape == on.gather_view(FIELD).shape == shape


@pytest.mark.parametrize("name", ["table1-rough", "rough-planes"])
def test_solutions_are_the_same_by_either(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """To rounding: measured 5e-15 of the largest pressure."""
    found = []
    for share in (0.0, 1.0):
        monkeypatch.setattr(contact_vectors, "LIST_SHARE", share)
        found.append(rf.solve(rf.read_scene(name), 48, tolerance=1e-10))
    one, other = found
    assert one.converged
    assert other.converged
    assert np.array_equal(one.contact, other.contact)
    np.testing.assert_allclose(one.pressure, other.pressure, rtol=0, atol=1e-12 * one.max_pressure)
