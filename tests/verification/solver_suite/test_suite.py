"""The suite for anyone's solver: faulty ones fail where they should, honest ones and other programs pass.

Our own solver passes in the case `solver_suite/own-solver` of the quick tier, which runs with the tests.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from refimpl.grid import Array
from verification.solver_suite import own, reference_solution
from verification.solver_suite.check import MODULUS, Entrant, Fault
from verification.solver_suite.command import Command
from verification.solver_suite.faulty_solvers.table import FAULTY, Faulty
from verification.solver_suite.gaps import rough_bump
from verification.solver_suite.isolated import Limited
from verification.solver_suite.protocol import Abilities, ContactProblem, SolverUnderTest
from verification.solver_suite.suite import run, suite

FINE = (Fault.SINGLE_PRECISION, Fault.ABSOLUTE_THRESHOLD)
"""Faults below the laxest claim."""
SOURCE = Path(__file__).with_name("solver.c")


def naming(fault: Fault) -> list[str]:
    return [check.id for check in suite() if fault in check.catches]


def test_every_fault_is_named_and_described() -> None:
    for check in suite():
        assert all(fault in check.case(own.solve).claim for fault in check.catches)
        assert len(check.tolerance_reason) > 10
    assert [fault for fault in Fault if not naming(fault)] == []


SOME = {check.id for check in suite() if not re.search(r"/design-(?!tiny).*[1-9]$", check.id)}
"""All cases, of the designs the tiny problems and every tenth: they are judged by one function."""


@pytest.mark.parametrize("whole", [False, pytest.param(True, marks=pytest.mark.nightly)])
@pytest.mark.parametrize("fault", FAULTY, ids=str)
def test_a_faulty_solver_fails_wherever_its_fault_is_named(fault: Fault, whole: bool) -> None:
    """In `make test` every fourth of the cases that name it."""
    named = naming(fault)[:: 1 if whole else 4]
    results = run(FAULTY[fault](), named)
    assert {r.id: r.status for r in results} == dict.fromkeys(named, "fail")
    assert all(r.unit for r in results if r.value is not None)


@pytest.mark.parametrize("fault", [f for f in FAULTY if f not in FINE], ids=str)
def test_the_laxest_claim_lets_no_faulty_solver_through(fault: Fault) -> None:
    lax = Limited(FAULTY[fault](), replace(own.solve.abilities, precision=1e-6))
    assert any(run(lax, [name])[0].status == "fail" for name in naming(fault))


def test_single_precision_that_says_so_is_held_to_what_it_says() -> None:
    noisy = naming(Fault.SINGLE_PRECISION)
    honest = Limited(FAULTY[Fault.SINGLE_PRECISION](), replace(own.solve.abilities, precision=1e-6))
    assert {r.status for r in run(honest, noisy)} == {"pass"}


@pytest.mark.nightly
@pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")
def test_a_program_in_c_passes_what_applies_to_it(tmp_path: Path) -> None:
    program = tmp_path / "solver"
    subprocess.run(["cc", "-O2", "-Wall", "-Werror", "-o", program, SOURCE, "-lm"], check=True)
    able = Abilities.named("aperiodic,load,approach", largest=32)
    results = run(Command((str(program),), able, timeout=60.0))
    verdicts = {r.id: r.status for r in results}
    assert {r.id: r for r in results if r.status in ("fail", "error")} == {}
    assert sum(status == "pass" for status in verdicts.values()) >= 20
    assert verdicts["solver/westergaard-load"] == verdicts["solver/sheared-pins"] == "unavailable"


def test_the_worst_of_several_answers_is_named() -> None:
    entrant = Entrant(Limited(lambda posed: reference_solution.eliminated(posed), own.solve.abilities))
    exact = entrant.press(rough_bump(5, seed=71), 1.0, load=0.05 * MODULUS)
    off = replace(exact, pressure=exact.pressure * 1.001)
    worse = replace(exact, pressure=exact.pressure * 1.002)
    answers = [(pressed, exact.pressure) for pressed in (off, worse, exact)]
    found = entrant.against(*answers)
    assert found.value == pytest.approx(2 * 0.002**2 / 2 / entrant.claim, rel=1e-9)
    assert found.note.startswith("problem 2 of 3: ")
    assert "problem" not in entrant.against(answers[0]).note


RESIDUALS = ("one-element", "rough-residual", "rough-residual-light", "load-balance", "sliding-residual")
ERRORS = (
    "wide-pins",
    "chequered",
    "square-patch",
    "rough-elimination",
    "sliding-elimination",
    "sheared-pins",
)
PERIODIC_ERRORS = ("periodic-elimination", "full-contact", "full-contact-sliding")  # there twice as much


@pytest.mark.parametrize(
    ("names", "power", "kept", "missed"),
    [(RESIDUALS, 1.0, 0.9, 1.5), (ERRORS, 0.5, 1.0, 1.2), (PERIODIC_ERRORS, 0.5, 0.95, 1.1)],
    ids=["residuals", "errors", "periodic errors"],
)
def test_a_claim_missed_by_little_fails_what_counts_in_claims(
    names: tuple[str, ...], power: float, kept: float, missed: float
) -> None:
    """Pressures too high by a share of the claim, or of its root: the energy of that error is its square."""

    def statuses(claims: float) -> set[str]:
        def too_high(posed: ContactProblem) -> Array:
            exact = own.solve(replace(posed, tolerance=1e-13 if posed.coupling is None else 1e-12))
            return np.asarray(exact.pressure) * (1 + (claims * posed.tolerance) ** power)

        found = run(Limited(too_high, own.solve.abilities), [f"solver/{name}" for name in names])
        return {result.status for result in found}

    assert statuses(kept) == {"pass"}
    assert statuses(missed) == {"fail"}


SYMMETRIC = {"no-tension", "mirrors", "transposition", "periodic-shift", "periodic-tiling"}
SYMMETRIC |= {"sliding-reversed", "identical-materials"}
"""What a uniform pressure has of a right answer."""
NONSENSE = {
    "huge": lambda p: np.full_like(p.gap, 1e308),
    "infinite both ways": lambda p: np.where(np.indices(p.gap.shape).sum(axis=0) % 2, 1e308, -1e308),
    "nothing": lambda p: np.zeros_like(p.gap),
    "cancelling": lambda p: np.where(np.indices(p.gap.shape).sum(axis=0) % 2, 1.0, -1.0),
}


IN_CI = ("infinite both ways", "nothing")  # one of those that overflow, one of those that vanish


@pytest.mark.parametrize(
    "answer",
    [
        pytest.param(answer, id=name, marks=[] if name in IN_CI else [pytest.mark.nightly])
        for name, answer in NONSENSE.items()
    ],
)
def test_nonsense_passes_nothing_but_symmetries_and_warns_of_nothing(answer: SolverUnderTest) -> None:
    """Energies and sums overflow or vanish: infinity over infinity is no proof that two answers agree."""
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        results = run(Limited(answer, own.solve.abilities), sorted(SOME))
    passed = {r.id.partition("/")[2] for r in results if r.status == "pass"}
    nothing = answer is NONSENSE["nothing"]  # no load is carried: that nothing pulls cannot be judged
    assert passed <= SYMMETRIC - ({"no-tension"} if nothing else set())
    assert [str(w.message) for w in warned] == []


@pytest.mark.parametrize("light", [0.001, 0.05])
def test_a_load_that_is_missed_alone_is_seen(light: float) -> None:
    """One of three loads is borne to 1e-4 too much: 1e4 times the claim of 1e-8."""

    def solver(problem: ContactProblem) -> Array:
        missed = problem.load is not None and np.isclose(problem.load, light * MODULUS)
        answer = own.solve(problem)
        return np.asarray(answer.pressure) * (1.0001 if missed else 1.0)

    (result,) = run(Faulty(solver), ["solver/load-balance"])
    assert result.status == "fail"
    assert result.value == pytest.approx(1e4, rel=1e-3)


@pytest.mark.parametrize("name", ["periodic-approach", "periodic-sheared-pins-approach"])
def test_an_honest_answer_at_its_claim_passes_with_its_mean_counted(name: str) -> None:
    """Errors of the contact's level, the worst there are, as large as the claim lets them be."""

    def lax(asked: ContactProblem) -> Array:
        exact = np.asarray(own.solve(replace(asked, tolerance=1e-12)).pressure)
        low, high = 1e-14, 1.0
        for _ in range(50):
            share = float(np.sqrt(low * high))
            residual = reference_solution.residual(asked, exact + share * exact.mean() * (exact > 0)).worst
            low, high = (share, high) if residual <= asked.tolerance else (low, share)
        return np.asarray(exact + low * exact.mean() * (exact > 0))

    for precision in (1e-8, 1e-6):
        (result,) = run(Limited(lax, replace(own.solve.abilities, precision=precision)), [f"solver/{name}"])
        assert result.error is not None
        assert 0 < result.error < 0.01  # of 2 claims: an error's energy is of second order
