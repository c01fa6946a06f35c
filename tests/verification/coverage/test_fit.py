"""The fit of the error bars' constants: known scales are found, features are stored, constants come again."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tests.refimpl.accuracy.made_up import made_up
from verification.coverage import fit
from verification.coverage.building import Solved, as_corrected, merged, pack, unpacked
from verification.coverage.class_scenes import CLASSES
from verification.coverage.likelihood import fit as likeliest


def test_mean_and_scales_that_errors_were_drawn_with_are_found() -> None:
    draw = np.random.default_rng(4)
    means, squares = draw.uniform(0, 1, (4000, 1)), draw.uniform(0, 1, (4000, 2))
    errors = 0.3 * means[:, 0] + np.sqrt(squares @ [0.04, 0.25]) * draw.standard_t(4, 4000)
    found = likeliest(errors, means, squares, freedoms=[2.0, 4.0, 10.0])
    assert found.freedom == 4.0
    assert abs(found.mean[0] - 0.3) < 3 * found.mean_error[0] < 0.1
    assert np.all(np.abs(found.scale - [0.2, 0.5]) < 3 * found.scale_error)


def test_stored_features_give_the_same_excess_and_bars(tmp_path: Path) -> None:
    grids = tuple(as_corrected(made_up(M)) for M in (48, 64, 96, 512))
    pack([Solved("few elements", 1, grids, {})], tmp_path / "f.json.gz")
    (found,) = unpacked(tmp_path / "f.json.gz")
    assert [max(grid.grid.shape) for grid in found.grids] == [64, 512]  # every second one, and the reference
    for stored, grid in zip(found.grids, grids[1::2], strict=True):
        assert stored.excess == pytest.approx(grid.excess, rel=1e-4)
        assert stored.numbers["contact_area"] == pytest.approx(grid.numbers["contact_area"], rel=1e-5)


def test_scenes_of_a_new_class_are_added_to_the_stored_ones(tmp_path: Path) -> None:
    grids = tuple(as_corrected(made_up(M)) for M in (48, 64, 96, 128, 512))
    stored = [Solved("pads", seed, grids, {}) for seed in (1, 2)]
    pack(stored, tmp_path / "f.json.gz")
    again = Solved("pads", 2, grids, {"contact_area": 1.0})
    new = [again, Solved("new", 1, grids, {})]
    pack(merged(unpacked(tmp_path / "f.json.gz"), new), tmp_path / "f.json.gz")
    found = unpacked(tmp_path / "f.json.gz")
    assert [(one.kind, one.seed) for one in found] == [("pads", 1), ("pads", 2), ("new", 1)]
    assert [len(one.grids) for one in found] == [3, 3, 3]
    assert found[1].exact == {"contact_area": 1.0}


def test_every_class_is_in_the_committed_constants_and_features() -> None:
    document = json.loads(fit.CONSTANTS.read_text(encoding="utf-8"))
    assert set(document["classes"]) == set(CLASSES)
    assert fit.FEATURES.stat().st_size <= 500_000


@pytest.mark.nightly
def test_the_committed_features_give_the_committed_constants_again() -> None:
    document = json.loads(fit.CONSTANTS.read_text(encoding="utf-8"))["constants"]
    for name, one in fit.fitted(unpacked(fit.FEATURES)).items():
        allowed = np.maximum(one["standard_error"] or 0.0, 1e-9)
        assert np.all(np.abs(np.subtract(one["value"], document[name]["value"])) <= allowed), name


def test_known_scatter_is_not_fitted_again() -> None:
    """Errors of deviation sqrt(1 + 2^2), of which 1 is known: 4000 normal ones give the 2 to 4 %."""
    errors = np.sqrt(5.0) * np.random.default_rng(7).standard_normal(4000)
    found = likeliest(errors, np.zeros((4000, 0)), np.ones((4000, 1)), freedoms=[1e3], known=np.ones(4000))
    assert found.scale[0] == pytest.approx(2.0, rel=0.04)
