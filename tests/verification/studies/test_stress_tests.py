"""Stress tests: verdicts on corrupted solutions, kinds of limits, the committed study."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fnmatch import fnmatchcase
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from appendix_a import wedge
from refimpl.operators.fft import FFTInfluence
from tests.changed import changed
from verification.cases.solvers.stress_tests import counted
from verification.exact import lawful_states, positive_definite
from verification.exact.dense_influence import DenseInfluence
from verification.output.result_files import committed, read_result
from verification.scenes.cross_checks import POLYMER, pressed
from verification.stress_tests import conditioning, judge, limits, study
from verification.stress_tests.__main__ import main
from verification.stress_tests.axes import AXES, grids, states, topography
from verification.stress_tests.axes.contacts import on, sheared
from verification.stress_tests.oracle import EXACT, NotSettled, Oracle
from verification.stress_tests.state import (
    EXISTS,
    NO_DIGITS,
    NO_STATE,
    NOT_FOUND,
    Extreme,
    Judged,
    Verdict,
    number,
)

pytestmark = pytest.mark.filterwarnings("ignore::refimpl.SurfaceWarning")
ALL = [unique for name in AXES for unique, _ in states(name)]
BALL = pressed(lower=POLYMER, load=30.0, direction=0.7, friction=rf.Friction(1e5, 0.3))


def of_row(row: study.Row) -> Judged:
    found = {name: row[name] for name in ("status", "error", "limit", "oracle", "note", "data")}
    return Judged(Verdict(row["verdict"]), **found)


def test_the_committed_study_names_every_failure_once_and_nothing_else() -> None:
    found = committed("extremes")
    assert found["counts"]["wrong"] == found["counts"]["crash"] == 0
    assert [row["id"] for row in found["states"]] == ALL
    unused = {glob for limit in limits.LIMITS for glob in (limit.rule, *limit.states)} - {""}
    for row in found["states"]:
        shown = limits.limits_of(row["id"], of_row(row))
        assert len(shown) == (row["verdict"] != "right"), row["id"]
        assert row["kind"] == (shown[0].kind.value if shown else None), row["id"]
        if shown:
            unused -= {shown[0].rule, *(glob for glob in shown[0].states if fnmatchcase(row["id"], glob))}
        exists = row["kind"] in (limits.Kind.BEYOND, limits.Kind.MISSED) and row["axis"] != "wedge"
        assert (row["note"] == EXISTS) == exists, row["id"]
        assert row["verdict"] != "unjudged" or row["data"]["lost"] > NO_DIGITS, row["id"]
        assert row["verdict"] != "right" or "lost" not in row["data"] or row["limit"] <= 0.1, row["id"]
    assert not unused
    assert [limit for limit in limits.LIMITS if not all((limit.what, limit.why, limit.evidence))] == []
    assert [limit for limit in limits.LIMITS if bool(limit.rule) == bool(limit.states)] == []
    (ridge,) = (row for row in found["states"] if row["id"] == "grid/ridge of 24 elements, fft/16 across")
    assert float(ridge["note"].split()[-2]) < 1e-9  # both solvers return it alike, as its limit says


def test_what_stands_behind_a_state_that_no_solver_finds() -> None:
    assert judge.sought(sheared(1.0, 0.0), 5, oblique=False).startswith("a state exists")
    assert judge.sought(sheared(100.0, 0.0), 5, oblique=False).startswith("no state exists: integer")
    assert judge.sought(sheared(100.0, 0.0), 5).startswith("continuation finds no state")
    periodic = replace(sheared(100.0, 0.0), periodic=True)
    assert judge.sought(periodic, 5, oblique=False).startswith("not decided")


SABOTAGE = {
    "pressure": lambda s: changed(s, pressure=s.pressure * (1 + 1e-5)),
    "one element": lambda s: changed(s, pressure=np.where(s.pressure == s.pressure.max(), 0.0, s.pressure)),
    "approach": lambda s: changed(s, approach=s.approach + 1e-9),
    "friction": lambda s: changed(s, friction_force=-s.friction_force),
    "normal": lambda s: changed(s, normal_force=s.normal_force * 1.00001),
}


@pytest.mark.parametrize(("name", "periodic"), [*((name, False) for name in SABOTAGE), ("pressure", True)])
def test_a_wrong_number_with_a_good_status_is_wrong(
    name: str, periodic: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene, solve = replace(BALL, periodic=periodic), rf.solve
    assert judge.by_oracle(scene, 4).verdict is Verdict.RIGHT
    monkeypatch.setattr(rf, "solve", lambda *a, **k: SABOTAGE[name](solve(*a, **k)))
    assert judge.by_oracle(scene, 4).verdict is Verdict.WRONG


def test_a_flipped_coupling_is_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    transformed = FFTInfluence._tangential_hat
    monkeypatch.setattr(FFTInfluence, "_tangential_hat", lambda self, angle: -transformed(self, angle))
    assert judge.by_oracle(BALL, 4, oblique=False).verdict is Verdict.WRONG


def eigenvalues() -> list[float]:
    """Of the normal matrix of 2 x 2 elements, by its entries for self, beside and across the corner."""
    a, b, c = DenseInfluence(rf.Grid.square(2.0, 2), 0.0).normal_matrix[0, [0, 1, 3]]
    return sorted([a + 2 * b + c, a - c, a - c, a - 2 * b + c])


def test_symmetric_parts_known_values() -> None:
    """Without slope the eigenvalues of the normal matrix, whatever c and beta; the correction ends that."""
    for beta in (0.0, 0.4, 1e3):
        np.testing.assert_allclose(positive_definite.symmetric_part(2, beta, 0.3), eigenvalues(), rtol=1e-12)
    assert positive_definite.least_symbol() > 1.8
    assert positive_definite.symmetric_part(4, 0.3, 0.3, slope=4.0)[0] < 0


@pytest.mark.parametrize(("over", "error"), [(-1e-9, 0.0), (0.0, 0.0), (1e-9, 1.0), (0.5, 1.0)])
def test_no_contact_is_right_up_to_first_touch(over: float, error: float) -> None:
    scene = on(np.zeros((4, 4)), 1.0)
    apart = rf.solve(scene, 4, approach=-1e-9)
    assert not apart.contact.any()
    found, note = judge.exact_error(scene, apart, approach=over)
    assert found == error
    assert ("apart" in note) == (error == 0)
    assert judge.exact_error(scene, apart)[0] == 1.0  # under a load


def test_support_is_where_tau_acts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Elements of the contact that are excluded from tau have none in the exact state either."""
    solution = rf.solve(BALL, 4)
    excluded = np.zeros((4, 4), dtype=bool)
    excluded[np.unravel_index(solution.pressure.argmax(), (4, 4))] = True
    seen: list[np.ndarray] = []
    solve = Oracle.solve
    monkeypatch.setattr(Oracle, "solve", lambda *given: (seen.append(given[2]), solve(*given))[1])
    beta_alone = np.where(excluded, BALL.friction.beta * solution.pressure, solution.traction)
    judge.exact_error(BALL, changed(solution, traction=beta_alone))
    assert np.array_equal(seen[0], solution.contact & ~excluded)
    dry = replace(BALL, friction=rf.Friction(beta=0.3))
    judge.exact_error(dry, rf.solve(dry, 4))
    assert np.array_equal(seen[1], rf.solve(dry, 4).contact)


