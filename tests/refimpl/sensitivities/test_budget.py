"""Budgets after V&V 20: what each part is, how parts add, and tolerances in a scene's file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import refimpl as rf
from refimpl.model.forces import facet_resultants
from refimpl.scene.scene_file import read_tolerances, scene_to_toml
from refimpl.sensitivities.budget import Budget, Budgets, budget

STEEL, COPPER = rf.Material(E=200e9, nu=0.3), rf.Material(E=118e9, nu=0.3)
SCENE = rf.Scene(
    upper=rf.Body(STEEL, rf.Sphere(radius=0.02)),
    lower=rf.Body(COPPER, rf.GaussianRoughness(rms=2e-6, correlation_length=400e-6, seed=3)),
    friction=rf.Friction(tau=40e6, beta=0.1),
    load=100.0,
    side=1.61e-3,
)
TOLERANCES = {"lower.material.E": 0.02, "friction.tau": 0.1, "load": 0.01, "lower.surface[0].rms": 0.05}


@pytest.fixture(scope="module")
def solution() -> rf.Solution:
    return rf.solve(SCENE, 64)


@pytest.fixture(scope="module")
def found(solution: rf.Solution) -> Budgets:
    return budget(SCENE, solution, TOLERANCES, sampling={"contact_area": 1e-9})


def test_input_of_the_peak_is_what_a_changed_scene_gives(found: Budgets, solution: rf.Solution) -> None:
    stiffer = replace(SCENE, lower=rf.Body(rf.Material(118e9 * 1.02, 0.3), SCENE.lower.surface))
    change = rf.solve(stiffer, 64).max_pressure - solution.max_pressure
    share = found.numbers["max_pressure"].inputs["lower.material.E"]
    assert share == pytest.approx(change, rel=0.05)  # a step of 2 % is no derivative


def test_cosines_are_those_of_the_exact_facets(found: Budgets, solution: rf.Solution) -> None:
    exact = facet_resultants(
        solution.pressure, solution.traction, solution.slopes, solution.grid.element_area
    )
    mu = found.numbers["friction_coefficient"]
    assert mu.sources["cosines"] == pytest.approx(abs(exact.friction / exact.normal - mu.value))
    # second order in the slope: about its square, times mu
    assert 0 < mu.sources["cosines"] < 3 * solution.slope_error.max_slope**2
    across = found.numbers["binormal_force"]
    assert across.sources["cosines"] == pytest.approx(abs(exact.binormal - across.value))


def test_cosines_misjudge_the_load(found: Budgets, solution: rf.Solution) -> None:
    """The peak and the area are those of another load; the peak, by solving for it."""
    exact = facet_resultants(
        solution.pressure, solution.traction, solution.slopes, solution.grid.element_area
    )
    tight = [rf.solve(replace(SCENE, load=load), 64, tolerance=1e-11) for load in (100.0, exact.normal)]
    change = abs(tight[1].max_pressure - tight[0].max_pressure)
    assert found.numbers["max_pressure"].sources["cosines"] == pytest.approx(change, rel=0.02)
    share = found.derivatives.relative("contact_area", "load") * abs(exact.normal / solution.normal_force - 1)
    area = found.numbers["contact_area"]
    assert area.sources["cosines"] == pytest.approx(share * area.value, rel=1e-6, abs=0)


def test_parts_add_in_squares_and_model_form_as_it_is() -> None:
    part = Budget(1.0, numerical=3.0, inputs={"a": 4.0}, sources={"x": 1.0, "y": 0.5}, sampling=12.0)
    assert part.total == pytest.approx(1.5 + 13.0)
    assert Budget(1.0, 3.0, {}, {}).total == 3.0


def test_tolerances_stand_in_the_scenes_file(tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    stated = '\n[tolerances]\n"lower.material.E" = 0.02\n"lower.surface[0].rms" = 0.05\n'
    file.write_text(scene_to_toml(SCENE) + stated)
    assert read_tolerances(file) == {"lower.material.E": 0.02, "lower.surface[0].rms": 0.05}
    assert rf.read_scene(file).load == SCENE.load


def test_without_tolerances_there_is_no_input(solution: rf.Solution) -> None:
    found = budget(SCENE, solution)
    assert found.tolerances == {}
    assert all(part.input == 0 for part in found.numbers.values())


@pytest.mark.parametrize(
    ("line", "named"),
    [
        ('"lower.material.G" = 0.02', "lower.material.G"),
        ('"lower.material.E" = 2', "between 0 and 1"),
        ('"lower.material.E" = "2 %"', "between 0 and 1"),
        ("load = -0.1", "between 0 and 1"),
        ('"upper.surface[0].rms" = 0.1', "upper.surface"),
    ],
)
def test_bad_tolerances_are_refused(tmp_path: Path, line: str, named: str) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(f"{scene_to_toml(SCENE)}\n[tolerances]\n{line}\n")
    with pytest.raises(rf.InputError, match="tolerances") as refused:
        rf.read_scene(file)
    assert named in str(refused.value)
