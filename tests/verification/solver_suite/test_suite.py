"""The suite for anyone's solver: our own passes it, faulty ones do not, and the reference is right."""

from __future__ import annotations

import re
import shutil
import subprocess
import warnings
from dataclasses import replace
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array
from refimpl.model.certificate import certify
from refimpl.model.problem import Terms
from refimpl.model.slopes import Slopes
from refimpl.scene.discretise import discretise
from verification.exact.dense_influence import DenseInfluence
from verification.exact.kernel_reference import normal, tangential
from verification.solver_suite import own, reference_solution
from verification.solver_suite.check import COMPLIANCE, MODULUS, Entrant, Fault
from verification.solver_suite.command import Command
from verification.solver_suite.faulty_solvers.table import FAULTY, Faulty, asked, periodic
from verification.solver_suite.gaps import rough_bump
from verification.solver_suite.isolated import Limited
from verification.solver_suite.protocol import Abilities, Answer, ContactProblem, Contestant, Coupling
from verification.solver_suite.suite import run, select, suite

FINE = (Fault.SINGLE_PRECISION, Fault.ABSOLUTE_THRESHOLD)
"""Faults below the laxest claim."""
SOURCE = Path(__file__).with_name("contestant.c")


def naming(fault: Fault) -> list[str]:
    """Ids of the checks that name a fault."""
    return [check.id for check in suite() if fault in check.catches]


def test_our_own_solver_passes_every_case_but_those_of_the_designs() -> None:
    """`contestants/own-solver` of the quick tier, which runs here as well, has those too."""
    posed: list[ContactProblem] = []

    def counting(problem: ContactProblem) -> Answer:
        posed.append(problem)
        return own.solve(problem)

    contestant = Limited(counting, own.solve.abilities)
    assert len(suite()) >= 40
    for check in suite():
        if "/design-" in check.id:
            continue
        posed.clear()
        result = check.case(contestant).run()
        assert result.status == "pass", result
        assert result.unit, f"{check.slug}: a number without its unit"
        assert 1 <= len(posed) <= 6
        assert max(problem.M for problem in posed) <= 512


@pytest.mark.parametrize("name", ["periodic-elimination", "periodic-approach"])
def test_a_periodic_mean_that_is_off_is_an_error(name: str) -> None:
    """It stores no energy, so nothing but the mean itself shows it."""

    def lifted(asked: ContactProblem) -> np.ndarray:
        pressure = np.array(own.solve(asked).pressure)
        return pressure + 1e-3 * pressure.mean() if asked.periodic else pressure

    (result,) = run(Limited(lifted, own.solve.abilities), [f"contestant/{name}"])
    assert result.error == pytest.approx(1e-6 / 1e-8, rel=1e-3)
    assert result.status == "fail"


def test_the_dense_reference_passes_what_is_small_enough() -> None:
    names = ["pins", "wide-pins", "sheared-pins*", "periodic-sheared-*", "hertz-peak", "sliding-residual"]
    results = {r.id.partition("/")[2]: r for r in run(own.dense, [f"contestant/{name}" for name in names])}
    too_large = {name for name, r in results.items() if r.status != "pass"}
    assert len(results) == 8
    assert too_large == {"hertz-peak", "wide-pins"}
    assert results["hertz-peak"].note == "the solver does not offer: 32 elements along one axis"


def test_every_fault_is_named_and_described() -> None:
    for check in suite():
        assert all(fault in check.case(own.solve).claim for fault in check.catches)
        assert len(check.tolerance_reason) > 10
    assert [fault for fault in Fault if not naming(fault)] == []


@pytest.mark.parametrize("fault", FAULTY, ids=str)
def test_a_faulty_solver_fails_wherever_its_fault_is_named(fault: Fault) -> None:
    results = run(FAULTY[fault](), naming(fault))
    assert {r.id: r.status for r in results} == dict.fromkeys(naming(fault), "fail")


@pytest.mark.parametrize("fault", [f for f in FAULTY if f not in FINE], ids=str)
def test_the_laxest_claim_lets_no_faulty_solver_through(fault: Fault) -> None:
    lax = Limited(FAULTY[fault](), replace(own.solve.abilities, precision=1e-6))
    assert any(run(lax, [name])[0].status == "fail" for name in naming(fault))


@pytest.mark.parametrize("precision", [1e-10, 3e-7])
def test_a_solver_is_held_to_the_precision_that_it_states(precision: float) -> None:
    entrant = Entrant(Limited(own.solve, replace(own.solve.abilities, precision=precision)))
    assert entrant.claim == precision


def test_single_precision_that_says_so_is_held_to_what_it_says() -> None:
    noisy = naming(Fault.SINGLE_PRECISION)
    honest = Limited(FAULTY[Fault.SINGLE_PRECISION](), replace(own.solve.abilities, precision=1e-6))
    assert {r.status for r in run(honest, noisy)} == {"pass"}


