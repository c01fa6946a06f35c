"""`verify --stale`: a result file is as old as the code that it judges, and comments are no code."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest

from reports.result_files import result_paths
from reports.revisions import newest
from tests.documents import ROOT
from verification.cli import main, stale
from verification.framework import provenance

JUDGED = ("refimpl",)
NOW = {"refimpl": "a", "refimpl/kernels": "b", "verification": "c"}


def git(root: Path, *arguments: str) -> str:
    identity = ["-c", "user.name=a", "-c", "user.email=a@example.org", "-c", "commit.gpgsign=false"]
    command = ["git", "-C", str(root), *identity, *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A repository with a module and a table of data, committed."""
    (tmp_path / "refimpl").mkdir()
    (tmp_path / "refimpl/area.py").write_text("def area(a):\n    return 3 * a\n")
    (tmp_path / "refimpl/data.json").write_text("[1]")
    (tmp_path / "README.md").write_text("x")
    git(tmp_path, "init", "-q")
    git(tmp_path, "add", ".")
    git(tmp_path, "commit", "-qm", "x")
    return tmp_path


def record(root: Path, **others: object) -> dict[str, Any]:
    return {"commit": git(root, "rev-parse", "HEAD"), "date": "2026-11-24T01:02:03", "dirty": False, **others}


def state(root: Path, found: dict[str, Any] | None) -> tuple[str, str]:
    age = stale.age("a", found, JUDGED, NOW, root)
    return age.state, age.reason


def test_code_counts_and_comments_do_not(checkout: Path) -> None:
    made = record(checkout)
    assert state(checkout, made) == ("current", "")
    module = checkout / "refimpl/area.py"
    module.write_text('"""Areas."""\n\ndef area(a):  # of a contact\n    """3 a."""\n    return 3*a\n')
    (checkout / "README.md").write_text("another")
    assert state(checkout, made) == ("current", "")
    module.write_text("def area(a):\n    return 4 * a\n")
    age, reason = state(checkout, made)
    assert (age, reason) == ("stale", f"commit {made['commit'][:12]} of 2026-11-24; 1 file changed since")
    (checkout / "refimpl/data.json").write_text("[2]")
    git(checkout, "add", ".")
    git(checkout, "commit", "-qm", "y")
    assert "2 files" in state(checkout, made)[1]
    git(checkout, "rm", "-q", "--cached", "refimpl/area.py")
    module.unlink()
    assert state(checkout, made)[0] == "stale"


