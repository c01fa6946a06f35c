"""Every number of a solution is declared once, with the rule of its error bar or none."""

from __future__ import annotations

import ast
import json
import math
from dataclasses import replace

import numpy as np
import pytest

import refimpl as rf
from refimpl.errors import InputError
from refimpl.solution.arrays import attributes_of
from refimpl.solution.quantities import QUANTITIES, REPORTED, TARGETS
from refimpl.solution.solution import Solution
from tests.changed import changed
from tests.layers import ROOT
from verification.coverage.scenes import random_scene
from verification.sweep.export import UNITS
from verification.sweep.run import OUTCOMES

HERTZ = rf.read_scene("hertz")
ROUGH = rf.read_scene("table1-rough")
YIELDING = replace(ROUGH, lower=rf.Body(replace(ROUGH.lower.material, hardness=0.9e9), ROUGH.lower.surface))


def public_numbers(solution: Solution) -> set[str]:
    names = (name for name in dir(solution) if not name.startswith("_"))
    return {name for name in names if isinstance(getattr(solution, name), float | int | np.number)} - {
        "converged"
    }


@pytest.mark.parametrize("scene", [rf.read_scene("table1-smooth"), YIELDING], ids=["elastic", "yielding"])
def test_each_public_number_has_a_rule_or_none(scene: rf.Scene) -> None:
    """A bar of zero is an exact number's: no plastic area of an elastic contact, the hardness itself."""
    found = rf.solve(scene, 32)
    exact = {"max_pressure"} if found.plastic_area else {"plastic_area", "plastic_share"}
    assert public_numbers(found) == set(QUANTITIES)
    assert found.mean_pressure == pytest.approx(found.pressure[found.contact].mean())
    for name in sorted(QUANTITIES):
        error = found.error(name)
        assert (error is None) == (QUANTITIES[name].rule is None)
        assert error is None or error > 0 or name in exact, name


def test_no_number_is_declared_outside_the_table() -> None:
    """Attributes of the solution's classes are of the table, or no numbers; views of it hold all of it."""
    for kind in Solution.__mro__[:-1]:
        declared = {name for name, hint in vars(kind).get("__annotations__", {}).items() if hint == "float"}
        assert not declared, kind
        returned = (getattr(value, "fget", getattr(value, "func", None)) for value in vars(kind).values())
        assert not [one for one in returned if one and one.__annotations__.get("return") in ("float", float)]
    solution = rf.solve(HERTZ, 8)
    assert QUANTITIES.keys() <= solution.summary().keys()
    assert solution.summary()["error"].keys() == QUANTITIES.keys()
    assert {f"{name}_unit" for name in QUANTITIES} <= attributes_of(solution).keys()
    assert {*QUANTITIES, *(f"{name}_error" for name in QUANTITIES)} <= set(OUTCOMES)
    assert QUANTITIES.keys() <= UNITS.keys()
    assert set(solution.uncertainty) == set(REPORTED)


def test_names_of_numbers_stand_in_no_other_list_of_the_product() -> None:
    """A literal list of five or more of them is a list that a new number would be missing from."""
    product = [
        ROOT / "refimpl/solution",
        ROOT / "refimpl/driver",
        ROOT / "verification/cli",
        ROOT / "verification/sweep",
    ]
    lists = [
        f"{path.name}:{node.lineno}"
        for folder in product
        for path in folder.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Tuple | ast.List | ast.Set | ast.Dict)
        and len(_texts(node) & QUANTITIES.keys()) >= 5
    ]
    assert [
        found for found in lists if not found.startswith("solve.py")
    ] == []  # `ACCURATE`, held to the table
    assert _texts(ast.parse("('approach', ('max_pressure', 1.0))").body[0]) == {"approach", "max_pressure"}


def _texts(node: ast.AST) -> set[str]:
    return {n.value for n in ast.walk(node) if isinstance(n, ast.Constant) and isinstance(n.value, str)}


