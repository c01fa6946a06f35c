"""Options of a solve: what they refuse, and what they take by default."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import Any

import pytest

import refimpl as rf
from refimpl.driver.limits import Limits
from refimpl.driver.options import Options

SCENE = rf.read_scene("table1-rough")


BALL, SOFT = rf.Body(rf.Material(200e9, 0.3), rf.Sphere(0.1)), rf.Material(3e9, 0.4, hardness=0.2e9)
HARD = rf.Scene(BALL, rf.Body(SOFT, rf.Flat()), rf.Friction(1e6, 0.05), 2.0, size=(1e-3, 0.8e-3))


def asked(**given: Any) -> Options:
    options: dict[str, Any] = {"scene": HARD, "grid": 8}
    return Options(**options | given)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        *(
            (
                {"grid": None, "accuracy": share},
                f"accuracy = {share}: expected a relative accuracy between 0 and",
            )
            for share in (-0.02, 1.5, math.nan, math.inf)
        ),
        ({"method": "fem"}, "method = 'fem': expected one of dense, fft, paper"),
        (
            {"method": "paper", "scene": replace(HARD, upper=HARD.lower, periodic=True)},
            "method = 'paper': expected dense or fft for a periodic",
        ),
        ({"scene": replace(HARD, load=161.0)}, "load = 161.0: expected at most 160 N, the hardness times"),
        ({"limits": Limits(max_seconds=9.0)}, "max_seconds = 9.0: expected none without an accuracy"),
    ],
)
def test_what_is_no_option_is_refused_with_what_would_do(given: dict[str, Any], said: str) -> None:
    with pytest.raises(rf.InputError, match=f"^{re.escape(said)}"):
        asked(**given)


def test_tolerances_and_quantities_by_default() -> None:
    """An accuracy of 0.2 % takes a thousandth of it; the paper's own tolerance of the load is 1e-4."""
    own = asked(), asked(grid=None, accuracy=0.002), asked(method="paper"), asked(tolerance=0.2)
    assert [one.residual_tolerance for one in own] == pytest.approx([1e-8, 2e-6, 1e-4, 0.2])
    assert [one.plan().demand for one in own[1:]] == [0.002, 1e-4, 0.2]
    assert asked().target_quantity == "friction_coefficient"
    assert asked(scene=replace(HARD, friction=rf.Friction())).target_quantity == "contact_area"


def test_seconds_that_the_opening_grids_exceed_are_refused_by_name() -> None:
    with pytest.raises(rf.InputError, match=r"grid = 64: .*max_seconds = 1e-09"):
        rf.solve(HARD, accuracy=0.1, max_seconds=1e-9)
