"""The house's layers: which package may import which. Read from the source, so lazy imports count as well."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from tests.layers import FILES, PACKAGES, ROOT, attribute_reads, closure, imported_names, modules, room, uses

ALLOWED: dict[str, set[str]] = {
    "refimpl": set(),
    "appendix_a": set(),
    "reports": {"verification.output.result_files", "verification.reproduction.printed"},
    "verification": {"refimpl", "appendix_a"},
    "verification/cli": {"refimpl", "appendix_a", "verification", "reports"},
    "verification/output": {"refimpl"},
}
"""Packages, and single modules of them: the report shares the form of result files with their writers, and
the paper's printed numbers with the cases."""


def imported(source: str) -> Iterator[tuple[int, str]]:
    """Line and module of every import of a package of ours, wherever in the file it stands."""
    calls = (node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Call))
    loaded = (c for c in calls if getattr(c.func, "attr", getattr(c.func, "id", "")) == "import_module")
    names = [(c.lineno, a.value) for c in loaded for a in c.args if isinstance(a, ast.Constant)]
    for line, name in [*imported_names(source), *names]:
        if name.partition(".")[0] in (*PACKAGES, "tests", "a relative import"):
            yield line, name


def layer(path: Path) -> str:
    """The row of ALLOWED that a file belongs to."""
    parts = path.relative_to(ROOT).parts
    room = "/".join(parts[:2])
    return room if room in ALLOWED else parts[0]


def breaches(path: Path, source: str) -> list[str]:
    row = layer(path)
    allowed = ALLOWED[row] | {row.replace("/", ".")}
    return [
        f"{path.name}:{line} imports {module}"
        for line, module in imported(source)
        if not any(f"{module}.".startswith(f"{name}.") for name in allowed)
    ]


@pytest.mark.parametrize("package", PACKAGES)
def test_imports_follow_the_layers(package: str) -> None:
    files = [path for path in FILES if path.relative_to(ROOT).parts[0] == package]
    assert files
    assert [b for path in files for b in breaches(path, path.read_text(encoding="utf-8"))] == []


@pytest.mark.parametrize(
    ("place", "source"),
    [
        ("refimpl/x.py", "def f():\n    from appendix_a import wedge"),
        ("appendix_a/x.py", "from refimpl.grid import Grid"),
        ("reports/x.py", "import importlib\nimportlib.import_module('verification.framework.case')"),
        ("verification/runner.py", "from reports.generator import render"),
        ("reports/x.py", "from verification.output.provenance import provenance"),
        ("refimpl/x.py", "from verification.output.result_files import read_result"),
        ("verification/cli/x.py", "from tests import conftest"),
        ("verification/x.py", "from . import case"),
    ],
)
def test_the_rule_sees_a_breach(place: str, source: str) -> None:
    assert breaches(ROOT / place, source)


def test_what_the_rule_allows() -> None:
    """Writers of result files import their form; the command line imports reports."""
    assert not breaches(ROOT / "reports/x.py", "from verification.output.result_files import read_result")
    assert not breaches(ROOT / "verification/cli/report.py", "from reports.generator import render")


# The rooms of refimpl: a module may import its own room and those of lower floors, and no other of its floor.
FLOORS = (
    {"errors", "plain", "operating_system"},
    {"grid", "kernels"},
    {"model", "surfaces", "operators"},
    {"scene", "measured", "planning", "accuracy", "solvers", "half_space", "bounds"},
    {"solution"},
    {"driver"},
    {"sensitivities"},
    {"identification"},
)
FLOOR = {name: level for level, rooms in enumerate(FLOORS) for name in rooms}
REFIMPL = [name for name in modules("refimpl") if name != "refimpl"]


def may_import(importer: str, imported: str) -> bool:
    own, other = room(importer), room(imported)
    return own == other or FLOOR[other] < FLOOR[own]


def test_rooms_import_lower_floors_only() -> None:
    assert {room(name) for name in REFIMPL} == set(FLOOR)
    used = [(name, other) for name in REFIMPL for other in uses(name, "refimpl")]
    assert [pair for pair in used if not may_import(*pair)] == []
    assert not may_import("refimpl.solvers.paper", "refimpl.scene.scene")
    assert not may_import("refimpl.model.problem", "refimpl.operators.fft")
    assert may_import("refimpl.solution.limits", "refimpl.scene.scene")


@pytest.mark.parametrize("package", ["refimpl", "verification"])
def test_no_file_imports_itself_through_others(package: str) -> None:
    circles = [
        name for name in modules(package) for used in uses(name, package) if name in closure(used, package)
    ]
    assert circles == []


