"""Bars by class of scene, judged by hand."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace as Made
from typing import Any

import pytest

from reports.result_files import read_result
from verification.coverage import classes


def test_references_by_hand() -> None:
    """The edge's 0.79 of 1e-8; straight ones, 1e-9, have 0.21 in the place of 0.79 (pi - 1 + ln 2) / 24."""
    straight, grid = Made(faces=10, squares=16), Made(element_area=1e-10)
    own = {"straight": straight, "grid": grid, "edge": 1e-8, "dmu_dA": 1e5, "peak": Made(height=6)}
    numbers = dict(zip(classes.NUMBERS, (3e-6, 2e-6, 0.4, 5, 7), strict=True))
    area, bound = 3e-6 - 7.9e-9 - 0.116690e-9, 0.12e-8 + 0.5 * 4 * 1e-10
    for yields, peak in ((False, 6), (True, 5)):
        bars = {name: {"a": 0.1, "b": 0.2} for name in numbers}
        finest: Any = Made(**numbers, uncertainty=bars, features=Made(**own, yields=yields))
        values, doubts = zip(*(classes.reference(finest, name) for name in numbers), strict=True)
        assert values == pytest.approx((area, area, 0.4 + 1e5 * (area - 3e-6), peak, 7), rel=1e-9)
        assert doubts == pytest.approx((bound, bound, 1e5 * bound, 0.3, 0.3))


def test_scenes_are_counted_by_class(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Seeds 3 to 7, of which 5 does not converge; all bars but the third hold."""
    asked = []
    ends = {3: (0.4, 0.1, 0.1), 4: (0.2, 0.2, 0.1), 6: (0.1, 0.3, 0.0), 7: (9.126, 1.0, 1.0)}

    def judged(seed: int, M: int, _: object) -> list[dict[str, object]] | None:
        asked.append(M)
        row = zip(("bar", "error", "reference_bound"), ends.get(seed, ()), strict=False)
        return None if seed == 5 else [{**dict(row), "number": "approach"}]

    monkeypatch.setattr(classes, "judged", judged)
    monkeypatch.setattr(classes, "scene", lambda kind, seed, _: seed)
    file = tmp_path / "c.json"
    classes.main(["--first", "3", "--scenes", "5", "--only", "grooves", "--json", str(file)])
    found = read_result(file)
    assert (asked, found["not_converged"]) == ([128, 48, 64, 96, 128], {"grooves": 1})
    every = found["table"][-1]
    assert [every[key] for key in ("scenes", "held", "held_at_worst", "usable")] == [4, 0.75, 0.5, 0.75]
    assert (every["held_of_usable"], every["median_bar_over_error"]) == pytest.approx((2 / 3, 2.5), rel=1e-5)
    assert every["p"] == pytest.approx(1 - 0.92**4, rel=1e-5)  # probability of three of four, or fewer
