"""Golden scenes: files proven anew, wrong contact sets refused, enclosures that are what they say."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from importlib import import_module, resources
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest

from verification.exact.kernel_reference import normal, tangential
from verification.framework.case import Unavailable
from verification.golden import build
from verification.golden.enclosure import BITS, NotProven, _Balls, arb, prove
from verification.golden.store import Enclosed, document, enclosed, named, parsed, stored


def test_twelve_scenes_are_stored_with_positive_margins_and_provenance() -> None:
    assert len(stored()) == 12
    for golden in stored():
        path = resources.files("verification.golden") / f"{golden.scene.name}.json"
        content = json.loads(path.read_text(encoding="utf-8"))
        assert golden.scene.M <= 12
        assert golden.margins["smallest pressure"] > 0
        gap = golden.margins["smallest separation"]
        assert golden.contact.all() if gap is None else gap > 0
        assert content["proof"]["largest relative radius"] < 1e-50
        assert golden.radius <= 2e-16 * golden.pressure.max()
        assert content["provenance"]["versions"]["python-flint"]


def test_heights_are_exact_in_binary() -> None:
    for golden in stored():
        heights = golden.scene.heights
        assert np.array_equal(heights, np.rint(heights * 2.0**60) / 2.0**60)
        gap = heights.max() - heights
        assert np.array_equal(heights.max() - gap, heights)


def test_files_are_written_anew_by_one_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    few = [s for s in build.scenes() if s.name in ("smooth", "rough", "single")]
    monkeypatch.setattr(build, "scenes", lambda: few)
    main = import_module("verification.golden.__main__").main
    assert main(["--json", str(tmp_path)]) == 0
    assert capsys.readouterr().out.count("proven") == 6
    names = {"smooth", "rough", "near-tie-misses", "near-tie-touches", "single", "oblique"}
    assert {path.stem for path in tmp_path.glob("*.json")} == names
    for path in tmp_path.glob("*.json"):
        fresh, golden = parsed(json.loads(path.read_text(encoding="utf-8"))), named(path.stem)
        if golden.scene.oblique:
            continue  # its slopes are a solver's, so its last digits depend on the linear algebra at hand
        assert np.array_equal(fresh.scene.heights, golden.scene.heights)
        assert np.array_equal(fresh.contact, golden.contact)
        assert np.abs(fresh.pressure - golden.pressure).max() <= fresh.radius + golden.radius
        assert all(fresh.numbers[key].meets(golden.numbers[key]) for key in golden.numbers)
    assert main(["--json", str(tmp_path / "nowhere")]) == 2


def test_a_wrong_contact_set_is_not_proven() -> None:
    golden = named("rough")
    for element in (np.argwhere(golden.contact)[0], np.argwhere(~golden.contact)[0]):
        wrong = golden.contact.copy()
        wrong[tuple(element)] ^= True
        with pytest.raises(NotProven, match="not above 0"):
            prove(golden.scene, wrong)


def test_near_ties_swap_their_sets_with_each_other() -> None:
    """Either proof fails with the other's contact set: 1e-10 of the approach decides."""
    misses, touches = named("near-tie-misses"), named("near-tie-touches")
    assert np.count_nonzero(misses.contact != touches.contact) == 1
    for scene, contact in ((misses.scene, touches.contact), (touches.scene, misses.contact)):
        with pytest.raises(NotProven):
            prove(scene, contact)


def test_coefficients_contain_independent_ones() -> None:
    golden = named("friction")
    with arb().ctx.workprec(BITS):
        balls = _Balls(golden.scene, golden.contact)
        h = 2.0**-10 / golden.scene.M
        for kind, exact in (("normal", normal), ("tangential", tangential)):
            for i, j in ((0, 0), (1, 0), (0, 1), (3, 5), (7, 7)):
                value = exact(i * h, j * h, h, h)
                with mp.workdps(40):
                    assert abs(mp.mpf(balls._table[kind][i][j].str(40, radius=False)) - value) <= 1e-38


def test_a_sign_of_c_moves_the_proof() -> None:
    golden = named("friction")
    swapped = replace(golden.scene, lower=golden.scene.upper, upper=golden.scene.lower)
    try:
        f = np.array([float(ball) for ball in prove(swapped, golden.contact).pressures])
    except NotProven:
        return
    assert np.abs(f - golden.pressure[golden.contact]).max() > 1e-3 * golden.pressure.max()


def test_enclosures_in_doubles_contain_the_ball() -> None:
    ball = arb().arb(1) / 3
    found = enclosed(ball)
    assert found.mid == 1 / 3
    assert 0 < found.radius < 1e-16
    assert ball in arb().arb(found.mid, found.radius)
    assert found.meets(Enclosed(1 / 3, 0.0)) is True
    assert not Enclosed(1.0, 0.1).meets(Enclosed(1.3, 0.1))
    assert Enclosed(1.0, 0.25).misses(1.5) == 0.75


def test_documents_round_trip_and_other_formats_are_refused() -> None:
    golden = named("oblique")
    content = document(golden.scene, prove(golden.scene, golden.contact))
    back = parsed(json.loads(json.dumps(content)))
    assert np.array_equal(back.pressure, golden.pressure)
    assert np.array_equal(back.scene.tan_x, golden.scene.tan_x)
    with pytest.raises(ValueError, match="format"):
        parsed({**content, "format": "another"})


def test_no_flint_is_unavailable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "flint", None)
    with pytest.raises(Unavailable, match="python-flint"):
        prove(named("single").scene, named("single").contact)
