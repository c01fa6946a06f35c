"""The short list names the dimensions of a fault."""

from __future__ import annotations

from verification.solver_suite.design import rows
from verification.solver_suite.diagnosis import Trait, levels, short_list


def trait(slug: str, name: str) -> Trait | None:
    return (levels(slug) or {}).get(name)


SLUGS = [f"design-{name}-{n:02}" for name, design in rows().items() for n in range(1, len(design) + 1)]


def test_two_dimensions_are_named_together() -> None:
    known = {slug: levels(slug) or {} for slug in SLUGS}
    failed = {s: row["borders"] == "periodic" and row["parity"] == "even" for s, row in known.items()}
    assert short_list(failed)[0] == "parity = even and borders = periodic"


def test_a_sector_is_named() -> None:
    failed = {slug: trait(slug, "sector") == "6" for slug in SLUGS}
    assert short_list(failed)[0] == "sector = 6"


def test_no_failure_has_no_list() -> None:
    assert short_list(dict.fromkeys(SLUGS, False)) == []
    assert levels("hertz-load") is None


def test_a_threshold_is_named() -> None:
    failed = {slug: float(trait(slug, "beta") or 0.0) > 1.4 for slug in SLUGS}
    assert short_list(failed)[0] == "beta above 1.3"


def test_dimensions_count_among_the_problems_that_have_them() -> None:
    """A memory fails where one dimension changes, and here and there among the other designs."""
    failed = {slug: trait(slug, "changed") == "edge" or slug.endswith("-17") for slug in SLUGS}
    failed["design-memory-17"] = trait("design-memory-17", "changed") == "edge"
    assert short_list(failed)[0] == "changed = edge"


def test_a_dimension_of_few_problems_does_not_hide_that_of_most_failures() -> None:
    """The changed sector explains one failure: it once stood first, by a score among the memories alone."""
    failed = {slug: bool(trait(slug, "beyond the gap")) for slug in SLUGS}
    failed[next(slug for slug in SLUGS if trait(slug, "changed") == "sector")] = True
    listed = short_list(failed)
    assert listed[0] == "beyond the gap"
    assert not any("changed" in each for each in listed)


def test_a_part_that_alone_differs_from_an_earlier_problem_is_named() -> None:
    """As by operators kept by a key without the direction, whatever the design."""
    failed = {slug: bool(trait(slug, "changed direction")) for slug in SLUGS}
    assert sum(failed[slug] for slug in SLUGS if "memory" not in slug) > 20
    assert short_list(failed)[0] == "changed direction"
    assert trait("design-plain-01", "changed edges") is None
    turned = next(slug for slug in SLUGS if trait(slug, "changed") == "edge")
    assert trait(turned, "changed edges") is True
    assert trait(turned, "changed borders") is None


def test_three_dimensions_are_listed_not_three_thresholds_of_one() -> None:
    small = {slug: float(trait(slug, "pressure over E*") or 0.0) > 1.0 for slug in SLUGS}
    assert short_list(small)[0] == "pressure over E* above 0.5"
    tiny = {slug: trait(slug, "elements") == 1.0 for slug in SLUGS}
    assert short_list(tiny)[0] == "elements below 2"
    assert not any("elements" in each for each in short_list(tiny)[1:])


def test_all_problems_are_everywhere() -> None:
    assert short_list(dict.fromkeys(SLUGS, True)) == ["everywhere"]
