"""Keys, rows and files of a sweep: what changes a key, what each column is, what no output may replace."""

from __future__ import annotations

import sqlite3
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.errors import InputError
from refimpl.solution.limits import Limit, ModelWarning
from verification.cli import main
from verification.sweep import engine, run
from verification.sweep.engine import Progress, Sweep
from verification.sweep.export import EXPORTED, unit_of
from verification.sweep.run import COORDINATES, OUTCOMES, outcome
from verification.sweep.store import checksum, open_store
from verification.sweep.study_file import study_from_dict

SMALL = {"scene": "table1-rough", "realisations": 2, "vary": {"grid": [6, 8]}}
STEEL = rf.Material(200e9, 0.3)


def digest(monkeypatch: pytest.MonkeyPatch, root: Path, versions: dict[str, str]) -> str:
    """The digest of a package at ``root`` beside those versions of libraries."""
    monkeypatch.setattr(rf, "__file__", str(root / "__init__.py"))
    monkeypatch.setattr(run, "version", versions.__getitem__)
    return run.code_digest.__wrapped__()  # type: ignore[attr-defined]  # without its cache


def test_a_key_knows_every_file_of_the_code_and_every_library(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    files = ("__init__.py", "errors.py", "solvers/dense.py", "solvers/production/level.py")
    for name in files:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(f"{name} = 1\n")
    versions = {"numpy": "2.1", "scipy": "1.15", "ducc0": "0.36"}
    found = [digest(monkeypatch, tmp_path, versions)]
    assert digest(monkeypatch, tmp_path, versions) == found[0]
    for name in files:
        (tmp_path / name).write_text(f"{name} = 2\n")
        found.append(digest(monkeypatch, tmp_path, versions))
    (tmp_path / "solvers/dense.py").rename(tmp_path / "solvers/plain.py")
    found.append(digest(monkeypatch, tmp_path, versions))
    found += [digest(monkeypatch, tmp_path, versions | {name: "9"}) for name in versions]
    assert len(set(found)) == len(found) == 1 + 4 + 1 + 3


def test_a_key_knows_the_measured_files(tmp_path: Path) -> None:
    heights = np.random.default_rng(3).normal(size=(12, 12))
    np.save(tmp_path / "map.npy", heights)
    lower = rf.Body(STEEL, rf.MeasuredSurface(tmp_path / "map.npy", unit="nm", pixel_size=1e-5))
    scene = rf.Scene(rf.Body(STEEL, rf.Sphere(0.1)), lower, rf.Friction(), 0.1, 1e-4)
    (tmp_path / "scene.toml").write_text(rf.scene_to_toml(scene))
    table = {"scene": "scene.toml", "vary": {"grid": [6]}}
    (first,) = study_from_dict(table, tmp_path).runs()
    (again,) = study_from_dict(table, tmp_path).runs()
    np.save(tmp_path / "map.npy", heights + 1)
    (other,) = study_from_dict(table, tmp_path).runs()
    assert first.key == again.key != other.key


@pytest.mark.parametrize("end", ["", "-wal", "-shm", "-journal"])
def test_no_output_replaces_a_file_of_the_store(
    end: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study, store = tmp_path / "s.toml", tmp_path / "s.sqlite"
    study.write_text('scene = "hertz"\n[vary]\ngrid = [6]\n')
    assert main(["sweep", str(study), "--store", str(store), "--csv", f"{store}{end}"]) == 2
    assert "another file than that of --store" in capsys.readouterr().err
    assert not store.exists()


def test_each_outcome_of_a_row_by_hand() -> None:
    """Flats of 5 x 5 elements touch everywhere: 16 on the border. Slopes by their angles."""
    flats = rf.Scene(rf.Body(STEEL, rf.Flat()), rf.Body(STEEL, rf.Flat()), rf.Friction(), 2.0, 1e-3)
    assert outcome(rf.solve(flats, 5), flats)["border_elements"] == 16
    rough = rf.Body(rf.Material(1e7, 0.3), rf.GaussianRoughness(3e-5, 2e-4, seed=2))
    scene = replace(flats, lower=rough, friction=rf.Friction(tau=1e4, beta=0.2), load=0.2)
    s = rf.solve(scene, 16)
    parts = {
        "friction_coefficient": {"active set": 0.25, "iteration": 0.5},
        "contact_area": {"active set": 2.0},
    }
    row = outcome(replace(s, uncertainty=parts, certificate=replace(s.certificate, gap=0.125)), scene)
    pushed = s.pressure * np.sin(s.theta_x) * np.cos(s.theta_y)
    expected = {
        "status": s.status.value,
        "friction_coefficient": s.friction_coefficient,
        "contact_area": s.contact_area,
        "contact_area_corrected": s.contact_area_corrected,
        "max_pressure": s.max_pressure,
        "approach": s.approach,
        "normal_force": s.normal_force,
        "friction_force": s.friction_force,
        "elastic_friction": pytest.approx(float(pushed.sum()) * (1e-3 / 16) ** 2, rel=1e-10),
        "binormal_force": s.binormal_force,
        "residual": 0.125,
        "friction_coefficient_cycle": 0.25,
        "contact_area_cycle": 2.0,
        "border_elements": sum(
            bool(s.contact[i, j]) for i in range(16) for j in range(16) if {i, j} & {0, 15}
        ),
    }
    assert {name: row[name] for name in expected} == expected
    assert abs(np.cos(s.theta_y)[s.contact] - 1).max() > 1e-4


def test_failed_runs_are_neither_found_nor_finished(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    execute, seen = engine.execute, list[Progress]()

    def failing(inputs: Any) -> Any:
        if inputs["grid"] == 8:
            raise ArithmeticError("no solution")
        return execute(inputs)

    monkeypatch.setattr(engine, "execute", failing)
    done = engine.sweep(study_from_dict(SMALL), tmp_path / "s.sqlite", workers=0, tick=seen.append)
    assert (done.found, done.finished, len(done.failures)) == (0, 2, 2)
    assert [row["grid"] for row in done.rows] == [6, 6]
    assert len(done.solve_seconds) == 2
    assert set(done.failures.values()) == {"ArithmeticError: no solution"}
    assert [(one.done, one.failed) for one in seen] == [(0, 0), (1, 0), (1, 1), (2, 1), (2, 2)]
    assert {one.total for one in seen} == {4}
    monkeypatch.setattr(engine, "execute", execute)
    again = engine.sweep(study_from_dict(SMALL), tmp_path / "s.sqlite", workers=0)
    assert (again.found, again.finished, again.failures) == (2, 2, {})


@pytest.mark.parametrize("status", list(rf.Status))
def test_rows_are_solutions_or_not_by_their_status(
    status: rf.Status, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows = [
        dict.fromkeys((*COORDINATES, *OUTCOMES), 1.0)
        | {"status": end, "key": key, "grid": 6, "warnings": "", "parameters": "{}"}
        for end, key in (("converged", "a"), (status.value, "b"))
    ]
    done = Sweep(0, 2, {}, rows, [1.0, 2.0], 3.0)
    solved = status in (rf.Status.CONVERGED, rf.Status.CYCLED)
    assert done.unconverged == ([] if solved else rows[1:])
    expected = {"converged": 2} if status is rf.Status.CONVERGED else {"converged": 1, status.value: 1}
    assert done.statuses == expected
    (tmp_path / "s.toml").write_text('scene = "hertz"\n[vary]\ngrid = [6]\n')
    monkeypatch.setattr(engine, "sweep", lambda *_, **__: done)
    assert main(["sweep", str(tmp_path / "s.toml"), "--store", str(tmp_path / "s.sqlite")]) == int(not solved)


def test_a_row_under_another_key_is_damage(tmp_path: Path) -> None:
    """Its checksum may be right."""
    path = tmp_path / "s.sqlite"
    engine.sweep(study_from_dict(SMALL | {"realisations": 1, "vary": {"grid": [6]}}), path, workers=0)
    with sqlite3.connect(path) as connection:
        (row,) = connection.execute("select * from runs").fetchall()
        values = ["0" * 32, *row[1:-1]]
        connection.execute("update runs set key = ?, checksum = ?", (values[0], checksum(values)))
    connection.close()
    with pytest.raises(InputError, match="damaged"), open_store(path):
        pass


def test_further_outcomes_of_an_oblong_row() -> None:
    """Slopes of 0.03 and 0.04: their root mean square is sqrt(0.00125); E* / H is 1 / 0.91."""
    tilt = 1e-3 * np.add.outer(0.03 * np.arange(12) / 6, 0.04 * np.arange(6) / 6)
    lower = rf.Body(rf.Material(1e9, 0.3, hardness=1e9), rf.ArraySurface(tilt))
    upper = rf.Body(rf.Material(float("inf"), 0.3), rf.Flat())
    scene = rf.Scene(upper, lower, rf.Friction(), 2.0, size=(2e-3, 1e-3))
    warned = [ModelWarning(Limit(x), 1, 2, "") for x in ("border", "half-space", "border")]
    s = replace(rf.solve(scene, (12, 6)), contact_area=5e-7, plastic_area=1e-7, warnings=tuple(warned))
    p = np.arange(72.0).reshape(12, 6)
    row = outcome(replace(s, pressure=p, gap=p + 72), scene)
    assert row["plasticity_index"] == pytest.approx(0.00125**0.5 / 0.91)
    assert (row["plastic_area"], row["plastic_share"], row["contact_area_share"]) == (1e-7, 0.2, 0.25)
    assert (row["mean_pressure"], row["mean_gap"], row["elements_x"], row["elements_y"]) == (36, 107.5, 12, 6)
    assert row["warnings"] == "border; half-space"


def test_each_coordinate_of_a_run() -> None:
    axes = {"grid": 6, "load": 3.0, "upper_rms": 2e-7, "lower_rms": 5e-7, "correlation_length": 3e-4}
    axes |= {"sliding_direction": 0.3, "sliding_offset": -2e-6, "tau": 1e6, "beta": 0.07}
    table = {"scene": "table1-rough", "vary": axes | {"upper.material.nu": 0.21}}
    (one,) = study_from_dict(table).runs()
    assert one.coordinates == {"realisation": 0, **axes, "parameters": '{"upper.material.nu": 0.21}'}
    upper, lower = (one.inputs["scene"][name]["surface"][-1] for name in ("upper", "lower"))
    assert (upper["rms"], lower["rms"]) == (2e-7, 5e-7)


def test_the_unit_of_every_column() -> None:
    units = {
        "N": "load normal_force friction_force elastic_friction binormal_force",
        "m": "upper_rms lower_rms correlation_length sliding_offset approach mean_gap",
        "m^2": "contact_area contact_area_corrected plastic_area contact_area_cycle",
        "Pa": "tau max_pressure mean_pressure",
        "rad": "sliding_direction",
        "s": "seconds",
    }
    for unit, names in units.items():
        found = [name for name in EXPORTED if unit_of(name) == unit and not name.endswith("_error")]
        assert sorted(found) == sorted(names.split())
