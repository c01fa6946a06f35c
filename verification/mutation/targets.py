"""The modules that are mutated, and the tests that judge each: ``targets.toml`` and ``judges.toml``."""

from __future__ import annotations

import ast
import re
import tomllib
from collections.abc import Iterable, Sequence
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


def near_first(
    root: Path, file: str, folders: Sequence[str], *, far: bool, names: Iterable[str] = ()
) -> tuple[str, ...]:
    """Return the tests of a file, nearest first: the mirror test, those of its folders that import it, with
    ``far`` all others that do, and the rest of the folders.

    After the mirror come those that mention one of ``names``, the most frequent mention first.
    """
    module = file.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
    area = sorted(path for folder in folders for path in (root / folder).rglob("test_*.py"))
    every = sorted((root / "tests").rglob("test_*.py")) if far else area
    importing = [path for path in every if module in imported(path.read_text(encoding="utf-8"))]
    mirrors = [path for path in area if path.name == f"test_{Path(file).stem}.py"]
    near = [path for path in importing if path in area]
    ordered = dict.fromkeys((*mirrors, *near, *importing, *area))
    said = re.compile("|".join(rf"\b_*{name}\b" for name in names) or "(?!)")
    often = {path: len(said.findall(path.read_text(encoding="utf-8"))) for path in ordered}
    by_mention = sorted(ordered, key=lambda path: (path not in mirrors, -often[path]))
    return tuple(str(path.relative_to(root)) for path in by_mention)


def definitions(source: str, changed: str) -> set[str]:
    """Return the names that hold the first line in which two sources differ: functions, classes, constants.

    Private names without their underscores, as tests may have them.
    """
    pairs = enumerate(zip(source.splitlines(), changed.splitlines(), strict=False), 1)
    line = next((number for number, (old, new) in pairs if old != new), 0)
    found: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.stmt) and node.lineno <= line <= (node.end_lineno or 0):
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                found.add(node.name)
            elif isinstance(node, ast.Assign):
                found |= {target.id for target in node.targets if isinstance(target, ast.Name)}
    return {name.strip("_") for name in found} - {""}


def imported(source: str) -> set[str]:
    """Return the names of modules that a source imports, and of what it imports from packages.

    >>> sorted(imported("import a.b\\nfrom c import d"))
    ['a.b', 'c', 'c.d']
    """
    found: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found |= {name.name for name in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module, *(f"{node.module}.{name.name}" for name in node.names)}
    return found


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
