"""The README tells the truth: its code runs, its output is real, its commands work, its files exist."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from statistics import median
from typing import Any

import pytest

from reports.result_files import committed
from tests.documents import ROOT, blocks, commands, run

README = (ROOT / "README.md").read_text(encoding="utf-8")


def test_every_block_runs_and_prints_what_the_readme_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Make is what CI runs."""
    (tmp_path / "docs").mkdir()
    monkeypatch.setenv("MPLBACKEND", "agg")
    assert run(re.sub(r"^\$ make .*\n", "", README, flags=re.M), tmp_path) == 1
    assert {path.name for path in tmp_path.rglob("*") if path.is_file()} == {"table1-rough.png"}


def test_it_is_short_and_its_commands_are_those_of_the_set_up() -> None:
    assert len(README.split()) <= 700
    (example,) = (block.text for block in blocks(README) if block.language == "python")
    assert len(example.strip().splitlines()) <= 12
    lines = [line for b in blocks(README) if b.language == "console" for line, _ in commands(b)]
    assert len(lines) >= 2
    assert all(line.startswith(("make ", ".venv/bin/rough-friction ")) for line in lines)


def test_what_it_names_is_there() -> None:
    makefile = (ROOT / "Makefile").read_text()
    install = (ROOT / "docs/install.md").read_text(encoding="utf-8")
    (targets,) = re.findall(r"^\.PHONY: (.*)$", makefile, flags=re.M)
    assert [target for target in targets.split() if f"`make {target}`" not in install] == []
    for target in re.findall(r"make (\w+)", README + install):
        assert re.search(rf"^{target}:", makefile, flags=re.M), target
    assert "make test" in (ROOT / ".ci/run").read_text()
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    assert [name for name in extras if name not in ("dev", "mutation") and f"`{name}`" not in install] == []
    pictures = re.findall(r"!\[[^]]*\]\(([^)]+)\)", README)
    assert pictures
    for name in [*pictures, "CITATION.cff", "CHANGELOG.md"]:
        assert (ROOT / name).exists(), name


JUDGED = {
    "mu": "friction_coefficient",
    "A": "contact_area",
    "A, perimeter-corrected,": "contact_area_corrected",
    "f_max": "max_pressure",
}


def in_both(halves: list[dict[str, Any]], key: str, unit: str) -> str:
    """A number of both halves, in the table's digits."""
    if unit == "%":
        return " / ".join(f"{100 * half[key]:.0f}" for half in halves) + " %"
    return " / ".join(f"{half[key]:.1f}" for half in halves)


def test_the_table_of_bars_is_that_of_the_results() -> None:
    page = (ROOT / "docs/error-bars.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| ([\w, -]+) to (0\.\d+) \| (.*) \|$", page, flags=re.M)
    assert len(rows) == 6
    studies = [committed(name) for name in ("coverage", "coverage_fresh")]
    for name, accuracy, rest in rows:
        halves = [
            found["numbers"][JUDGED[name]]
            for study in studies
            for found in study["accuracies"]
            if found["accuracy"] == float(accuracy)
        ]
        cells = [in_both(halves, key, "%") for key in ("met", "covered", "covered_at_worst")]
        cells += [in_both(halves, key, "") for key in ("median_bar_over_error", "median_cost")]
        assert rest.split(" | ") == cells, name
    text = " ".join(README.split())
    (mu,) = (row for name, accuracy, row in rows if (name, accuracy) == ("mu", "0.01"))
    _, held, _, longer, _ = mu.split(" | ")
    assert f"those of mu as summed over elements cover in {held.split()[-2]} %" in text
    assert f"are {longer.split()[-1]} times the error in the median" in text
    scenes = sum(last - first + 1 for first, last in (study["seeds"] for study in studies))
    assert f"on {scenes} random scenes" in text


NUMBERS = ("contact_area", "contact_area_corrected", "friction_coefficient", "max_pressure", "approach")
HEAD = "| class of scene | A | A, corrected | mu | p_max | approach |"


def stated_by_class(head: str) -> dict[str, list[str]]:
    """The cells of a table on the page of error bars, by class."""
    lines = (ROOT / "docs/error-bars.md").read_text(encoding="utf-8").splitlines()
    start = next(k for k, line in enumerate(lines) if line.startswith(head)) + 2
    rows = (
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in lines[start : lines.index("", start)]
    )
    return {name: cells for name, *cells in rows}


def test_the_corrected_mu_of_every_class_is_that_of_the_study() -> None:
    rows: dict[str, dict[str, Any]] = {}
    for row in committed("coverage_corrected")["table"]:
        rows.setdefault(row["class"], {})[row["number"]] = row
    found = {}
    for kind, numbers in rows.items():
        corrected, summed = numbers["friction_coefficient_corrected"], numbers["friction_coefficient"]
        found[kind] = [f"{100 * row['held']:.0f} %" for row in (corrected, summed)]
        found[kind] += [f"{corrected['median_bar_over_error']:.1f}"]
        found[kind] += [f"{row['bias_over_bar']:+.2f}" for row in (corrected, summed)]
    del found[None]
    assert stated_by_class("| class of scene | corrected mu") == found


def test_a_seventh_of_the_error_is_that_of_the_study() -> None:
    """Quotients of the classes' medians of error and bar, summed over corrected: their median."""
    values: dict[tuple[str, str, str], list[float]] = {}
    for row in committed("coverage_corrected")["rows"]:
        for part in ("error", "bar"):
            values.setdefault((row["class"], row["number"], part), []).append(row[part])
    mu, kinds = "friction_coefficient", {kind for kind, _, _ in values}
    error, bar = (
        median(median(values[k, mu, part]) / median(values[k, f"{mu}_corrected", part]) for k in kinds)
        for part in ("error", "bar")
    )
    assert (round(error), f"{bar:.1f}") == (7, "2.7")
    assert "a seventh of the error, covered in 80 to 100 % by class of scene" in " ".join(README.split())


def test_every_class_and_number_is_that_of_the_study() -> None:
    table = committed("coverage_classes")["table"]
    found: dict[str, list[str]] = {}
    for row in table:
        if row["class"] and row["number"] in NUMBERS:
            cell = f"{100 * row['held']:.0f} % / {100 * row['usable']:.0f} %"
            found.setdefault(row["class"], []).append(cell)
    assert stated_by_class(HEAD) == found
