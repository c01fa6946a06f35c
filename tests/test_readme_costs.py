"""The table of costs is that of the newest benchmark with every code in it, digit by digit."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

from reports.result_files import committed
from tests.documents import ROOT

PAGE = (ROOT / "docs/costs.md").read_text(encoding="utf-8")
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
    "the same in processor time": over(PEER, "processor seconds"),
    "memory of a solve, ASPHER's over ours": quotient(PEER, OURS, "memory of the solve"),
    "our convolutions in all": lambda ratios, rows: float(rows[OURS]["convolution equivalents"]),
    "ours with friction over ours without": over(SHEARED),
    "ours with friction and slopes over ours without": over(SLOPED),
}


EVERY = frozenset({OURS, ALONE, PEER, QUICKEST, SHEARED, SLOPED})
RUNS = committed("benchmarks")["runs"]


def newest(codes: frozenset[str] = EVERY) -> dict[tuple[str, int], tuple[Ratios, Rows]]:
    """Ratios and rows by surface and grid, of the last run in which all of the codes took part."""
    found = {}
    for run in RUNS:
        if {row["code"] for row in run["rows"]} >= codes:
            for ratios in run["ratios"]:
                at = ratios["kind"], ratios["M"]
                rows = {row["code"]: row for row in run["rows"] if (row["kind"], row["M"]) == at}
                found[at] = ratios, rows
    return found


def shown(number: float | None) -> str:
    return "-" if number is None else f"{number:.1f}" if number < 9.95 else f"{number:.0f}"


def test_the_table_is_that_of_the_record() -> None:
    found = newest()
    expected = [
        [label, *(" / ".join(shown(number(*found[kind, M])) for kind in ("smooth", "rough")) for M in GRIDS)]
        for label, number in TABLE.items()
    ]
    table = PAGE.partition("| | 128 |")[2].partition("\n\n")[0]
    rows = [line.strip("| ").split(" | ") for line in table.splitlines()[2:]]
    assert rows == expected


def at_512(number: Number, codes: frozenset[str] = EVERY) -> list[float]:
    """That number on the smooth and on the rough flat."""
    found = newest(codes)
    return [float(number(*found[kind, 512]) or 0.0) for kind in ("smooth", "rough")]


def seconds(ratios: Ratios, rows: Rows) -> float:
    return float(rows[OURS]["seconds"]["median"])


def test_what_is_said_first_is_so() -> None:
    smooth, rough = at_512(seconds)
    text = " ".join(PAGE.split())
    readme = " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())
    for said in (text, readme):
        assert f"takes {smooth:.2f} s on a smooth flat and {rough:.2f} s on a rough one" in said
    smooth, rough = at_512(over(PEER))
    assert 5.5 < smooth < 6.5  # "a sixth"
    assert 4.5 < rough < 5.5  # "a fifth"
    friction, slopes = at_512(over(SHEARED)), at_512(over(SLOPED))
    assert 1.5 <= min(friction) <= max(friction) <= 1.75
    assert max(s - f for s, f in zip(slopes, friction, strict=True)) <= 0.5
    others = EVERY - {QUICKEST} | {"tamaas", "ContactMechanics"}
    for name, version in (("tamaas", "Tamaas 2.9.0"), ("ContactMechanics", "ContactMechanics 1.8.3")):
        smooth, rough = at_512(over(name), others)
        assert re.search(rf"{version} (takes )?{smooth:.0f} / {rough:.0f} times", text)
        assert min(smooth, rough) > max(at_512(over(PEER), others))
    smooth, rough = at_512(seconds, others)
    assert f"with {smooth:.2f} / {rough:.2f} s of ours" in text
