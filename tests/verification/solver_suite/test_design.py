"""The covering design covers, and a right solver passes it."""

from __future__ import annotations

import itertools
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from refimpl.grid import Array
from verification.solver_suite import covering, own
from verification.solver_suite.checks.covering import further
from verification.solver_suite.covering import FILE, stored, text
from verification.solver_suite.design import further_rows, in_turn, posed, rows
from verification.solver_suite.dimensions import DESIGNS, FIXED, FURTHER
from verification.solver_suite.isolated import Limited
from verification.solver_suite.protocol import ContactProblem
from verification.solver_suite.suite import identity, run, select

SEARCHED = ("large", "capped")
"""Designs whose search takes a second at most."""


@pytest.mark.parametrize("name", DESIGNS | FURTHER)
def test_every_combination_of_levels_occurs(name: str) -> None:
    """All pairs, of ``triples`` all triples; but no flat periodic gap at an approach."""
    design = (DESIGNS | FURTHER)[name]
    made = stored(name, design)
    assert len(made) == len((rows() | further_rows())[name])
    for chosen in itertools.combinations(design.dimensions, design.strength):
        found = {tuple(row[each] for each in chosen) for row in made}
        assert found == set(itertools.product(*(design.dimensions[each] for each in chosen)))


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=[] if n in SEARCHED else [pytest.mark.nightly]) for n in DESIGNS | FURTHER]
)
def test_the_stored_rows_are_those_that_the_search_finds(name: str) -> None:
    assert text(name) == json.loads(FILE.read_text(encoding="utf-8"))[name]


def test_a_changed_row_changes_the_digest_of_the_suite(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One of ``--thorough`` too; those of the suite are read at its import, and are in its claims."""
    before, found = identity()["digest"], json.loads(FILE.read_text(encoding="utf-8"))
    found["plain-2"].reverse()
    (tmp_path / "changed.json").write_text(json.dumps(found))
    monkeypatch.setattr(covering, "FILE", tmp_path / "changed.json")
    for read in (further_rows, further):
        read.cache_clear()
    try:
        assert identity()["digest"] != before
    finally:
        for read in (further_rows, further):
            read.cache_clear()


QUICK = ["solver/design-tiny-*", "solver/design-memory-0*", "solver/design-capped-0*"]


@pytest.mark.parametrize(
    ("solver", "claim"),
    [(own.solve, 1e-6), (own.solve, 1e-10), (own.dense, 1e-8)],
    ids=["lax", "strict", "dense"],
)
def test_no_right_solver_fails_at_the_claim_that_it_states(solver: own.Own, claim: float) -> None:
    statuses = [r.status for r in run(Limited(solver, replace(solver.abilities, precision=claim)), QUICK)]
    assert {*statuses} <= {"pass", "unavailable"}
    assert statuses.count("pass") >= 20  # type: ignore[arg-type]  # a status is a text


def test_our_solver_claims_no_success_on_a_gap_that_strong_tau_leaves_without_solution() -> None:
    """A drawn gap; tau is the mean pressure."""
    row = FIXED | {"control": "load", "tau": 0.0, "coupling": 0.45, "elements": 8, "borders": "periodic"}
    drawn = posed(row, 0, 1e-8)
    assert drawn.coupling is not None
    assert drawn.load is not None
    strong = replace(drawn, coupling=replace(drawn.coupling, tau=drawn.load / drawn.area))
    assert not own.solve(strong).converged
    assert own.solve(replace(strong, coupling=None)).converged


def test_problems_in_turn_differ_in_one_dimension() -> None:
    for row in rows()["memory"]:
        first, second, third = in_turn(row)
        assert first == third
        changed = {name for name in {*first, *second} if second.get(name) != first.get(name)}
        assert len(changed) == 1 or changed == {"modulus", "coupling"}  # which leaves c0 as it is


def test_a_memory_is_judged_by_all_problems_in_turn() -> None:
    """The second problem of the case is solved with the first one's modulus; first and third are right."""
    number = 1 + next(n for n, row in enumerate(rows()["memory"]) if row["changed"] == "modulus")
    moduli: list[float] = []

    def with_the_first_modulus(problem: ContactProblem) -> Array:
        moduli.append(problem.reduced_modulus)
        return np.asarray(own.solve(replace(problem, reduced_modulus=moduli[0])).pressure)

    (check,) = select([f"solver/design-memory-{number:02}"])
    assert check.case(own.solve).run().status == "pass"
    assert check.case(Limited(with_the_first_modulus, own.solve.abilities)).run().status == "fail"
    assert len(moduli) == 3


def test_a_flat_periodic_gap_has_the_mean_pressure() -> None:
    (row, number) = next(
        (row, n)
        for n, row in enumerate(rows()["tiny"], start=1)
        if row["borders"] == "periodic" and not posed(row, n, 1e-8).gap.any()
    )
    (check,) = select([f"solver/design-tiny-{number:02}"])
    assert check.case(own.solve).run().status == "pass"

    def uneven(problem: ContactProblem) -> Array:
        f = np.asarray(own.solve(problem).pressure)
        return f * (1.001 if f.size == 1 else np.linspace(0.99, 1.01, f.size).reshape(f.shape))

    assert check.case(Limited(uneven, own.solve.abilities)).run().status == "fail", row
