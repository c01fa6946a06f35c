"""Cases are found by themselves, in a fixed order, and never twice."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from textwrap import indent

import pytest

from verification.framework import registry
from verification.framework.case import Tier

Make = Callable[..., str]

ONE = """
@case("{id}", metric="equal", tolerance=0.0, tier="{tier}")
def {name}():
    return Measured(1.0, 1.0)
"""


def source(*ids: str, tier: str = "quick") -> str:
    return "".join(ONE.format(id=i, name=i.replace("/", "_"), tier=tier) for i in ids)


def test_all_modules_are_found_and_ordered_by_module_and_line(make_package: Make) -> None:
    package = make_package(beta=source("b/1"), alpha=source("a/2", "a/1"))
    importlib.import_module(f"{package}.beta")
    assert [c.id for c in registry.load(package)] == ["a/2", "a/1", "b/1"]


@pytest.mark.parametrize(
    "modules",
    [
        {"alpha": source("a/1"), "beta": source("a/1")},
        {"alpha": "for _ in range(2):\n" + indent(source("a/1"), "    ")},
    ],
    ids=["two modules", "a loop"],
)
def test_an_id_declared_twice_is_refused(make_package: Make, modules: dict[str, str]) -> None:
    package = make_package(**modules)
    if "beta" in modules:  # whichever module came first
        importlib.import_module(f"{package}.beta")
    with pytest.raises(ValueError, match="declared twice"):
        registry.load(package)


@pytest.mark.parametrize(
    "fault", ["import surely_not_installed\n", source("a/1").replace("equal", "close"), "(\n"]
)
def test_a_module_that_cannot_be_imported_stops_the_run(make_package: Make, fault: str) -> None:
    package = make_package(alpha=source("a/1"), beta=fault)
    with pytest.raises((ImportError, ValueError, SyntaxError)):
        registry.load(package)


FAMILY = '''
@family("factor, tolerance, tier, name",
        {"f/1": (2.0, 0.0, "quick", "two"), "f/2": (3.0, 0.5, "full", "three")},
        metric="absolute", source="this test")
def times(factor):
    """Times {name}.

    Claim: 2 times {factor:g} is twice it
    Tolerance: of the row,
    in two lines

    Remarks are no part of the declaration.
    """
    return Measured(2 * factor, 4.0)
'''


def test_a_family_declares_a_case_for_each_row(make_package: Make) -> None:
    one, two, later = registry.load(make_package(alpha=FAMILY + source("a/later")))
    assert (one.id, one.title, one.claim) == ("f/1", "Times two", "2 times 2 is twice it")
    assert (one.source, one.tolerance_reason) == ("this test", "of the row, in two lines")
    assert (two.id, two.title, two.tolerance, two.tier) == ("f/2", "Times three", 0.5, Tier.FULL)
    assert [c.run().value for c in (one, two)] == [4.0, 6.0]
    assert one.line == two.line < later.line


@pytest.mark.parametrize("fault", [FAMILY.replace("{name}", "{nome}"), FAMILY.replace("2.0, ", ""),
                                   FAMILY.replace("Claim: ", "Clain: ")])  # fmt: skip
def test_a_badly_declared_family_is_refused(make_package: Make, fault: str) -> None:
    with pytest.raises((KeyError, ValueError)):
        registry.load(make_package(alpha=fault))


def test_selection_by_tier_and_glob(make_package: Make) -> None:
    package = make_package(alpha=source("a/1", "b/1"), beta=source("a/full", tier="full"))
    cases = registry.load(package)

    def ids(tier: Tier, *globs: str) -> list[str]:
        return [c.id for c in registry.select(cases, tier, globs)]

    assert ids(Tier.QUICK) == ["a/1", "b/1"]
    assert ids(Tier.FULL) == ["a/1", "b/1", "a/full"]
    assert ids(Tier.FULL, "a/*") == ["a/1", "a/full"]
    assert ids(Tier.QUICK, "b/1", "a/*") == ["a/1", "b/1"]


@pytest.mark.parametrize("globs", [("a/full",), ("a/1", "none/*")])
def test_a_selection_without_cases_is_an_error(make_package: Make, globs: tuple[str, ...]) -> None:
    package = make_package(alpha=source("a/1"), beta=source("a/full", tier="full"))
    with pytest.raises(LookupError, match=r"none|a/full"):
        registry.select(registry.load(package), Tier.QUICK, globs)
