"""Adapters: each code that is installed solves the problem it is given; one that is not says so.

What a code does when it is set up wrongly is shown here too, and that the suite fails it then.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest

from verification.adapters import aspher, contactmechanics, negative_controls, slippy, table, tamaas
from verification.adapters.published_code import PublishedAnswer, PublishedCode, closure
from verification.benchmarks.problems import problem
from verification.framework.case import Unavailable
from verification.solver_suite import gaps, reference_solution, suite
from verification.solver_suite.own import solve as own
from verification.solver_suite.protocol import Abilities, ContactProblem, ask

PUBLISHED = (tamaas.solve, contactmechanics.solve, aspher.solve)
SPHERE = problem("smooth", 128, 1e-8)
"""Table 1's paraboloid on a flat."""
TINY = problem("smooth", 4, 1e-8)


def needs(code: PublishedCode) -> pytest.MarkDecorator:
    return pytest.mark.skipif(code.installed is None, reason=f"{code.distribution} is not installed")


BUMP, WAVE = gaps.rough_bump(24, 1) * 1e-3, gaps.waves(24, 3, shortest=8) * 1e-6
SMALL: dict[str, tuple[Any, dict[str, Any]]] = {
    "free": (BUMP, {"load": 20.0}),
    "free, light": (BUMP, {"load": 0.5}),
    "free, approach": (BUMP, {"approach": 1e-4}),
    "free, punch": (0 * BUMP, {"load": 1.0}),
    "periodic": (WAVE, {"load": 1.0, "periodic": True}),
    "periodic, light": (WAVE, {"load": 1e-3, "periodic": True}),
    "periodic, approach": (WAVE, {"approach": -1e-6, "periodic": True}),
    "periodic, nearly full": (WAVE, {"approach": -1e-7, "periodic": True}),
    "periodic, pressed flat": (WAVE, {"load": 200.0, "periodic": True}),
}
"""Small problems in SI units, two of them lopsided."""


def small(name: str, **other: Any) -> ContactProblem:
    gap, control = SMALL[name]
    return ContactProblem(gap - gap.min(), 1e-3 / len(gap), 2e9, **control, **other)


CANNOT = {
    ("tamaas", "free, approach"): "an approach in free space",
    ("tamaas", "free, punch"): "did not converge",  # its error is relative to the heights: there are none
    ("aspher", "free, approach"): "approach",
    ("aspher", "periodic, approach"): "approach",
    ("aspher", "periodic, nearly full"): "approach",
}


@pytest.mark.parametrize("name", SMALL)
@pytest.mark.parametrize("code", [pytest.param(p, marks=needs(p), id=p.extra) for p in PUBLISHED])
def test_code_meets_the_tolerance_or_refuses(code: PublishedCode, name: str) -> None:
    posed = small(name)
    if (code.extra, name) in CANNOT:
        with pytest.raises(Exception, match=CANNOT[code.extra, name]):
            ask(code, posed)
        return
    pressure = np.asarray(ask(code, posed).pressure)
    # adapters derive their tolerances from bounds of mechanics, so the recomputed residual must comply
    assert reference_solution.residual(posed, pressure).worst <= posed.tolerance
    np.testing.assert_allclose(pressure, np.asarray(own(posed).pressure), atol=1e-4 * pressure.max(), rtol=0)


@pytest.mark.parametrize("code", [pytest.param(p, marks=needs(p), id=p.extra) for p in PUBLISHED])
def test_code_gives_table_1_in_free_space(code: PublishedCode) -> None:
    answer = code(SPHERE)
    # 166.2417 MPa: all four codes at 128 x 128; the periodic problem has 171.0454 MPa
    assert float(np.max(np.asarray(answer.pressure))) == pytest.approx(166.2417e6, rel=1e-6)
    assert answer.converged is True
    assert f"{code.installed}" in code.version


def test_pressures_that_deform_nothing_have_no_residual() -> None:
    flat = ContactProblem(np.zeros((2, 3)), 1e-6, 1e9, load=6e-3, periodic=True)
    uneven = np.full((2, 3), 1e9) * [1, 1 + 4e-16, 1]  # by rounding, and its residual is 1e16
    assert np.isnan(table.recomputed(flat, uneven))
    lone = ContactProblem(np.array([[0.0, 1e-6, 2e-6]]), 1e-6, 1e9, load=6e-3, periodic=True)
    assert table.recomputed(lone, np.array([[6e9, 0.0, 0.0]])) > 1  # a load that one element cannot carry


