"""The compact solver is right without a fault, and the campaign's faults are reproducible."""

from __future__ import annotations

import json
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

from verification.contestants import compact
from verification.contestants.campaign import run, summary
from verification.contestants.fault_error import error, probes
from verification.contestants.random_faults import COUNTED, SEEDS, random_fault
from verification.contestants.suite import suite

NAMED = [c for c in suite() if not c.slug.startswith("design-")]


def test_the_compact_solver_passes_every_case() -> None:
    """But for those with a cap, which it does not have."""
    ended = {c.slug: c.case(compact.solve).run().status for c in NAMED}
    capped = {name for name, status in ended.items() if status == "unavailable"}
    assert {name for name, status in ended.items() if status != "pass"} == capped
    assert all("cap" in name or "plastic" in name for name in capped), capped


def test_at_least_two_hundred_faults_with_their_seeds() -> None:
    faults = [random_fault(seed) for seed in SEEDS]
    assert len(faults) >= 200
    assert len({(f.effect, f.condition) for f in faults}) > 190
    assert [(f.effect, f.condition) for f in faults] == [
        (f.effect, f.condition) for f in map(random_fault, SEEDS)
    ]


def test_probes_are_of_every_kind_and_both_right_solvers_agree_on_them() -> None:
    found = list(islice(probes(), 30))  # the smallest; the campaign solves them all
    kinds = {
        (p.problem.periodic, p.problem.coupling is not None, p.problem.shape[0] != p.problem.shape[1])
        for p in found
    }
    assert {(False, True, True), (True, True, True), (False, False, False), (True, True, False)} <= kinds
    probe = found[7]
    assert probe.error(np.asarray(compact.solve(probe.problem).pressure)).peak < 1e-4


def test_an_error_is_relative_to_the_peak_and_counted_in_claims() -> None:
    """A thousandth of everything, squared, is 100 claims of 1e-8; a periodic mean adds as many."""
    probe = next(p for p in probes() if not p.problem.periodic)
    found = probe.error(1.001 * probe.exact)
    assert found.peak == pytest.approx(1e-3)
    assert found.claims == pytest.approx(100, rel=1e-6)
    periodic = next(p for p in probes() if p.problem.periodic)
    assert periodic.error(1.001 * periodic.exact).claims == pytest.approx(200, rel=1e-6)


def test_faults_have_errors() -> None:
    load = next(f for f in map(random_fault, SEEDS) if f.effect.startswith("load times"))
    assert error(load).peak > COUNTED
    reflected = next(f for f in map(random_fault, SEEDS) if f.effect == "direction reflected in x")
    assert error(reflected).peak > COUNTED


def test_a_campaign_goes_on_where_its_log_ends(tmp_path: Path) -> None:
    log = tmp_path / "log.jsonl"
    seeds = [s for s in SEEDS if random_fault(s).effect.startswith("load times")][:2]
    (first,) = run(seeds[:1], log)
    assert first["error"] > COUNTED
    assert first["caught"].startswith("design-")
    known = [first | {"effect": "kept from the log"}]
    log.write_text("".join(json.dumps(record) + "\n" for record in known), encoding="utf-8")
    stale = first | {"fault": seeds[1], "caught": None, "code": "older"}
    with log.open("a", encoding="utf-8") as file:
        file.write(json.dumps(stale) + "\n")
    records = run(seeds, log)
    assert records[1]["caught"] is not None
    assert [r["effect"] for r in records] == ["kept from the log", random_fault(seeds[1]).effect]
    assert len(log.read_text(encoding="utf-8").splitlines()) == 3


def test_the_summary_counts_and_names_survivors() -> None:
    one = {"fault": 1, "effect": "e", "condition": "c", "error": 0.5, "claims": 1e6}
    found = summary(
        [
            one | {"caught": "design-plain-01"},
            one | {"caught": None, "fault": 2},
            one | {"caught": "design-other-03"},
            one | {"error": 1e-6, "claims": 0.1, "caught": None, "fault": 3},
        ]
    )
    assert (found["counted"], found["caught"], found["caught_first"]) == (3, 2, 1)
    assert [r["seed"] for r in found["survivors"]] == [2]
    assert [r["seed"] for r in found["lesser_survivors"]] == [3]
