"""The study of error bars: scenes that know no grid, a store that survives kills, the document, its page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from refimpl.accuracy.refinement import FIRST_GRIDS
from refimpl.model.friction import is_frictionless
from reports.drawing import svg
from reports.studies import exhibit
from tests.verification.coverage.rungs import GRIDS, rung
from verification.coverage import document
from verification.coverage.document import grids_of, reference_check, solves
from verification.coverage.judge import (
    summary,
    verdicts,
)
from verification.coverage.scenes import CLASSES, SIDE, random_scene
from verification.coverage.shapes import measured_like
from verification.coverage.store import NUMBERS, climb, ladders, rungs


@pytest.mark.filterwarnings("ignore::refimpl.SurfaceWarning")
def test_scenes_repeat_and_know_no_grid() -> None:
    for seed, kind in enumerate(CLASSES):
        drawn, again = random_scene(seed), random_scene(seed)
        assert drawn.kind == kind
        coarse, fine = (np.array(d.scene.heights(d.scene.grid(M))) for d, M in ((drawn, 32), (again, 96)))
        # every third centre of the fine grid is one of the coarse; mid-heights differ by what is not sampled
        shift = fine[:, 1::3, 1::3] - coarse
        assert np.ptp(shift, axis=(1, 2)).max() <= 1e-12 * SIDE, kind


def test_measured_like_heights_have_the_rms_asked_for() -> None:
    heights = measured_like(np.random.default_rng(1), 64, 2e-6, 0.8, roll_off=4)
    assert heights.std() == pytest.approx(2e-6)
    assert abs(heights.mean()) < 1e-20


def test_the_store_resumes_after_a_kill(tmp_path: Path) -> None:
    store = tmp_path / "store.jsonl"
    climb(store, [0], [32, 48])
    whole = store.read_text()
    store.write_text(whole[:-100])  # killed while the last line was written
    assert [found.M for found in rungs(store)] == [32]
    climb(store, [0], [32, 48])
    assert [found.M for found in ladders(store)[0]] == [32, 48]
    found = solves(ladders(store).values())
    assert found["not_converged"] == 0
    assert found["worst_apart"] <= 1e-6
    first, second = ladders(store)[0]
    assert first.carried is None
    assert second.carried is not None
    assert second.carried < second.point_logs


def test_the_reference_is_checked_on_one_more_grid(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    module = "verification.coverage.document"
    monkeypatch.setattr(f"{module}.CHECK", 128)
    monkeypatch.setattr(f"{module}.grids_of", lambda seed: (32, 64))
    store = tmp_path / "store.jsonl"
    climb(store, [8], [32, 64])
    found = reference_check([6, 8], store)
    assert found["seeds"] == [8]
    assert found["worst_over_bound"] is not None
    assert reference_check([6], store)["worst_over_bound"] is None


def test_periodic_scenes_end_at_a_coarser_reference() -> None:
    ends = {kind: grids_of(seed)[-1] for seed, kind in enumerate(CLASSES)}
    assert {kind for kind, end in ends.items() if end == 512} == {"periodic waves", "periodic rough"}
    to_256 = (32, 64, 80, 96, 112, 128, 160, 192, 224, 256)
    assert grids_of(0) == (*to_256, 320, 384, 448, 512, 1024)
    assert grids_of(list(CLASSES).index("periodic waves")) == (*to_256, 512)


def test_the_document_solves_what_is_wanting_and_judges_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(document, "grids_of", lambda _: (*FIRST_GRIDS, 128, 256))
    frictionless = next(seed for seed in range(99) if is_frictionless(random_scene(seed).scene.friction))
    store, seeds = tmp_path / "study.jsonl", [0, frictionless]
    climb(store, [5], [*FIRST_GRIDS])  # of another study
    found: dict[str, Any] = document.document([0.05], seeds, store)
    assert found["solves"]["count"] == 8
    (judged,) = found["accuracies"]
    scenes = {number: judged["numbers"][number]["scenes"] for number in NUMBERS}
    assert scenes == {name: 1 if name == "friction_coefficient" else 2 for name in NUMBERS}
    assert {number: verdicts["seed"] for number, verdicts in judged["verdicts"].items()} == {
        name: [0] if name == "friction_coefficient" else seeds for name in NUMBERS
    }
    by_class = [judged["classes"][kind]["contact_area"]["scenes"] for kind in CLASSES]
    assert sum(by_class) == 2


def test_the_report_shows_the_study() -> None:
    ladder = {3: [rung(M) for M in GRIDS]}
    found = verdicts(ladder, 0.02)
    columns = ("seed", "class", "grid", "met", "bar", "error", "cost")
    judged = {
        "accuracy": 0.02,
        "numbers": {number: summary(v for v in found if v.number == number) for number in NUMBERS},
        "classes": {"rough ball": {number: summary(found) for number in NUMBERS}},
        "verdicts": {
            v.number: dict(
                zip(columns, ([3], [v.kind], [256], [v.met], [v.bar], [v.error], [v.cost]), strict=True)
            )
            for v in found
        },
    }
    study = {
        "seeds": [3, 3],
        "solves": {"count": 7, "seconds": 1.0, "worst_residual": 1e-8, "worst_apart": 1e-9},
        "reference_check": {"grid": 1024, "seeds": [3], "worst_over_bound": 0.5},
        "accuracies": [judged],
    }
    shown = exhibit("coverage", study)
    assert shown.tables[0].rows[0][:5] == ("mu", 0.02, 1, 100.0, 100.0)
    ((figure, data),) = shown.figures
    drawn = svg(figure, data)
    assert drawn is not None
