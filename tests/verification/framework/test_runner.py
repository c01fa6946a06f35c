"""The runner: the same results from any number of workers, and no failure that gets lost."""

from __future__ import annotations

import importlib.util
import json
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from verification.framework import files, provenance, runner
from verification.framework.case import Case, Measured, Metric, Result, Status, Tier

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
    assert run_of(*statuses).exit_status == exit_status


def test_an_empty_selection_is_an_error(make_package: Make) -> None:
    with pytest.raises(LookupError):
        runner.run("quick", only=["no/such"], package=make_package(good=GOOD))


def test_a_file_is_whole_or_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "results.json"
    files.write_text("old", path)

    def break_off() -> None:
        with files.replacing(path) as temporary:
            temporary.write_text("half of the n")
            raise RuntimeError

    with pytest.raises(RuntimeError):
        break_off()
    assert path.read_text() == "old"
    files.write_text("new", path)
    assert path.read_text() == "new"
    assert [p.name for p in tmp_path.iterdir()] == ["results.json"]


def test_json_refuses_what_json_does_not_have() -> None:
    with pytest.raises(ValueError):
        files.to_json({"x": float("nan")})


@pytest.mark.parametrize("terminal", [True, False])
def test_progress_is_for_terminals(
    terminal: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: terminal)
    progress = files.Progress(3)
    progress.tick("pass  a/b")
    progress.close()
    assert ("[1/3] pass  a/b" in capsys.readouterr().err) is terminal


def test_provenance_says_what_is_not_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(provenance, "PACKAGES", ("numpy", "surely-not-installed"))
    found = provenance.versions()
    assert found["numpy"]
    assert found["surely-not-installed"] is None


def test_a_commit_is_that_of_our_own_checkout(monkeypatch: pytest.MonkeyPatch) -> None:
    for prefix, found in (("vendored/", (None, None)), ("", ("x", True))):
        answers = {"--show-prefix": prefix}
        monkeypatch.setattr(provenance, "_git", lambda _, *asked, a=answers: a.get(asked[-1], "x"))
        assert tuple(provenance.revision().values()) == found


def test_the_command_names_no_directory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.modules["__main__"], "__spec__", None)
    monkeypatch.setattr(sys, "argv", ["/some/where/rough-friction", "verify", "--only", "hertz/*"])
    assert provenance.command() == "rough-friction verify --only 'hertz/*'"
    monkeypatch.setattr(sys, "argv", ["verify", "--json", "/some/where/out.json", "--map", "maps/a.x3p"])
    assert provenance.command() == "verify --json out.json --map maps/a.x3p"


@pytest.mark.parametrize("module", ["verification.properties", "verification.coverage.classes"])
def test_the_command_of_a_module_can_be_typed(monkeypatch: pytest.MonkeyPatch, module: str) -> None:
    found = importlib.util.find_spec(module)
    assert found is not None
    if found.submodule_search_locations is not None:  # a package: Python runs this of it
        found = importlib.util.find_spec(f"{module}.__main__")
    monkeypatch.setattr(sys.modules["__main__"], "__spec__", found)
    monkeypatch.setattr(sys, "argv", ["/some/where/__main__.py", "--cheap", "0.3"])
    assert provenance.command() == f"python -m {module} --cheap 0.3"


def test_errata_are_the_cases_that_record_them() -> None:
    data = {"equation": "0", "printed": "a", "corrected": "b", "measure": "m", "printed_error": 1.0}
    complete = {**data, "corrected_error": 0.0}

    def result(id: str, data: dict[str, object]) -> Result:
        measured = Measured(0.0, data=data)
        return Case(id, "t", "c", "s", Metric.AT_MOST, 0.0, "exact", lambda: measured).run()

    found = runner.errata([result("a/half", {**data}), result("a/whole", {**complete, "more": 2})])
    assert found == [{"case": "a/whole", "status": "pass", **complete}]
