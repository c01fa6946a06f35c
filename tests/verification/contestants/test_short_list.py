"""The short list names the dimensions of a fault."""

from __future__ import annotations

from verification.contestants.design import rows
from verification.contestants.short_list import levels, short_list

SLUGS = [f"design-{name}-{n:02}" for name, design in rows().items() for n in range(1, len(design) + 1)]


def test_two_dimensions_are_named_together() -> None:
    known = {slug: levels(slug) or {} for slug in SLUGS}
    failed = {s: row["borders"] == "periodic" and row["parity"] == "even" for s, row in known.items()}
    assert short_list(failed)[0] == "borders = periodic and parity = even"


def test_a_sector_is_named() -> None:
    failed = {slug: (levels(slug) or {}).get("sector") == 6 for slug in SLUGS}
    assert short_list(failed)[0] == "sector = 6"


def test_no_failure_has_no_list() -> None:
    assert short_list(dict.fromkeys(SLUGS, False)) == []
    assert levels("hertz-load") is None