def test_the_periodic_problem_solved_silently_is_seen_by_its_peak() -> None:
    gap = rough_bump(32, seed=70)
    entrant, silent = Entrant(own.solve), Entrant(Faulty(asked(periodic)))
    peaks = [e.press(gap, 1.0, load=0.05 * MODULUS).pressure.max() for e in (entrant, silent)]
    assert 0.005 < abs(peaks[1] / peaks[0] - 1) < 0.1  # a few per cent, as in the published case
    assert {r.status for r in run(silent.contestant, ["contestant/surroundings"])} == {"fail"}


@pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")
def test_a_program_in_c_passes_what_applies_to_it(tmp_path: Path) -> None:
    program = tmp_path / "contestant"
    subprocess.run(["cc", "-O2", "-Wall", "-Werror", "-o", program, SOURCE, "-lm"], check=True)
    able = Abilities.named("aperiodic,load,approach", largest=32)
    results = run(Command((str(program),), able, timeout=60.0))
    verdicts = {r.id: r.status for r in results}
    assert {r.id: r for r in results if r.status in ("fail", "error")} == {}
    assert sum(status == "pass" for status in verdicts.values()) >= 20
    assert verdicts["contestant/westergaard-load"] == verdicts["contestant/sheared-pins"] == "unavailable"


def test_an_empty_selection_is_refused() -> None:
    with pytest.raises(LookupError, match="hertz-peek"):
        select(["contestant/hertz-peek"])


def problem(coupling: Coupling | None = None) -> ContactProblem:
    gap = rough_bump(5, seed=71)
    return ContactProblem(gap - gap.min(), 0.2, MODULUS, load=0.05 * MODULUS, coupling=coupling)


def test_the_referees_displacement_is_the_sum_over_elements() -> None:
    coupling = Coupling(0.02 * MODULUS, 0.3, COMPLIANCE, sliding_direction=1.1)
    posed, f = problem(coupling), np.random.default_rng(72).uniform(0, 1, (5, 5)) * 1e-2 * MODULUS
    f[2, 3] = 0.0
    u = mp.mpf(0)
    for i, j in np.ndindex(5, 5):
        x, y, h = (1 - i) * 0.2, (4 - j) * 0.2, 0.2
        r = coupling.tau * (f[i, j] > 0) + coupling.beta * f[i, j]
        along = mp.cos(1.1) * tangential(x, y, h, h) + mp.sin(1.1) * tangential(y, x, h, h)
        u += f[i, j] * normal(x, y, h, h) / (mp.pi * MODULUS) + r * COMPLIANCE * along
    assert abs(reference_solution.displacement(posed, f)[1, 4] / float(u) - 1) < 1e-13


@pytest.mark.parametrize("coupling", [None, Coupling(0.0, 0.4, COMPLIANCE, 0.5)], ids=["still", "sliding"])
def test_the_energy_norm_error_is_bounded_by_the_gap(coupling: Coupling | None) -> None:
    posed = problem(coupling)
    exact, random = reference_solution.eliminated(posed), np.random.default_rng(73)
    for size in (1e-6, 1e-3, 0.3):
        f = np.abs(exact * (1 + size * random.standard_normal(exact.shape)))
        f += size * exact.max() * (random.random(exact.shape) < 0.2)
        f *= exact.sum() / f.sum()
        found = reference_solution.residual(posed, f)
        assert found.balance < 1e-14
        scale = reference_solution.energy(posed, exact) / reference_solution.energy(posed, f)
        assert 0 < reference_solution.misfit(posed, f, exact) * scale <= found.gap
    assert reference_solution.residual(posed, exact).worst < 1e-13


def test_elimination_agrees_with_our_dense_reference() -> None:
    for posed in (problem(), replace(problem(), load=None, approach=0.08), replace(problem(), periodic=True)):
        found = rf.solve(own.scene(posed), posed.M, method="dense", oblique=False, approach=posed.approach)
        np.testing.assert_allclose(
            reference_solution.eliminated(posed), found.pressure, atol=1e-9 * found.max_pressure
        )


@pytest.mark.parametrize("length", [1.0, 1e-7])
def test_elimination_takes_back_what_it_dropped_too_much(length: float) -> None:
    # On this plane two rounds of it are needed: without them elements would penetrate.
    gap = np.random.default_rng(0).uniform(0, length, (8, 8))
    posed = ContactProblem(gap - gap.min(), 0.2, MODULUS, approach=-0.02 * length, periodic=True)
    assert reference_solution.residual(posed, reference_solution.eliminated(posed)).worst < 1e-13


