"""Fits of a model that is linear by construction, and the notes on them."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

import refimpl as rf
from refimpl.identification import Identification, Interval, Row, identify
from refimpl.identification.design import Proposal
from refimpl.identification.ensemble import is_random, redrawn
from refimpl.identification.forward import Forward, Response
from refimpl.identification.laws import Law
from refimpl.identification.result import notes

SCENE = rf.read_scene("hertz")
LOADS, SIZE = (1.0, 2.0, 5.0, 10.0, 20.0), math.log(2.0)
NONE = Response((0.0, 0.0), 0.0, (1.0, 1.0), 0.0, 0.0, 0.0, {}, 0.1, 0.0, 0.0, (1e6,), (1e-6,), 1, ())


def linear_fit(above: float = 0.0) -> Identification:
    """Of mu = tau / P + beta + ln(H / 1e8) P / 100 at tau = 2, beta = 0.3, H = 2e8 Pa, the third row off."""

    def linear(self: Forward, scene: rf.Scene, theta: Any, tolerances: Any = None) -> Response:
        self.solves += 1
        slopes = 1 / scene.load, 1.0, scene.load / 100
        inputs = {name: 0.196 * tolerance for name, tolerance in (tolerances or {}).items()}
        mu = float(slopes @ (theta - [0, 0, math.log(1e8)]))
        return replace(NONE, at=tuple(theta), mu=mu, slopes=slopes, inputs=inputs)

    hard = replace(SCENE.lower, material=replace(SCENE.lower.material, hardness=1.5e8))
    rows = [Row(load, 2 / load + 0.3 + SIZE * load / 100, 1e-4) for load in LOADS]
    rows[2] = replace(rows[2], mu=rows[2].mu + above)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(Forward, "respond", linear)
        of = {"load": 0.02, "upper.material.E": 0.5}
        scene = replace(SCENE, lower=hard)
        return identify(scene, rows, 8, loads=(40.0, 3.0), fit=["hardness"], tolerances=of)


@pytest.fixture(scope="module")
def found() -> Identification:
    return linear_fit()


def test_a_row_above_the_fit_is_an_outlier_with_a_positive_residual() -> None:
    made = linear_fit(above=0.01)
    assert made.residuals[2] == max(made.residuals, key=abs)
    assert made.residuals[2] > 10
    assert any(note.startswith("row 3 (5 N) is off by +") for note in made.warnings)


@pytest.mark.parametrize(
    ("factor", "units"),
    [
        (1.3, False),
        (0.7, False),
        (4.0, False),
        (10.5, True),
        (0.11, True),
        (26.0, True),
        (9.0, True),
        (15.0, False),
    ],
)
def test_a_dropped_row_is_off_by_units_only_near_their_factors(
    found: Identification, factor: float, units: bool
) -> None:
    rows = [replace(found.rows[0], mu=factor * found.fitted.predicted[0]), *found.rows[1:]]
    made = replace(found, rows=tuple(rows), deleted=(6, 0, 0), fitted=replace(found.fitted, dropped=0))
    (said,) = notes(made)
    assert f", and dropped from it: its mu is {factor:.3g} times the fit's" in said
    assert ("units" in said.partition("times")[2]) == units


def test_an_identification_of_a_linear_model(found: Identification) -> None:
    """Inputs that shift all rows by as much shift beta: by 0.196 / 1.96 of their tolerances."""
    assert [one.value for one in found.values.values()] == pytest.approx([2.0, 0.3, 2e8], rel=1e-6)
    assert (found.degrees, found.method, found.proposal) == (2, "ellipse", None)
    shifts = [found.shares[f"input {name}"][1] for name in ("load", "upper.material.E")]
    assert shifts == pytest.approx([0.002, 0.05], rel=1e-4)
    assert [p.load for p in found.predictions] == [*LOADS, 40.0, 3.0]
    assert found.predictions[5].mu.value == pytest.approx(0.35 + 0.4 * SIZE, rel=1e-6)
    spread = math.sqrt(found.covariance[2, 2])  # Pa: of the logarithm, times H
    high = found.values["lower.material.hardness"].high
    assert (found.shares["measurement"][2], 2e8 * math.log(high / 2e8)) == pytest.approx(
        (spread, 1.959964 * spread), rel=1e-4
    )
    assert found.solves == 5 * found.passes + 5 + 2
    printed = repr(found).splitlines()
    assert [line.split("  ")[0] for line in printed[:3]] == [
        "tau (MPa)",
        "beta",
        "lower.material.hardness (MPa)",
    ]
    assert [line.split()[2 if "MPa" in line else 1] for line in printed[:3]] == ["2e-06", "0.3", "200"]
    assert "tau/MPa + beta" in printed[3]


def laws(aic: float) -> dict[str, Any]:
    return {"laws": (Law("Coulomb", {}, 1.0, 4.0, 1.0), Law("tau + beta f", {}, 1.0, aic, 1.0))}


def tau(value: float, low: float, high: float, **others: Interval) -> dict[str, Any]:
    combined = Interval(0.2, 0.1, 0.25)
    return {"values": {"tau": Interval(value, low, high), **others}, "factor": 3e-9, "combination": combined}


APART, SETTLED = "apart from beta (95 % interval", "did not settle: the last solves differ by up to"
EDGE = {"responses": [{"border": 0.02}, {}]}
SAID: list[tuple[dict[str, Any], str]] = [
    (
        tau(10, 7, 13),
        f"{APART} +-30 %): A/P hardly changes; the data determine 3e-09/Pa tau + beta = 0.2 (0.1",
    ),
    (tau(0, 0, 13), f"{APART} unbounded)"),
    (
        tau(1, 0, 9) | {"proposal": Proposal((0.4, 150.0), (0.13, 0.3))},
        "to 0.25); measure at 0.4 N and 150 N: tau's interval falls to +-13 %; a curved surface",
    ),
    (
        tau(1, 0, 9) | {"proposal": Proposal((0.4, 150.0), (9.0, 0.3))},
        "to 0.25); a curved surface",
    ),
    (
        tau(9, 9, 9, beta=Interval(0, 0, 1), h=Interval(2e8, 1e8, 5e8)),
        "h is hardly determined (95 % interval 1e+",
    ),
    ({"fit": {"nonlinearity": 0.6}}, f"{SETTLED} 0.6 standard"),
    ({"fit": {"limited": True, "nonlinearity": 0.4}}, f"{SETTLED} 0.4 standard"),
    ({"chi_square": 9.25, "probability": 0.004}, "square 9.25 of 2 degrees of freedom has probability 0.004"),
    ({"deleted": (3, -3.14, -3)}, "row 2 (2 N) is off by -3.1 standard uncertainties from the fit to"),
    (
        {"deleted": (6, 0, 0), "fit": {"dropped": 0}},
        "row 1 (1 N) is off by +6.0 standard uncertainties from",
    ),
    ({"responses": [{"contact_fraction": x} for x in (0.002, 0.0049)]}, "less than 0.5 % of the domain"),
    (
        {"responses": [{"border": 0.021}, {"contact_fraction": 0.991}]},
        "fills the domain or reaches its border",
    ),
    ({"responses": [{"numerical": 1, "contact_edge": 1}, {"contact_edge": 1}]}, "uncertainty in 2 rows"),
    ({"responses": [{}, {"border": 0.021}]}, "contact reaches the domain's border"),
    ({"responses": [{"plastic": 0.25}, {}]}, "up to 25 % of the contact is at the hardness"),
    (
        {"responses": [{"plastic": 0.56}, {"warnings": ("plasticity index 1.2 of Eq. (12) reaches 1",)}]},
        "up to 56 % of the contact is at the hardness",
    ),
    ({"responses": [{"warnings": ("plasticity index 1.2",)}, {}]}, "plasticity index 1.2"),
    ({"responses": [{"warnings": ("1.5 deg",)}, {"warnings": ("2 deg",)}]}, "2 deg"),
    (laws(10.2), "the law Coulomb describes the data better (AIC lower by 6.2)"),
    (laws(10.0) | tau(10, 8, 12) | {"probability": 0.01, "fit": {"nonlinearity": 0.5}} | EDGE, ""),
]


@pytest.mark.parametrize(("changes", "said"), SAID)
def test_each_note_by_itself_and_none_at_the_thresholds(
    found: Identification, changes: dict[str, Any], said: str
) -> None:
    others = {name: value for name, value in changes.items() if name not in ("fit", "responses")}
    fitted = replace(found.fitted, **changes.get("fit", {}))
    if "responses" in changes:
        fitted = replace(fitted, responses=tuple(replace(NONE, **change) for change in changes["responses"]))
        others["rows"] = found.rows[:2]
    texts = notes(replace(found, fitted=fitted, **others))
    assert len(texts) == bool(said)
    assert said in "".join(texts)


def test_random_parts_of_both_bodies_are_redrawn() -> None:
    rough, ball = rf.GaussianRoughness(1e-6, 1e-4, seed=5), rf.Sphere(0.1)
    scene = replace(SCENE, upper=rf.Body(SCENE.upper.material, ball + rough))
    assert redrawn(scene, 2).upper.surface.parts == (ball, replace(rough, seed=2005))
    assert (is_random(scene), is_random(SCENE)) == (True, False)
