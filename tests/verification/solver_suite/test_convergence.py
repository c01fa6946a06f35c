"""Other discretisations: right ones pass though they equal nobody, wrong limits and low orders do not."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from refimpl.grid import Array
from verification.cli import main
from verification.framework.case import Result
from verification.solver_suite import convergence, own, suite
from verification.solver_suite.check import Entrant
from verification.solver_suite.convergence import SLOW, WRONG, exit_status, of_field, weighted
from verification.solver_suite.protocol import Abilities, Answer, ContactProblem, SolverUnderTest

FREE = Abilities(periodic=False, coupling=True)
QUICK = ("other-hertz", "other-ellipse", "other-load")


def averaging(problem: ContactProblem) -> Answer:
    """Another discretisation: displacements are means over the elements, not values at the centres.

    Periodic, by conjugate gradients with projection (Polonsky and Keer 1999) in Fourier space.
    """
    (nx, ny), (hx, hy) = problem.shape, problem.spacings
    qx, qy = np.fft.fftfreq(nx, hx)[:, None], np.fft.fftfreq(ny, hy)[None, :]
    q = 2 * np.pi * np.hypot(qx, qy)
    q[0, 0] = np.inf
    symbol = 2 / (problem.reduced_modulus * q) * (np.sinc(qx * hx) * np.sinc(qy * hy)) ** 2

    def moved(f: np.ndarray) -> np.ndarray:
        return np.fft.ifft2(np.fft.fft2(f) * symbol).real

    assert problem.load is not None
    mean = problem.load / problem.area
    f, t, before, conjugate = np.full(problem.shape, mean), np.zeros(problem.shape), 1.0, 0.0
    for _ in range(500):
        v = moved(f) + problem.gap
        v -= v[f > 0].mean()
        square = float((v[f > 0] ** 2).sum())
        t = np.where(f > 0, v + conjugate * square / before * t, 0.0)
        r = moved(t)
        r -= r[f > 0].mean()
        step = float((v * t)[f > 0].sum() / (r * t)[f > 0].sum())
        f, before, conjugate = np.maximum(f - step * t, 0), square, 1.0
        new = (f == 0) & (v < 0)
        if new.any():
            f, conjugate = np.where(new, -step * v, f), 0.0
        f *= mean / f.mean()
        if square < 1e-24:
            break
    return Answer(f, True)


averaging.abilities = Abilities(aperiodic=False, approach=False)  # type: ignore[attr-defined]


def changed(how: str) -> SolverUnderTest:
    def solve(problem: ContactProblem) -> Answer:
        modulus = problem.reduced_modulus * (1.01 if how == "stiff" else 1.0)
        f = np.asarray(own.solve(replace(problem, reduced_modulus=modulus)).pressure)
        if how == "shifted":  # by half an element
            f = (f + np.roll(f, 1, axis=0)) / 2
        return Answer(f.T if how == "transposed" else f, True)

    solve.abilities = FREE  # type: ignore[attr-defined]
    return solve


def results(solver: SolverUnderTest, slugs: tuple[str, ...] = QUICK) -> list[Result]:
    return [check.case(solver).run() for check in convergence.CASES if check.slug in slugs]


def test_another_discretisation_passes_by_its_limit_and_fails_equality() -> None:
    found = results(averaging, ("other-wave",))
    assert [r.status for r in found] == ["pass"], found[0].note
    assert exit_status(found) == 0
    equal = suite.run(averaging, ["solver/periodic-elimination"])
    assert [r.status for r in equal] == ["fail"]


def test_our_own_passes_all() -> None:
    found = [check.case(own.solve).run() for check in convergence.CASES]
    assert {r.id: r.status for r in found if r.status != "pass"} == {}
    assert exit_status(found) == 0


@pytest.mark.parametrize(("how", "status"), [("stiff", WRONG), ("transposed", WRONG), ("shifted", SLOW)])
def test_a_fault_has_its_exit_status(how: str, status: int) -> None:
    found = results(changed(how), ("other-hertz",) if how == "shifted" else ("other-ellipse",))
    assert exit_status(found) == status, found[0].note


@pytest.mark.parametrize(
    ("ends", "status"),
    [
        ([], WRONG),
        ([("pass", 2.0), ("unavailable", 0.0)], 0),
        ([("unavailable", 0.0)], WRONG),
        ([("pass", 2.0), ("fail", 2.0)], WRONG),
        ([("pass", 1.19)], SLOW),  # below three fifths of the expected order
        ([("pass", 1.21)], 0),
    ],
)
def test_the_exit_status_of_a_run(ends: list[tuple[str, float]], status: int) -> None:
    made: Any = [
        SimpleNamespace(id=str(k), status=end, data={"order": order, "expected": 2})
        for k, (end, order) in enumerate(ends)
    ]
    assert exit_status(made) == status


@pytest.mark.parametrize(("falls", "error"), [(0, 0.02), (1, 0.0)])
def test_fields_that_do_not_converge_are_judged_on_the_finest_grid(falls: int, error: float) -> None:
    """Pressures of 1 with a chessboard of 2 % have the right load; it stays, or falls with the spacing."""

    def pose(_: Entrant, n: int) -> tuple[Array, Array]:
        chessboard = (-1.0) ** np.add.outer(np.arange(n), np.arange(n))
        return 1 + 0.02 * (12 / n) ** falls * chessboard, np.ones((n, n))

    found = of_field(pose)(None)  # type: ignore[arg-type]  # nobody is asked
    assert found.value == pytest.approx(error, abs=1e-12)
    assert found.data["order"] == pytest.approx(falls, abs=1e-9)


def test_a_field_weighted_by_hand() -> None:
    """Peak 10: weights 1 at 10 and 6, (3/6)^4 = 1/16 at 3, none at 0."""
    exact, found = np.array([10.0, 6.0, 3.0, 0.0]), np.array([11.0, 6.0, 3.0, 5.0])
    load, error = weighted(found, exact)
    assert load == pytest.approx(1 + 1 / (16 + 3 / 16))
    assert error == pytest.approx(np.sqrt(1 / (136 + 9 / 16)))


def test_the_command_line_judges_by_limits(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["verify", "--solver", "verification.solver_suite.own:solve", "--discretisation", "other"]
    assert main([*words, "--only", "solver/other-load", "--json", str(tmp_path / "a.json")]) == 0
    assert "over the exact load: 1.00" in capsys.readouterr().out
    document = json.loads((tmp_path / "a.json").read_text())
    assert [case["id"] for case in document["cases"]] == ["solver/other-load"]
    assert document["solver"]["low_order"] == []
    assert main([*words, "--only", "solver/pins"]) == 2
    assert main(["verify", "--discretisation", "other"]) == 2
