"""The price list: reliable offers only, the front, growth, and the command."""

from __future__ import annotations

import json
import resource
from dataclasses import replace
from importlib import resources
from pathlib import Path

import pytest

import refimpl as rf
from reports.studies.tradeoff import build
from tests.verification.cli.children import forked
from verification.cli import main
from verification.cli.tradeoff import _table
from verification.tradeoff import prices, study
from verification.tradeoff.measure import QUANTITIES, Run, _convolution_time, run
from verification.tradeoff.settings import Setting, settings

SHIPPED = {
    "hertz": {"friction_coefficient"},
    "metal-polymer": set(),
    "rough-planes": {"paper", "qp", "single"},
    "table1-rough": set(),
    "table1-smooth": set(),
}
"""What is left out of the study of every shipped scene."""
REFERENCE = dict.fromkeys(QUANTITIES, 1.0)


def made(M: int, seconds: float, error: float, status: str = "converged", nested: bool = True) -> Run:
    numbers = dict.fromkeys(QUANTITIES, 1.0 + error)
    return Run(Setting("fft", M, 1e-8, nested=nested), numbers, status, seconds, 10.0, 0.1, 8 * M**2)


def test_an_error_that_is_small_by_chance_is_no_price() -> None:
    runs = [made(16, 1.0, 0.0005), made(32, 2.0, 0.02), made(64, 4.0, 0.005)]
    offers = {
        row["error"]: row["M"] for row in prices.price_list(runs, REFERENCE, dict.fromkeys(QUANTITIES, 0.0))
    }
    assert offers == {0.1: 16, 0.03: 16, 0.01: 64, 0.003: None, 0.001: None}


def test_no_price_below_the_doubt_of_the_reference_nor_from_what_did_not_settle() -> None:
    runs = [made(16, 1.0, 0.0, "stagnated"), made(16, 3.0, 0.0, nested=False)]
    rows = prices.price_list(runs, REFERENCE, dict.fromkeys(QUANTITIES, 0.004))
    assert {row["error"]: row["seconds"] for row in rows} == {
        0.1: 3.0,
        0.03: 3.0,
        0.01: 3.0,
        0.003: None,
        0.001: None,
    }


def test_the_front_falls() -> None:
    runs = [made(16, 1.0, 0.1), made(32, 2.0, 0.2), made(64, 3.0, 0.01), made(8, 0.5, 0.0, "stagnated")]
    assert [r.setting.M for r in prices.front(runs, REFERENCE, "contact_area")] == [16, 64]


def test_growth_finds_the_exponents() -> None:
    (row,) = prices.growth([made(M, 1e-6 * M**3, 0.0) for M in (16, 32, 64)])
    assert row["time"] == pytest.approx(3)
    assert row["memory"] == pytest.approx(2)
    assert prices.affordable([made(M, 1e-6 * M**3, 0.0) for M in (16, 32, 64)], row["way"], 1.0) == 100


def test_seconds_that_do_not_grow_tell_no_affordable_grid() -> None:
    """As on tiny grids beside other work: their exponent may be nothing, or below."""
    for power in (-0.5, 0.0, 1e-3, 0.9):
        runs = [made(M, 0.1 * M**power, 0.0) for M in (8, 12, 16)]
        assert prices.affordable(runs, prices.growth(runs)[0]["way"], 60.0) is None


def test_every_way_has_a_name_of_its_own() -> None:
    ways = settings([64], [1e-3, 1e-5])
    assert len({w.way for w in ways}) == len(ways) == 11


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "t.json"
    command = ["tradeoff", "table1-smooth", "--grids", "8,12,16", "--reference", "32", "--repeats", "1"]
    assert main([*command, "--json", str(out)]) == 0
    assert "cheapest way" in capsys.readouterr().out
    found = json.loads(out.read_text())
    assert {run["method"] for run in found["runs"]} == {"fft", "paper", "dense", "qp"}
    assert all(run["status"] for run in found["runs"])
    shown = build({"studies": [found]})
    assert len(shown.figures) == 3
    for M, said in ((None, "takes three of its grids"), (123, "takes 60 s at about 123 elements")):
        told = build({"studies": [found | {"dense up to": {"seconds": 60.0, "M": M}}]})
        assert any(said in note for note in told.paragraphs)


