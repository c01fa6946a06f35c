#!/usr/bin/env -S uv run --script
# /// script
# dependencies = ["nox"]
# ///
"""Sessions of `nox` for systems without make: `nox -s lint`, `nox -s tests-3.13 -- tests/test_docs.py`."""

from __future__ import annotations

import nox

nox.needs_version = ">=2025.2.9"
nox.options.default_venv_backend = "uv|virtualenv|venv"
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "PYTHONUTF8": "1"}


@nox.session
def lint(session: nox.Session) -> None:
    """Ruff and mypy, with the versions of the constraints."""
    session.install("-c", "constraints.txt", "-e", ".[dev]")
    session.run("ruff", "check", ".")
    session.run("mypy")


@nox.session(python=["3.11", "3.12", "3.13", "3.14"])
def tests(session: nox.Session) -> None:
    """All tests, or those that are named, with the newest dependencies."""
    session.install("-e", ".[dev]")
    session.run("python", "-m", "pytest", "-n", "2", "--dist", "worksteal", *session.posargs, env=ONE_THREAD)


@nox.session(default=False)
def wheel(session: nox.Session) -> None:
    """The wheel without extras, away from the checkout, solves a scene."""
    folder = session.create_tmp()
    session.install("build")
    session.run("python", "-m", "build", "--wheel", "--outdir", folder)
    session.cd(folder)
    session.install("--find-links", ".", "rough-friction")
    session.run("rough-friction", "solve", "table1-rough", "--grid", "64")


if __name__ == "__main__":
    nox.main()
