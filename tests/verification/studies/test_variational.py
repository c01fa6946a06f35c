"""The variational competitor: energy, minimisers against enumeration, timing, and the committed table."""

from __future__ import annotations

import itertools
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

import refimpl as rf
from refimpl.grid import Array, Mask
from refimpl.scene.scene_file import scene_from_dict
from refimpl.solvers.paper import _Scheme
from reports.result_files import read_result
from verification.cases.paper import iterations, scheme
from verification.cases.solvers import variational
from verification.framework.case import Status, Unavailable
from verification.framework.registry import find
from verification.scenes.cross_checks import Trial, pressed
from verification.variational import __main__ as command
from verification.variational import timing
from verification.variational.energy import Energy, certified, frictionless, table2_scene
from verification.variational.minimisers import MINIMISERS, interior_point
from verification.variational.timing import (
    PAPER_GRIDS,
    Row,
    growth,
    measure,
    predicted,
    printed_growth,
    table,
    timed,
)


def energy(M: int, approach: float = 1.6e-6) -> Energy:
    return Energy(frictionless(table2_scene(), M, approach))


def by_enumeration(A: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """The complementary solution among all supports: no solver, only linear algebra and signs."""
    n = len(depth)
    for chosen in itertools.product((False, True), repeat=n):
        on = np.array(chosen)
        x = np.zeros(n)
        x[on] = np.linalg.solve(A[np.ix_(on, on)], depth[on])
        if np.all(x >= 0) and np.all(A @ x >= depth - 1e-12):
            return x
    raise AssertionError("no support is complementary")


@pytest.mark.parametrize("name", list(MINIMISERS))
def test_minimisers_against_enumeration(name: str) -> None:
    small = energy(5)
    assert 5 < len(small.depth) < 16
    exact = by_enumeration(small.matrix(), small.depth)
    assert 0 < np.count_nonzero(exact) < len(exact)
    error = np.abs(MINIMISERS[name](small).x - exact).max() / exact.max()
    assert error <= {"NNLS": 1e-13, "L-BFGS-B": 1e-5, "PIQP": 1e-5}[name]  # as in the cases, fewer unknowns


def test_matrix_and_product_are_one_operator() -> None:
    e = energy(12)
    x = np.random.default_rng(1).standard_normal(len(e.depth))
    A = e.matrix()
    assert np.array_equal(A, A.T)
    assert np.allclose(A @ x, e.apply(x), rtol=0, atol=1e-13 * np.abs(A @ x).max())
    # sum of centre coefficients: I[1/rho] of a unit square at its centre is 4 asinh(1)
    assert A[0, 0] == pytest.approx(4 * np.arcsinh(1.0), rel=1e-14)


def test_pressure_gives_the_interference_back() -> None:
    e = energy(12)
    state = certified(e.problem, e.pressure(MINIMISERS["NNLS"](e).x))
    contact = state.pressure > 0
    u = state.displacement_lower + state.displacement_upper
    assert np.allclose(u[contact], (e.approach - e.problem.gap)[contact], rtol=1e-12)
    assert state.certificate.largest <= 1e-12


def test_no_element_outside_the_interference_is_loaded() -> None:
    """Restricting the unknowns loses nothing: with all elements as unknowns the minimum is the same."""
    e = energy(12)
    everywhere = Energy(e.problem)
    everywhere.__dict__["interference"] = np.ones_like(e.interference)
    assert len(everywhere.depth) == 144 > len(e.depth)
    whole = everywhere.pressure(MINIMISERS["NNLS"](everywhere).x)
    assert np.abs(whole - e.pressure(MINIMISERS["NNLS"](e).x)).max() <= 1e-12 * whole.max()


def test_load_constraint_finds_the_approach() -> None:
    reference = rf.solve(table2_scene(), grid=16, method="dense", oblique=False)
    for assumed in (1.05, 1.5):
        found = interior_point(energy(16, assumed * reference.approach), load=70.0)
        assert found.approach * assumed == pytest.approx(1.0, abs=1e-8)


def test_missing_solver_is_unavailable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "piqp", None)
    with pytest.raises(Unavailable, match="variational"):
        interior_point(energy(5))
    assert find("variational/load-multiplier").run().status == Status.UNAVAILABLE


