"""`rough-friction remake`: recipes, and files that are replaced whole or not at all."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from reports.result_files import read_result
from tests.documents import ROOT
from verification.cli import remake
from verification.cli.remake import Recipe, recipes
from verification.cli.remake import remade as made_again

FOLDER = ROOT / "reports/results"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of results with one file in it, and work beside it."""
    monkeypatch.setattr(remake, "ROOT", tmp_path)
    monkeypatch.setattr("reports.results_page.main", lambda: None)
    results = tmp_path / "results"
    results.mkdir()
    (results / "a.json").write_text('{"x": 1}')
    return results


def command(code: str) -> Recipe:
    return Recipe("a", f'python -c "{code}" FILE', 1.0)


def test_every_committed_file_has_a_recipe_or_is_made_by_hand() -> None:
    known = recipes(FOLDER)
    by_hand = {"tradeoff", "benchmarks", "appendix_a_3d", "remade", "large_grids", "sweeps"}
    names = {path.stem for path in FOLDER.glob("*.json") if "." not in path.stem}
    assert names - by_hand <= set(known)
    assert known["table2"].command == "python -m verification.variational --json FILE"


def test_a_new_file_replaces_the_committed_one_and_is_logged(folder: Path) -> None:
    code = "import sys; open(sys.argv[1], 'w').write('[2]')".replace("[2]", '{\\"x\\": 2}')
    (entry,) = made_again([command(code)], folder, 60.0)
    assert entry.ended == "made"
    assert read_result(folder / "a.json") == {"x": 2}
    assert [row[0] for row in read_result(folder / "remade.json")["rows"]] == ["a.json"]


@pytest.mark.parametrize(
    ("code", "ended"),
    [
        ("raise SystemExit(3)", "exit status 3"),
        ("pass", "wrote no file"),
        ("import sys; open(sys.argv[1], 'w').write('x')", "no result file"),
        ("import time; time.sleep(60)", "time ran out"),
    ],
)
def test_what_goes_wrong_leaves_the_committed_file(folder: Path, code: str, ended: str) -> None:
    (entry,) = made_again([command(code)], folder, 2.0)
    assert entry.ended.startswith(ended)
    assert json.loads((folder / "a.json").read_text()) == {"x": 1}


def test_a_command_that_needs_more_time_than_is_left_is_not_started(folder: Path) -> None:
    (entry,) = made_again([Recipe("a", f"{sys.executable} FILE", 100.0)], folder, 5.0)
    assert entry.ended == "no time left"
    assert not (folder / "remade.json").exists()
