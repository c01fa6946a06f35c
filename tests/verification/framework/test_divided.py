"""One run of the full tier holds the cases of every committed file of cases, and is divided among them."""

from __future__ import annotations

import pytest

from verification.framework.case import Tier
from verification.framework.divided import part, patterns
from verification.framework.registry import load, select
from verification.output.result_files import FOLDER, committed

ROWS = patterns((FOLDER / "README.md").read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", ROWS)
def test_a_committed_file_is_its_part_of_a_run(name: str) -> None:
    found = committed(name)
    other = {"id": "other/case", "status": "pass", "seconds": 1.0}
    whole = {**found, "cases": [other, *found["cases"]]}
    assert part(whole, ROWS[name])["cases"] == found["cases"]
    assert part(whole, ROWS[name])["counts"] == found["counts"]


def test_a_row_without_a_case_is_refused() -> None:
    with pytest.raises(LookupError, match="nothing"):
        part(committed("validation"), ["nothing/*"])


def test_every_case_of_the_full_tier_has_a_file() -> None:
    globs = [glob for row in ROWS.values() for glob in row]
    full = {case.id for case in select(load(), Tier.FULL, ())}
    quick = {case.id for case in select(load(), Tier.QUICK, ())}
    assert {case.id for case in select(load(), Tier.FULL, globs)} >= full - quick