def test_what_is_not_known_is_said(checkout: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    assert state(checkout, None) == ("unknown", "older than the record: its commit is not known")
    assert state(checkout, record(checkout, dirty=True))[0] == "unknown"
    age, reason = state(checkout, record(checkout, commit="0" * 40))
    assert age == "unknown"
    assert "does not have" in reason
    assert state(tmp_path_factory.mktemp("no checkout"), record(checkout))[0] == "unknown"
    (checkout / "installed").mkdir()
    assert state(checkout / "installed", record(checkout))[0] == "unknown"


def test_digests_need_no_repository(checkout: Path) -> None:
    made = record(checkout, commit=None, dirty=None, sources={**NOW, "verification": "other"})
    assert state(checkout, made) == ("current", "")
    made["sources"] = {"refimpl": "a", "refimpl/kernels": "other", "refimpl/gone": "d"}
    assert state(checkout, made) == ("stale", "2026-11-24; changed since: refimpl/gone, refimpl/kernels")
    made |= {"commit": git(checkout, "rev-parse", "HEAD"), "dirty": True}
    assert state(checkout, made)[0] == "stale"
    made["dirty"] = False  # the commit is what was run, and since then comments alone changed
    assert state(checkout, made) == ("current", "")


def test_the_newest_run_of_a_record_counts() -> None:
    runs = [{"provenance": {"date": date}} for date in ("2026-01-02", "2026-01-03", "2026-01-01")]
    assert newest({"runs": runs, "other": [1, "x"]}) == {"date": "2026-01-03"}
    assert newest({"provenance": {"date": "1"}}) == {"date": "1"}
    assert newest({"date": "2026-01-01"}) is None


def test_digests_are_of_contents(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(provenance, "ROOT", tmp_path)
    (tmp_path / "refimpl/kernels/deep").mkdir(parents=True)
    (tmp_path / "tests").mkdir()
    for name in ("refimpl/a.py", "refimpl/kernels/b.py", "refimpl/kernels/deep/c.json", "tests/d.py"):
        (tmp_path / name).write_text(name)
    before = provenance.sources()
    assert list(before) == ["refimpl", "refimpl/kernels"]  # the tests of an installed package are not ours
    (tmp_path / "refimpl/a.py").rename(tmp_path / "refimpl/z.py")
    assert provenance.sources() == before
    (tmp_path / "refimpl/kernels/deep/c.json").write_text("other")
    after = provenance.sources()
    assert [folder for folder in before if before[folder] != after[folder]] == ["refimpl/kernels"]


def test_every_result_file_declares_what_it_judges() -> None:
    assert set(stale.JUDGED) == {path.stem for path in result_paths(ROOT / "reports" / "results")}
    folders = provenance.sources()
    for judged in stale.JUDGED.values():
        tops = [top.removeprefix(stale.LEFT_OUT) for top in judged]
        assert all(any(f"{folder}/".startswith(f"{top}/") for folder in folders) for top in tops), judged


def test_a_folder_that_is_left_out_makes_nothing_stale(checkout: Path) -> None:
    judged = ("refimpl", ":!refimpl/identification")
    made = record(checkout, sources=dict(NOW))
    (checkout / "refimpl/identification").mkdir()
    (checkout / "refimpl/identification/fit.py").write_text("x = 1\n")
    git(checkout, "add", ".")
    git(checkout, "commit", "-qm", "y")
    now = {**NOW, "refimpl/identification": "new"}
    assert stale.age("a", made, judged, now, checkout).state == "current"
    assert stale.age("a", made, ("refimpl",), now, checkout).state == "stale"
    made |= {"commit": made["commit"], "sources": {**NOW, "refimpl": "other"}}  # the commit is compared
    assert stale.age("a", made, judged, now, checkout).state == "current"


def test_a_sample_that_is_looked_at_once_is_a_record_and_no_failure(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert set(stale.JUDGED) > stale.ONCE
    made = provenance.provenance() | {"commit": None}
    changed = made | {"sources": {**provenance.sources(), "refimpl": "other"}}
    documents = {"class_costs": {"provenance": changed}, "coverage_classes": {"provenance": made}}
    monkeypatch.setattr(stale, "read_results", lambda folder: documents)
    assert main(["verify", "--stale", "--json", "-"]) == 0
    states = {line["name"]: line["state"] for line in json.loads(capsys.readouterr().out)}
    assert states == {"class_costs": "record", "coverage_classes": "current"}


def test_the_command_fails_when_one_is_stale(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    made = provenance.provenance() | {"commit": None}
    documents = {"pulled": {"provenance": made}, "new": {"provenance": made}, "old": {"date": "2026"}}
    monkeypatch.setattr(stale, "read_results", lambda folder: documents)
    assert main(["verify", "--stale", "--json", "-"]) == 0
    states = {line["name"]: line["state"] for line in json.loads(capsys.readouterr().out)}
    assert states == {"pulled": "current", "new": "current", "old": "unknown"}
    documents["pulled"] = {"provenance": made | {"sources": {**provenance.sources(), "refimpl": "other"}}}
    assert main(["verify", "--stale"]) == 1
    line = capsys.readouterr().out.splitlines()[0]
    assert line.split()[:2] == ["stale", "pulled.json"]
    assert line.endswith("changed since: refimpl")
