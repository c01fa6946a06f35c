"""Provenance of a result: versions, commit, machine, date and command."""

from __future__ import annotations

import datetime
import platform
import re
import shlex
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import TypeVar

T = TypeVar("T")
ROOT = Path(__file__).resolve().parents[2]
DISTRIBUTION = "rough-friction"
PACKAGES = ("numpy", "scipy", "ducc0", "scikit-fem", "meshio", "mpmath", "python-flint", "SurfaceTopography",
            "matplotlib", "hypothesis", "pytest")  # fmt: skip


def or_none(ask: Callable[[], T]) -> T | None:
    """Return the answer, or None for whatever is raised: provenance never ends a run that is finished."""
    try:
        return ask()
    except Exception:  # metadata of installed packages may hold anything
        return None


def versions() -> dict[str, str | None]:
    """Return the version of Python, of this package and each dependency; None for one not found."""
    from refimpl import __version__  # here and not above: --help is quick

    found: dict[str, str | None] = {"python": platform.python_version(), DISTRIBUTION: __version__}
    for package in PACKAGES:
        found[package] = or_none(partial(version, package))
    return found


def revision() -> dict[str, str | bool | None]:
    """Return this file's checkout's commit and whether it is `dirty`; `commit` is None if installed."""
    if not _is_checkout() or _git(ROOT, "rev-parse", "--show-prefix") != "":
        return {"commit": None, "dirty": None}
    changes = _git(ROOT, "status", "--porcelain")
    return {
        "commit": _git(ROOT, "rev-parse", "HEAD"),
        "dirty": None if changes is None else bool(changes),
    }


def is_known(commit: str) -> bool:
    """Return whether the checkout has the commit; True where unknown: if installed, or a shallow clone."""
    if not _is_checkout() or _git(ROOT, "rev-parse", "--is-shallow-repository") != "false":
        return True
    named = re.fullmatch("[0-9a-f]{7,64}", commit)  # no option of git's
    return bool(named) and _git(ROOT, "cat-file", "-e", f"{commit}^{{commit}}") is not None


def machine() -> dict[str, str | int | None]:
    """Return the processor model, cores this process may use, and platform."""
    from refimpl.operating_system import cores, processor_name  # here and not above: --help is quick

    return {
        "cores": or_none(cores),
        "processor": or_none(processor_name),
        "platform": or_none(platform.platform),
    }


def command() -> str:
    """Return the command line to be typed again: `python -m MODULE`, or names instead of absolute paths."""
    arguments = [Path(word).name if Path(word).is_absolute() else word for word in sys.argv[1:]]
    module = sys.modules["__main__"].__spec__  # None of scripts, such as pip's for an entry point
    if module is None:
        return shlex.join([Path(sys.argv[0]).name, *arguments])
    return shlex.join(["python", "-m", module.name.removesuffix(".__main__"), *arguments])


def provenance() -> dict[str, object]:
    """Return all of it, ready for JSON."""
    now = datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds")
    return {
        "command": command(),
        "date": now,
        **revision(),
        "versions": versions(),
        "machine": machine(),
    }


def _is_checkout() -> bool:
    return (ROOT / "pyproject.toml").is_file()


def _git(root: Path, *arguments: str) -> str | None:
    """Return the output of a git command without a lock; None without git or a repository."""
    try:
        asked = ["git", "--no-optional-locks", "-C", str(root), *arguments]
        done = subprocess.run(asked, capture_output=True, encoding="utf-8", errors="replace", check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return done.stdout.strip()
