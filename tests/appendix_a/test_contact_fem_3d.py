"""Three-dimensional asperities in contact by finite elements: geometry, forces, and the model at no slope."""

from __future__ import annotations

import numpy as np
import pytest

from appendix_a.contact_fem import solid_contact
from appendix_a.contact_fem.solid import asperity
from verification.cases.appendix_a.model_form_3d import SLIGHT, by_model, pair_of
from verification.cases.appendix_a.solid_half_space import (
    by_elements,
)


def test_a_flat_body_turned_upside_down_is_flat() -> None:
    """Vertical answers stay; an upward force pulls the lower surface's neighbours away, the upper's along."""
    body = asperity(0.0, 0.0, 0.3, 2)
    n = body.at.shape[1] * body.at.shape[2]
    assert body.compliance == pytest.approx(body.compliance.T, abs=1e-10)
    mirrored = body.mirrored()
    assert mirrored.at[0] == pytest.approx(body.at[0])
    assert mirrored.compliance[2 * n :, 2 * n :] == pytest.approx(body.compliance[2 * n :, 2 * n :], abs=1e-9)
    assert mirrored.compliance[:n, 2 * n :] == pytest.approx(-body.compliance[:n, 2 * n :], abs=1e-9)


def test_forces_of_unit_pressure_close_on_the_projection() -> None:
    body = asperity(0.02, 0.1, 0.3, 2)
    lower, upper = body.at, body.mirrored().at + np.array([0.001, 0.0, 0.1])[:, None, None]
    sampled = solid_contact._sample(lower, upper)
    force = sampled.traction(beta=0.0)
    width, depth = np.ptp(lower[0]), np.ptp(lower[1])
    assert force[2].sum() == pytest.approx(-width * depth, rel=1e-12)
    # the rise across the patch, summed over y, is what pressure passes along x
    profile = lower[2, -1] - lower[2, 0]
    rise = float(profile.mean()) * depth
    assert force[0].sum() == pytest.approx(rise, rel=1e-3)
    assert (sampled.on_upper @ upper[0].ravel())[5:9] == pytest.approx(
        (sampled.on_lower @ lower[0].ravel())[5:9], abs=1e-10
    )


def test_without_slope_the_model_and_the_elements_agree() -> None:
    fem, model = by_elements(pair_of(SLIGHT), 3), by_model(SLIGHT, 48)
    assert fem[0] == pytest.approx(model[0], rel=5e-3)  # 0.2 % measured
    assert fem[1] == pytest.approx(model[1], rel=1e-3)