def test_the_command_line_is_imported_by_the_cases_that_check_it_alone() -> None:
    users = {name for name in modules("verification") if room(name) != "cli"}
    users = {name for name in users if any(room(other) == "cli" for other in uses(name, "verification"))}
    assert users <= {"verification.start", "verification.cases.error_bars.planning"}


def test_solvers_see_a_problem_alone() -> None:
    others = {"scene", "planning", "solution", "surfaces", "driver"}
    solvers = [name for name in REFIMPL if room(name) == "solvers"]
    assert [name for name in solvers if others & {room(other) for other in closure(name)}] == []


def test_the_plain_reference_shares_nothing_with_what_it_judges() -> None:
    """It imports numpy alone, in a Python that has nothing else, and only the driver imports it."""
    assert closure("refimpl.plain") <= {"refimpl.plain"}
    assert [n for n in REFIMPL if "refimpl.plain" in uses(n, "refimpl")] == ["refimpl.driver.reference"]
    others = (path for package in PACKAGES[1:] for path in (ROOT / package).rglob("*.py"))
    assert not [path for path in others if "refimpl.plain" in path.read_text(encoding="utf-8")]
    code = f"""
import sys
before = set(sys.modules)
sys.path.insert(0, {str(Path(np.__file__).parents[1])!r})
import numpy, numpy.typing
kept = {{name.partition(".")[0] for name in set(sys.modules) - before}}
class OnlyNumpy:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] not in kept | sys.stdlib_module_names:
            raise ImportError(name)
sys.meta_path.insert(0, OnlyNumpy())
import runpy
plain = runpy.run_path({str(ROOT / "refimpl" / "plain.py")!r})
z = numpy.zeros((3, 3))
assert plain["solve"](z, z, (1.0, 1.0), (1e9, 0.3), (1e9, 0.3), 0.0, 0.1, load=1.0).ended == "converged"
"""
    subprocess.run([sys.executable, "-I", "-S", "-c", code], check=True)


def test_the_plain_reference_is_one_page() -> None:
    lines = (ROOT / "refimpl" / "plain.py").read_text(encoding="utf-8").splitlines()
    assert sum(bool(line.strip()) for line in lines) <= 215


def test_importing_refimpl_loads_no_package_of_scipy() -> None:
    """SciPy loads each of its packages at its first use; all take twice our own code's time."""
    code = "import sys, scipy, refimpl; print(*(f'scipy.{m}' in sys.modules for m in scipy.__all__))"
    done = subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT, capture_output=True, text=True)
    assert set(done.stdout.split()) == {"False"}


JUDGES = ("refimpl.model.certificate", "refimpl.bounds.proven_bounds", "refimpl.solution.limits")


def test_judges_take_problem_and_state() -> None:
    judges = [*JUDGES, *(name for name in REFIMPL if room(name) == "accuracy")]
    assert [name for name in judges if "refimpl.solution.solution" in closure(name)] == []


def test_a_solution_is_built_once() -> None:
    sources = {n: path.read_text(encoding="utf-8") for n, path in modules("refimpl").items()}
    builds = [n for n, text in sources.items() if re.search(r"(?<!class )(?<![\w.])Solution\(", text)]
    assert builds == ["refimpl.solution.solution"]
    assert [n for n, text in sources.items() if re.search(r"replace\((solution|solved),", text)] == []


@pytest.mark.parametrize(
    ("attributes", "allowed"),
    [
        (
            {"normal_compliance", "shear_compliance"},  # multiplied in one module
            {"model.materials", "model.elasticity", "half_space.influence_error_3d"},
        ),
        ({"tau", "beta"}, {"model.friction", "plain", "scene.scene_file", "scene.parameters"}),
    ],
)
def test_few_modules_read_an_attribute(attributes: set[str], allowed: set[str]) -> None:
    readers = {name for name in REFIMPL if attribute_reads(name, "refimpl", attributes)}
    assert readers <= {f"refimpl.{name}" for name in allowed}


ASK_THE_GRID = {"grid", "operators", "scene", "surfaces", "measured", "plain"}


def test_shapes_and_topology_come_from_the_grid() -> None:
    pattern = r"M \* M|\(M, M\)|M\*\*2|\bif [\w.]*periodic\b|\bif not [\w.]*periodic\b"
    sources = modules("refimpl")
    others = [name for name in REFIMPL if room(name) not in ASK_THE_GRID]
    assert [n for n in others if re.search(pattern, sources[n].read_text(encoding="utf-8"))] == []
