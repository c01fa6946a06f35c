"""The axisymmetric solution under a cap, and the published law, against numbers by hand."""

from __future__ import annotations

import math

import mpmath as mp
import numpy as np
import pytest

from verification.exact.axisymmetric import displacement
from verification.exact.capped_sphere import capped_sphere, disc_displacement, plastic_limit
from verification.exact.hertz import Sphere
from verification.exact.sphere_plasticity import kogut_etsion

SPHERE = Sphere(70.0, 0.14, 8.8e10)


@pytest.mark.parametrize("r", [0.0, 0.999, 1.7])
def test_a_loaded_circle_displaces_as_the_quadrature_says(r: float) -> None:
    exact, _ = displacement(lambda s: mp.mpf(1), 1.0, r, 1.0)
    assert disc_displacement(np.array([r]), np.array([1.0]))[0] == pytest.approx(exact, rel=1e-10)


def test_without_yield_it_is_hertz() -> None:
    found = capped_sphere(SPHERE, 2 * SPHERE.peak_pressure, 400)
    assert found.core == 0
    assert found.approach == pytest.approx(SPHERE.approach, rel=2e-6)
    assert found.radius == pytest.approx(SPHERE.contact_radius, rel=1e-3)


def test_pressures_obey_both_bounds_and_the_load() -> None:
    hardness = 0.7 * SPHERE.peak_pressure
    found = capped_sphere(SPHERE, hardness, 400)
    assert found.pressure.min() == 0
    assert found.pressure.max() == hardness
    h = found.r[1] - found.r[0]
    assert 2 * math.pi * h * float(found.r @ found.pressure) == pytest.approx(70.0, rel=1e-12)
    assert 0 < found.core < found.radius
    assert np.all(found.pressure[found.r < found.core - h] == hardness)


def test_half_of_hertz_is_nearly_the_plastic_limit() -> None:
    """a^2 = 4/3 a_H^2; d / d_H = 2/3 + 4 (1/2) (2/pi) sqrt(4/3) / pi = 1.134649."""
    hardness = SPHERE.peak_pressure / 2
    radius, approach = plastic_limit(SPHERE, hardness)
    assert radius / SPHERE.contact_radius == pytest.approx(math.sqrt(4 / 3), rel=1e-12)
    assert approach / SPHERE.approach == pytest.approx(1.1346491678707882, rel=1e-12)
    assert capped_sphere(SPHERE, hardness).approach == pytest.approx(approach, rel=2e-5)


def test_the_published_law_begins_with_hertz_and_ends_at_the_hardness() -> None:
    assert kogut_etsion(1.0) == (1.0, 1.0)
    end = kogut_etsion(110.0)
    mean_over_hardness = 2 / 3 * (0.454 + 0.41 * 0.3) * end.load / end.area
    assert mean_over_hardness == pytest.approx(1.0, abs=0.01)
    with pytest.raises(ValueError, match="ends at 110"):
        kogut_etsion(111.0)
