"""The README tells the truth: its code runs, its output is real, its commands work, its files exist."""

from __future__ import annotations

import contextlib
import io
import re
import shlex
from pathlib import Path

import pytest

from verification.cli import main

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", README, flags=re.M | re.S)


def commands() -> list[str]:
    """Arguments of every `rough-friction` line in the console blocks."""
    return re.findall(r"^\$ \.venv/bin/rough-friction (.*)$", "\n".join(blocks("console")), flags=re.M)


def same_but_for_the_last_digit(printed: str, stated: str) -> bool:
    """Equal texts whose numbers differ by one unit of their last printed digit at most."""
    if NUMBER.sub("#", printed) != NUMBER.sub("#", stated):
        return False
    pairs = zip(NUMBER.findall(printed), NUMBER.findall(stated), strict=True)
    return all(
        abs(float(p) - float(s)) <= 1.01 * 10.0 ** -len(s.partition(".")[2]) if "." in s else p == s
        for p, s in pairs
    )


def test_the_example_prints_what_the_readme_says() -> None:
    (source,), (stated,) = blocks("python"), blocks("text")
    assert len(source.strip().splitlines()) <= 12
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        exec(compile(source, "README.md", "exec"), {})
    assert same_but_for_the_last_digit(printed.getvalue(), stated)


def test_the_comparison_sees_a_changed_number() -> None:
    assert same_but_for_the_last_digit("mu = 0.0894 (ok)", "mu = 0.0893 (ok)")
    assert not same_but_for_the_last_digit("mu = 0.0895 (ok)", "mu = 0.0893 (ok)")
    assert not same_but_for_the_last_digit("mu = 0.0893 (cycled)", "mu = 0.0893 (ok)")
    assert not same_but_for_the_last_digit("mu^3 = 0.0893", "mu^2 = 0.0893")


def test_the_commands_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "docs").mkdir()
    monkeypatch.chdir(tmp_path)
    assert len(commands()) >= 5
    for command in commands():
        assert main(shlex.split(command)) == 0, command
        assert capsys.readouterr().out
    made = {path.name for path in tmp_path.rglob("*") if path.is_file()}
    assert made == {"table1-rough.png", "hertz.json", "hertz.vtu", "results.json", "report.html"}


@pytest.mark.parametrize("target", ["report", "test", "clean"])
def test_the_make_targets_exist(target: str) -> None:
    assert f"make {target}" in README
    assert re.search(rf"^{target}:", (ROOT / "Makefile").read_text(), flags=re.M)


def test_the_files_it_names_exist() -> None:
    links = re.findall(r"!\[[^]]*\]\(([^)]+)\)", README)
    assert links
    for name in [*links, "CITATION.cff", "CHANGELOG.md", "refimpl/data/scenes", "verification/cases"]:
        assert (ROOT / name).exists(), name


def test_ci_runs_the_readmes_test_command() -> None:
    assert "make test" in (ROOT / ".ci/run").read_text()
