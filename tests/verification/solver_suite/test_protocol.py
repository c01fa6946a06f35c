"""How a solver under test is called, and that only a checked answer counts: every other end fails closed."""

from __future__ import annotations

import json
import math
import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from refimpl.errors import InputError
from verification.solver_suite import command
from verification.solver_suite.check import Entrant
from verification.solver_suite.command import Command, read_answer, write_problem
from verification.solver_suite.protocol import (
    Abilities,
    Answer,
    BadAnswer,
    ContactProblem,
    Coupling,
    Unsupported,
    abilities_of,
    ask,
)
from verification.solver_suite.suite import run

Capture = pytest.CaptureFixture[str]
GAP = np.array([[0.0, 1e-7], [2e-7, 3e-7]])
PROBLEM = ContactProblem(GAP, 1e-6, 1e9, load=1e-4, coupling=Coupling(1e6, 0.1, 1e-11, 0.3))
FINE = np.ones((2, 2))


@pytest.mark.parametrize(
    ("field", "changed"),
    [
        ("spacing_y", {"spacing_y": -1e-6}),
        ("gap", {"gap": np.array([[0.0, np.nan], [0.0, 0.0]])}),
        ("gap", {"gap": GAP + 1e-9}),
        ("reduced_modulus", {"reduced_modulus": -1e9}),
        ("load", {"load": None}),
        ("load", {"approach": 1e-7}),
        ("approach", {"load": None, "approach": np.inf}),
        ("tolerance", {"tolerance": 1.0}),
    ],
)
def test_a_problem_is_checked(field: str, changed: dict[str, object]) -> None:
    given = {"gap": GAP, "spacing": 1e-6, "reduced_modulus": 1e9, "load": 1.0} | changed
    with pytest.raises(InputError) as refused:
        ContactProblem(**given)  # type: ignore[arg-type]  # what no type checker saw is the point
    assert refused.value.field == field


def test_an_approach_counts_from_the_mean_planes_only_where_it_is_periodic() -> None:
    for periodic, touch in ((False, 2e-7), (True, 3.5e-7)):
        problem = ContactProblem(GAP, 1e-6, 1e9, approach=2e-7, periodic=periodic)
        assert problem.approach_from_touch == pytest.approx(touch, rel=1e-14)
    assert PROBLEM.approach_from_touch is None


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (np.ones((2, 3)), "shape"),
        (np.array([[1.0, np.nan], [1.0, 1.0]]), "1 pressures are not finite"),
        (1j * FINE, "returned an array of complex128: .* array of real numbers"),
        (np.ma.masked_array(FINE, mask=FINE > 0), "4 pressures are masked"),
        (None, "returned None"),
        ([[1.0, 1.0], [1.0, 1.0]], "returned a list"),
        ((FINE, True), r"returned a tuple: .* Answer\(pressure, converged\)"),
        (Answer(FINE, np.False_), "the solver did not converge by its own report"),
        (Answer(FINE, 1), "converged = 1: expected true or false"),
        (Answer(None, True), "returned an array of object"),
        (Answer([[1.0], [1.0, 1.0]], True), "inhomogeneous"),
    ],
)
def test_what_is_no_answer_is_refused(answer: object, said: str) -> None:
    with pytest.raises((BadAnswer, ValueError), match=said):
        ask(lambda problem: answer, _still())  # type: ignore[arg-type,return-value]  # wrong on purpose


def _still() -> ContactProblem:
    return ContactProblem(GAP, 1e-6, 1e9, load=1e-4)


def test_an_array_and_an_answer_are_accepted() -> None:
    for answer in (
        FINE,
        FINE.astype(int),
        np.ma.masked_array(FINE),
        Answer([[1, 1], [1, 1]], True),
        Answer(FINE, np.True_),
    ):
        np.testing.assert_array_equal(ask(lambda problem, a=answer: a, _still()).pressure, FINE)  # type: ignore[misc]


def test_a_solver_cannot_change_the_problem_it_is_judged_by() -> None:
    def meddling(problem: ContactProblem) -> Answer:
        problem.gap[:] = 0.0
        return Answer(FINE, True)

    pressed = Entrant(meddling).press(GAP, 2e-6, load=1e-4)
    np.testing.assert_array_equal(pressed.problem.gap, GAP)


