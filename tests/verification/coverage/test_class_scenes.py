"""Scenes drawn by class: the stored features, which error bars were fitted to, are of what is drawn today."""

from __future__ import annotations

from itertools import islice

import pytest

from verification.coverage.building import unpacked
from verification.coverage.class_scenes import CLASSES, scene
from verification.coverage.fit import FEATURES

STORED = unpacked(FEATURES)


@pytest.mark.filterwarnings("ignore::refimpl.SurfaceWarning")
@pytest.mark.parametrize("kind", CLASSES)
def test_a_stored_scene_follows_from_its_class_and_seed(kind: str) -> None:
    """Load and friction are drawn last: whatever is drawn before has its share in them."""
    for stored in islice((one for one in STORED if one.kind == kind), 4):
        drawn, found = scene(kind, stored.seed), stored.grids[-1]
        load = found.numbers["normal_force"]
        assert drawn.lengths == pytest.approx(found.grid.lengths, rel=1e-2)
        assert drawn.periodic == found.grid.periodic
        assert drawn.load == pytest.approx(load, rel=1e-5)
        # mu = tau A / N + beta, and a little by slopes
        by_tau = found.dmu_dA * found.numbers["contact_area"]
        assert drawn.friction.tau == pytest.approx(found.dmu_dA * load, rel=5e-3)
        assert drawn.friction.beta + by_tau == pytest.approx(found.numbers["friction_coefficient"], abs=1e-2)
        assert (drawn.lower.material.hardness or 0.0) == pytest.approx(found.hardness or 0.0, rel=5e-3)
