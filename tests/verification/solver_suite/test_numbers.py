"""Numbers beside the pressures: right ones pass, in every kind of problem; wrong ones fail the case."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from refimpl.grid import Array
from verification.solver_suite import numbers, own, reference_solution
from verification.solver_suite.design import posed, rows
from verification.solver_suite.isolated import Limited, run
from verification.solver_suite.protocol import (
    NUMBERS,
    Answer,
    BadAnswer,
    ContactProblem,
    Coupling,
    ask,
)
from verification.solver_suite.suite import run as run_here

HEIGHTS = np.random.default_rng(81).uniform(0, 1e-6, (9, 7))
FREE = ContactProblem(HEIGHTS - HEIGHTS.min(), 1e-6, 1e9, load=1e-4)
SQUARE = replace(FREE, gap=np.zeros((3, 3)))
SLIDING = Coupling(tau=0.0, beta=0.7, shear_compliance=0.3 / (np.pi * 1e9), sliding_direction=1.1)
KINDS = {
    "free": FREE,
    "at an approach": replace(FREE, load=None, approach=3e-7),
    "periodic": replace(FREE, periodic=True),
    "periodic, at an approach": replace(FREE, load=None, approach=-3e-7, periodic=True),
    "sliding": replace(FREE, coupling=SLIDING),
    "oblong": replace(FREE, spacing_y=1.7e-6),
}


def numbers_of(problem: ContactProblem, f: Array) -> dict[str, float]:
    """By definition, from dense matrices or exact symbols."""
    return {
        "approach": reference_solution.approach_of(problem, f),
        "contact_area": float((f > 0).sum()) * problem.element_area,
        "mean_displacement": float(reference_solution.displacement(problem, f).mean()),
    }


@pytest.mark.parametrize("problem", KINDS.values(), ids=KINDS)
def test_numbers_of_the_solution_agree_with_pressures_that_just_meet_the_claim(
    problem: ContactProblem,
) -> None:
    """The numbers of the exact pressures beside others, as far off as the claim allows."""
    exact, random = reference_solution.eliminated(problem), np.random.default_rng(82)
    right = numbers_of(problem, exact)
    del right["contact_area"]
    for _ in range(20):
        off = np.where(exact > 0, random.standard_normal(exact.shape), 0.0) * exact.max()
        if problem.load is not None:
            off -= np.where(exact > 0, off[exact > 0].mean(), 0.0)
        allowed = problem.tolerance * reference_solution.energy(problem, exact) / 2
        size = (allowed / reference_solution.energy(problem, off)) ** 0.5
        found = np.maximum(exact + size * off, 0.0)
        assert numbers.wrong(problem, Answer(found, True, **right)) == []
        assert numbers.wrong(problem, Answer(found, True, **numbers_of(problem, found))) == []


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("problem", KINDS.values(), ids=KINDS)
def test_a_number_a_thousandth_off_is_wrong(problem: ContactProblem, name: str) -> None:
    f = reference_solution.eliminated(problem)
    right = numbers_of(problem, f)[name]
    off = problem.element_area if name == "contact_area" else 1e-3 * float(np.ptp(problem.gap))
    for wrong in (right + off, right - off):
        (sentence,) = numbers.wrong(problem, Answer(f, True, **{name: wrong}))
        assert sentence.startswith(name.replace("_", " "))


def test_where_nothing_touches_area_and_displacement_are_zero() -> None:
    apart = replace(FREE, load=None, approach=-1e-7)
    nothing = np.zeros(apart.shape)
    right = Answer(nothing, True, approach=-1e-7, contact_area=0.0, mean_displacement=0.0)
    assert numbers.wrong(apart, right) == []
    for wrong in ({"approach": 1e-7}, {"contact_area": apart.element_area}, {"mean_displacement": 1e-9}):
        assert len(numbers.wrong(apart, Answer(nothing, True, **wrong))) == 1


def test_the_approach_at_a_hardness_is_that_of_the_elements_below_it() -> None:
    row = next(row for row in rows()["capped"] if row["borders"] == "free" and row["control"] == "load")
    problem = posed(row, 1, 1e-8)
    answer = own.solve(problem)
    f, v = np.asarray(answer.pressure), None
    assert problem.hardness is not None
    assert numbers.wrong(problem, answer) == []
    v = reference_solution.displacement(problem, f) + problem.gap
    below = (f > 0) & (f < 0.999 * problem.hardness)
    assert answer.approach == pytest.approx(float(v[below].mean()), rel=1e-4)
    (sentence,) = numbers.wrong(problem, replace(answer, approach=1.01 * float(answer.approach or 0.0)))
    assert sentence.startswith("approach")


@pytest.mark.parametrize("wrong", [np.nan, np.inf, "1e-6", True, np.array([1e-6])])
def test_what_is_no_number_is_a_bad_answer(wrong: object) -> None:
    with pytest.raises(BadAnswer, match="expected a finite number, or None"):
        ask(lambda p: Answer(p.gap, True, approach=wrong), SQUARE)  # type: ignore[arg-type]


def halved(problem: ContactProblem) -> Answer:
    answer = own.solve(problem)
    return replace(answer, approach=0.5 * float(answer.approach or 0.0))


def halving() -> Limited:
    return Limited(halved, own.solve.abilities)


def test_numbers_come_back_from_another_process() -> None:
    (found,) = run(halving, ["solver/hertz-load"], timeout=60.0)
    assert found.status == "fail"
    assert "approach" in found.note
    assert run_here(own.solve, ["solver/hertz-load"])[0].status == "pass"


@pytest.mark.parametrize(("share", "error"), [(1.0, None), (1.01, pytest.approx(1e-2 / 1e-8))])
def test_pressures_are_judged_before_the_numbers_beside_them(share: float, error: float | None) -> None:
    def solver(problem: ContactProblem) -> Answer:
        answer = halved(problem)
        return replace(answer, pressure=share * np.asarray(answer.pressure))

    (found,) = run_here(Limited(solver, own.solve.abilities), ["solver/load-balance"])
    assert (found.status, found.error) == ("fail", error)
    assert "m: its pressures give" in found.note
    assert found.note.startswith("approach" if error is None else "loads asked (N) [")


def test_a_wrong_number_is_reported_with_its_unit() -> None:
    """Three elements of 1 um^2, and half of one."""
    answer = Answer(np.where(np.sort(HEIGHTS, axis=None)[2] >= HEIGHTS, 1.0, 0.0), True, contact_area=1e-12)
    assert numbers.wrong(FREE, answer) == ["contact area 1e-12 m^2: its pressures give 3e-12 +- 5e-13 m^2"]
