"""The seconds and ratios of docs/costs.md and README are those of the benchmarks' newest runs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from reports.studies.benchmarks import newest_rows
from tests.documents import ROOT
from verification.benchmarks.codes import ALONE, OWN, SHEARED, SLOPED
from verification.output.result_files import committed

PAGE = (ROOT / "docs/costs.md").read_text(encoding="utf-8")
RUNS: dict[tuple[str, int], dict[str, Mapping[str, Any]]] = {
    at: {row["code"]: row for row in rows}
    for at, rows in newest_rows(committed("benchmarks")["runs"]).items()
}
FLATS = [RUNS["smooth", 512], RUNS["rough", 512]]


def seconds(code: str) -> list[str]:
    return [f"{rows[code]['seconds']['median']:.2f} s" for rows in FLATS]


def ratios(code: str, digits: int = 1) -> list[str]:
    return [f"{rows[code]['ratio']['seconds']['median']:.{digits}f}" for rows in FLATS]


def test_error_bars_take_as_long_as_is_said() -> None:
    """Without friction, on both flats: the rest of a solve over its solver alone."""
    shares: dict[int, list[float]] = {}
    for (_, M), rows in RUNS.items():
        whole, alone = (rows[code]["seconds"]["median"] for code in (OWN, ALONE))
        shares.setdefault(M, []).append(whole / alone - 1)
    assert "about as long as the solver at 128 x 128, and half as long at 512 x 512" in PAGE
    assert 0.8 < min(shares[128]) <= max(shares[128]) < 1.25
    assert 0.35 < min(shares[512]) <= max(shares[512]) < 0.65


def test_what_is_said_first_is_so() -> None:
    readme = " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())
    smooth, rough = seconds(SLOPED)
    flats = f"{smooth} on a smooth flat, {rough} on a rough one"
    assert f"{flats}, friction, slopes and error bars included, one thread ([costs]" in readme
    whole = "this code with friction and slope terms, from a scene to numbers with error bars"
    ours = {whole: SLOPED, "the same without slope terms": SHEARED, "without both": OWN}
    for label, code in ours.items():
        assert row(label) == seconds(code)
    quickest = "aspher+options"
    for label, code in {"ASPHER 0.1.3": "aspher", "ASPHER with its quickest options": quickest}.items():
        assert row(label) == ratios(code)
    assert row("Tamaas 2.9.0") == ratios("tamaas", 0)
    assert row("ContactMechanics 1.8.3") == ratios("ContactMechanics", 0)


def row(label: str) -> list[str]:
    (line,) = (line for line in PAGE.splitlines() if line.startswith(f"| {label} |"))
    return [cell.strip() for cell in line.strip("|").split("|")][1:]
