"""Means over blocks of contact elements, which continue a field beyond scattered contact."""

from __future__ import annotations

import numpy as np
import pytest

from refimpl.operators.block_means import BlockMeans


@pytest.mark.parametrize("shape", [(64, 96), (70, 41)])
def test_transposed_is_the_transpose(shape: tuple[int, int]) -> None:
    rng = np.random.default_rng(2)
    means = BlockMeans(rng.random(shape) < 0.1)
    a, b = rng.standard_normal((2, *shape))
    assert np.vdot(b, means.continued(a)) == pytest.approx(np.vdot(a, means.transposed(b)), rel=1e-12)


def test_dense_contact_is_continued_by_its_value_and_a_lone_element_fades() -> None:
    contact = np.zeros((128, 128), dtype=bool)
    contact[::2, ::2] = True
    found = BlockMeans(contact).continued(contact.astype(float))
    assert 0.7 < found[64, 64] < 1
    lone = np.zeros_like(contact)
    lone[64, 64] = True
    along = BlockMeans(lone).continued(lone.astype(float))[64, 65:]
    assert along[0] < 0.1
    assert np.all(np.diff(along[4:]) <= 0)
    assert along[-1] == 0