def test_conditions_known_values(monkeypatch: pytest.MonkeyPatch) -> None:
    solve = np.linalg.solve
    monkeypatch.setattr(np.linalg, "solve", lambda *system: solve(*system) * (1 + 1e-10))
    found = conditioning.measure(2)
    assert found["largest"] == pytest.approx(eigenvalues()[-1], rel=1e-14)
    assert found["least"] == pytest.approx(eigenvalues()[0], rel=1e-13)
    assert found["condition"] == pytest.approx(found["largest"] / found["least"], rel=1e-14)
    assert found["digits lost by a direct solve"] == pytest.approx(np.log10(1e-10 / 2.0**-52), abs=1e-4)
    assert found["CG iterations"] == 3


def raising(error: Exception) -> Judged:
    raise error


def endless() -> Judged:
    while True:
        pass


def solver(does: Callable[..., Judged], *given: object) -> Callable[[], Judged]:
    return partial(judge.tested, does, *given)


@pytest.mark.parametrize(
    ("verdict", "status", "run"),
    [
        ("right", "value", lambda: number(1e-9, 1e-8, "value", "x")),
        ("wrong", "value", lambda: number(float("nan"), 1e-8, "value", "x")),
        ("detected failure", "InputError", partial(judge.tested, rf.Material, -1.0, 0.3)),
        ("detected failure", "InputError", partial(judge.tested, wedge.stresses, 1.0, 0.0, 2.0)),
        ("detected failure", "NotConverged", solver(raising, rf.NotConverged("no state"))),
        ("crash", "ArithmeticError", solver(raising, ArithmeticError("from anywhere"))),
        ("crash", "ZeroDivisionError", solver(raising, ZeroDivisionError("division by zero"))),
        ("crash", "OutOfTime", solver(endless)),
        ("unjudged", "NotSettled", partial(raising, NotSettled("the oracle"))),
        ("unjudged", "ArithmeticError", partial(raising, ArithmeticError("the reference"))),
        ("unjudged", "IndexError", partial(raising, IndexError("in the oracle"))),
        ("unjudged", "InputError", partial(raising, rf.InputError("load", -1, "of the reference"))),
        ("unjudged", "OutOfTime", endless),
    ],
)
def test_verdicts(verdict: str, status: str, run: Callable[[], Judged]) -> None:
    row = study.run_state("a/b/c", Extreme("b", "c", 0.0, run, 0.2))
    assert (row["verdict"], row["status"]) == (verdict, status)
    assert (row["digits"] is None) == (verdict not in ("right", "wrong"))
    assert study.unexplained([row]) == ["a/b/c"] * (verdict != "right")  # no limit names it
    assert counted([row]).value == (verdict != "right")
    assert not study.unexplained([row | {"kind": "a kind"}])


