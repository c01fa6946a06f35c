"""The README's table of costs is that of the newest benchmark with every code in it, digit by digit."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping
from typing import Any

import pytest

from tests.documents import ROOT

README = (ROOT / "README.md").read_text(encoding="utf-8")
GRIDS = (128, 256, 512, 1024, 2048)
OURS, ALONE, PEER, QUICKEST = "refimpl", "refimpl-solver", "aspher", "aspher+options"
SHEARED, SLOPED = f"{OURS}+friction", f"{OURS}+friction+slopes"
Ratios, Rows = Mapping[str, Any], Mapping[str, Any]
Number = Callable[[Ratios, Rows], float | None]


def fastest(name: str) -> Number:
    return lambda ratios, rows: ratios[name]["seconds over ours"] if name in ratios else None


def over(code: str, clock: str = "seconds") -> Number:
    return lambda ratios, rows: float(ratios[code][clock]["median"])


def quotient(one: str, other: str, what: str) -> Number:
    return lambda ratios, rows: float(rows[one][what]["median"] / rows[other][what]["median"])


TABLE: dict[str, Number] = {
    "ASPHER 0.1.3 over our solver, both from a gap to a pressure": fastest("fastest peer, solver alone"),
    "the same in a process that has solved it before": fastest("fastest peer, solver alone, again"),
    "ASPHER with its quickest options over our solver": quotient(QUICKEST, ALONE, "seconds"),
    "ASPHER over ours from a scene to numbers with error bars": over(PEER),
    "the same with ASPHER's quickest options": over(QUICKEST),
    "the same in processor time: ASPHER keeps both cores busy": over(PEER, "processor seconds"),
    "memory of a solve, ASPHER's over ours": quotient(PEER, OURS, "memory of the solve"),
    "our convolutions in all": lambda ratios, rows: float(rows[OURS]["convolution equivalents"]),
    "ours with friction over ours without": over(SHEARED),
    "ours with friction and slopes over ours without": over(SLOPED),
}


def newest() -> dict[tuple[str, int], tuple[Ratios, Rows]]:
    """Ratios and rows by surface and grid, of the last run in which every code took part."""
    found = {}
    record = json.loads((ROOT / "reports/results/benchmarks.json").read_text(encoding="utf-8"))
    for run in record["runs"]:
        if {row["code"] for row in run["rows"]} >= {OURS, ALONE, PEER, QUICKEST, SHEARED, SLOPED}:
            for ratios in run["ratios"]:
                at = ratios["kind"], ratios["M"]
                rows = {row["code"]: row for row in run["rows"] if (row["kind"], row["M"]) == at}
                found[at] = ratios, rows
    return found


def shown(number: float | None) -> str:
    return "-" if number is None else f"{number:.1f}" if number < 9.95 else f"{number:.0f}"


@pytest.mark.parametrize("label", TABLE)
def test_a_row_is_that_of_the_record(label: str) -> None:
    found = newest()
    cells = [" / ".join(shown(TABLE[label](*found[kind, M])) for kind in ("smooth", "rough")) for M in GRIDS]
    assert f"| {label} | {' | '.join(cells)} |" in README.splitlines()


def test_no_other_row_stands_there() -> None:
    table = README.partition("| | 128 |")[2].partition("\n\n")[0]
    assert re.findall(r"^\| (\S.*?) \|", table, flags=re.M) == list(TABLE)