def test_abilities_decide_what_is_posed() -> None:
    assert Abilities.named("aperiodic, load") == Abilities(periodic=False, approach=False)
    assert Abilities().lacking(PROBLEM) == "coupling"
    assert Abilities(load=False).lacking(_still()) == "load"
    assert Abilities(largest=1).lacking(_still()) == "2 elements along one axis"
    assert Abilities.named("aperiodic, load, rectangle, oblong elements").oblong_elements
    wide = ContactProblem(np.zeros((2, 3)), 1e-6, 1e9, load=1.0)
    oblong = ContactProblem(np.zeros((2, 2)), 1e-6, 1e9, load=1.0, spacing_y=2e-6)
    assert (wide.lengths, oblong.lengths) == ((2e-6, 3e-6), (2e-6, 4e-6))
    assert (Abilities().lacking(wide), Abilities().lacking(oblong)) == ("rectangle", "oblong elements")
    assert Abilities(rectangle=True, oblong_elements=True).lacking(wide) is None
    hard = replace(_still(), hardness=1e8)
    assert (Abilities().lacking(hard), Abilities(hardness=True).lacking(hard)) == ("hardness", None)
    with pytest.raises(InputError, match="hardness"):
        replace(_still(), hardness=0.0)
    with pytest.raises(Unsupported, match="coupling"):
        ask(lambda problem: FINE, PROBLEM)
    strength = PROBLEM.coupling_strength
    assert strength == pytest.approx(math.pi * 1e-11 * 1e9 * 0.1)
    for limit, lacking in ((strength, None), (0.9 * strength, f"coupling of strength {strength:.3g}")):
        assert Abilities(coupling=True, strongest=limit).lacking(PROBLEM) == lacking


def test_an_admitted_failure_is_an_error_without_friction_and_beyond_reach_with_it() -> None:
    def lagging(problem: ContactProblem) -> Answer:
        return Answer(FINE, False)

    lagging.abilities = Abilities(coupling=True)  # type: ignore[attr-defined]
    with pytest.raises(Unsupported, match="did not converge by its own report, at a coupling of strength"):
        ask(lagging, PROBLEM)
    with pytest.raises(BadAnswer, match="did not converge by its own report"):
        ask(lagging, _still())


def test_abilities_that_do_not_exist_are_refused() -> None:
    for wrong in ("aperiodic", "load", "load,periodic,magic", ""):
        with pytest.raises(InputError, match="abilities"):
            Abilities.named(wrong)
    absurd = ({"precision": 1e-5}, {"precision": 0.0}, {"largest": 0}, {"coupling": "no"}, {"strongest": -1})
    for limits in absurd:
        with pytest.raises(InputError, match="abilities"):
            Abilities(**limits)  # type: ignore[arg-type]  # wrong on purpose
    boastful = type("Boastful", (), {"abilities": "all", "__call__": lambda self, problem: FINE})()
    with pytest.raises(InputError, match="abilities"):
        abilities_of(boastful)


def test_unsupported_is_unavailable_and_an_exception_is_an_error() -> None:
    def unwilling(problem: ContactProblem) -> Answer:
        raise Unsupported("only odd grids") if problem.M % 2 == 0 else RuntimeError("broke")

    (even,) = run(unwilling, ["solver/one-element"])
    assert (even.status, even.note) == ("unavailable", "only odd grids")
    with pytest.raises(RuntimeError, match="broke"):
        ask(unwilling, ContactProblem(np.zeros((3, 3)), 1e-6, 1e9, load=1.0))


HEADER = {
    "M", "spacing", "reduced_modulus", "control", "value", "periodic", "tolerance", "friction", "tau", "beta",
    "shear_compliance", "sliding_direction", "shape", "lengths", "hardness",
}  # fmt: skip


def test_a_problem_is_written_to_the_last_digit(tmp_path: Path) -> None:
    write_problem(PROBLEM, tmp_path)
    header = json.loads((tmp_path / "problem.json").read_text())
    assert set(header) == HEADER
    assert all(key in str(command.__doc__) for key in HEADER)
    assert (header["M"], header["control"], header["value"], header["periodic"]) == (2, "load", 1e-4, 0)
    assert (header["friction"], header["tau"], header["sliding_direction"]) == (1, 1e6, 0.3)
    assert (header["shape"], header["lengths"]) == ([2, 2], [2e-6, 2e-6])
    assert command.header_of(replace(PROBLEM, spacing_y=3e-6))["lengths"] == (2e-6, 6e-6)
    assert len((tmp_path / "problem.json").read_text().splitlines()) == len(HEADER) + 2  # one key a line
    np.testing.assert_array_equal(np.loadtxt(tmp_path / "gap.csv", delimiter=","), GAP)
    np.testing.assert_array_equal(np.load(tmp_path / "problem.npz")["gap"], GAP)
    write_problem(ContactProblem(GAP, 1e-6, 1e9, approach=-1e-8, periodic=True), tmp_path)
    header = json.loads((tmp_path / "problem.json").read_text())
    assert (header["control"], header["value"], header["periodic"]) == ("approach", -1e-8, 1)
    assert (header["friction"], header["tau"], header["hardness"]) == (0, 0.0, 0.0)
    write_problem(replace(PROBLEM, hardness=2e8), tmp_path)
    assert json.loads((tmp_path / "problem.json").read_text())["hardness"] == 2e8


