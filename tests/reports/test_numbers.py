"""Numbers beside the paper's, in sentences, and on the first page: by hand."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest

from reports import findings
from reports.agreement import (
    Number,
    fine,
    numbers,
    verdict_of,
)
from reports.front_page import front_page
from tests.reports.sample import case

CASES = {
    "reproduction/table3-area": case("a/1", data={
        "sigma_e (um)": [0.0, 1.6821, 1.6821],
        "mesh": [512, 256, 512],
        "printed": [0.64e-6, 0.21e-6, 0.2e-6],
        "ours": [0.65e-6, 0.22e-6, 0.19e-6],
        "half width 95 %": [0.0, 3e-9, 4e-9],
    }),
    "reproduction/section8-scatter": case(
        "b/1", data={"scatter of mu": [0.011, 0.02, 0.03], "scatter of A": "no"}
    ),
}  # fmt: skip


def test_means_of_two_ensembles_scatter_both() -> None:
    """Of 4e-9 m^2 either, 5.66e-3 mm^2 together; the smooth ball has the rounding alone, 5e-4 mm^2."""
    ball, coarse, rough = (n for n in numbers(CASES) if n.part == "Table 3")
    assert (rough.printed, rough.computed, rough.unit) == (pytest.approx(0.2), pytest.approx(0.19), "mm²")
    assert rough.uncertainty == pytest.approx(math.hypot(4e-3 * math.sqrt(2), 0.0005))
    assert ball.uncertainty == pytest.approx(0.0005)
    assert (rough.difference, rough.within, ball.within) == (pytest.approx(-0.01), False, False)
    assert rough.ratio == pytest.approx(0.95)
    assert (coarse.label, rough.label) == ("1.680 µm, 256²", "1.680 µm, 512²")
    assert fine([ball, coarse, rough]) == [ball, rough]


MADE = case(
    "a/1",
    value=-0.5,
    data={
        "x": [0.1, -3.0, None, 2.0],
        "numbers": {"mu": 0.25},
        "sure": True,
        "lower, self": [1.9, -1.9, -2.5],
        "upper, in line": [2.0, "n/a"],
        "across": [0.1],
        "elsewhere": [0.2],
    },
)


@pytest.mark.parametrize(
    ("key", "found"),
    [
        ("value", -0.5),
        ("x#max", 3.0),  # the largest magnitude
        ("x#2", None),
        ("numbers#mu", 0.25),
        ("sure", None),
        ("#readings", 6.0 - 1.0),  # numbers of the three lists
        ("#below 2", 3.0),  # 1.9, -1.9 and 0.1
    ],
)
def test_the_number_under_a_key(key: str, found: float | None) -> None:
    assert findings.number(MADE, key) == found


ROUNDING = {
    "sigma_e (um)": [0.0, 1.6821],
    "A: u of inputs": [0.024, 0.01],
    "A: change at R = 0.143 m": [0.0142, 0.0],
    "p_max: u of inputs": [0.024, 0.01],
    "p_max: change at R = 0.143 m": [-0.014, 0.0],
}


def test_the_rounding_of_printed_inputs_is_part_of_u() -> None:
    """A of the ball is 1.6 % above print: beyond its last digit, within it and 2.4 % by the inputs."""
    cases = CASES | {"reproduction/input-rounding": case("a/1", data=ROUNDING)}
    ball, _, rough = (n for n in numbers(cases) if n.part == "Table 3")
    assert ball.uncertainty == pytest.approx(math.hypot(0.0005, 0.024 * 0.65))
    assert (ball.within, ball.by_inputs, rough.by_inputs) == (True, True, False)
    assert ball.rounded_radius == pytest.approx(0.65 * 1.0142)
    assert rough.uncertainty == pytest.approx(math.hypot(4e-3 * math.sqrt(2), 0.0005, 0.0019))
    assert verdict_of([ball]) == "input rounded in print"
    assert verdict_of([ball, rough]) == "not confirmed"


NUMBERS = [
    Number("Table 3", "μ, Table 3", "1.680 µm, 512²", "", 0.1, 0.11, 0.004, 0.0005, 0.004),
    Number("Table 3", "A, Table 3", "smooth, 512²", "mm²", 0.5, 0.5004, 0.0, 0.0005),
    Number("Table 3", "A, Table 3", "smooth, 256²", "mm²", 0.5, 0.9, 0.0, 0.0005),
]
COVERED = [
    {
        "class": kind,
        "number": name,
        "scenes": 300,
        "held": 0.9 + 0.011 * k,
        "held_of_usable": 0.9 + 0.011 * k,
        "usable": 0.5,
        "unbounded": 0.2 * (k == 2),
        "p": 0.001 if kind and k == 2 else 0.5,
        "median_bar_over_error": 1.234 + k,
    }
    for k, name in enumerate(("friction_coefficient_corrected", "contact_area", "max_pressure", "approach"))
    for kind in (None, "flat")
]
STUDIES: dict[str, Any] = {
    "coverage_corrected": {"table": COVERED},
    "extremes": {
        "counts": {"right": 0, "wrong": 1, "crash": 2, "detected failure": 3, "unjudged": 4},
        "states": [],
    },
}


def test_the_first_page_by_hand() -> None:
    """mu is 0.01 off, beyond u = 0.0057; A by 4e-4 less than its rounding, of which sampling has nothing."""
    cases = [
        case("hertz/approach", value=2.5e-6, reference=2.4e-6, unit="m"),
        case("hertz/peak-pressure", "error"),
    ]
    errata = [{"equation": "A5"}, {"equation": "A1"}]
    evidence: Any = SimpleNamespace(cases=cases, studies=STUDIES, errata=errata)
    found = SimpleNamespace(**front_page(evidence, [], NUMBERS))
    assert (found.unexplained, found.worst, found.conversion) == ([NUMBERS[0]], [NUMBERS[0]], 1)
    assert found.table3_rows == {"μ": NUMBERS[:1], "A (mm²)": NUMBERS[1:2]}
    assert found.roughness == ["1.680 µm", "smooth"]
    assert found.hertz == ["approach 2.5 for 2.4 µm (4.2e-02)"]
    assert found.quantities == [("μ, Table 3", 1, "1.100", "", 0), ("A, Table 3", 1, "1.001", "", 1)]
    bars, extremes = found.trust
    for text in (
        "corrected μ 90 %, 50 %, 1.2; ",
        "p_max 92 % (90 % of the bounded), 50 %, 3.2; ",
        "Classes where fewer than 92 % cover, beyond chance (probability below 1 %): p_max of flat (92 %)",
    ):
        assert text in bars
    assert "1 wrong beyond the conditioning of the input, 2 crashes, 3 failed and reported it" in extremes
    assert (found.judged, found.printed, found.all_of_table3) == (0, (1, 3), (1, 3))
