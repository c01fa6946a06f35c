"""Named warnings: for each limit a scene that leaves it and one that does not; notes; ends of options."""

from __future__ import annotations

import json
import math
import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import refimpl as rf
from refimpl.driver.options import Options
from refimpl.half_space.influence_error import SlopeError
from refimpl.model.forces import Forces, plasticity_index
from refimpl.planning.term_effects import Effect
from refimpl.solution.evidence import Evidence
from refimpl.solution.limits import model_warnings
from refimpl.solution.model_warning import Limit, ModelWarning, Notice, plain_warning
from tests.changed import changed
from tests.refimpl.states import state_of

STEEL, COPPER = rf.Material(200e9, 0.30), rf.Material(118e9, 0.30)
HARD_STEEL = rf.Material(200e9, 0.30, hardness=7e9)
SOFT_COPPER = rf.Material(118e9, 0.30, hardness=800e6)
BALL = rf.Sphere(0.14)
SMOOTH = replace(
    rf.read_scene("table1-smooth"), upper=rf.Body(HARD_STEEL, BALL), lower=rf.Body(SOFT_COPPER, rf.Flat())
)


def rough(rms: float, material: rf.Material = SOFT_COPPER, length: float = 104e-6) -> rf.Scene:
    return replace(SMOOTH, lower=rf.Body(material, rf.GaussianRoughness(rms, length, seed=2)))


def named(s: rf.Solution) -> dict[Limit, ModelWarning]:
    return {w.limit: w for w in s.warnings if isinstance(w, ModelWarning)}


def evidence(s: rf.Solution, scene: rf.Scene, **changes: object) -> Evidence:
    """What the limits of a solution are compared with, but for some changes."""
    given = {name: changes.pop(name) for name in ("problem", "state") if name in changes}
    own = replace(s.details.evidence, scene=scene, **given)  # type: ignore[arg-type]  # fields of an Evidence
    vars(own).update(changes)  # which it computes when first read
    return own


def test_a_smooth_ball_leaves_no_limit() -> None:
    s = rf.solve(SMOOTH, 64)
    assert s.warnings == ()


def test_plasticity_index_is_eq_12() -> None:
    warned = named(rf.solve(rough(0.6e-6), 64, plastic=False))[Limit.PLASTICITY]
    modulus = SMOOTH.materials.reduced_modulus
    assert SMOOTH.materials.softer_hardness == 800e6
    # 2.2 for sqrt(4.6) = 2.14, and one realisation's slopes on one grid
    assert warned.number == pytest.approx(plasticity_index(modulus, 800e6, 0.6e-6, 104e-6), rel=0.15)
    assert warned.allowed == 1
    assert Limit.PLASTICITY not in named(rf.solve(rough(0.3e-6), 64, plastic=False))


def test_friction_against_the_softer_bodys_shear_strength() -> None:
    strong = replace(SMOOTH, friction=rf.Friction(tau=150e6, beta=0.08))
    warned = named(rf.solve(strong, 32))[Limit.SHEAR]  # 166 MPa more times beta
    assert warned.number > warned.allowed == pytest.approx(800e6 / 27**0.5)
    assert Limit.SHEAR not in named(rf.solve(replace(SMOOTH, friction=rf.Friction(tau=150e6)), 32))


def test_a_soft_ball_under_its_pull_off_force_is_told_of_adhesion() -> None:
    rubber, glass = rf.Body(rf.Material(E=2e6, nu=0.49), rf.Flat()), rf.Material(E=70e9, nu=0.2)
    lens = rf.Scene(rf.Body(glass, rf.Sphere(radius=5e-3)), rubber, rf.Friction(), load=1e-3, side=1e-3)
    note = next(w for w in rf.solve(lens, 32).warnings if "adhesion" in w)
    assert f"{1e-3 / (1.5 * np.pi * 5e-3):.2g} J/m^2" in note  # JKR: 1.5 pi w R
    assert not any("adhesion" in w for w in rf.solve(replace(lens, load=0.1), 32).warnings)


def test_slopes_beyond_the_table() -> None:
    s = rf.solve(SMOOTH, 16)
    steeper = SlopeError(rms_gradient=0.01, max_slope=0.7, at_rms=0.001, at_max=None)
    warned = {w.limit: w for w in model_warnings(evidence(s, SMOOTH, slope_error=steeper))}
    assert Limit.RMS_GRADIENT not in warned
    assert warned[Limit.MAX_SLOPE].number == math.inf
    assert "beyond" in warned[Limit.MAX_SLOPE]


