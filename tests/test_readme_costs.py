"""The table of costs is that of the newest benchmarks with every code in them, digit by digit."""

from __future__ import annotations

from functools import partial

from tests.documents import ROOT
from verification.benchmarks.codes import ALONE, OWN, SHEARED, SLOPED
from verification.benchmarks.page import EVERY, PEER, QUICKEST, Number, Ratios, Rows, newest, over, table
from verification.output.result_files import committed

PAGE = (ROOT / "docs/costs.md").read_text(encoding="utf-8")
RUNS = committed("benchmarks")["runs"]


def test_the_table_is_that_of_the_record() -> None:
    shown = PAGE.partition("| | 128 |")[2].partition("\n\n")[0]
    assert [line.strip("| ").split(" | ") for line in shown.splitlines()[2:]] == table(RUNS)


def at_512(number: Number, codes: frozenset[str] = EVERY) -> list[float]:
    """Medians on the smooth and on the rough flat, on one thread."""
    found = newest(RUNS, codes)
    spreads = [number(*found[kind, 512]) for kind in ("smooth", "rough")]
    return [spread["median"] for spread in spreads if spread is not None]


def seconds(code: str, ratios: Ratios, rows: Rows) -> dict[str, float]:
    return dict(rows[code]["seconds"])


def test_error_bars_take_as_long_as_is_said() -> None:
    """Without friction, on both flats: the rest of a solve over its solver alone."""
    shares: dict[int, list[float]] = {}
    for (_, M), (_, rows) in newest(RUNS).items():
        whole, alone = (rows[code]["seconds"]["median"] for code in (OWN, ALONE))
        shares.setdefault(M, []).append(whole / alone - 1)
    least, most = min(shares[512]), max(shares[512])
    said = f"take about as long as the solver at 128 x 128, {least:.1f} to {most:.1f} times at 512 x 512."
    assert f"Without friction, error bars and warnings {said}" in PAGE
    assert 0.8 < min(shares[128]) <= max(shares[128]) < 1.25


def test_what_is_said_first_is_so() -> None:
    readme = " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())
    smooth, rough = at_512(partial(seconds, SLOPED))
    flats = f"{smooth:.2f} s on a smooth flat, {rough:.2f} s on a rough one"
    assert f"{flats}, friction, slopes and error bars included, one thread ([costs]" in readme
    whole = "this code with friction and slope terms, from a scene to numbers with error bars"
    ours = {whole: SLOPED, "the same without slope terms": SHEARED, "the same without friction": OWN}
    for label, code in ours.items():
        assert row(label) == [f"{number:.2f} s" for number in at_512(partial(seconds, code))]
    for label, code in {"ASPHER 0.1.3": PEER, "ASPHER with its quickest options": QUICKEST}.items():
        assert row(label) == [f"{ratio:.1f}" for ratio in at_512(over(code))]
    others = EVERY - {QUICKEST} | {"tamaas", "ContactMechanics"}
    for name, version in (("tamaas", "Tamaas 2.9.0"), ("ContactMechanics", "ContactMechanics 1.8.3")):
        ratios = at_512(over(name), others)
        assert row(version) == [f"{ratio:.0f}" for ratio in ratios]
        assert min(ratios) > max(at_512(over(PEER), others))  # "the fastest of the solvers tried"


def row(label: str) -> list[str]:
    (line,) = (line for line in PAGE.splitlines() if line.startswith(f"| {label} |"))
    return [cell.strip() for cell in line.strip("|").split("|")][1:]
