"""The matrix of checks and faults: verdicts, who could see what, processes that leave nothing behind."""

from __future__ import annotations

import json
from importlib import import_module
from pathlib import Path

import pytest

import refimpl as rf
from refimpl.kernels import normal_integral
from refimpl.operators import dense
from reports.result_files import read_result
from verification.framework.case import Case, Measured, Metric
from verification.matrix import run as running
from verification.matrix.appendix_faults import IN_APPENDIX
from verification.matrix.checks import SAMPLES, all_checks, run, traced
from verification.matrix.faults import FAULTS, Fault
from verification.matrix.local_faults import IN_REFIMPL
from verification.matrix.merge import merged
from verification.matrix.patches import everywhere, fault


def touching() -> Measured:
    solution = rf.solve(SAMPLES[0].scene, 5, method="dense")
    return Measured(value=solution.normal_force, reference=SAMPLES[0].scene.load)


def reading_nothing() -> Measured:
    return Measured(value=1.0, reference=1.0)


def for_ever() -> Measured:
    while True:
        pass


def check(function: object, name: str = "some/check") -> Case:
    assert callable(function)
    return Case(name, "t", "c", "s", Metric.RELATIVE, 1e-9, "r", function)


NO_KERNEL = Fault("no kernel", ((dense, "normal_integral", lambda *a: 0 * normal_integral(*a)),), "")


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    known = [check(touching), check(reading_nothing, "other/check")]
    monkeypatch.setattr(running, "all_checks", lambda: known)
    monkeypatch.setattr(running, "family", lambda check: check.id)
    monkeypatch.setattr(running, "manufacture", lambda *a: None)
    monkeypatch.setattr(running, "FAULTS", {"no-kernel": NO_KERNEL})
    monkeypatch.setattr(running, "IN_REFIMPL", {})
    monkeypatch.setattr(running, "IN_APPENDIX", {})


@pytest.mark.usefixtures("few")
def test_the_matrix_tells_who_sees_what_and_who_alone() -> None:
    *_, matrix = running.measure()
    assert set(matrix.verdicts["no-kernel"]) == {"some/check"}  # the other never calls the kernel
    found = json.loads(json.dumps(matrix.document()))
    assert found["faults"][0]["caught_by"] == ["some/check"]
    by_id = {entry["id"]: entry for entry in found["checks"]}
    assert by_id["some/check"]["alone"] == ["no-kernel"]
    assert by_id["other/check"]["catches"] == []
    assert rf.solve(SAMPLES[0].scene, 5, method="dense").normal_force == pytest.approx(
        SAMPLES[0].scene.load
    )  # the fault stayed in its process


@pytest.mark.usefixtures("few")
def test_dear_and_broken_checks_are_left_out_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    broken = check(lambda: Measured(value=2.0, reference=1.0), "broken/check")
    known = [check(touching), check(reading_nothing, "other/check"), broken]
    monkeypatch.setattr(running, "all_checks", lambda: known)
    *_, matrix = running.measure(known={"some/check": 7.0})
    assert set(matrix.sound) == {"other/check"}
    assert matrix.excluded == {"some/check": "takes 7.0 s", "broken/check": "fail without a fault"}


@pytest.mark.usefixtures("few")
def test_the_command_writes_the_file_and_fails_for_a_fault_that_nothing_sees(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    main = import_module("verification.matrix.__main__").main
    assert main(["--json", str(tmp_path / "matrix.json")]) == 0
    harmless = Fault("nothing", ((dense, "normal_integral", normal_integral),), "")
    monkeypatch.setattr(running, "FAULTS", {"harmless": harmless})
    assert main(["--json", str(tmp_path / "matrix.json")]) == 1
    assert "seen by none: harmless" in capsys.readouterr().out
    content = read_result(tmp_path / "matrix.json")
    assert content["format"] == running.FORMAT
    assert content["provenance"]["versions"]["numpy"]


def test_a_check_that_never_ends_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("verification.matrix.checks.SECONDS", 0.2)
    assert run(check(for_ever)).status == "error"


def test_a_trace_holds_what_the_check_calls() -> None:
    names = {code.co_name for code in traced(check(touching))}
    assert {"solve_reference", "certify", "normal_matrix"} <= names
    assert not traced(check(reading_nothing))


def test_every_local_fault_replaces_something() -> None:
    all_checks()  # imports whatever holds the functions
    for name, described in {**IN_REFIMPL, **IN_APPENDIX}.items():
        assert name not in FAULTS
        patches = fault(described).patches
        assert patches, name
        for owner, attribute, wrong in patches:
            assert vars(owner)[attribute] is not wrong


def test_patches_reach_every_module_that_holds_the_function() -> None:
    owners = {owner.__name__ for owner, _, _ in everywhere(normal_integral, None)}
    assert {"refimpl.kernels.points", "verification.exact.dense_influence"} <= owners
    assert not any(name.startswith("tests") for name in owners)


@pytest.mark.usefixtures("few")
def test_dear_checks_are_added_to_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main, path = import_module("verification.matrix.__main__").main, tmp_path / "matrix.json"
    assert main(["--json", str(path), "--skip", "some/*"]) == 1
    first = read_result(path)
    assert first["excluded"] == {"some/check": "excluded on request"}
    assert main(["--json", str(path), "--only", "some/*", "--against", "no-*", "--add"]) == 0
    both = read_result(path)
    assert both["excluded"] == {}
    assert both["faults"][0]["caught_by"] == ["some/check"]
    assert [check["alone"] for check in both["checks"]] == [[], ["no-kernel"]]
    assert len(both["added"]) == 1
    assert main(["--json", str(path), "--only", "some/*", "--add"]) == 1
    assert read_result(path) == both
    assert capsys.readouterr().err == "no check is left to try\n"


def test_a_check_is_not_added_twice() -> None:
    document = {"format": "1", "faults": [], "checks": [{"id": "some/check"}], "excluded": {}}
    with pytest.raises(ValueError, match="tried before: some/check"):
        merged(document, document)


def test_an_added_part_brings_the_faults_description_up_to_date() -> None:
    def document(what: str, check: str) -> dict[str, object]:
        fault = {"name": "f", "what": what, "kind": "local", "tried": 1, "broke": 0, "caught_by": [check]}
        row = {"id": check, "catches": ["f"], "alone": ["f"], "among_few": []}
        return {"format": "1", "faults": [fault], "checks": [row], "excluded": {}, "provenance": {}}

    found = merged(document("times 0.9", "some/check"), document("times 0.999", "other/check"))
    assert [fault["what"] for fault in found["faults"]] == ["times 0.999"]
    assert [fault["tried"] for fault in found["faults"]] == [2]
    assert [check["among_few"] for check in found["checks"]] == [["f"], ["f"]]
