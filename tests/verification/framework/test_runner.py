"""The runner: the same results from any number of workers, and no failure that gets lost."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from verification.framework import runner, workers
from verification.framework.case import Case, Measured, Metric, Result, Status, Tier
from verification.output import files, provenance

Make = Callable[..., str]

GOOD = """
@case("good/series", metric="absolute", tolerance=1e-12)
def series():
    x = np.random.default_rng(1).normal(size=(200, 200))
    return Measured(float(np.linalg.svd(x)[1].sum()), 2404.2, data={"x": x[0]}, reference_uncertainty=0.0)

@case("good/threads", metric="equal", tolerance=0.0)
def threads():
    return Measured(float(os.environ["OMP_NUM_THREADS"]), 1.0)
"""
BAD = """
@case("bad/dies", metric="equal", tolerance=0.0)
def dies():
    os._exit(0)

@case("bad/exits", metric="equal", tolerance=0.0)
def exits():
    raise SystemExit(0)

@case("bad/after", metric="equal", tolerance=0.0)
def after():
    return Measured(1.0, 1.0)

@case("bad/missing", metric="equal", tolerance=0.0)
def missing():
    raise Unavailable("needs a code that is not here")
"""


def test_results_do_not_depend_on_the_number_of_workers(make_package: Make) -> None:
    package = make_package(bad=BAD, good=GOOD)
    runs = [runner.run("quick", jobs=jobs, package=package) for jobs in (1, 2)]
    first, second = ([(r.id, r.status, r.value, r.data) for r in run.results] for run in runs)
    assert first == second
    statuses = {r.id: r.status for r in runs[0].results}
    assert statuses == {
        "bad/dies": "error",
        "bad/exits": "error",
        "bad/after": "pass",
        "bad/missing": "unavailable",
        "good/series": "fail",
        "good/threads": "pass",
    }
    assert runs[0].counts == {"pass": 2, "fail": 1, "error": 2, "unavailable": 1}
    assert runs[0].exit_status == 1
    document = json.loads(files.to_json(runs[0].document()))
    assert [c["id"] for c in document["cases"]] == list(statuses)
    keys = {"versions", "commit", "dirty", "machine", "date", "command"}
    assert keys <= set(document["provenance"])
    assert document["provenance"]["versions"]["numpy"]


def run_of(*statuses: str) -> runner.Run:
    case = Case("a/b", "t", "c", "s", Metric.EQUAL, 0.0, "exact", lambda: Measured(1.0, 1.0))
    results = tuple(case.result(Status(s), "", 0.0) for s in statuses)
    return runner.Run(Tier.QUICK, (), results, 0.0)


@pytest.mark.parametrize(
    ("statuses", "exit_status"),
    [
        (["pass"], 0),
        (["pass", "unavailable"], 0),
        (["unavailable"], 1),
        ([], 1),
        (["pass", "fail"], 1),
        (["pass", "error"], 1),
    ],
)
def test_exit_status(statuses: list[str], exit_status: int) -> None:
    run = run_of(*statuses)
    assert run.exit_status == exit_status
    assert run.counts == {status.value: statuses.count(status.value) for status in Status}


def test_results_come_in_the_order_of_the_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    """The case in the middle ends last: the other worker has taken the third one by then."""

    class Player:
        def run(self, one: Any) -> Any:
            time.sleep(0.2 if one.module == "b" else 0.0)
            return SimpleNamespace(id=one.id)

        def close(self) -> None:
            pass

    monkeypatch.setattr(workers, "Worker", Player)
    cases: Any = [SimpleNamespace(id=f"{letter}/1", module=letter) for letter in "abc"]
    ended: list[str] = []
    found = workers.run_all(cases, 2, lambda result: ended.append(result.id))
    assert [result.id for result in found] == ["a/1", "b/1", "c/1"]
    assert sorted(ended) == ["a/1", "b/1", "c/1"]
    assert ended[-1] == "b/1"


@pytest.mark.parametrize(
    ("prefix", "changes", "found"),
    [
        ("", "", ("abc", False)),
        ("", None, ("abc", None)),  # git cannot tell
        ("vendored/", "", (None, None)),  # another repository's checkout
    ],
)
def test_a_commit_is_that_of_our_own_checkout(
    prefix: str, changes: str | None, found: tuple[object, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    answers = {"--show-prefix": prefix, "HEAD": "abc", "--porcelain": changes}
    monkeypatch.setattr(provenance, "_git", lambda root, *words: answers[words[-1]])
    assert tuple(provenance.revision().values()) == found


def test_the_command_names_no_directory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.modules["__main__"], "__spec__", None)
    monkeypatch.setattr(sys, "argv", ["/some/where/rough-friction", "verify", "--only", "hertz/*"])
    assert provenance.command() == "rough-friction verify --only 'hertz/*'"
    monkeypatch.setattr(sys, "argv", ["verify", "--json", "/some/where/out.json", "--map", "maps/a.x3p"])
    assert provenance.command() == "verify --json out.json --map maps/a.x3p"


def test_errata_are_the_cases_that_record_them() -> None:
    data = {"equation": "0", "printed": "a", "corrected": "b", "measure": "m", "printed_error": 1.0}
    complete = {**data, "corrected_error": 0.0}

    def result(id: str, data: dict[str, object]) -> Result:
        measured = Measured(0.0, data=data)
        return Case(id, "t", "c", "s", Metric.AT_MOST, 0.0, "exact", lambda: measured).run()

    found = runner.errata([result("a/half", {**data}), result("a/whole", {**complete, "more": 2})])
    assert found == [{"case": "a/whole", "status": "pass", **complete}]
