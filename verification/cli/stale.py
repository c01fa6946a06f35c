"""`rough-friction verify --stale`: which committed results are older than what they judge."""

from __future__ import annotations

import argparse
import ast
import subprocess
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from importlib import resources
from pathlib import Path
from typing import Any, Literal

from reports.result_files import read_results
from verification.cli.output import columns, emit
from verification.framework.provenance import ROOT, SOURCES, sources

State = Literal["current", "stale", "unknown"]

JUDGED: Mapping[str, tuple[str, ...]] = {
    "accuracy_costs": ("refimpl", "verification/benchmarks"),
    "appendix_a": ("appendix_a",),
    "appendix_a_3d": ("appendix_a/fem3d",),
    "appendix_a_between": ("appendix_a/fem", "refimpl/data"),
    "appendix_a_fem3d": ("appendix_a",),
    "appendix_a_map": ("appendix_a/fem", "refimpl/data"),
    "appendix_correction": ("refimpl", "appendix_a"),
    "benchmarks": ("refimpl", "verification/benchmarks"),
    "chaos": ("refimpl", "verification/chaos", "verification/sweep"),
    "contestants": ("refimpl", "verification/contestants"),
    "coverage": ("refimpl", "verification/coverage"),
    "class_costs": ("refimpl", "verification/coverage"),
    "coverage_classes": ("refimpl", "verification/coverage"),
    "coverage_fresh": ("refimpl", "verification/coverage"),
    "cross_code": ("verification/adapters", "verification/contestants"),
    "extremes": ("refimpl", "appendix_a", "verification/extremes"),
    "extremes_drawn": ("refimpl", "verification/extremes"),
    "fault_matrix": ("refimpl", "appendix_a", "verification/cases", "verification/matrix"),
    "faults_by_hand": ("refimpl", "appendix_a", "verification", "tests"),
    "fuzz": ("refimpl", "verification/fuzz", "verification/sweep"),
    "identification": ("refimpl", "verification/coverage"),
    "hypothesis": ("refimpl", "verification/properties"),
    "large_grids": ("refimpl", "verification/benchmarks"),
    "model_form": ("refimpl", "appendix_a"),
    "multilevel": ("refimpl", "verification/multilevel"),
    "mutation": ("refimpl", "appendix_a", "tests"),
    "mutation_areas": ("refimpl", "appendix_a", "verification", "tests"),
    "mutation_fresh": ("refimpl", "appendix_a", "tests"),
    "mutation_judges": ("verification", "tests"),
    "named_faults": ("verification/contestants",),
    "planning": ("refimpl",),
    "priors": ("refimpl", "verification/coverage"),
    "pulled": ("refimpl",),
    "quick": ("refimpl", "appendix_a", "verification/cases"),
    "random_order": ("refimpl", "appendix_a", "verification", "tests"),
    "random_faults": ("verification/contestants",),
    "reproduction": ("refimpl",),
    "sensitivity": ("refimpl",),
    "sweeps": ("refimpl", "verification/benchmarks", "verification/sweep"),
    "table2": ("refimpl", "verification/variational"),
    "tau_shares": ("refimpl",),
    "tradeoff": ("refimpl", "verification/tradeoff"),
    "variational": ("refimpl", "verification/variational"),
}
"""Folders that each committed file judges, with all below them, and the study's own where it has one.

A file that is not listed judges all code.
"""


@dataclass(frozen=True)
class Age:
    """State of the file of the ``name`` relative to the present code, and the reason."""

    name: str
    state: State
    reason: str


def run(options: argparse.Namespace) -> int:
    """Print one line a file; status 1 when one is stale."""
    found = list(ages(read_results(Path(str(resources.files("reports").joinpath("results"))))))
    rows = [[age.state, f"{age.name}.json", age.reason] for age in found]
    emit([asdict(age) for age in found], options.json, columns(rows, indent=""))
    return int(any(age.state == "stale" for age in found))


def ages(documents: Mapping[str, Any], root: Path = ROOT) -> Iterator[Age]:
    """The age of each document, by name of its file."""
    now = sources()
    for name, document in documents.items():
        yield age(name, newest_provenance(document), JUDGED.get(name, SOURCES), now, root)


def newest_provenance(document: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """Provenance of the document, or of the newest run in its list; None where it records no commit."""
    listed = [entry for value in document.values() if isinstance(value, list) for entry in value]
    records = [
        item["provenance"] for item in (document, *listed) if isinstance(item, dict) and "provenance" in item
    ]
    return max(records, key=lambda record: str(record["date"]), default=None)


def age(
    name: str,
    provenance: Mapping[str, Any] | None,
    judged: tuple[str, ...],
    now: Mapping[str, str],
    root: Path = ROOT,
) -> Age:
    """Compare digests of the code; where they differ, or there are none, the commit with the present files.

    The comparison with the commit leaves comments and docstrings out, which digests cannot.
    """
    if provenance is None:
        return Age(name, "unknown", "older than the record: its commit is not known")
    then = provenance.get("sources")
    differing = None if then is None else _differing(then, now, judged)
    if differing == []:
        return Age(name, "current", "")
    commit, date = provenance["commit"], str(provenance["date"])[:10]
    changed = None if commit is None else changed_files(commit, judged, root)
    made = date if commit is None else f"commit {commit[:12]} of {date}"
    if differing is not None and (changed is None or provenance["dirty"]):
        return Age(name, "stale", f"{made}; changed since: {', '.join(differing)}")
    if changed is None:
        return Age(name, "unknown", f"{made}, which this repository does not have")
    if changed:
        return Age(name, "stale", f"{made}; {len(changed)} file{'s' * (len(changed) > 1)} changed since")
    if provenance["dirty"]:
        return Age(name, "unknown", f"{made}, with uncommitted changes")
    return Age(name, "current", "")


def _differing(then: Mapping[str, str], now: Mapping[str, str], judged: tuple[str, ...]) -> list[str]:
    folders = sorted(f for f in {*then, *now} if any(f"{f}/".startswith(f"{top}/") for top in judged))
    return [folder for folder in folders if then.get(folder) != now.get(folder)]


def changed_files(commit: str, judged: tuple[str, ...], root: Path = ROOT) -> list[str] | None:
    """Files whose code differs from that at the commit; None where git does not know it.

    Only a checkout of our own counts, not a repository around an installed package.
    """
    if not (root / ".git").exists():
        return None
    listed = _git(root, "diff", "--name-only", "--no-renames", "-z", commit, "--", *judged)
    if listed is None:
        return None
    names = [name for name in listed.decode().split("\0") if name]
    return [
        name
        for name in names
        if _code(name, _git(root, "show", f"{commit}:{name}")) != _code(name, _here(root / name))
    ]


def _here(path: Path) -> bytes | None:
    return path.read_bytes() if path.is_file() else None


def _code(name: str, content: bytes | None) -> str | bytes | None:
    """The syntax tree without docstrings as text, of Python; the content itself of all else."""
    if content is None or not name.endswith(".py"):
        return content
    tree = ast.parse(content)
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            node.body = [line for line in node.body if not _is_text(line)]
    return ast.dump(tree)


def _is_text(line: ast.stmt) -> bool:
    return (
        isinstance(line, ast.Expr)
        and isinstance(line.value, ast.Constant)
        and isinstance(line.value.value, str)
    )


def _git(root: Path, *arguments: str) -> bytes | None:
    """Output of a git command; None where there is no git, no repository, or no such commit or file."""
    try:
        done = subprocess.run(["git", "-C", str(root), *arguments], capture_output=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return done.stdout