def test_an_element_left_out_is_seen_by_its_penetration() -> None:
    for posed in (problem(), replace(problem(), load=None, approach=0.08)):
        exact = reference_solution.eliminated(posed)
        others = exact > 0
        others[np.unravel_index(np.argmin(np.where(others, exact, np.inf)), exact.shape)] = False
        f, _ = reference_solution._Elimination(posed).on(others.ravel())
        found = reference_solution.residual(posed, f.reshape(exact.shape))
        assert found.balance < 1e-13
        assert found.gap > 1e-5


def test_the_approach_of_a_state_is_counted_as_the_problem_counts_it() -> None:
    for repeats, approach in ((False, 0.08), (True, -0.02)):
        posed = replace(problem(), load=None, approach=approach, periodic=repeats)
        assert reference_solution.approach_of(posed, reference_solution.eliminated(posed)) == pytest.approx(
            approach, rel=1e-12
        )


def test_pressures_without_energy_cannot_be_judged() -> None:
    nothing: Contestant = Limited(lambda p: np.zeros_like(p.gap), Abilities())
    statuses = {r.id: r.status for r in run(nothing)}
    assert "pass" not in {s for name, s in statuses.items() if name != "contestant/no-tension"}
    assert statuses["contestant/no-tension"] == "error"


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

        found = run(Limited(too_high, own.solve.abilities), [f"contestant/{name}" for name in names])
        return {result.status for result in found}

    assert statuses(kept) == {"pass"}
    assert statuses(missed) == {"fail"}


SYMMETRIC = {"no-tension", "mirrors", "transposition", "periodic-shift", "periodic-tiling"}
SYMMETRIC |= {"sliding-reversed", "identical-materials"}
"""What a uniform pressure has of a right answer."""
NONSENSE = {
    "huge": lambda p: np.full_like(p.gap, 1e308),
    "infinite both ways": lambda p: np.where(np.indices(p.gap.shape).sum(axis=0) % 2, 1e308, -1e308),
    "large": lambda p: np.full_like(p.gap, 1e58),
    "tiny": lambda p: np.full_like(p.gap, 5e-324),
    "nothing": lambda p: np.zeros_like(p.gap),
    "cancelling": lambda p: np.where(np.indices(p.gap.shape).sum(axis=0) % 2, 1.0, -1.0),
    "pulling": lambda p: -np.ones_like(p.gap),
}


SOME = [check.id for check in suite() if not re.search(r"/design-(?!tiny).*[1-9]$", check.id)]
"""All cases, of the designs the tiny problems and every tenth: they are judged by one function."""


@pytest.mark.parametrize("answer", NONSENSE.values(), ids=NONSENSE)
def test_nonsense_passes_nothing_but_symmetries_and_warns_of_nothing(answer: Contestant) -> None:
    """Energies and sums overflow or vanish: infinity over infinity is no proof that two answers agree."""
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        results = run(Limited(answer, own.solve.abilities), SOME)
    passed = {r.id.partition("/")[2] for r in results if r.status == "pass"}
    assert passed <= SYMMETRIC
    assert [str(w.message) for w in warned] == []


def test_what_the_suite_counts_at_an_approach_is_at_most_three_times_our_certificates() -> None:
    """Whatever the pressures: what our adapter's `WORK` rests on, and no more than it takes."""
    posed = replace(problem(), load=None, approach=0.08)
    exact = reference_solution.eliminated(posed)
    draw, ratios = np.random.default_rng(5), []
    scene = own.scene(posed)
    judged = discretise(scene, scene.grid(posed.M), Terms(oblique=False), posed.approach)
    for _ in range(200):
        off = exact * draw.normal(size=exact.shape) + draw.uniform(-0.5, 0.5) * exact
        pressure = np.maximum(exact + 10 ** draw.uniform(-6, 0) * off, 0.0)
        slopes = Slopes.flat(exact.shape)
        state = certify(judged, DenseInfluence(judged.grid, 0.0), pressure, 0 * pressure, slopes)
        ours = max(state.certificate.gap, state.certificate.load_error)
        ratios.append(reference_solution.residual(posed, pressure).gap / ours)
    assert max(ratios) <= own.WORK * (1 + 1e-6)
    assert max(ratios) >= 0.8 * own.WORK


@pytest.mark.parametrize("light", [0.001, 0.01, 0.05])
def test_a_load_that_is_missed_alone_is_seen(light: float) -> None:
    """One of three loads is borne to 1e-4 too much: 1e4 times the claim of 1e-8."""

    def solver(problem: ContactProblem) -> Array:
        missed = problem.load is not None and np.isclose(problem.load, light * MODULUS)
        answer = own.solve(problem)
        return np.asarray(answer.pressure) * (1.0001 if missed else 1.0)

    (result,) = run(Faulty(solver), ["contestant/load-balance"])
    assert result.status == "fail"
    assert result.value == pytest.approx(1e4, rel=1e-3)
