"""Benchmarks: the judge agrees with the reference, tolerances are found, turns taken, records only grow."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from verification.benchmarks import rounds
from verification.benchmarks.__main__ import main
from verification.benchmarks.codes import ALONE, OWN, SHEARED, SLOPED, codes
from verification.benchmarks.problems import problem
from verification.benchmarks.rounds import Failed, Turns, in_turns, tuned, tuned_turns
from verification.benchmarks.summary import ratios
from verification.benchmarks.timed import residuals_of
from verification.output.result_files import read_result
from verification.solver_suite import own, reference_solution


def found(seconds: float, **more: Any) -> dict[str, Any]:
    """A round as a child process reports it."""
    return {
        "seconds": seconds,
        "seconds again": seconds / 4,
        "processor seconds": seconds / 2,
        "peak memory": 3e8,
        "memory before": 1e8,
        "converged": True,
        "operations": {},
        "residual": None,
        "gap": 1e-9,
        "balance": 0.0,
        "penetration": 0.0,
        "tension": 0.0,
        "area": 1.0,
        "peak": 1.0,
        "padded box": [4, 4],
    } | more


def turns(code: str, *seconds: float) -> Turns:
    return Turns(code, "smooth", 64, 1e-8, [found(s) for s in seconds])


@pytest.mark.filterwarnings("ignore::refimpl.SurfaceWarning")
def test_residuals_agree_with_the_dense_reference() -> None:
    posed = problem("rough", 16, 1e-4)
    pressure = np.array(own.solve(posed).pressure)
    pressure[pressure > 0] *= 1 + 0.01 * np.sin(np.arange((pressure > 0).sum()))  # far from converged
    ours, theirs = residuals_of(posed, pressure), reference_solution.residual(posed, pressure)
    assert ours["gap"] == pytest.approx(theirs.gap, rel=1e-9)
    assert ours["balance"] == pytest.approx(theirs.balance, rel=1e-9)
    assert ours["gap"] > 1e-5
    assert ours["area"] == pytest.approx((pressure > 0).sum() * posed.element_area)


def test_penetration_and_tension_are_found_and_other_problems_refused() -> None:
    posed = problem("smooth", 24, 1e-8)
    pressure = np.array(own.solve(posed).pressure)
    peak, exact = pressure.max(), residuals_of(posed, pressure)
    assert exact["tension"] == 0.0
    assert exact["penetration"] < 1e-8
    rim = np.unravel_index(np.argmin(np.where(pressure > 0, pressure, np.inf)), pressure.shape)
    pressure[rim] = -0.01 * peak
    off = residuals_of(posed, pressure)
    v = reference_solution.displacement(posed, pressure) + posed.gap
    approach = np.average(v, weights=pressure)
    assert off["tension"] == pytest.approx(0.01, rel=1e-12)
    assert off["peak"] == peak
    assert off["penetration"] == pytest.approx((approach - v.min()) / approach, rel=1e-9)
    assert off["penetration"] > 1e-3
    with pytest.raises(ValueError, match="free space"):
        residuals_of(replace(posed, periodic=True), pressure)


def tuning(gap: Callable[[float], float], start: float, seconds: float = 1.0) -> tuple[float, list[float]]:
    """The tolerance found for a code whose gap follows from its tolerance, and all that were tried."""
    tried: list[float] = []

    def solve(tolerance: float) -> dict[str, Any]:
        tried.append(tolerance)
        return found(seconds, gap=gap(tolerance))

    return tuned(solve, start, loosen=True)[0], tried


def test_tuning_never_loosens_ours_and_gives_up_aloud() -> None:
    assert tuned(lambda t: found(1.0, gap=t / 100), 1e-8, loosen=False)[0] == 1e-8
    assert tuned(lambda t: found(1.0, gap=3 * t), 1e-8, loosen=False)[0] < 1e-8
    with pytest.raises(Failed, match=r"relative gap 1.0e-06 at tolerance .* 8 tries"):
        tuned(lambda t: found(1.0, gap=1e-6), 1e-8, loosen=True)


@pytest.mark.parametrize(
    ("gap", "start", "seconds", "low", "high", "first"),
    [
        (lambda t: t / 100, 1e-8, 21.0, 1e-8, 1e-8, [1e-8]),  # it takes long: not loosened
        # the start misses by 8: tightened by as much, then loosened again
        (lambda t: rounds.TARGET * (t / 5e-8) ** 3, 1e-7, 1.0, 2.5e-8, 5e-8, [1e-7, 1e-7 / 8]),
        # a jump too far is taken back only as far as needed
        (lambda t: rounds.TARGET * (t / 8e-7) ** 4, 1e-7, 1.0, 4e-7, 8e-7, [1e-7]),
        # a failure within a factor of two ends the search
        (lambda t: 0.8e-8 if t < 1.5e-7 else 1e-6, 1e-7, 1.0, 1e-7, 1e-7, [1e-7, 2e-7]),
    ],
    ids=["long", "start misses", "jump too far", "within two"],
)
def test_a_search_for_a_tolerance(
    gap: Callable[[float], float], start: float, seconds: float, low: float, high: float, first: list[float]
) -> None:
    tolerance, tried = tuning(gap, start, seconds)
    assert low <= tolerance <= high
    assert tried[: len(first)] == pytest.approx(first)


def test_who_cannot_make_it_is_left_out_with_the_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*_: object) -> dict[str, Any]:
        raise Failed("out of memory")

    monkeypatch.setattr(Turns, "solve", never)
    broke = tuned_turns("peer", "smooth", 64, None, 1, 60.0)
    assert broke.failure == "out of memory"
    assert "after 64 x 64: out of memory" in tuned_turns("peer", "smooth", 128, broke, 1, 60.0).failure
    slow = turns("peer", 9.0, 1.5)  # times eight for twice the grid, of the quicker round
    assert tuned_turns("peer", "smooth", 128, slow, 1, 11.9).failure == "not run: 12 s expected"
    assert tuned_turns("peer", "smooth", 256, slow, 1, 95.0).failure == "not run: 96 s expected"
    assert tuned_turns("peer", "smooth", 128, slow, 1, 12.1).failure == "out of memory"


def test_turns_alternate_and_a_failure_ends_only_its_own() -> None:
    order: list[str] = []

    def solve(one: Turns) -> dict[str, Any]:
        order.append(one.code)
        if one.code == "B" and order.count("B") == 2:
            raise Failed("out of memory")
        return found(1.0)

    three = [Turns(name, "smooth", 64, 1e-8) for name in "ABC"]
    in_turns(three, 3, solve)
    assert "".join(order) == "ABCABCAC"
    assert three[1].failure == "out of memory"
    assert [len(one.rounds) for one in three] == [3, 1, 3]


def test_ratios_pair_rounds() -> None:
    """A slow spell in the second round meets both codes: the ratio does not hear of it."""
    all_turns = [turns(OWN, 1.0, 5.0, 2.0), turns("slow", 9.0, 45.0, 18.0), turns(SHEARED, 1.5, 7.0, 3.2)]
    table: Any = ratios(all_turns)
    assert table["slow"]["seconds"] == {"median": 9.0, "least": 9.0, "most": 9.0}
    assert table[SHEARED]["seconds"]["median"] == 1.5
    assert ALONE not in table["slow"]
    alone: Any = ratios([*all_turns, turns(ALONE, 0.5, 5.0, 1.0)])
    assert alone["slow"][ALONE]["seconds"] == {"median": 18.0, "least": 9.0, "most": 18.0}
    assert ratios([turns("alone", 1.0)]) == {}


@pytest.mark.parametrize("name", [OWN, ALONE, SLOPED])
def test_our_codes_solve_table_1(name: str) -> None:
    pressed = codes()[name].ready("smooth", 24, 1e-8)()
    assert pressed.converged
    found = residuals_of(problem("smooth", 24, 1e-8), pressed.pressure)
    if name in (OWN, ALONE):
        assert found["gap"] <= 1e-8
        assert found["balance"] <= 1e-8
        assert pressed.residual is None
    else:
        assert pressed.residual is not None
        assert pressed.residual <= 1e-8
        assert found["gap"] > 1e-3  # copper and steel couple, so the frictionless judge must object


def test_a_run_from_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "record.json"
    main(["--grids", "32", "--codes", OWN, "--kinds", "smooth", "--rounds", "1", "--json", str(file)])
    (recorded,) = read_result(file)["runs"]
    (entry,) = recorded["rows"]
    assert entry["meets the target"]
    assert entry["seconds"]["median"] > 0
    assert "smooth 32" in capsys.readouterr().out
    assert recorded["conditions"]["versions"] == {OWN: codes()[OWN].version}
