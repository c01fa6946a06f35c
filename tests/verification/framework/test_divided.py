"""One run of the full tier holds the cases of every committed file of cases, and is divided among them."""

from __future__ import annotations

from typing import Any

import pytest

from verification.framework.case import Tier
from verification.framework.divided import part, parts, patterns
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


@pytest.mark.parametrize("globs", [["validation/*", "nothing/*"], []])
def test_a_glob_without_a_case_is_refused(globs: list[str]) -> None:
    with pytest.raises(LookupError, match=r"nothing|without --only"):
        part(committed("validation"), globs)


def whole(**changes: Any) -> dict[str, Any]:
    """Return what the committed files were divided from."""
    cases = [case for name in ROWS for case in committed(name)["cases"]]
    return {**committed("validation"), "only": [], "cases": cases, "errata": [], **changes}


def test_no_case_has_two_files() -> None:
    found = parts(whole(), ROWS)
    assert sum(len(one["cases"]) for one in found.values()) == len(whole()["cases"])
    with pytest.raises(ValueError, match=r"two files: validation/"):
        parts(whole(), ROWS | {"again": ["validation/*"]})


@pytest.mark.parametrize("changes", [{"tier": "quick"}, {"only": ["validation/*"]}])
def test_a_run_of_less_than_the_full_tier_is_refused(changes: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match="all of the full tier"):
        parts(whole(**changes), ROWS)


@pytest.mark.parametrize(
    "row",
    [
        "| `a-b.json` | `rough-friction verify --tier full --only 'a/*' --json FILE` | a name with a dash |",
        "| `a.json` | `rough-friction verify --tier full --only 'a/*' --json OUT` | another word |",
        "| `a.json` | rough-friction verify --tier full --only 'a/*' --json FILE | no code |",
    ],
)
def test_a_row_of_the_full_tier_that_is_not_read_is_refused(row: str) -> None:
    with pytest.raises(ValueError, match="row a file"):
        patterns(row)


def test_two_rows_of_a_file_are_refused() -> None:
    row = "| `a.json` | `rough-friction verify --tier full --only 'a/*' --json FILE` | twice |"
    assert patterns(row) == {"a": ["a/*"]}
    with pytest.raises(ValueError, match="row a file"):
        patterns(f"{row}\n{row}")


def test_every_case_of_the_full_tier_has_a_file() -> None:
    globs = [glob for row in ROWS.values() for glob in row]
    full = {case.id for case in select(load(), Tier.FULL, ())}
    quick = {case.id for case in select(load(), Tier.QUICK, ())}
    assert {case.id for case in select(load(), Tier.FULL, globs)} >= full - quick
