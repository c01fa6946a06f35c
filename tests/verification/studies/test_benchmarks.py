"""Benchmarks: the judge agrees with the reference, tolerances are found, turns taken, records only grow."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from refimpl.errors import InputError
from reports.result_files import read_result
from verification.benchmarks import child, rounds, run
from verification.benchmarks.__main__ import known, main
from verification.benchmarks.codes import ALONE, OWN, SHEARED, SLOPED, codes
from verification.benchmarks.judge import judged, padded_box
from verification.benchmarks.problems import problem
from verification.benchmarks.rounds import Failed, Turns, error, in_turns, solved, tuned
from verification.benchmarks.run import append
from verification.benchmarks.summary import lines, ratios, row
from verification.cli.output import columns
from verification.solver_suite import own, reference_solution


def found(seconds: float, **more: Any) -> dict[str, Any]:
    """A round as a child process reports it."""
    return {
        "seconds": seconds,
        "seconds again": seconds / 4,
        "processor seconds": seconds / 2,
        "peak memory": 3e8,
        "memory before": 1e8,
        "convolution seconds": 0.5,
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
@pytest.mark.parametrize("kind", ["smooth", "rough"])
def test_judge_agrees_with_the_dense_reference(kind: str) -> None:
    posed = problem(kind, 24, 1e-4)
    pressure = np.array(own.solve(posed).pressure)
    pressure[pressure > 0] *= 1 + 0.01 * np.sin(np.arange((pressure > 0).sum()))  # far from converged
    ours, theirs = judged(posed, pressure), reference_solution.residual(posed, pressure)
    assert ours.gap == pytest.approx(theirs.gap, rel=1e-9)
    assert ours.balance == pytest.approx(theirs.balance, rel=1e-9)
    assert ours.gap > 1e-5
    assert ours.area == pytest.approx((pressure > 0).sum() * posed.element_area)


def test_judge_finds_penetration_and_tension_where_they_are() -> None:
    posed = problem("smooth", 24, 1e-8)
    pressure = np.array(own.solve(posed).pressure)
    peak = pressure.max()
    exact = judged(posed, pressure)
    assert exact.tension == 0.0
    assert exact.penetration < 1e-8
    rim = np.unravel_index(np.argmin(np.where(pressure > 0, pressure, np.inf)), pressure.shape)
    pressure[rim] = -0.01 * peak
    found = judged(posed, pressure)
    v = reference_solution.displacement(posed, pressure) + posed.gap
    approach = np.average(v, weights=pressure)
    assert found.tension == pytest.approx(0.01, rel=1e-12)
    assert found.peak == peak
    assert found.penetration == pytest.approx((approach - v.min()) / approach, rel=1e-9)
    assert found.penetration > 1e-3


def test_judge_refuses_what_it_cannot_judge() -> None:
    posed = problem("smooth", 8, 1e-8)
    periodic = type(posed)(posed.gap, posed.spacing, 1e9, load=1.0, periodic=True)
    with pytest.raises(ValueError, match="free space"):
        judged(periodic, np.ones((8, 8)))


def test_padded_box_is_twice_the_contact() -> None:
    pressure = np.zeros((40, 40))
    pressure[3:11, 5:11] = 1.0
    assert padded_box(pressure) == (16, 12)


@pytest.mark.parametrize("slack", [0.03, 1.0, 30.0])
def test_tuning_finds_the_loosest_tolerance_within_two(slack: float) -> None:
    """Gap in steps, as iterations have: the tolerance found will do, and twice that would not."""
    tried: list[float] = []

    def solve(tolerance: float) -> dict[str, Any]:
        tried.append(tolerance)
        return found(1.0, gap=slack * 1.3 ** np.floor(np.log(tolerance) / np.log(1.3)))

    tolerance, best = tuned(solve, 1e-7, loosen=True)
    assert error(best) <= rounds.TARGET < error(solve(2.6 * tolerance))
    assert len(tried) <= 9


def test_tuning_never_loosens_ours_and_gives_up_aloud() -> None:
    assert tuned(lambda t: found(1.0, gap=t / 100), 1e-8, loosen=False)[0] == 1e-8
    assert tuned(lambda t: found(1.0, gap=3 * t), 1e-8, loosen=False)[0] < 1e-8
    with pytest.raises(Failed, match=r"relative gap 1.0e-06 at tolerance .* 8 tries"):
        tuned(lambda t: found(1.0, gap=1e-6), 1e-8, loosen=True)


def test_a_solve_that_takes_long_is_not_loosened() -> None:
    tried: list[float] = []

    def solve(seconds: float, tolerance: float) -> dict[str, Any]:
        tried.append(tolerance)
        return found(seconds, gap=tolerance / 100)

    assert tuned(partial(solve, 21.0), 1e-8, loosen=True)[0] == 1e-8
    assert tried == [1e-8]
    assert tuned(partial(solve, 19.9), 1e-8, loosen=True)[0] > 4e-7


def test_a_start_that_misses_is_tightened_by_as_much_and_loosened_again() -> None:
    tried: list[float] = []

    def solve(tolerance: float) -> dict[str, Any]:
        tried.append(tolerance)
        return found(1.0, gap=rounds.TARGET * (tolerance / 5e-8) ** 3)

    assert 2.5e-8 <= tuned(solve, 1e-7, loosen=True)[0] <= 5e-8
    assert tried[1] == pytest.approx(1e-7 / 8)


def test_a_jump_too_far_is_taken_back_only_as_far_as_needed() -> None:
    def solve(tolerance: float) -> dict[str, Any]:
        return found(1.0, gap=rounds.TARGET * (tolerance / 8e-7) ** 4)

    assert 4e-7 <= tuned(solve, 1e-7, loosen=True)[0] <= 8e-7


def test_without_any_gap_tolerances_are_loosened_to_the_last_try() -> None:
    assert tuned(lambda _: found(1.0, gap=0.0), 1e-10, loosen=True)[0] == pytest.approx(1e-3)


def test_what_fails_within_a_factor_of_two_ends_the_search() -> None:
    tried: list[float] = []

    def solve(tolerance: float) -> dict[str, Any]:
        tried.append(tolerance)
        return found(1.0, gap=0.8e-8 if tolerance < 1.5e-7 else 1e-6)

    assert tuned(solve, 1e-7, loosen=True)[0] == 1e-7
    assert tried == [1e-7, 2e-7]


def test_peers_are_loosened_and_ours_is_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run, "solved", lambda _c, _k, _m, tolerance, *_: found(1.0, gap=tolerance / 100))
    for name in (OWN, ALONE, SHEARED, SLOPED):
        assert run._tuned(name, "smooth", 64, None, 1, 60.0).tolerance == rounds.CERTIFIED
    first = run._tuned("peer", "smooth", 64, None, 1, 60.0)
    assert 5e-7 <= first.tolerance <= 1e-6
    # on the next grid a peer goes on from there
    tried: list[float] = []
    monkeypatch.setattr(
        run, "solved", lambda _c, _k, _m, tolerance, *_: tried.append(tolerance) or found(30.0)
    )
    first.rounds = [found(7.0), found(1.0)]
    assert not run._tuned("peer", "smooth", 128, first, 1, 60.0).failure
    assert tried == [first.tolerance]


def test_who_cannot_make_it_is_left_out_with_the_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*_: object) -> dict[str, Any]:
        raise Failed("out of memory")

    monkeypatch.setattr(run, "solved", never)
    broke = run._tuned("peer", "smooth", 64, None, 1, 60.0)
    assert broke.failure == "out of memory"
    assert "after 64 x 64: out of memory" in run._tuned("peer", "smooth", 128, broke, 1, 60.0).failure
    slow = turns("peer", 9.0, 1.5)  # times eight for twice the grid, of the quicker round
    assert run._tuned("peer", "smooth", 128, slow, 1, 11.9).failure == "not run: 12 s expected"
    assert run._tuned("peer", "smooth", 256, slow, 1, 95.0).failure == "not run: 96 s expected"
    assert run._tuned("peer", "smooth", 128, slow, 1, 12.1).failure == "out of memory"


def test_a_coupled_result_is_judged_by_its_certificate() -> None:
    assert error(found(1.0, gap=0.02, residual=3e-9)) == 3e-9


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


def test_ratios_pair_rounds_and_name_the_fastest_peer() -> None:
    """A slow spell in the second round meets both codes: the ratio does not hear of it."""
    all_turns = [turns(OWN, 1.0, 5.0, 2.0), turns("slow", 9.0, 45.0, 18.0), turns("fast", 3.0, 15.0, 8.0)]
    table: Any = ratios([*all_turns, turns("fast+options", 2.0, 5.0, 4.0), turns(SHEARED, 1.5, 7.0, 3.2)])
    assert table["slow"]["seconds"] == {"median": 9.0, "least": 9.0, "most": 9.0}
    assert table["fastest peer"] == {"code": "fast", "seconds over ours": 3.0}
    assert table["fastest set-up of a peer"] == {"code": "fast+options", "seconds over ours": 2.0}
    assert table[SHEARED]["seconds"]["median"] == 1.5
    assert "fastest peer, solver alone" not in table
    assert ratios([turns("alone", 1.0)]) == {}


def test_the_solver_alone_is_compared_as_peers_are() -> None:
    all_turns = [turns(OWN, 4.0), turns(ALONE, 2.0), turns("peer", 6.0), turns("peer+options", 1.0)]
    all_turns[1].rounds[0]["seconds again"] = 0.75
    table: Any = ratios(all_turns)
    assert table["fastest peer"] == {"code": "peer", "seconds over ours": 1.5}
    assert table["fastest peer, solver alone"] == {"code": "peer", "seconds over ours": 3.0}
    assert table["fastest peer, solver alone, again"] == {"code": "peer", "seconds over ours": 2.0}
    all_turns[2].rounds[0]["seconds again"] = None  # too long to be repeated
    assert "fastest peer, solver alone, again" not in ratios(all_turns)


def test_rows_count_convolutions_on_the_padded_box() -> None:
    one = turns(OWN, 1.0, 2.0)
    one.rounds[-1]["operations"] = {"n log2 n": 640.0}
    entry: Any = row(one)
    assert entry["convolution equivalents"] == 640.0 / (16 * 4)
    assert entry["times one convolution"]["median"] == 3.0
    assert entry["memory of the solve"]["median"] == 2e8
    assert entry["seconds again"] == {"median": 0.375, "least": 0.25, "most": 0.5}
    assert entry["meets the target"] is True
    assert "seconds" not in row(Turns("absent", "smooth", 64, 1e-8, failure="left out"))


def test_lines_show_ratios_and_who_was_left_out() -> None:
    left_out = Turns("absent", "smooth", 64, 1e-8, failure="not run: 900 s expected")
    both = [turns(OWN, 1.0), turns("peer", 3.0), left_out]
    shown = lines([row(one) for one in both], [{"kind": "smooth", "M": 64, **ratios(both)}])
    assert [cells[:4] for cells in shown[1:3]] == [
        ["smooth 64", OWN, "1", ""],
        ["smooth 64", "peer", "3", "3"],
    ]
    assert shown[3] == ["smooth 64", "absent", "", "", "", "", "not run: 900 s expected"]
    assert "not run" in columns(shown)
    assert shown[1][-1] == "300 MB"


def test_names_are_checked() -> None:
    assert known("--kinds", None, ["smooth", "rough"]) == ["smooth", "rough"]
    with pytest.raises(InputError, match="--codes"):
        known("--codes", "hertz", [OWN])


def test_a_record_only_grows(tmp_path: Path) -> None:
    file = tmp_path / "record.json"
    append({"rows": [1]}, file)
    append({"rows": [2]}, file)
    assert read_result(file)["runs"] == [{"rows": [1]}, {"rows": [2]}]


@pytest.mark.parametrize("name", [OWN, ALONE, SHEARED, SLOPED])
def test_our_codes_solve_table_1(name: str) -> None:
    pressed = codes()[name].ready("smooth", 48, 1e-8)()
    assert pressed.converged
    verdict = judged(problem("smooth", 48, 1e-8), pressed.pressure)
    if name in (OWN, ALONE):
        assert verdict.gap <= 1e-8
        assert verdict.balance <= 1e-8
        assert pressed.residual is None
    else:
        assert pressed.residual is not None
        assert pressed.residual <= 1e-8
        assert verdict.gap > 1e-3  # copper and steel couple, so the frictionless judge must object


def test_peak_memory_is_of_this_process() -> None:
    before = child.peak_memory()
    held = np.ones(4_000_000)
    assert child.peak_memory() >= before
    assert 2e7 < before < 1e11
    assert held.any()


def test_a_run_from_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "record.json"
    main(["--grids", "32", "--codes", OWN, "--kinds", "smooth", "--rounds", "1", "--json", str(file)])
    (recorded,) = read_result(file)["runs"]
    (entry,) = recorded["rows"]
    assert entry["meets the target"]
    assert entry["seconds"]["median"] > 0
    assert "smooth 32" in capsys.readouterr().out
    assert recorded["conditions"]["versions"] == {OWN: codes()[OWN].version}
    with pytest.raises(Failed, match="KeyError"):
        solved("no such code", "smooth", 32, 1e-8, threads=1, limit=60)
