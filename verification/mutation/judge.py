"""A mutant's trial: its kill-suite in a forked process whose import system serves the mutated source.

The parent process imports what the suite needs from outside the tree, once: a child starts in milliseconds.
The child forgets what it has of the tree itself, so that everything it imports from there sees the mutant.
Processor time is limited, so that an endless loop ends and a busy machine condemns nobody.
"""

from __future__ import annotations

import importlib
import importlib.machinery
import json
import os
import resource
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from types import CodeType
from typing import Any, NamedTuple

import hypothesis
import pytest

OUR_PACKAGES = ("refimpl", "appendix_a", "verification", "reports", "tests")
NO_SHRINKING = (hypothesis.Phase.explicit, hypothesis.Phase.generate)
LONGEST = 60  # processor seconds of one test; the slowest takes less than half of them


class Verdict(NamedTuple):
    """``outcome`` survived, killed or timeout; ``killer`` the first test that failed; processor time."""

    outcome: str
    killer: str | None
    seconds: float


class Suite:
    """The kill-suite ``tests`` (arguments for pytest) of the tree at ``root``, where it is run from.

    With ``by_file`` (paths alone) the files are collected one after the other, until one fails: most mutants
    are noticed by the first.
    """

    def __init__(self, root: Path, tests: Sequence[str], *, by_file: bool = False) -> None:
        self.root, self.tests, self.by_file = root, tests, by_file

    def baseline(self) -> float:
        """Processor seconds of the suite on the tree as it is, measured with everything foreign imported.

        Raises RuntimeError when it fails: nothing could be judged by it.
        """
        collected = self.import_foreign()
        found = self._forked(None, "", limit=None)
        if collected["status"] or found["status"]:
            killers = (collected["killer"], found["killer"])
            raise RuntimeError(f"{self.tests[0]}: its suite fails without a mutant: {killers}")
        return float(found["seconds"])

    def import_foreign(self) -> dict[str, Any]:
        """Collect the suite, import from outside the tree what that needs, and return the child's report."""
        collected = self._forked(None, "", limit=None, more=("--collect-only",))
        for name in collected.get("foreign", ()):
            importlib.import_module(name)
        return collected

    def verdict(self, module: str, source: str, limit: int) -> Verdict:
        """Try ``module`` (a path in the tree) with another source, within ``limit`` processor seconds."""
        return self._judged(self._forked(module, source, limit))

    def verdict_of_tree(self, limit: int, options: Sequence[str] = ()) -> Verdict:
        """Try the tree as it stands, within ``limit`` processor seconds; ``options`` are pytest's."""
        return self._judged(self._forked(None, "", limit, options))

    @staticmethod
    def _judged(found: dict[str, Any]) -> Verdict:
        outcome = "timeout" if found["status"] is None else "killed" if found["status"] else "survived"
        return Verdict(outcome, found["killer"], round(found["seconds"], 2))

    def _forked(
        self, module: str | None, source: str, limit: int | None, more: Sequence[str] = ()
    ) -> dict[str, Any]:
        """Run in a child; its report, in which ``status`` is None when the child did not end by itself."""
        begun = _children_seconds()
        reading, writing = os.pipe()
        sys.stdout.flush()
        child = os.fork()
        if child == 0:
            os.close(reading)
            try:
                report = self._run(module, source, limit, more)
            except BaseException as broken:  # the child must end here, whatever the mutant does
                report = {"status": 1, "killer": type(broken).__name__}
            with os.fdopen(writing, "w") as pipe:
                json.dump(report, pipe)
            os._exit(0)
        os.close(writing)
        with os.fdopen(reading) as pipe:
            text = pipe.read()
        os.waitpid(child, 0)
        report = json.loads(text) if text else {"status": None, "killer": None}
        return report | {"seconds": _children_seconds() - begun}

    def _run(self, module: str | None, source: str, limit: int | None, more: Sequence[str]) -> dict[str, Any]:
        if limit is not None:
            resource.setrlimit(resource.RLIMIT_CPU, (limit, limit))
        quiet = os.open(os.devnull, os.O_WRONLY)
        os.dup2(quiet, 1)
        os.dup2(quiet, 2)
        os.chdir(self.root)
        sys.path.insert(0, str(self.root))
        os.environ["PYTHONPATH"] = str(self.root)
        _forget_the_tree()
        if module is not None:
            _serve(self.root / module, compile(source, module, "exec"))
        hypothesis.settings.register_profile(
            "judge", derandomize=True, database=None, deadline=None, phases=NO_SHRINKING
        )
        hypothesis.settings.load_profile("judge")
        first = _FirstFailure()
        options = ("-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", "--assert=plain")
        for tests in [[test] for test in self.tests] if self.by_file else [self.tests]:
            status = int(pytest.main([*options, *more, *tests], plugins=[first]))
            if self.by_file and status == pytest.ExitCode.NO_TESTS_COLLECTED:  # a module without doctests
                status = 0
            if status:
                break
        report: dict[str, Any] = {"status": status, "killer": first.test}
        if module is None:
            report["foreign"] = _foreign(self.root)
        return report


def _forget_the_tree() -> None:
    """Import its packages anew from here on, this one among them: the child would not see mutants of them."""
    for name in [name for name in sys.modules if name.split(".")[0] in OUR_PACKAGES]:
        del sys.modules[name]


class _FirstFailure:
    """Notes the first test, or the first file, that failed; a test that finds no end fails."""

    def __init__(self) -> None:
        self.test: str | None = None

    def pytest_runtest_setup(self) -> None:
        signal.signal(signal.SIGXCPU, lambda *_: pytest.fail(f"no end within {LONGEST} processor seconds"))
        used, hard = resource.getrusage(resource.RUSAGE_SELF), resource.getrlimit(resource.RLIMIT_CPU)[1]
        limit = int(used.ru_utime + used.ru_stime) + LONGEST
        resource.setrlimit(resource.RLIMIT_CPU, (limit if hard < 0 else min(limit, hard), hard))

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed and self.test is None:
            self.test = report.nodeid

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        if report.failed and self.test is None:
            self.test = report.nodeid


def _serve(path: Path, code: CodeType) -> None:
    """Make every import of the file at ``path`` run ``code``."""
    original = importlib.machinery.SourceFileLoader.get_code
    real = path.resolve()

    def get_code(loader: importlib.machinery.SourceFileLoader, name: str) -> CodeType | None:
        found = original(loader, name)
        return code if Path(loader.path).resolve() == real else found

    importlib.machinery.SourceFileLoader.get_code = get_code  # type: ignore[method-assign,assignment]  # the hook


def _foreign(root: Path) -> list[str]:
    """Loaded modules of the standard library and of installed packages, those of ``root`` left out."""
    found = []
    for name, module in list(sys.modules.items()):
        file = getattr(module, "__file__", None)
        spec = getattr(module, "__spec__", None)
        if file and spec and spec.name == name and not Path(file).resolve().is_relative_to(root.resolve()):
            found.append(name)
    return found


def _children_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