def test_an_error_that_the_status_admits_is_a_detected_failure() -> None:
    failed = changed(rf.solve(BALL, 4), status=rf.Status.STAGNATED)
    assert judge.verdict(failed, 1.0, "x").verdict is Verdict.DETECTED


def test_the_command_runs_an_axis(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(study.lawful_states, "TAUS", ())
    monkeypatch.setattr(study.conditioning, "GRIDS", (2, 3))
    path = tmp_path / "e.json"
    assert main(["--json", str(path), "--axis", "kernel"]) == 0
    found = read_result(path)
    assert found["counts"]["wrong"] == 0
    assert len(found["states"]) == len(list(states("kernel")))
    with pytest.raises(SystemExit):
        main(["--json", str(path), "--axis", "nonsense"])


@pytest.mark.parametrize("wrong", [0, 1])
def test_a_converged_contact_that_is_not_lawful_counts_in_the_status(
    wrong: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    counted = lawful_states.Count(0.0, 0, 1, 0, 1, {"fft": {}, "dense": {}}, wrong)
    monkeypatch.setattr(lawful_states, "count", lambda tau: counted)
    monkeypatch.setattr(study.conditioning, "GRIDS", (2, 3))
    assert main(["--json", str(tmp_path / "e.json"), "--axis", "kernel"]) == wrong


TAU = "friction/tau, fft/tau/f = 5.62"


@pytest.mark.parametrize(
    ("unique", "kind"),
    [
        ("load/plane, fft/p/E* = 1e+01", "BEYOND"),
        ("friction/tau, soft ball, dense/tau/f = 100", "NONE_FOUND"),
        ("wedge/r = 1/gamma = 1.5707963267948966", "NO_PROBLEM"),
        ("wedge/r = 1/gamma = 1.5707963257948965", "MISSED"),
        (TAU, None),
        ("load/plane, dense/p/E* = 1e+01", None),  # right today: a failure would be new
        ("friction/beta, fft/beta = 10", None),
    ],
)
def test_a_state_that_is_not_solved_has_a_kind(unique: str, kind: str | None) -> None:
    assert unique in ALL
    named = None if kind is None else limits.Kind[kind].value
    judged = {v: Judged(v, "stagnated", None, 1e-6, "none") for v in Verdict}
    assert study.kind_of(unique, judged[Verdict.DETECTED]) == named
    for verdict in (Verdict.RIGHT, Verdict.UNJUDGED, Verdict.WRONG, Verdict.CRASH):
        assert study.kind_of(unique, judged[verdict]) is None


@pytest.mark.parametrize(
    ("error", "share", "note", "named"),
    [
        (1e-9, 0.6, NO_STATE, True),
        (1e-9, 0.6, f"{NOT_FOUND}: no route", True),
        (1e-9, 0.6, "", False),
        (1e-9, 0.6, "not decided: no route", False),
        (1e-9, 0.6, EXISTS, False),
        (1e-9, 0.5, NO_STATE, False),
        (1e-3, 0.6, NO_STATE, False),
        (None, 1.0, NO_STATE, False),
    ],
)
def test_elements_without_tau_are_counted_in_the_state(
    error: float | None, share: float, note: str, named: bool
) -> None:
    found = Judged(Verdict.DETECTED, "iteration limit", error, 1e-6, EXACT, note, {"without tau": share})
    assert study.kind_of(TAU, found) == (limits.Kind.EXCLUDED.value if named else None)
    assert study.kind_of("a/b/c", found) == study.kind_of(TAU, found)
    assert study.kind_of(TAU, replace(found, oracle="the dense solver")) is None  # a second solver of ours


def test_a_state_under_an_approach_is_sought_too() -> None:
    scene = pressed(lower=POLYMER, rms=None)
    found = judge.by_oracle(scene, 5, approach=1e-30)
    assert (found.verdict, found.data["without tau"], found.note) == (Verdict.DETECTED, 1.0, EXISTS)


def test_a_failed_state_tells_how_much_of_its_contact_carries_no_tau() -> None:
    judged = judge.by_oracle(sheared(100.0, 0.0), 5, oblique=False)
    assert (judged.verdict, judged.data["without tau"]) == (Verdict.DETECTED, pytest.approx(16 / 17))


@pytest.mark.parametrize(("offset", "verdict"), [(2.0**42, Verdict.RIGHT), (2.0**48, Verdict.UNJUDGED)])
def test_heights_without_digits_are_no_problem_to_judge(offset: float, verdict: Verdict) -> None:
    judged = topography.shifted(offset, dyadic=False, method="fft")
    assert judged.verdict is verdict
    assert (study.kind_of("a/b/c", judged) == limits.Kind.NO_PROBLEM) == (verdict is Verdict.UNJUDGED)


@pytest.mark.parametrize("offset", [2.0**42, 2.0**48])
def test_an_error_beyond_that_of_the_data_is_wrong(offset: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(topography, "change", lambda there, here: 1.0)
    judged = topography.shifted(offset, dyadic=False, method="fft")
    assert judged.verdict is Verdict.WRONG
    assert study.kind_of("a/b/c", judged) is None


@pytest.mark.parametrize(
    ("fails", "verdict"),
    [
        ((), "right"),
        (("dense",), "unjudged"),
        ((None,), "detected failure"),
        ((None, "dense"), "detected failure"),
    ],
    ids=["neither", "the judge", "the solver", "both"],
)
def test_a_solver_is_not_blamed_for_its_judge(
    fails: tuple[str | None, ...], verdict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    solve = rf.solve

    def failing(*given: Any, **options: Any) -> rf.Solution:
        found = solve(*given, **options)
        failed = options.get("method") in fails
        return changed(found, status=rf.Status.ITERATION_LIMIT) if failed else found

    monkeypatch.setattr(rf, "solve", failing)
    judged = judge.judged(partial(grids.against_dense, grids.ridge(6, 2), 6))
    assert judged.verdict == verdict
    assert (judged.error is None) == ("dense" in fails)  # nothing is measured by a reference that failed
