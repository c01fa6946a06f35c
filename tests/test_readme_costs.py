"""The table of costs is that of the newest benchmarks with every code in them, digit by digit."""

from __future__ import annotations

import re

from reports.result_files import committed
from tests.documents import ROOT
from verification.benchmarks.codes import OWN, SHEARED, SLOPED
from verification.benchmarks.page import EVERY, PEER, QUICKEST, Number, Ratios, Rows, newest, over, table

PAGE = (ROOT / "docs/costs.md").read_text(encoding="utf-8")
RUNS = committed("benchmarks")["runs"]


def test_the_table_is_that_of_the_record() -> None:
    shown = PAGE.partition("| | 128 |")[2].partition("\n\n")[0]
    assert [line.strip("| ").split(" | ") for line in shown.splitlines()[2:]] == table(RUNS)


def at_512(number: Number, codes: frozenset[str] = EVERY) -> list[float]:
    """Medians on the smooth and on the rough flat, on one thread."""
    found = newest(RUNS, codes)
    spreads = [number(*found[kind, 512, 1]) for kind in ("smooth", "rough")]
    return [spread["median"] for spread in spreads if spread is not None]


def seconds(ratios: Ratios, rows: Rows) -> dict[str, float]:
    return dict(rows[OWN]["seconds"])


def test_what_is_said_first_is_so() -> None:
    smooth, rough = at_512(seconds)
    text = " ".join(PAGE.split())
    readme = " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())
    for said in (text, readme):
        assert f"takes {smooth:.2f} s on a smooth flat and {rough:.2f} s on a rough one" in said
    smooth, rough = at_512(over(PEER))
    assert 4.5 < smooth < 5.5  # "a fifth"
    assert 2.5 < rough < 3.5  # "a third"
    friction, slopes = at_512(over(SHEARED)), at_512(over(SLOPED))
    assert 1.5 <= min(friction) <= max(friction) <= 1.75
    assert max(s - f for s, f in zip(slopes, friction, strict=True)) < 0.35  # "0.3 more"
    smooth, rough = at_512(over(QUICKEST))
    assert f"{1 / smooth:.1f} and {1 / rough:.1f} of that" in text
    others = EVERY - {QUICKEST} | {"tamaas", "ContactMechanics"}
    for name, version in (("tamaas", "Tamaas 2.9.0"), ("ContactMechanics", "ContactMechanics 1.8.3")):
        smooth, rough = at_512(over(name), others)
        assert re.search(rf"{version} (takes )?{smooth:.0f} / {rough:.0f} times", text)
        assert min(smooth, rough) > max(at_512(over(PEER), others))
    smooth, rough = at_512(seconds, others)
    assert f"with {smooth:.2f} / {rough:.2f} s of ours" in text
