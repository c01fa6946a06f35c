"""Round trips with all fields set: nothing that is saved comes back otherwise, or as its default."""

from __future__ import annotations

import csv
import io
import json
import math
import pickle
import tomllib
from dataclasses import asdict, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import refimpl as rf
from refimpl.accuracy.grid_features import GridFeatures
from refimpl.model.problem import Terms
from refimpl.planning.plan import Plan, make_plan
from refimpl.scene.discretise import discretise
from refimpl.scene.scene_file import scene_from_dict, scene_to_dict, scene_to_toml
from refimpl.solution.quantities import QUANTITIES
from refimpl.surfaces import surface_from_dict
from refimpl.surfaces.from_table import KINDS
from reports.results import check
from tests.generated import instances, plain
from verification.coverage.building import features_of
from verification.framework.case import Case, Measured, Metric, Result, Tier
from verification.framework.runner import Run as CasesRun
from verification.sweep.export import header, to_csv
from verification.sweep.run import COORDINATES, OUTCOMES, Run
from verification.sweep.store import open_store
from verification.sweep.study_file import study_from_dict

LENGTHS = st.floats(1e-6, 1e-3)
SHARES = st.floats(0.01, 0.49)
KNOWN = {
    ("Sphere", "radius"): st.floats(0.01, 1.0),
    ("GaussianRoughness", "rms"): LENGTHS,
    ("GaussianRoughness", "correlation_length"): st.one_of(LENGTHS, st.tuples(LENGTHS, LENGTHS)),
    ("GaussianRoughness", "acf_level"): SHARES,
    ("SelfAffineRoughness", "hurst"): SHARES,
    ("SelfAffineRoughness", "short_cut"): st.floats(1e-6, 2e-6),
    ("SelfAffineRoughness", "roll_off"): st.floats(3e-6, 9e-6),
    ("SelfAffineRoughness", "long_cut"): st.floats(1e-5, 1e-4),
    ("SelfAffineRoughness", "rms"): LENGTHS,
    ("SelfAffineRoughness", "rms_gradient"): st.none(),  # one of both: the other has a test of its own
    ("SelfAffineRoughness", "anisotropy"): st.floats(2.0, 9.0),
    ("MeasuredSurface", "path"): st.just(Path("/nowhere/map.npy")),
    ("MeasuredSurface", "unit"): st.sampled_from(["m", "mm", "um", "nm"]),
    ("MeasuredSurface", "pixel_size"): st.tuples(LENGTHS, LENGTHS),
    ("MeasuredSurface", "outliers"): st.floats(3.0, 9.0),
    ("MeasuredSurface", "scan_lines"): st.sampled_from(["x", "y"]),
    ("MeasuredSurface", "low_pass"): st.floats(1e-6, 2e-6),
    ("MeasuredSurface", "high_pass"): st.floats(3e-6, 9e-6),
    ("MeasuredSurface", "level"): st.sampled_from(["none", "mean"]),
    ("MeasuredSurface", "missing"): st.just("refuse"),
    ("MeasuredSurface", "max_missing"): SHARES.filter(lambda share: share != 0.05),
    ("MeasuredSurface", "mirror"): st.sampled_from(["x", "y"]),
    ("MeasuredSurface", "rotate_deg"): st.sampled_from([90.0, 180.0, 270.0]),
    ("MeasuredSurface", "height_scale"): st.floats(0.9, 0.99),
    ("MeasuredSurface", "centre"): st.tuples(LENGTHS, LENGTHS),
    ("Material", "E"): st.floats(1e6, 1e12),
    ("Material", "nu"): SHARES,
    ("Material", "hardness"): st.floats(1e6, 1e10),
    ("Friction", "tau"): st.floats(1.0, 1e9),
    ("Friction", "beta"): SHARES,
    ("Scene", "load"): st.floats(1e-3, 1e3),
    ("Scene", "side"): st.none(),  # size is given
    ("Scene", "sliding_offset"): st.floats(-1e-3, 1e-3),
    ("Scene", "size"): st.tuples(st.floats(1e-3, 9e-3), st.floats(1e-3, 9e-3)),
    ("Grid", "shape"): st.tuples(st.integers(1, 99), st.integers(1, 99)),
    ("Grid", "lengths"): st.tuples(LENGTHS, LENGTHS),
}
ANY_SURFACE = st.one_of(*(instances(kind, KNOWN) for kind in KINDS.values()))
SUMMED = st.lists(ANY_SURFACE, min_size=1, max_size=3).map(lambda p: sum(p[1:], start=p[0]))
KNOWN |= {
    ("Scene", "friction"): instances(rf.Friction, KNOWN),  # of the laws, what a scene file may hold
    ("Body", "surface"): SUMMED,
}
FEW = settings(max_examples=25, derandomize=True, database=None)


@FEW
@given(instances(rf.Scene, KNOWN))
def test_scenes(scene: rf.Scene) -> None:
    for table in (tomllib.loads(scene_to_toml(scene)), json.loads(json.dumps(scene_to_dict(scene)))):
        again = scene_from_dict(table, Path("/elsewhere"))
        assert plain(again) == plain(scene)