def test_short_calls_are_averaged() -> None:
    calls: list[int] = []

    def call() -> int:
        calls.append(sum(range(100_000)))
        return len(calls)

    result, cpu, wall = timed(call)
    assert result == len(calls) > 1
    assert cpu * len(calls) >= 0.2
    assert wall > 0


def test_budget_leaves_out_what_would_not_fit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(timing, "_SHORTEST", 0.0)
    rows = measure((8, 12), ("paper", "NNLS"), rounds=1, budget=0.0)
    assert [(row.method, row.M) for row in rows] == [("paper", 8), ("NNLS", 8)]
    assert all(row.cpu and row.pressure_error <= 1e-4 for row in rows)
    dense = Row("x", 10, 1, 1, 0.0, 0.0, {"flops at least": 1.0}, [2.0], [9.0])
    assert predicted(dense, 20) == pytest.approx(2.0 * 4**3.3)


def test_growth_and_ratios() -> None:
    def rows(name: str, power: float) -> list[Row]:
        return [Row(name, M, 1, 1, 0.0, 0.0, {}, [M ** (2 * power)], [1.0]) for M in (32, 64, 128, 256)]

    found = table(rows("paper", 1.0) + rows("NNLS", 3.0))
    assert found["growth"] == pytest.approx({"paper": 1.0, "NNLS": 3.0})
    assert found["ratio to paper"]["NNLS"]["64"] == pytest.approx(64.0**4)  # type: ignore[index]
    # Table 2: 1 h at 100, 4 days at 256
    assert printed_growth()["variational"] == pytest.approx(np.log(96) / np.log(2.56**2))
    assert growth([10, 20], [1.0, 4.0]) == pytest.approx(1.0)


def test_command_writes_the_table(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for variable in command.THREADS:
        monkeypatch.setenv(variable, "1")
    monkeypatch.setattr(timing, "_SHORTEST", 0.0)
    out = tmp_path / "table2.json"
    command.main(["--json", str(out), "--rounds", "1", "--grids", "8", "10"])
    found = read_result(out)
    assert {row["M"] for row in found["rows"]} == {8, 10}
    assert {"scene", "conditions", "provenance", "printed", "growth", "ratio to paper"} <= set(found)
    assert found["provenance"]["piqp"]


def test_committed_table_is_complete_and_accurate() -> None:
    found = read_result(variational.COMMITTED)
    by_grid: dict[int, list[dict[str, object]]] = {}
    for row in found["rows"]:
        # a time counts only with the right answer: the scheme's own tolerance allows 3.5e-4 (its cases)
        assert row["pressure_error"] <= 3.5e-4
        by_grid.setdefault(row["M"], []).append(row)
    for M in PAPER_GRIDS:
        methods = {row["method"] for row in by_grid[M]}
        assert {"paper", "paper, load", "production", "production, load", "L-BFGS-B"} <= methods
        finals = [int(str(row["final"])) for row in by_grid[M]]
        assert max(finals) - min(finals) <= 1
    assert found["provenance"]["dirty"] is False
    recorded = scene_from_dict(tomllib.loads(found["scene"]), Path())  # of all keys that there were then
    assert rf.scene_to_toml(table2_scene()) == rf.scene_to_toml(recorded)


def test_load_share_is_the_change_of_the_production_state() -> None:
    one_element = pressed(rms=2e-6, load=1e-4, friction=rf.Friction())  # its pressure is the load
    trial = Trial("", "", one_element, 17, {"oblique": False})
    assert scheme.load_share(trial) == pytest.approx(1e-4, rel=1e-9)
    assert scheme.load_share(scheme.trials()["approach"]) == 0.0


def test_trace_case_sees_an_uncorrected_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """With the residual correction switched off the case fails."""
    iterate = _Scheme._iterate

    def uncorrected(self: _Scheme, u: Array, inside: Mask, *, on_circle: bool) -> Mask:
        return iterate(self, u, inside, on_circle=True)

    monkeypatch.setattr(_Scheme, "_iterate", uncorrected)
    monkeypatch.setattr(iterations, "SCENES", ("hertz",))
    assert find("paper/periodicity-error").run().status == Status.FAIL