def test_a_ball_of_the_wrong_sign_is_concave() -> None:
    """A radius is positive for a ball above and negative for one below: else contact is at the border."""
    ball, flat = SMOOTH.upper, rf.Body(SMOOTH.lower.material, rf.Flat())
    bowl, hollow = rf.Body(ball.material, rf.Sphere(-0.14)), replace(SMOOTH, upper=flat, lower=ball)
    for scene, which in ((hollow, "lower"), (replace(SMOOTH, upper=bowl, lower=flat), "upper")):
        assert f"{which} body is concave" in str(named(rf.solve(scene, 32))[Limit.BORDER])
    assert Limit.BORDER not in named(rf.solve(replace(SMOOTH, upper=flat, lower=bowl), 32))


def test_contact_at_the_border() -> None:
    s = rf.solve(replace(SMOOTH, side=0.6e-3), 32)
    warned = named(s)[Limit.BORDER]
    border = s.contact.copy()
    border[1:-1, 1:-1] = False
    assert warned.number == border.sum() > 0
    assert "enlarge the domain" in str(warned)
    assert Limit.BORDER not in named(rf.solve(SMOOTH, 32))
    assert Limit.BORDER not in named(rf.solve(replace(SMOOTH, side=0.6e-3, periodic=True), 32))
    assert named(rf.solve(SMOOTH, 1))[Limit.BORDER].number == 1


def test_elements_per_correlation_length_told_once() -> None:
    s = rf.solve(rough(0.3e-6), 32)
    warned = named(s)[Limit.CORRELATION]
    assert warned.number == pytest.approx(104e-6 / (1.61e-3 / 32))
    assert warned.allowed == 4
    assert sum("correlation length" in w for w in s.warnings) == 1
    assert Limit.CORRELATION not in named(rf.solve(rough(0.3e-6), 64))


@pytest.mark.parametrize(("M", "points"), [(32, 2.0), (64, None), (65, None)])
@pytest.mark.filterwarnings("ignore::refimpl.surfaces.surface.SurfaceWarning")
def test_points_of_data_between_elements(M: int, points: float | None) -> None:
    side = SMOOTH.lengths[0]
    heights = rf.ArraySurface(np.zeros((48, 64)), pixel=(side / 48, side / 64))
    warned = named(rf.solve(replace(SMOOTH, lower=rf.Body(STEEL, heights)), M)).get(Limit.DATA)
    assert (warned and warned.number) == points


def test_a_neglected_term_that_matters() -> None:
    s = rf.solve(SMOOTH, 32)
    assert Limit.NEGLECTED not in named(s)
    effects = {"coupled": Effect(0.0, 1e-3), "oblique": Effect(1e-9, 0.0)}
    warned = model_warnings(evidence(s, SMOOTH, neglected=effects))
    found = [w for w in warned if w.limit is Limit.NEGLECTED]
    assert [(w.number, w.allowed) for w in found] == [(1e-3, 1e-8)]
    assert "normal-tangential coupling neglected" in found[0]
    assert "coupled = true" in found[0]


def test_a_term_within_what_the_plan_allows_is_no_warning() -> None:
    """Without friction that is more than the accuracy asked for: a share of what the grid leaves open."""
    s = rf.solve(replace(SMOOTH, friction=rf.Friction()), 64)
    assert s.plan.demand < s.details.neglected["oblique"].larger <= s.plan.budget
    assert Limit.NEGLECTED not in named(s)
    mattered = evidence(s, SMOOTH, neglected={"oblique": Effect(0.0, 2 * s.plan.budget)})
    (found,) = (w for w in model_warnings(mattered) if w.limit is Limit.NEGLECTED)
    assert found.allowed == s.plan.budget


def test_warnings_are_texts_with_numbers() -> None:
    s = rf.solve(rough(0.5e-6), 32, plastic=False)
    first = named(s)[Limit.HARDNESS]
    again = pickle.loads(pickle.dumps(first))
    assert (again, vars(again)) == (first, vars(first))
    by_name = {w["name"]: w for w in s.summary()["warnings"]}
    assert by_name["peak pressure"]["limit"] == 800e6
    assert json.dumps(by_name)
    note = {"name": "note", "number": None, "limit": None, "text": "resampled"}
    assert plain_warning("resampled") == note


@pytest.mark.parametrize("status", list(rf.Status))
def test_a_certificate_that_fails_counts_more_than_an_accuracy_that_is_missed(status: rf.Status) -> None:
    s = rf.solve(SMOOTH, 16)
    ended = replace(s.details.evidence, state=replace(s.details.state, status=status))
    ended_well = status in (rf.Status.CONVERGED, rf.Status.CYCLED)
    found = changed(s, evidence=ended, shortfall=Notice("short")).status
    assert found is (rf.Status.ACCURACY_NOT_REACHED if ended_well else status)