def test_a_reference_that_is_not_settled_judges_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = rf.read_scene("table1-smooth")
    loose = replace(rf.solve(scene, 16), status=rf.Status.STAGNATED)
    monkeypatch.setattr(rf, "solve", lambda *_, **__: loose)
    out = tmp_path / "t.json"
    command = ["tradeoff", "table1-smooth", "--grids", "8", "--reference", "16", "--json", str(out)]
    assert main(command) == 1
    assert "the reference on 8 elements a side ends in 'stagnated'" in capsys.readouterr().err
    assert not out.exists()


def test_a_way_without_a_solution_fails_alone(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    measured = study.run

    def failing(scene: rf.Scene, setting: Setting, repeats: int) -> Run:
        if setting.method == "dense":
            raise ArithmeticError("no approach balances the load")
        return measured(scene, setting, repeats)

    monkeypatch.setattr(study, "run", failing)
    found = study.study(rf.read_scene("table1-smooth"), "s", [8], 16, 1, lambda _: None)
    assert set(found["failed"].values()) == {"no approach balances the load"}
    assert all("dense" in at for at in found["failed"])
    assert {run["method"] for run in found["runs"]} == {"fft", "paper", "qp"}
    assert "failed:\ndense" in _table(found).replace("  ", "")


@pytest.mark.parametrize("scene", sorted(SHIPPED))
def test_every_shipped_scene_has_a_price_list(
    scene: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without friction mu is zero and has no relative error; periodic scenes have fewer ways."""
    out = tmp_path / "t.json"
    command = ["tradeoff", scene, "--grids", "8,12", "--reference", "24", "--repeats", "1"]
    assert main([*command, "--json", str(out)]) == 0
    found, told = json.loads(out.read_text()), capsys.readouterr().out
    left_out = SHIPPED[scene]
    assert set(found["left out"]) == left_out
    assert all(f"  {name} " in told for name in left_out)
    methods = {run["method"] for run in found["runs"]} | {"single" for run in found["runs"] if run["single"]}
    assert methods == {"fft", "paper", "dense", "qp", "single"} - left_out
    quantities = set(QUANTITIES) - left_out
    for of in (found["reference"]["numbers"], found["reference"]["doubt"], found["front"]):
        assert set(of) == quantities
    assert {row["quantity"] for row in found["prices"]} == quantities
    assert all(set(run["errors"]) == quantities for run in found["runs"])
    shown = build({"studies": [found]})
    assert len(shown.figures) == len(quantities)
    assert any("Neglected: " in note for note in shown.paragraphs) is bool(left_out)
    old = {key: value for key, value in found.items() if key != "left out"}
    assert not any("Neglected: " in note for note in build({"studies": [old]}).paragraphs)


def test_the_scenes_above_are_all_that_are_shipped() -> None:
    folder = resources.files("refimpl") / "data" / "scenes"
    assert {path.name.removesuffix(".toml") for path in folder.iterdir()} == set(SHIPPED)


@pytest.mark.parametrize("bad", [["--reference", "16"], ["--grids", "8,x"], ["--repeats", "0"]])
def test_bad_input_is_refused(bad: list[str]) -> None:
    command = ["tradeoff", "table1-smooth", "--grids", "16", "--reference", "32", *bad]
    try:
        status = main(command)
    except SystemExit as refused:
        status = int(refused.code or 0)
    assert status == 2


def test_single_precision_settles_to_its_own_rounding_and_no_further() -> None:
    """24 bits: displacements to some 1e-7, so a certificate of 1e-5 is met and one of 1e-12 cannot be."""
    scene = rf.read_scene("table1-smooth")
    double, single = (run(scene, Setting("fft", 32, 1e-5, single=one), 1) for one in (False, True))
    assert single.status == double.status == "converged"
    assert single.setting.way == "fft, 1e-05, single"
    for name, value in double.numbers.items():
        assert 0 <= abs(single.numbers[name] / value - 1) < 1e-5
    assert single.numbers["max_pressure"] != double.numbers["max_pressure"]
    assert run(scene, Setting("fft", 32, 1e-12, single=True), 1).status == "stagnated"


def test_a_transform_takes_time_under_a_limit_of_processor_time() -> None:
    """There the clock of the process advances in milliseconds: it gave 0 s, which ratios are taken over."""

    def limited() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (600, 600))

    def lasts() -> int:
        return 0 if all(_convolution_time((8, 8)) > 0 for _ in range(20)) else 1

    assert forked(lasts, before=limited).status == 0
