"""Bars and costs by class of scene: references and summaries, known values; the words of the pages."""

from __future__ import annotations

import pytest

from tests.refimpl.accuracy.made_up import AREA_LIMIT, BETA, DMU_DA, made_up
from verification.coverage import classes
from verification.coverage.building import Solved, as_corrected

MU = BETA + DMU_DA * AREA_LIMIT


def test_references_known_values() -> None:
    """A disc's limits, and their bounds: 0.12 of the edge."""
    fine = as_corrected(made_up(512))
    for name, limit, unit in (("contact_area", AREA_LIMIT, 1.0), ("friction_coefficient", MU, DMU_DA)):
        for number in (name, f"{name}_corrected"):
            value, bound = classes.reference(fine, number)
            assert (value, bound) == pytest.approx((limit, 0.12 * unit * fine.edge), rel=1e-9)
    assert classes.reference(fine, "max_pressure")[0] == fine.peak.height
    assert classes.reference(fine, "approach")[0] == fine.numbers["approach"]


def test_one_grid_of_a_scene_is_judged_and_an_exact_number_counts_first() -> None:
    """Seed 5 of three grids takes the third; the known area is a tenth larger than any grid's."""
    grids = tuple(as_corrected(made_up(M)) for M in (48, 64, 96, 512))
    exact = {"contact_area": 1.1 * AREA_LIMIT}
    found = {row["number"]: row for row in classes.rows([Solved("few elements", 5, grids, exact)])}
    assert {row["M"] for row in found.values()} == {96}
    assert found["contact_area_corrected"]["error"] == pytest.approx(0.1, rel=1e-6)
    assert found["friction_coefficient_corrected"]["error"] < 1e-6
    assert not found["contact_area"]["too_large"]


def test_a_summary_counts_bars_known_values() -> None:
    """Four scenes; all bars but the third hold."""
    ends = (0.4, 0.1, 0.1), (0.2, 0.2, 0.1), (0.1, 0.3, 0.0), (9.126, 1.0, 1.0)
    keys = "bar", "error", "reference_bound"
    every = classes.summary(dict(zip(keys, row, strict=True)) for row in ends)
    assert [every[key] for key in ("scenes", "held", "held_at_worst", "usable")] == [4, 0.75, 0.5, 0.75]
    assert (every["held_of_usable"], every["median_bar_over_error"]) == pytest.approx((2 / 3, 2.5), rel=1e-5)
    assert every["p"] == pytest.approx(1 - 0.92**4, rel=1e-5)  # probability of three of four, or fewer
    assert every["unbounded"] == 0.0


def test_each_class_has_a_summary_of_its_numbers_and_one_of_all() -> None:
    row = {"error": 0.1, "bar": 0.2, "reference_bound": 0.0, "number": "approach"}
    found = classes.tables([{"class": "grooves", **row}, {"class": "waves", **row}])
    counted = [(each["class"], each["number"], each["scenes"]) for each in found]
    assert counted == [
        ("grooves", "approach", 1),
        ("grooves", None, 1),
        ("waves", "approach", 1),
        ("waves", None, 1),
        (None, "approach", 2),
        (None, None, 2),
    ]