FULL, FEW = {"pressure": np.full((6, 4), 2.5e9), "contact_area": 6e-7}, np.zeros((6, 4))
FEW[1, 1] = FEW[1, 2] = FEW[4, 1] = 1e6
PEAK = "pressure, 2500 MPa, exceeds the softer body's hardness, 800 MPa: A, mu and pressures are not reliable"
FLAT = "degrees: influence coefficients of a flat are off by"


@pytest.mark.parametrize(
    ("name", "number", "changes", "text"),
    [
        ("rms gradient", 0.031, {"slope_error": SlopeError(0.1, 0.0, 0.031, 0.0, 0.017, 0.0)},
         f"gradient 5.73 {FLAT} 3.1% in line and 1.7% across, above 2 %"),
        ("maximum slope", 0.061, {"slope_error": SlopeError(0.0, 0.25, 0.0, 0.012, 0.0, 0.061)},
         f"slope 14.3 {FLAT} 1.2% in line and 6.1% across, above 2 %"),
        # at 0.8 GPa 600 N take 0.75 mm^2, a quarter more
        ("peak pressure", 2.5e9, FULL | {"forces": Forces(600.0, 0.0, 0.0)},
         f"{PEAK} (at the hardness A is at least P/H, 25.0% more); set plastic = true"),
        # the cube root of 3 P R / (4 E*), with 1 / E* = 0.91 / 118 + 0.91 / 200 per GPa
        ("border", 16, FULL | {"load": 5e3},
         "enlarge the domain: Hertz's contact radius is 0.00186 m, half of the domain 0.0008 m "
         "(are the load, 5000 N, and the radius, 0.14 m, right?)"),
        # three elements in two patches: the root of 3 / (2 pi)
        ("contact radius", 0.690988, {"pressure": FEW}, "a mean radius of 0.69 elements: below 3 areas"),
        ("active set of tau", 2, {"pressure": FEW, "excluded": np.arange(24).reshape(6, 4) < 7},
         "under tau: 2 elements in contact carry"),
    ],
)  # fmt: skip
def test_a_warning_has_its_numbers_in_their_units(
    name: str, number: float, changes: dict[str, Any], text: str
) -> None:
    scene = replace(SMOOTH, side=None, size=(2.4e-3, 1.6e-3))
    s = rf.solve(scene, (6, 4))
    given, state = dict(changes), state_of(s)
    problem = replace(s.details.problem, load=given.pop("load", 70.0))
    state = replace(state, **{key: given.pop(key) for key in changes if key in vars(state)})
    made = evidence(s, scene, problem=problem, state=state, **given)
    (found,) = (w for w in model_warnings(made) if w.limit == name)
    assert found.number == pytest.approx(number, rel=1e-5)
    assert text in found


def test_a_radius_just_below_3_is_printed_below_3() -> None:
    """A plateau of 28 elements: the root of 28 / pi, 2.985, would be rounded to 3.0."""
    heights = np.zeros((12, 12))
    heights[2:9, 3:7] = 1e-6
    s = rf.solve(
        replace(SMOOTH, upper=rf.Body(STEEL, rf.Flat()), lower=rf.Body(STEEL, heights), load=1e-3), 12
    )
    assert "a mean radius of 2.99 elements: below 3" in named(s)[Limit.RADIUS]


MODULUS = 1 / (0.91 / 118e9 + 0.91 / 200e9)  # E* (Pa)
SIDE = 1.61e-3  # m


@pytest.mark.parametrize(
    ("field", "end", "beyond"),
    [
        ("load", 1e-30 * MODULUS * SIDE**2, 0.999),
        ("load", 1e6 * MODULUS * SIDE**2, 1.001),
        ("friction.tau", 1e6 * MODULUS, 1.001),
        ("approach", 1e6 * SIDE, 1.001),
        ("approach", -1e6 * SIDE, 1.001),
    ],
)
def test_strains_from_1e_minus_30_to_1e6_are_accepted(field: str, end: float, beyond: float) -> None:
    scene = rf.read_scene("table1-smooth")  # without a hardness, which limits the load

    def options(number: float) -> Options:
        if field == "approach":
            return Options(scene=scene, grid=8, approach=number)
        changes = {"load": number} if field == "load" else {"friction": rf.Friction(tau=number)}
        return Options(scene=replace(scene, **changes), grid=8)  # type: ignore[arg-type]  # one of two fields

    options(end / beyond)
    with pytest.raises(rf.InputError) as refused:
        options(end * beyond)
    assert refused.value.field == field