def test_a_square_scene_keeps_its_side_and_a_rigid_body_its_name() -> None:
    rigid = rf.Body(rf.Material(np.inf, 0.2), rf.Flat())
    scene = rf.Scene(rigid, rf.Body(rf.Material(1e9, 0.3), rf.Flat()), rf.Friction(), 2.0, side=3e-3)
    assert "rigid" in scene_to_toml(scene)
    assert plain(scene_from_dict(tomllib.loads(scene_to_toml(scene)), Path())) == plain(scene)


@FEW
@given(SUMMED)
def test_surfaces(surface: Any) -> None:
    table = json.loads(json.dumps(surface.to_dict()))
    assert plain(surface_from_dict(table, Path("/elsewhere"))) == plain(surface)
    assert plain(pickle.loads(pickle.dumps(surface))) == plain(surface)


def test_a_surface_given_by_its_gradient_comes_back_by_its_gradient() -> None:
    sizes = {"hurst": 0.7, "roll_off": 2e-5, "long_cut": 4e-5, "short_cut": 3e-6, "seed": 5}
    surface = rf.SelfAffineRoughness(**sizes, rms_gradient=0.13)
    again = surface_from_dict(json.loads(json.dumps(surface.to_dict())))
    assert plain(again) == plain(surface)
    assert (again.given, again.rms_gradient) == ("rms_gradient", 0.13)  # type: ignore[attr-defined]


@FEW
@given(instances(GridFeatures, KNOWN))
def test_features_of_a_grid(made: GridFeatures) -> None:
    assert plain(features_of(json.loads(json.dumps(asdict(made))))) == plain(made)


def test_rows_of_a_sweep(tmp_path: Path) -> None:
    """Every column a value of its own: one that stands in another's place is seen."""
    coordinates: dict[str, float | str] = {name: 2.5 + k for k, name in enumerate(COORDINATES)}
    coordinates |= {"parameters": '{"lower.material.nu": 0.25}'}
    outcomes = {name: -1.0 / (3 + k) for k, name in enumerate(OUTCOMES)}
    outcomes |= {"status": "stagnated", "seconds": 12.25}
    run = Run(coordinates, {"grid": 8, "scene": {"load": 1.5}})
    with open_store(tmp_path / "s.sqlite") as store:
        store.add(run, outcomes)
    with open_store(tmp_path / "s.sqlite") as store:
        (row,) = store.finished([run])
    expected: dict[str, object] = {"key": run.key, **coordinates, **outcomes}
    assert row == expected
    (read,) = csv.DictReader(io.StringIO(to_csv([row])))
    for name, value in (expected | {"lower.material.nu": 0.25}).items():
        assert read[header(name)] == str(value), name


def test_a_study_has_all_that_its_table_states() -> None:
    vary = {"grid": [8, 16], "load": [3.0, 4.0], "upper_rms": [1e-7], "lower_rms": [2e-7]}
    vary |= {"correlation_length": [2e-4], "sliding_direction": [0.3], "sliding_offset": [1e-5]}
    vary |= {"tau": [5e6], "beta": [0.07], "lower.surface[0].lay": [0.4]}
    table = {"scene": "table1-rough", "realisations": 3, "first_seed": 7, "normalise": True, "vary": vary}
    study = study_from_dict(table | {"solve": {"method": "dense", "oblique": False, "tolerance": 1e-6}})
    run = list(study.runs())[-1]  # of the third realisation
    assert run.coordinates["realisation"] == 2
    assert run.coordinates["parameters"] == '{"lower.surface[0].lay": 0.4}'
    single = {name: values[-1] for name, values in vary.items() if name in run.coordinates}
    assert {name: run.coordinates[name] for name in single} == single
    solved = scene_from_dict(run.inputs["scene"], Path())
    assert (solved.load, solved.sliding_direction, solved.sliding_offset) == (4.0, 0.3, 1e-5)
    assert solved.friction == rf.Friction(tau=5e6, beta=0.07)
    upper, lower = solved.upper.surface.parts[-1], solved.lower.surface.parts[0]
    assert upper == rf.GaussianRoughness(1e-7, 2e-4, seed=11, normalise=True)
    assert lower == rf.GaussianRoughness(2e-7, 2e-4, seed=12, normalise=True, lay=0.4)
    assert run.inputs["solve"] == {"method": "dense", "oblique": False, "tolerance": 1e-6}


