"""The modules that are mutated, and the tests that judge each: ``targets.toml`` and ``judges.toml``."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import NamedTuple

INVARIANTS = tuple(
    f"tests/verification/properties/test_properties.py::test_invariant[{name}-{solver}]"
    for name in (
        "displacements", "load_balance", "complementarity", "local_friction_law", "area_and_peak",
        "agrees_with_the_dense_reference", "load_and_approach", "quarter_turn",
    )
    for solver in ("dense", "fft")
)  # fmt: skip
"""Invariants that recompute a state by other means, or turn it: all 25 would take three times as long."""


class Target(NamedTuple):
    """``module`` (a path) of ``subject``, and paths of the tests that judge it beside its doctests."""

    subject: str
    module: str
    tests: tuple[str, ...]

    @property
    def files(self) -> tuple[str, ...]:
        """The files that hold the tests."""
        return tuple(dict.fromkeys(test.partition("::")[0] for test in self.tests))

    @property
    def suite(self) -> tuple[str, ...]:
        """Arguments for pytest."""
        return (self.module, *self.tests)


def _read(name: str) -> tuple[Target, ...]:
    """One target for each module of each row of a table."""
    table = tomllib.loads(Path(__file__).with_name(name).read_text(encoding="utf-8"))
    return tuple(
        Target(row["subject"], module, (*row["tests"], *(INVARIANTS if row.get("invariants") else ())))
        for row in table["target"]
        for module in row["modules"]
    )


TARGETS = _read("targets.toml")
"""The numerics."""
JUDGES = _read("judges.toml")
"""What judges or reports; it has a score of its own."""