def test_without_contact_no_bar_is_known() -> None:
    found = rf.solve(HERTZ, 8, approach=-1e-9)
    assert {found.error(name) for name in QUANTITIES} == {None}
    assert json.loads(json.dumps(found.summary()["error"])) == dict.fromkeys(QUANTITIES)
    assert all(row.split()[-1] == "-" or " - " in row for row in str(found).splitlines()[1:13])


def test_a_part_without_a_rule_leaves_the_number_without_a_bar() -> None:
    """And what follows from the number; what does not keeps its own."""
    solution = rf.solve(HERTZ, 16)
    own = dict(solution.uncertainty["contact_area"], discretisation=None)
    found = changed(solution, uncertainty={**solution.uncertainty, "contact_area": own})
    without = {name for name in QUANTITIES if found.error(name) is None}
    never = {"elastic_friction"}
    assert without == {"contact_area", "contact_area_share", "mean_pressure"} | never
    assert "contact_area_error" not in attributes_of(found)
    assert " - " in next(row for row in str(found).splitlines() if "contact area A" in row)


@pytest.mark.parametrize("name", ["mean_gap", "normal_force", "A"])
def test_an_accuracy_of_a_number_that_is_no_target_is_refused(name: str) -> None:
    with pytest.raises(InputError, match=r"quantity.*expected one of friction_coefficient_corrected"):
        rf.solve(HERTZ, accuracy=0.1, quantity=name)
    assert name not in TARGETS


def test_rules_by_hand() -> None:
    """A = 2 +- 0.5, A_p = 0.5 +- 0.25, P = N = 8 +- 0.8: 8.8 / 1.5 - 8 / 2, and 0.75 / 1.5 - 0.25."""
    parts = {"contact_area": {"a": 0.3, "b": 0.2}, "plastic_area": {"a": 0.25}, "normal_force": {"a": 0.8}}
    parts["approach"] = {"a": 0.125}
    numbers = {"contact_area": 2.0, "plastic_area": 0.5, "normal_force": 8.0, "mean_pressure": 4.0}
    found = changed(rf.solve(HERTZ, 8), uncertainty=parts, approach=-3.0, plastic_share=0.25, **numbers)
    assert found.error("mean_pressure") == pytest.approx(8.8 / 1.5 - 4)
    assert found.error("plastic_share") == pytest.approx(0.75 / 1.5 - 0.25)
    assert found.error("mean_gap") == pytest.approx(0.125 + 3 * 0.1)
    wide = changed(found, uncertainty={**parts, "contact_area": {"a": 2.0}})
    assert (wide.error("mean_pressure"), wide.error("plastic_share")) == (math.inf, 0.75)


@pytest.mark.parametrize("seed", [81_000, 81_001])
def test_bars_that_follow_from_others_cover(seed: int) -> None:
    """Seeds that no rule was looked at with; under the load and at an approach, a third of them yielding."""
    scene = random_scene(seed).scene
    if seed % 3 == 0:
        peak = rf.solve(scene, 32).mean_pressure
        body = rf.Body(replace(scene.lower.material, hardness=2 * peak), scene.lower.surface)
        scene = replace(scene, lower=body)
    pressed = rf.solve(scene, 48)
    for approach in (None, pressed.approach):
        found, finer = (rf.solve(scene, M, approach=approach) for M in (48, 96))
        for name in ("mean_pressure", "mean_gap", "plastic_share", "contact_area_share"):
            off, bar = abs(getattr(found, name) - getattr(finer, name)), found.error(name)
            assert bar is not None
            assert off <= bar + 1e-12 * abs(getattr(found, name)), (name, approach, off, bar)


def test_at_most_36_names_are_public() -> None:
    """35, and the part of F that the slopes bear."""
    names = {name for name in dir(rf.solve(HERTZ, 8)) if not name.startswith("_")}
    assert len(names) <= 36
    assert Solution.__doc__ is not None
    assert [name for name in names if name not in Solution.__doc__] == []
