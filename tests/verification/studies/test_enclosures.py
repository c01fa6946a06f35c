"""Enclosed scenes: files proven anew, wrong contact sets refused, enclosures that are what they say."""

from __future__ import annotations

import json
import sys
from importlib import import_module, resources
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest

from verification.enclosures import build
from verification.enclosures.proof import BITS, NotProven, _Balls, prove
from verification.enclosures.store import Enclosed, document, enclosed, named, parsed, stored
from verification.exact.kernel_reference import arb, normal, tangential
from verification.framework.case import Unavailable


def test_twelve_scenes_are_stored_with_positive_margins_and_provenance() -> None:
    assert len(stored()) == 12
    for known in stored():
        path = resources.files("verification.enclosures") / f"{known.scene.name}.json"
        content = json.loads(path.read_text(encoding="utf-8"))
        assert known.scene.M <= 12
        assert known.margins["smallest pressure"] > 0
        gap = known.margins["smallest separation"]
        assert known.contact.all() if gap is None else gap > 0
        assert content["proof"]["largest relative radius"] < 1e-50
        assert known.radius <= 2e-16 * known.pressure.max()
        assert content["provenance"]["versions"]["python-flint"]


def test_files_are_written_anew_by_one_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    few = [s for s in build.scenes() if s.name in ("rough", "single")]
    monkeypatch.setattr(build, "scenes", lambda: few)
    main = import_module("verification.enclosures.__main__").main
    assert main(["--json", str(tmp_path)]) == 0
    assert capsys.readouterr().out.count("proven") == 5
    names = {"rough", "near-tie-misses", "near-tie-touches", "single", "oblique"}
    assert {path.stem for path in tmp_path.glob("*.json")} == names
    for path in tmp_path.glob("*.json"):
        fresh, known = parsed(json.loads(path.read_text(encoding="utf-8"))), named(path.stem)
        if known.scene.oblique:
            continue  # its slopes are a solver's, so its last digits depend on the linear algebra at hand
        assert np.array_equal(fresh.scene.heights, known.scene.heights)
        assert np.array_equal(fresh.contact, known.contact)
        assert np.abs(fresh.pressure - known.pressure).max() <= fresh.radius + known.radius
        assert all(fresh.numbers[key].meets(known.numbers[key]) for key in known.numbers)
    assert main(["--json", str(tmp_path / "nowhere")]) == 2


def test_a_wrong_contact_set_is_not_proven() -> None:
    known = named("rough")
    for element in (np.argwhere(known.contact)[0], np.argwhere(~known.contact)[0]):
        wrong = known.contact.copy()
        wrong[tuple(element)] ^= True
        with pytest.raises(NotProven, match="not above 0"):
            prove(known.scene, wrong)


def test_near_ties_swap_their_sets_with_each_other() -> None:
    """Either proof fails with the other's contact set: 1e-10 of the approach decides."""
    misses, touches = named("near-tie-misses"), named("near-tie-touches")
    assert np.count_nonzero(misses.contact != touches.contact) == 1
    for scene, contact in ((misses.scene, touches.contact), (touches.scene, misses.contact)):
        with pytest.raises(NotProven):
            prove(scene, contact)


def test_coefficients_contain_independent_ones() -> None:
    known = named("friction")
    with arb().ctx.workprec(BITS):
        balls = _Balls(known.scene, known.contact)
        h = 2.0**-10 / known.scene.M
        for kind, exact in (("normal", normal), ("tangential", tangential)):
            for i, j in ((0, 0), (1, 0), (0, 1), (3, 5), (7, 7)):
                value = exact(i * h, j * h, h, h)
                with mp.workdps(40):
                    assert abs(mp.mpf(balls._table[kind][i][j].str(40, radius=False)) - value) <= 1e-38


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
    known = named("oblique")
    content = document(known.scene, prove(known.scene, known.contact))
    back = parsed(json.loads(json.dumps(content)))
    assert np.array_equal(back.pressure, known.pressure)
    assert np.array_equal(back.scene.tan_x, known.scene.tan_x)
    with pytest.raises(ValueError, match="format"):
        parsed({**content, "format": "another"})


def test_no_flint_is_unavailable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "flint", None)
    with pytest.raises(Unavailable, match="python-flint"):
        prove(named("single").scene, named("single").contact)
