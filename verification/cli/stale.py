"""`rough-friction verify --stale`: which committed results are older than what they judge.

A file is current, stale, a record of a sample that is looked at once, or of unknown age.
"""

from __future__ import annotations

import argparse
import ast
import subprocess
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from importlib import resources
from pathlib import Path
from typing import Any, Literal

from reports.result_files import read_results
from reports.revisions import newest
from verification.cli.output import columns, emit
from verification.framework.code_digest import code_of
from verification.framework.provenance import ROOT, SOURCES, sources

State = Literal["current", "stale", "record", "unknown"]

LEFT_OUT = ":!"
SOLVES = ("refimpl", ":!refimpl/identification")
"""Code of a solve, its error bars and its warnings; a fit of tau and beta uses it and is no part of it."""

JUDGED: Mapping[str, tuple[str, ...]] = {
    "accuracy_costs": (*SOLVES, "verification/benchmarks"),
    "appendix_a": ("appendix_a",),
    "appendix_a_3d": ("appendix_a/fem3d",),
    "appendix_a_between": ("appendix_a/fem", "refimpl/data"),
    "appendix_a_fem3d": ("appendix_a",),
    "appendix_a_map": ("appendix_a/fem", "refimpl/data"),
    "appendix_correction": (*SOLVES, "appendix_a"),
    "benchmarks": (*SOLVES, "verification/benchmarks"),
    "contestants": (*SOLVES, "verification/solver_suite"),
    "coverage": (*SOLVES, "verification/coverage"),
    "class_costs": (*SOLVES, "verification/coverage"),
    "coverage_classes": (*SOLVES, "verification/coverage"),
    "coverage_fresh": (*SOLVES, "verification/coverage"),
    "cross_code": ("verification/adapters", "verification/solver_suite"),
    "extremes": (*SOLVES, "appendix_a", "verification/stress_tests"),
    "identification": ("refimpl", "verification/coverage"),
    "hypothesis": (*SOLVES, "verification/properties"),
    "large_grids": (*SOLVES, "verification/benchmarks"),
    "model_form": (*SOLVES, "appendix_a"),
    "planning": SOLVES,
    "pulled": SOLVES,
    "quick": ("refimpl", "appendix_a", "verification/cases"),
    "remade": (),
    "reproduction": SOLVES,
    "sensitivity": SOLVES,
    "sweeps": (*SOLVES, "verification/benchmarks", "verification/sweep"),
    "tau_shares": SOLVES,
    "variational": (*SOLVES, "verification/cases/solvers"),
}
"""Folders that each committed file judges, with all below them, and the study's own where it has one.
``:!`` leaves a folder out, as in git.

A file that is not listed judges all code.
"""


ONCE = frozenset(("class_costs", "coverage_classes"))
"""Files of a sample that is looked at once: they judge the code of their commit, and stay as a record."""


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
        found = age(name, newest(document), JUDGED.get(name, SOURCES), now, root)
        yield replace(found, state="record") if found.state == "stale" and name in ONCE else found


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
    tops = [top for top in judged if not top.startswith(LEFT_OUT)]
    out = [top.removeprefix(LEFT_OUT) for top in judged if top.startswith(LEFT_OUT)]
    folders = sorted(f for f in {*then, *now} if _within(f, tops) and not _within(f, out))
    return [folder for folder in folders if then.get(folder) != now.get(folder)]


def _within(folder: str, tops: Iterable[str]) -> bool:
    return any(f"{folder}/".startswith(f"{top}/") for top in tops)


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
    return code_of(ast.parse(content))


def _git(root: Path, *arguments: str) -> bytes | None:
    """Output of a git command; None where there is no git, no repository, or no such commit or file."""
    try:
        done = subprocess.run(["git", "-C", str(root), *arguments], capture_output=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return done.stdout
