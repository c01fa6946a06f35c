"""What git tracks stays small, as people clone it and read its differences; settings of all tests."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from tests.documents import ROOT
from verification.output.result_files import FOLDER, SUFFIX, name_of, result_paths

MOST_BYTES = 500_000  # of a file
MOST_BYTES_IN_ALL = 6_500_000


@pytest.fixture(scope="module")
def tracked() -> list[Path]:
    """The tracked files that are there. In a checkout git must answer; a copy without `.git` is skipped."""
    if not (ROOT / ".git").exists():
        pytest.skip("no git checkout: nothing says which files are tracked")
    listed = subprocess.run(
        ["git", "-C", str(ROOT), "ls-files", "-z"], capture_output=True, text=True, check=True
    )
    paths = [ROOT / name for name in listed.stdout.split("\0") if name]
    return [path for path in paths if path.is_file()]


def test_every_file_is_small(tracked: list[Path]) -> None:
    assert len(tracked) > 100
    sizes = {str(path.relative_to(ROOT)): path.stat().st_size for path in tracked}
    assert {name: size for name, size in sizes.items() if size > MOST_BYTES} == {}
    assert sum(sizes.values()) <= MOST_BYTES_IN_ALL


def test_no_built_report_is_tracked(tracked: list[Path]) -> None:
    built = [path for path in tracked if path.suffix in (".html", ".pdf")]
    assert [str(path.relative_to(ROOT)) for path in built if path.parent != ROOT / "reports/templates"] == []


def test_every_result_file_is_compressed_and_has_its_command_in_the_readme() -> None:
    assert [path.name for path in result_paths(FOLDER) if not path.name.endswith(SUFFIX)] == []
    rows = (FOLDER / "README.md").read_text(encoding="utf-8").splitlines()
    named = {row.split("`")[1] for row in rows if row.startswith("| `")}
    assert named == {f"{name_of(path)}.json" for path in result_paths(FOLDER)}


def test_numbers_below_the_usual_absolute_tolerance_are_compared() -> None:
    """`tests.conftest` removes it: compliances of 1e-17 and 2e-17 m/Pa are not equal, nor is 1e-300 zero."""
    assert pytest.approx(1e-17, rel=0.5) != 2e-17
    assert pytest.approx(0.0) != 1e-300
    assert pytest.approx([1e-17, 0.0], rel=1e-6) == [1.0000001e-17, 0.0]
