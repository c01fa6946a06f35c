"""Cases of roughness: what they measure."""

from __future__ import annotations

import pytest

from verification.cases.contact import lay


def test_weak_roughness_pulls_as_its_first_order_does() -> None:
    force, first_order = lay.weak_forces(seed=2, direction=0.3)
    assert force == pytest.approx(first_order, rel=0.05)  # 4 nm on an indentation of 1.2 um; measured 1 %
