"""Every quick case: what `make report` would fail on, `make test` fails on."""

from __future__ import annotations

from itertools import groupby

import pytest
from _pytest.mark import ParameterSet

from verification.framework import registry
from verification.framework.case import Case, Status, Tier

QUICK = registry.select(registry.load(), Tier.QUICK)
BY_MODULE = {name: list(cases) for name, cases in groupby(QUICK, key=lambda case: case.module)}

LONG = {
    "beyond_yield": 16, "capped_sphere": 14, "scheme": 13, "wedge": 10, "accuracy": 7, "kernels": 7,
    "cross_check": 6, "section8": 6, "slides": 5, "rectangles": 5, "capped": 4, "contact": 4,
    "assumptions": 4, "tau_shares": 4, "fem_answer": 4, "fem3d": 3, "hertz": 3, "iterations": 3,
    "pulled": 2, "errata": 2,
}  # fmt: skip
"""Modules that `make nightly` and `make report` run, with their seconds; their subjects have other tests."""


def _marked(module: str, cases: list[Case]) -> ParameterSet:
    name = module.rpartition(".")[2]
    return pytest.param(cases, id=name, marks=[pytest.mark.nightly] if name in LONG else [])


@pytest.mark.parametrize("cases", [_marked(module, cases) for module, cases in BY_MODULE.items()])
def test_the_cases_of_a_module_pass(cases: list[Case]) -> None:
    """In one process and in their order, for they share solutions; all of them, whichever fails."""
    results = [case.run() for case in cases]
    unavailable = {r.id: r.note for r in results if r.status == Status.UNAVAILABLE}
    assert {r.id: r.note for r in results if r.status != Status.PASS and r.id not in unavailable} == {}
    if unavailable:
        pytest.skip(f"{len(results) - len(unavailable)} passed, and not to be had here: {unavailable}")