def test_an_answer_may_be_an_archive(tmp_path: Path) -> None:
    np.savez(tmp_path / "answer.npz", pressure=FINE)
    assert read_answer(tmp_path).converged is True
    (tmp_path / "answer.json").write_text('{"converged": false, "approach": 1.5e-6, "contact_area": 9e-12}')
    found = read_answer(tmp_path)
    assert (found.converged, found.approach, found.contact_area) == (False, 1.5e-6, 9e-12)
    assert found.mean_displacement is None
    np.savez(tmp_path / "answer.npz", forces=FINE)
    with pytest.raises(BadAnswer, match="KeyError"):
        read_answer(tmp_path)
    with (tmp_path / "answer.npz").open("wb") as single:
        np.save(single, FINE)
    with pytest.raises(BadAnswer, match="holds a single array: expected an archive, as of savez"):
        read_answer(tmp_path)
    (tmp_path / "answer.npz").write_bytes(b"PK\x03\x04 cut short")
    with pytest.raises(BadAnswer, match="unreadable"):
        read_answer(tmp_path)


@pytest.mark.parametrize(
    ("script", "said"),
    [
        ("exit 3", "exit status 3: nothing said"),
        ("rm -r $0; echo gone >&2; exit 1", "exit status 1: gone"),
        ("kill -SEGV $$", "killed by SIGSEGV: nothing said"),
        ("true", "neither pressure.csv nor answer.npz"),
        (": > $0/pressure.csv", "unreadable"),
        ("mkfifo $0/pressure.csv", "pressure.csv is no regular file"),
        ("cp $0/gap.csv $0/pressure.csv; mkfifo $0/answer.json", "answer.json is no regular file"),
        ("cp $0/gap.csv $0/pressure.csv; cp $0/problem.npz $0/answer.npz", "both"),
        ("printf '1,2\\n\\n3,4,\\n' > $0/pressure.csv", "line 3, number 3: '' is no number"),
        ("printf '1,2\\n0.0D+00,4\\n' > $0/pressure.csv", "line 2, number 1: '0.0D+00' is no number"),
        (
            'cp $0/gap.csv $0/pressure.csv; echo \'{"approach": 1, "approach": 2}\' > $0/answer.json',
            "the key 'approach' is there twice",
        ),
        ("printf '1,2\\n3,4\\n5\\n' > $0/pressure.csv", "line 3 has 1 numbers, those before have 2"),
        (
            "cp $0/gap.csv $0/pressure.csv; echo '{\"converged\": false}' > $0/answer.json",
            "did not converge by its own report",
        ),
        ("cp $0/gap.csv $0/pressure.csv; echo '[1]' > $0/answer.json", "unreadable"),
        ("sleep 30 & sleep 30", "no answer within 0.2 s"),
    ],
)
def test_a_program_that_does_not_answer_is_an_error(script: str, said: str) -> None:
    (result,) = run(Command(("sh", "-c", script), Abilities(), timeout=0.2), ["solver/one-element"])
    assert result.status == "error"
    assert said in result.note


def test_of_what_a_program_says_only_the_end_is_read() -> None:
    script = "yes 'iteration after iteration' | head -c 20000000; echo; echo out of memory; exit 3"
    tracemalloc.start()
    try:
        (result,) = run(Command(("sh", "-c", script), Abilities(), timeout=30), ["solver/one-element"])
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert "exit status 3: out of memory" in result.note
    assert peak < 5e6


def test_a_program_that_answers_wrongly_fails() -> None:
    wrong = Command(("sh", "-c", "cp $0/gap.csv $0/pressure.csv"), Abilities(), timeout=5.0)
    (result,) = run(wrong, ["solver/one-element"])
    assert (result.status, result.note) == ("fail", "load (N) 0.46875; exact 445553.0")


def test_a_command_is_split_as_a_shell_does() -> None:
    (missing,) = run(Command(("./not-there",), Abilities(), 1.0), ["solver/one-element"])
    assert (missing.status, "cannot run ./not-there" in missing.note) == ("error", True)
    assert Command.of("sh 'a b' -q", Abilities(), 1.0).words == ("sh", "a b", "-q")
