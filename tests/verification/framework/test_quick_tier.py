"""Quick cases, judged as `make report` does."""

from __future__ import annotations

from itertools import groupby

import pytest

from verification.framework import registry
from verification.framework.case import Case, Status, Tier

QUICK = registry.select(registry.load(), Tier.QUICK)
PARTS = [pytest.param(list(cases), id=module) for module, cases in groupby(QUICK, lambda case: case.module)]


@pytest.mark.parametrize("cases", PARTS)
def test_the_cases_of_a_module_pass(cases: list[Case]) -> None:
    """In one process and in their order, for they share solutions; all of them, whichever fails."""
    results = [case.run() for case in cases]
    unavailable = {r.id: r.note for r in results if r.status == Status.UNAVAILABLE}
    assert {r.id: r.note for r in results if r.status != Status.PASS and r.id not in unavailable} == {}
    if unavailable:
        pytest.skip(f"{len(results) - len(unavailable)} passed, and not to be had here: {unavailable}")
