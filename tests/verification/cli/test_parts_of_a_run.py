"""`rough-friction remake --from RUN`: files of some cases, cut from a run of all."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from refimpl.errors import InputError
from reports.result_files import read_result
from verification.cli.parts_of_a_run import parts, patterns_of, read_run
from verification.cli.remake import GOOD, Recipe, cut
from verification.framework.runner import FORMAT

CASES = [
    {"id": "love/disc", "status": "pass", "tier": "quick", "seconds": 0.25},
    {"id": "love/far", "status": "fail", "tier": "full", "seconds": 3.5},
    {"id": "errata/a5", "status": "unavailable", "tier": "quick", "seconds": 1.0},
]
RUN: dict[str, Any] = {
    "format": FORMAT,
    "tier": "full",
    "only": [],
    "counts": {"pass": 1, "fail": 1, "error": 0, "unavailable": 1},
    "seconds": 99.0,
    "cases": CASES,
    "errata": [{"case": "errata/a5", "equation": "A5"}],
    "provenance": {"commit": "abc"},
}


@pytest.fixture
def whole(tmp_path: Path) -> Path:
    path = tmp_path / "full.json"
    path.write_text(json.dumps(RUN))
    return path


def test_a_file_holds_the_cases_of_its_command_with_their_counts_and_seconds(whole: Path) -> None:
    commands = {
        "love": "rough-friction verify --tier full --jobs 1 --only 'love/*' --json FILE",
        "quick": "rough-friction verify --tier quick --jobs 2 --json FILE",
        "extremes": "python -m verification.stress_tests --json FILE",
    }
    found = dict(parts(read_run(whole), commands))
    assert list(found) == ["love", "quick"]
    assert [each["id"] for each in found["love"]["cases"]] == ["love/disc", "love/far"]
    assert found["love"]["counts"] == {"pass": 1, "fail": 1, "error": 0, "unavailable": 0}
    assert (found["love"]["seconds"], found["love"]["only"]) == (3.75, ["love/*"])
    assert found["love"]["errata"] == []
    assert (found["quick"]["tier"], found["quick"]["seconds"]) == ("quick", 1.25)
    assert found["quick"]["errata"] == RUN["errata"]
    assert found["quick"]["provenance"] == {"commit": "abc"}


def test_files_are_written_and_named_in_the_record(whole: Path, tmp_path: Path) -> None:
    recipe = Recipe("far", "rough-friction verify --tier full --only love/far --json FILE", 5.0)
    other = Recipe("disc", "rough-friction verify --tier full --only love/disc --json FILE", 5.0)
    (entry,) = cut(whole, {"far": recipe, "disc": other}, ["far"], tmp_path)
    assert (entry.file, entry.seconds, entry.ended) == ("far", 3.5, "cut from a whole run; 1 did not pass")
    assert entry.ended not in GOOD
    assert read_result(tmp_path / "far.json")["cases"] == CASES[1:2]
    assert not (tmp_path / "disc.json").exists()
    (passed,) = cut(whole, {"disc": other}, None, tmp_path)
    assert passed.ended in GOOD


def test_the_self_test_is_a_pattern_of_cases() -> None:
    assert patterns_of("rough-friction verify --self-test --jobs 1 --json FILE") == (
        "full",
        ("contestants/*",),
    )


@pytest.mark.parametrize(
    ("document", "allowed"),
    [
        ('{"format": 3}', "all cases"),
        ("x", "all cases"),
        (json.dumps({**RUN, "tier": "quick"}), "holds some"),
        (json.dumps({**RUN, "only": ["love/*"]}), "holds some"),
    ],
)
def test_no_other_file_is_cut(document: str, allowed: str, tmp_path: Path) -> None:
    path = tmp_path / "run.json"
    path.write_text(document)
    with pytest.raises(InputError, match=allowed) as refused:
        read_run(path)
    assert refused.value.field == "--from"