def test_absent_code_is_unavailable() -> None:
    absent = PublishedCode("no-such-solver", "none", "", Abilities(), lambda _: PublishedAnswer([], True))
    assert absent.version == "no-such-solver (not installed)"
    with pytest.raises(Unavailable, match=r"pip install -c constraints.txt -e '\.\[none\]' in a checkout"):
        absent(TINY)


def test_slippy_is_unavailable_without_its_interpreter(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(slippy.INTERPRETER, raising=False)
    assert slippy.solve.installed is None
    with pytest.raises(Unavailable, match="slippy is not installed: an interpreter"):
        slippy.solve(TINY)
    monkeypatch.setenv(slippy.INTERPRETER, "/no/such/python")
    assert slippy.solve.installed is None


@pytest.mark.parametrize("name", SMALL)
def test_closure_is_a_bound(name: str) -> None:
    """Where the mean gap under the pressure is `closure`, the relative gap is at most the tolerance."""
    posed = small(name)
    pressure = np.asarray(own(posed).pressure)
    mean_displacement = 2 * reference_solution.energy(posed, pressure) / (pressure.sum() * posed.element_area)
    if mean_displacement > 0:  # one periodic element under load stores no energy in the reference's symbols
        rounding = 1e-12  # an exact equality where contact is full
        assert closure(posed) / (0.5 * mean_displacement) <= posed.tolerance * (1 + rounding)


@needs(tamaas.solve)
def test_negative_control_tamaas_saturated_in_pascal_stays_at_the_uniform_pressure() -> None:
    gap = gaps.rough_bump(12, seed=71)
    posed = ContactProblem(gap - gap.min(), 1 / 12, 2e9, load=4e7, periodic=True, hardness=2e8)
    in_pascal, right = tamaas._saturated(posed, 1.0), tamaas.solve(posed)
    assert in_pascal.converged is True
    assert np.ptp(np.asarray(in_pascal.pressure)) < 1e-3 * np.ptp(np.asarray(right.pressure))


@needs(tamaas.solve)
def test_negative_control_tamaas_without_its_second_step_is_periodic() -> None:
    """`registerNonPeriodic` alone changes nothing, and nothing says so: 171.05 instead of 166.24 MPa."""
    fallen_in = negative_controls.registered_only(SPHERE)
    periodic = tamaas.solve(replace(SPHERE, periodic=True))
    assert fallen_in.converged is True
    assert float(np.max(np.asarray(fallen_in.pressure))) == pytest.approx(171.0454e6, rel=1e-6)
    np.testing.assert_allclose(
        np.asarray(fallen_in.pressure), np.asarray(periodic.pressure), rtol=0, atol=171e6 * 1e-6
    )
    assert fails(negative_controls.registered_only, "solver/hertz-peak", "solver/surroundings")


def fails(code: PublishedCode, *cases: str) -> bool:
    return [result.status for result in suite.run(code, cases)] == ["fail"] * len(cases)


def test_table_has_every_entrant_and_recomputes_residuals(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also those that are not installed, by name; residuals and seconds are of the cases that ran."""
    few = suite.select(["solver/hertz-peak", "solver/sliding-residual"])
    monkeypatch.setattr(table, "suite", lambda: few)
    entrants = cast(list[dict[str, Any]], table.measured()["entrants"])
    assert [entrant["name"] for entrant in entrants] == list(table.ENTRANTS)
    for entrant in entrants:
        if not entrant["installed"]:
            assert "(not installed)" in entrant["version"]
            continue
        if entrant["name"] == "refimpl, dense":
            assert entrant["counts"]["fail"] == entrant["counts"]["error"] == 0  # too large for it, or passed
            continue
        by_id = {row["id"]: row for row in entrant["results"]}
        peak, sliding = by_id["solver/hertz-peak"], by_id["solver/sliding-residual"]
        assert peak["status"] != "error", peak["note"]
        assert peak["seconds"] > 0
        if entrant["name"] in ("Tamaas, registered only", "SlipPY, its default in free space"):
            assert peak["status"] == "fail"
            assert peak["residual"] > 1e-3
        else:
            assert peak["status"] == "pass"
            assert 0 < peak["residual"] <= 1e-8
        assert sliding["status"] == ("pass" if entrant["role"] == "ours" else "unavailable")
