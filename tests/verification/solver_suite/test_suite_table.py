"""Tables of a run, the identity of a solver, and the suite's version where people cite it."""

from __future__ import annotations

import csv
import hashlib
import io
import json
from pathlib import Path

import numpy as np
import pytest

from tests.documents import ROOT
from tests.verification.cli.commands import refused
from verification.cli import main, suite_table
from verification.output.provenance import versions
from verification.solver_suite import identity
from verification.solver_suite.suite import VERSION, suite
from verification.solver_suite.suite import identity as of_suite

OWN = "verification.solver_suite.own:solve"
ONLY = [
    "--only",
    "solver/one-element",
    "--only",
    "solver/westergaard-load",
    "--only",
    "solver/pins",
]
COUNTS = {"pass": 2, "fail": 1, "error": 0, "unavailable": 3}


def entry(name: str, *rows: tuple[str, str, float | None]) -> dict[str, object]:
    results = [{"id": i, "status": s, "error": e, "tolerance": 0.1, "metric": "at_most"} for i, s, e in rows]
    return {
        "name": name,
        "version": "a_b 1",
        "checksum": "00ff",
        "suite": "9",
        "counts": COUNTS,
        "results": results,
    }


ENTRIES = [entry("mine", ("x/a", "pass", 0.05), ("x/b", "fail", 0.3)), entry("R&D", ("x/a", "error", None))]


def test_verdicts_stand_beside_those_of_the_published_codes() -> None:
    head, rows = suite_table.verdicts(ENTRIES)
    assert list(head) == ["case", "mine", "R&D"]
    assert rows == [["a", "pass 0.5", "error"], ["b", "fail 3", "-"]]
    assert suite_table.overview(ENTRIES)[1][0] == ["mine", "a_b 1", "00ff", "9", "2 of 3", "1", "0", "3"]


def test_latex_escapes_and_markdown_has_a_cell_for_each_column() -> None:
    tex, md = suite_table.text_of(".tex", ENTRIES), suite_table.text_of(".md", ENTRIES)
    assert r"case & mine & R\&D \\" in tex
    assert r"a\_b 1" in tex
    assert tex.count(r"\begin{tabular}") == tex.count(r"\end{tabular}") == 2
    assert {line.count(" | ") for line in md.splitlines()[:4]} == {7}
    rows = list(csv.DictReader(io.StringIO(suite_table.text_of(".csv", ENTRIES))))
    assert [(row["code"], row["case"], row["error"]) for row in rows][1:] == [
        ("mine", "x/b", "0.3"),
        ("R&D", "x/a", ""),
    ]


def test_a_run_writes_its_table(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = tmp_path / "run.csv"
    words = ["verify", "--solver", OWN, *ONLY, "--table", str(table)]
    assert main([*words, "--json", "-"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["suite"] == of_suite()
    rows = list(csv.DictReader(io.StringIO(table.read_text())))
    mine = [row for row in rows if row["code"] == OWN]
    assert [(row["case"].partition("/")[2], row["status"]) for row in mine] == [
        ("one-element", "pass"), ("pins", "pass"), ("westergaard-load", "pass"),
    ]  # fmt: skip
    assert {row["checksum"] for row in mine} == {document["solver"]["checksum"]}
    assert {"Tamaas", "ContactMechanics", "ASPHER"} <= {row["code"] for row in rows}
    refused(f"verify --solver {OWN} --table {tmp_path}/run.pdf", "ends in .csv, .tex or .md")
    refused(f"verify --table {table}", "--table")


def test_the_identity_of_a_solver(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    script = tmp_path / "mine.py"
    script.write_text("x = 1\n")
    monkeypatch.chdir(tmp_path)
    inner = hashlib.sha256(b"x = 1\n").digest()
    expected = hashlib.sha256(inner).hexdigest()[: identity.DIGITS]
    assert identity.of_files(["mine.py"]) == expected
    program = identity.of_command(["sh", str(script)])["checksum"]
    script.write_text("x = 2\n")
    assert identity.of_command(["sh", str(script)])["checksum"] not in (program, None)
    assert identity.of_command(["no-such-program"])["checksum"] is None
    assert identity.of_object("numpy", np.sum)["version"] == f"numpy {versions()['numpy']}"
    assert identity.of_object("no_such_module", 1) == {"version": None, "checksum": None}
    assert identity.of_distribution("numpy") is not None
    assert identity.of_distribution("no-such-distribution") is None


def test_the_suite_is_cited_by_the_version_and_digest_that_it_has() -> None:
    """After a change of cases: raise VERSION in suite.py, and copy what its module prints to CITATION.cff."""
    cited, found = (ROOT / "CITATION.cff").read_text(), of_suite()
    assert f'version: "{VERSION}"' in cited
    assert f"{found['cases']} cases, digest {found['digest']}" in cited


@pytest.mark.parametrize("page", ["README.md", "docs/check-your-solver.md"])
def test_the_cases_are_as_many_as_the_page_says(page: str) -> None:
    drawn = sum("/design-" in case.id for case in suite())
    text = (ROOT / page).read_text(encoding="utf-8")
    assert f" {len(suite()) - drawn} cases" in text
    assert f"{drawn} " in text