def test_a_case_keeps_its_numbers_to_the_report() -> None:
    """From a case's declaration and its measurement to the result file, by JSON, as a report reads it."""
    measured = Measured(2.5, 2.0, 0.125, "N", {"h": [1.0, np.nan]}, "a note")
    case = Case(
        "subject/slug", "Title", "Claim", "Source", Metric.RELATIVE, 0.5, "Reason", lambda: measured,
        Tier.FULL,
    )  # fmt: skip
    result = case.run()
    document = json.loads(json.dumps(CasesRun(Tier.FULL, ("*",), (result,), 3.25).document()))
    (found,) = check(document)["cases"]
    numbers = {
        "value": 2.5,
        "reference": 2.0,
        "reference_uncertainty": 0.125,
        "error": 0.25,
        "tolerance": 0.5,
    }
    texts = {
        "id": "subject/slug",
        "title": "Title",
        "claim": "Claim",
        "source": "Source",
        "metric": "relative",
    }
    texts |= {"tolerance_reason": "Reason", "status": "pass", "unit": "N", "note": "a note", "tier": "full"}
    expected = {**numbers, **texts, "seconds": result.seconds, "data": {"h": [1.0, None]}}
    assert set(expected) == {field.name for field in fields(Result)}
    assert found == expected
    assert (document["tier"], document["only"], document["seconds"]) == ("full", ["*"], 3.25)
    assert document["counts"] == {"pass": 1, "fail": 0, "error": 0, "unavailable": 0}


def test_plans() -> None:
    scene = rf.read_scene("table1-rough")
    requested = Terms(coupled=True, tilted=False, plastic=False)
    found = make_plan(discretise(scene, scene.grid(24)), "dense", requested, demand=0.03)
    assert plain(pickle.loads(pickle.dumps(found))) == plain(found)
    other = scene.grid((20, 28))
    # 8 bytes in each of 10 matrices between 560 elements
    assert plain(found.on(other)) == plain(replace(found, grid=other, memory=8 * 10 * 560**2))
    assert {field.name for field in fields(Plan)} > {"method", "requested", "demand", "budget", "contact"}
    assert (found.method, found.requested, found.demand, found.budget) == ("dense", requested, 0.03, 0.015)
    assert found.decided_on == 24 * 24


def test_solutions() -> None:
    """The JSON of a solution holds each of its numbers, and its parts of uncertainty."""
    steel = rf.Material(200e9, 0.3, hardness=2e9)
    lower = rf.Body(rf.Material(118e9, 0.28), rf.Sphere(-0.2) + rf.GaussianRoughness(2e-7, 2e-4, seed=2))
    scene = rf.Scene(rf.Body(steel, rf.Flat()), lower, rf.Friction(15e6, 0.08), 70.0, size=(1.7e-3, 1.2e-3))
    solution = rf.solve(scene, (34, 20), tolerance=1e-7)
    found = json.loads(json.dumps(solution.summary()))
    names = ("approach", "normal_force", "friction_force", "binormal_force", "friction_coefficient")
    names += ("contact_area", "contact_area_corrected", "plastic_area", "max_pressure", "plastic_share")
    assert {name: found[name] for name in names} == {name: getattr(solution, name) for name in names}
    assert len({found[name] for name in names} - {0.0}) >= 8  # no two of them alike
    assert (found["grid"], found["size"], found["tolerance"]) == ([34, 20], [1.7e-3, 1.2e-3], 1e-7)
    assert found["certificate"] == asdict(solution.certificate)
    assert found["uncertainty"] == {name: dict(parts) for name, parts in solution.uncertainty.items()}
    assert [term["effect"] for term in found["plan"]] == [asdict(t.effect) for t in solution.plan.terms]
    assert found["neglected"] == {name: asdict(one) for name, one in solution.details.neglected.items()}
    assert len(found["warnings"]) == len(solution.warnings) > 0
    again = pickle.loads(pickle.dumps(solution))
    for name in (name for name in dir(solution) if not name.startswith("_") and name != "details"):
        one, other = getattr(solution, name), getattr(again, name)
        same = np.array_equal(one, other) if isinstance(one, np.ndarray) else repr(one) == repr(other)
        assert same or callable(one), name


def test_a_solution_computes_what_is_read_and_stores_all() -> None:
    """A solve leaves error bars and warnings open; a pickle has them."""
    solution = rf.solve(rf.read_scene("table1-rough"), 32)
    open_yet = {"features", "neglected", "slope_error"}
    assert not open_yet & vars(solution.details.evidence).keys()
    assert solution.contact_area > 0
    assert not open_yet & vars(solution.details.evidence).keys()
    stored = vars(pickle.loads(pickle.dumps(solution)))
    assert repr(stored["uncertainty"]) == repr(solution.uncertainty)
    assert stored["warnings"] == solution.warnings


def test_flat_slopes_are_flat_in_a_pickle() -> None:
    """Bounds of pressures at the hardness exist for flat slopes alone; computed anew, they are the same."""
    softer = rf.Body(rf.Material(118e9, 0.3, hardness=120e6), rf.Flat())
    scene = replace(rf.read_scene("hertz"), lower=softer)
    solution = rf.solve(scene, 32)
    again = pickle.loads(pickle.dumps(solution))
    assert again.slopes.is_flat
    assert solution.plastic_area > 0
    assert math.isfinite(solution.details.bounds.energy)
    assert repr(again.details.bounds) == repr(solution.details.bounds)


def test_no_solution_is_forged() -> None:
    solution = rf.solve(rf.read_scene("hertz"), 8)
    for name in (*QUANTITIES, "pressure", "status", "uncertainty"):
        with pytest.raises(TypeError, match="unexpected keyword"):
            replace(solution, **{name: getattr(solution, name)})
        with pytest.raises(AttributeError):
            setattr(solution, name, getattr(solution, name))
