"""Reference data: bounds are true, files are whole and reproducible, changes in them are found."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from refimpl.grid import Array
from tests.verification.solver_suite.asked import problem_of
from verification.cli import main
from verification.solver_suite import own, reference_solution
from verification.solver_suite.checks.sliding import FREE, PERIODIC
from verification.solver_suite.gaps import rough_bump, waves
from verification.solver_suite.pin_arrays import PinArray
from verification.solver_suite.protocol import ContactProblem, Coupling
from verification.solver_suite.reference import agreement, files
from verification.solver_suite.reference.certified import (
    CONTACT,
    SEPARATED,
    Certified,
    certified,
)
from verification.solver_suite.reference.files import SUMS, checksums
from verification.solver_suite.reference.periodic_bound import periodic_bound
from verification.solver_suite.reference.posed import _key

E = 2e9
SMALL = ("pins", "out-of-reach*", "sheared-pins", "capped-pins*")
ONLY = [word for name in SMALL for word in ("--only", f"solver/{name}")]


def _lowest(heights: Array) -> Array:
    return np.asarray(heights - heights.min())


def within(found: Certified, exact: Array) -> None:
    """The exported pressures and all bounds hold against the exact ones."""
    off = found.pressure - exact
    dA = found.problem.element_area
    rounding = 1e-15 * float(exact.max())
    assert float(np.abs(off).max()) <= found.bounds.pressure + rounding
    assert float(np.sqrt((off**2).sum() * dA)) <= found.bounds.pressure_l2 + rounding
    assert abs(float(off.sum())) * dA <= found.bounds.load + rounding * exact.size * dA
    assert ((found.contact == CONTACT) <= (exact > 0)).all()
    assert ((found.contact == SEPARATED) <= (exact == 0)).all()


@pytest.mark.parametrize("by_load", [True, False])
@pytest.mark.parametrize("array", [FREE[2], PERIODIC[2]])
def test_pressures_that_were_chosen_lie_within_the_bounds(array: PinArray, by_load: bool) -> None:
    found = certified(problem_of(array, by_load=by_load))
    # the pins' gaps are rounded (1e-16 of 0.5 m), which moves pressures by 1e-12 of the peak
    slack = replace(found.bounds, pressure=found.bounds.pressure + 1e-11 * array.pressure.max())
    assert float(np.abs(found.pressure - array.pressure).max()) <= slack.pressure
    assert found.bounds.pressure < 1e-7 * array.pressure.max()
    assert np.array_equal(found.contact == CONTACT, array.pressure > 0)
    assert np.array_equal(found.contact == SEPARATED, array.pressure == 0)


WAVY = ContactProblem(_lowest(0.01 * waves(16, 5, shortest=4)), 1 / 16, E, approach=-0.006, periodic=True)
BUMP = ContactProblem(_lowest(rough_bump(8, 1)), 1 / 8, E, approach=0.01)


@pytest.mark.parametrize("depth", [-0.016, -0.0005])
def test_at_a_periodic_approach_elimination_lies_within_the_bounds(depth: float) -> None:
    found = certified(replace(WAVY, approach=depth))
    within(found, reference_solution.eliminated(found.problem))
    assert 0 < found.bounds.pressure < 1e-8 * found.pressure.max()


@pytest.mark.parametrize("tolerance", [1e-4, 1e-8])
def test_a_loose_solution_lies_within_its_periodic_bounds(tolerance: float) -> None:
    """Its error is large, so that a bound without a margin would show."""
    loose, exact = own.solved(WAVY, tolerance), reference_solution.eliminated(WAVY)
    bound = periodic_bound(WAVY, loose)
    assert bound is not None
    error = np.asarray(loose.pressure) - exact
    assert float(np.abs(error).max()) <= bound.pressure
    assert abs(float(error.sum())) * WAVY.element_area <= bound.load
    moved = reference_solution.by_pressure(WAVY, error)
    assert float(np.vdot(error, moved)) * WAVY.element_area <= bound.energy
    assert (bound.in_contact <= (exact > 0)).all()
    assert (bound.out_of_contact <= (exact == 0)).all()


def test_where_planes_overlap_or_are_free_no_periodic_bound_is_claimed() -> None:
    """Full contact: any mean pressure is a solution at approach 0, none beyond."""
    under_load = replace(
        WAVY, gap=_lowest(0.001 * waves(8, 5, shortest=2)), spacing=1 / 8, approach=None, load=2e8
    )
    solution = own.solved(under_load, 1e-10)
    assert solution.pressure.min() > 0
    assert periodic_bound(replace(under_load, load=None, approach=0.0), solution) is None
    assert periodic_bound(BUMP, own.solved(BUMP, 1e-10)) is None


def test_without_contact_pressures_are_exactly_zero() -> None:
    found = certified(replace(BUMP, approach=-0.05))
    assert not found.pressure.any()
    assert found.bounds.pressure == 0
    assert (found.contact == SEPARATED).all()


def test_a_problem_that_differs_in_one_number_is_another_one() -> None:
    gap = np.array([[0.0, 1.0, 5.0], [3.0, 2.0, 4.0]]) * 1e-7
    slides = Coupling(tau=2e6, beta=0.7, shear_compliance=-3e-11, sliding_direction=2.5)
    whole = ContactProblem(
        gap, 1e-6, 5e9, approach=-4e-8, periodic=True, coupling=slides, spacing_y=3e-6, hardness=8e8
    )
    others: list[dict[str, Any]] = [
        {"spacing": 2e-6}, {"spacing_y": 2e-6}, {"reduced_modulus": 1e9}, {"approach": -1e-8},
        {"hardness": 1e9}, {"approach": None, "load": 1.0}, {"periodic": False}, {"gap": gap[::-1]},
        {"gap": gap.reshape(3, 2)}, *({"coupling": replace(slides, **{key: 0.5})} for key in vars(slides)),
    ]  # fmt: skip
    posed = [whole, *(replace(whole, **other) for other in others)]
    assert len({_key(problem) for problem in posed}) == len(posed)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("export") / "data"
    assert main(["verify", "--export", str(path), *ONLY]) == 0
    return path


def test_equal_versions_write_equal_bytes(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    again = tmp_path / "again"
    assert main(["verify", "--export", str(again), *ONLY, "--json", "-"]) == 0
    assert json.loads(capsys.readouterr().out)["version"] == files.version_of(folder)
    for path in folder.rglob("*"):
        if path.is_file():
            assert path.read_bytes() == (again / path.relative_to(folder)).read_bytes(), path.name


def test_the_index_has_its_schema(folder: Path) -> None:
    jsonschema = pytest.importorskip("jsonschema")
    schema = json.loads((folder / "schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    index = json.loads((folder / "index.json").read_text())
    jsonschema.validate(index, schema)
    del index["problems"][0]["answer"]["bounds"]["load"]
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(index, schema)


def test_arrays_have_the_shapes_of_the_index_and_solve_the_problems(folder: Path) -> None:
    for entry in agreement.index_of(folder)["problems"]:
        problem = agreement.problem_of(folder, entry)
        pressure = agreement.array_of(folder, entry, "pressure")
        answer = entry["answer"]
        assert pressure.sum() * problem.element_area == pytest.approx(answer["load"], rel=1e-12)
        assert np.count_nonzero(pressure) == answer["elements_in_contact"]
        if pressure.any():
            assert reference_solution.residual(problem, pressure).worst < 1e-11
        if pressure.any() and problem.hardness is None:
            assert reference_solution.approach_of(problem, pressure) == pytest.approx(
                answer["approach"], rel=1e-9
            )


def test_an_export_agrees_with_itself(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert agreement.main([str(folder)]) == 0
    assert "every problem agrees" in capsys.readouterr().out


@pytest.fixture
def copy(folder: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(folder, tmp_path / "copy"))


def multiply(copy: Path, factor: float) -> None:
    name = copy / "data/pins.pressure.f64"
    (factor * np.fromfile(name, "<f8")).astype("<f8").tofile(name)


def test_a_changed_file_is_found(copy: Path) -> None:
    multiply(copy, 1 + 1e-15)
    found = list(agreement.disagreements(copy, ["pins"]))
    assert found == [f"data/pins.pressure.f64: its checksum is not the one in {SUMS}"]


def test_pressures_beyond_the_bounds_are_found_whatever_the_checksums(copy: Path) -> None:
    multiply(copy, 1 + 1e-7)
    (copy / SUMS).write_text("".join(f"{digest}  {name}\n" for name, digest in checksums(copy).items()))
    (found,) = agreement.disagreements(copy, ["pins"])
    assert found.startswith("pins: pressure differs by")


def test_a_folder_that_holds_something_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "mine.txt").write_text("keep")
    only = ["--only", "solver/pins"]
    assert main(["verify", "--export", str(tmp_path), *only]) == 2
    assert main(["verify", "--export", str(tmp_path / "x"), "--self-test"]) == 2
    assert main(["verify", "--export", str(tmp_path / "x"), "--only", "solver/wide-pins"]) == 2
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]
    assert "a new or an empty directory" in capsys.readouterr().err


def test_an_interrupted_export_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files.Export, "close", lambda self: (_ for _ in ()).throw(KeyboardInterrupt))
    assert main(["verify", "--export", str(tmp_path / "x"), "--only", "solver/pins"]) == 130
    assert list(tmp_path.iterdir()) == []


def test_what_is_no_export_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert agreement.main([]) == 2
    assert agreement.main([str(tmp_path)]) == 2
    (tmp_path / "index.json").write_text('{"format": "another"}')
    assert agreement.main([str(tmp_path)]) == 2
    assert "an index whose format is" in capsys.readouterr().err
