"""Options of a solve: an accuracy is a share, on both sides of its ends."""

from __future__ import annotations

import math

import pytest

import refimpl as rf
from refimpl.driver.options import Options

SCENE = rf.read_scene("table1-rough")


@pytest.mark.parametrize("accuracy", [0.0, 1.0, -0.02, 1.5, math.nan, math.inf])
def test_an_accuracy_that_is_no_share_is_refused(accuracy: float) -> None:
    with pytest.raises(rf.InputError, match="a relative accuracy between 0 and 1") as refused:
        Options(scene=SCENE, accuracy=accuracy)
    assert refused.value.field == "accuracy"


@pytest.mark.parametrize("accuracy", [1e-12, 0.999])
def test_any_share_is_an_accuracy(accuracy: float) -> None:
    assert Options(scene=SCENE, accuracy=accuracy).accuracy == accuracy
