"""Cases of roughness: other codes on the same heights, where they are installed; what the cases measure."""

from __future__ import annotations

import pytest

from verification.adapters import contactmechanics, tamaas
from verification.adapters.published_code import PublishedCode
from verification.cases.contact import lay, self_affine

PUBLISHED = [
    pytest.param(
        peer,
        id=peer.extra,
        marks=pytest.mark.skipif(peer.installed is None, reason=f"{peer.distribution} is not installed"),
    )
    for peer in (tamaas.solve, contactmechanics.solve)
]


@pytest.mark.parametrize("peer", PUBLISHED)
def test_other_codes_find_the_same_pressures(peer: PublishedCode) -> None:
    assert self_affine.agreement(peer).value < 1e-6  # of the peak; measured 4e-12


def test_weak_roughness_pulls_as_its_first_order_does() -> None:
    force, first_order = lay.weak_forces(seed=2, direction=0.3)
    assert force == pytest.approx(first_order, rel=0.05)  # 4 nm on an indentation of 1.2 um; measured 1 %
