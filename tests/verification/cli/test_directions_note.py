"""The hint on a sweep over directions."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest

from verification.cli.sweep import directions_note


@pytest.mark.parametrize(
    ("turns", "hint"),
    [((0.0,), False), ((0.0, math.pi), False), ((0.0, 0.785, math.pi), True), ((0.0, 0.785, 1.571), True)],
)
def test_directions_without_their_opposite_are_remarked_on(turns: tuple[float, ...], hint: bool) -> None:
    study: Any = SimpleNamespace(vary={"sliding_direction": turns})
    assert bool(directions_note(study)) is hint
