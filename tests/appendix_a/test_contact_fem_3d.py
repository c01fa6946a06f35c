"""Three-dimensional asperities in contact by finite elements: geometry, forces, and the model at no slope."""

from __future__ import annotations

import numpy as np
import pytest

from appendix_a.contact_fem import solid_contact
from appendix_a.contact_fem.scene import WavyPair
from appendix_a.contact_fem.solid import asperity
from appendix_a.contact_fem.solid_contact import press
from verification.cases.appendix_a.solid_half_space import (
    BETA,
    COPPER,
    SHARE,
    SLIGHT,
    STEEL,
    by_elements,
    by_model,
    distance_of,
)

SHIFT, SLOPE = -0.25, 6.5


def pair_of(slope: float) -> WavyPair:
    """Steel climbing copper at a steepest slope (degrees)."""
    return WavyPair(slope, SHIFT, COPPER, STEEL, beta=BETA)


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
    pair = pair_of(SLIGHT)
    (approach, mu), (solution, _, sunk) = by_elements(pair, 3), by_model(pair)
    assert approach == pytest.approx(sunk, rel=5e-3)  # 0.2 % measured
    assert mu == pytest.approx(solution.friction_coefficient, rel=1e-3)


def test_climbing_at_a_slope_raises_friction_as_in_the_model() -> None:
    pair = pair_of(SLOPE)
    distance, load = distance_of(pair), SHARE * pair.full_contact_pressure
    body = asperity(pair.amplitude, -SHIFT / 2, 0.3, 3)
    found = press(body.of_modulus(COPPER.E), body.mirrored().of_modulus(STEEL.E), distance, load, BETA)
    # 0.05 % measured; without the shear of the mean planes taken off, or with other tangents, 0.5 % and more
    assert found.friction_coefficient == pytest.approx(by_model(pair)[0].friction_coefficient, rel=2e-3)
