"""`make results`: files of some cases, cut from a run of all, and the commands of the other files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from reports.result_files import name_of, read_result, result_paths
from verification.cli import results
from verification.cli.results import main, patterns_of
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
COMMITTED = """
| `love.json` | `rough-friction verify --tier full --jobs 1 --only 'love/*' --json FILE` | fields |
| `disc.json` | `rough-friction verify --tier full --only 'love/disc' --json FILE`, a second | one |
| `quick.json` | `rough-friction verify --tier quick --jobs 2 --json FILE` | the quick tier |
| `extremes.json` | `python -m verification.stress_tests --json FILE` (4 minutes) | extremes |
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of results with its README, and the run of all cases beside it."""
    monkeypatch.setattr("reports.results_page.main", lambda: None)
    monkeypatch.setattr(results, "FOLDER", tmp_path)
    (tmp_path / "README.md").write_text(COMMITTED)
    (tmp_path / "full").write_text(json.dumps(RUN))
    return tmp_path


def test_a_file_holds_the_cases_of_its_command_and_the_other_commands_are_listed(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([str(folder / "full")]) == 1  # a case failed
    love, disc, quick = (read_result(folder / f"{name}.json.gz") for name in ("love", "disc", "quick"))
    assert [each["id"] for each in love["cases"]] == ["love/disc", "love/far"]
    assert love["counts"] == {"pass": 1, "fail": 1, "error": 0, "unavailable": 0}
    assert (love["seconds"], love["only"], love["errata"]) == (3.75, ["love/*"], [])
    assert disc["cases"] == CASES[:1]
    assert (quick["tier"], quick["seconds"]) == ("quick", 1.25)
    assert quick["errata"] == RUN["errata"]
    assert quick["provenance"] == {"commit": "abc"}
    assert not (folder / "extremes.json.gz").exists()
    printed = capsys.readouterr().out
    assert "love.json   2 cases  1 did not pass\n" in printed
    assert "disc.json   1 cases\n" in printed
    assert "  python -m verification.stress_tests --json reports/results/extremes.json.gz" in printed


def test_a_run_that_passed_has_status_zero(folder: Path) -> None:
    (folder / "README.md").write_text("\n".join(COMMITTED.splitlines()[2:]))
    assert main([str(folder / "full")]) == 0


def test_the_self_test_is_a_pattern_of_cases() -> None:
    command = "rough-friction verify --self-test --jobs 1 --json FILE"
    assert patterns_of(command) == ("full", ("solver_suite/*",))


def test_every_committed_file_has_its_command() -> None:
    assert sorted(results.commands()) == sorted(name_of(path) for path in result_paths(results.FOLDER))


@pytest.mark.parametrize(
    ("document", "allowed"),
    [
        ('{"format": 3}', "all cases"),
        ("x", "all cases"),
        (json.dumps({**RUN, "tier": "quick"}), "holds some"),
        (json.dumps({**RUN, "only": ["love/*"]}), "holds some"),
    ],
)
def test_no_other_file_is_cut(
    document: str, allowed: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "full").write_text(document)
    with pytest.raises(SystemExit, match="2"):
        main([str(folder / "full")])
    assert allowed in capsys.readouterr().err
    assert not (folder / "love.json.gz").exists()
