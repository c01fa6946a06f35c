"""The first page in numbers: what lies beyond the uncertainty, Hertz, biases, and trust."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from reports.agreement import Number
from reports.front_page import front_page
from tests.reports.sample import case

NUMBERS = [
    Number("Table 3", "μ, Table 3", "σ_e 1.68 µm, 512²", "", 0.1, 0.11, 0.004, 0.0005, sampled=True),
    Number("Table 3", "A, Table 3", "σ_e 0 µm, 512²", "mm²", 0.5, 0.5004, 0.0, 0.0005),
    Number("Table 3", "A, Table 3", "σ_e 0 µm, 256²", "mm²", 0.5, 0.9, 0.0, 0.0005),
]
COVERED = {name: {"covered": 0.9 + 0.011 * k, "median_bar_over_error": 1.234 + k} for k, name in
           enumerate(("friction_coefficient", "contact_area", "max_pressure"))}  # fmt: skip
STUDIES: dict[str, Any] = {
    "coverage": {"accuracies": [{"accuracy": 0.02, "numbers": {}}, {"accuracy": 0.01, "numbers": COVERED}]},
    "extremes": {"counts": {"right": 5, "wrong": 1, "crash": 2, "honest failure": 3}},
}


def test_the_first_page_by_hand() -> None:
    """mu is 0.01 off, beyond u = 0.0057; A by 4e-4 less than its rounding, of which sampling has nothing."""
    cases = [
        case("hertz/approach", value=2.5e-6, reference=2.4e-6, unit="m"),
        case("hertz/peak-pressure", "error"),
    ]
    found = front_page(SimpleNamespace(cases=cases, studies=STUDIES), [], NUMBERS)  # type: ignore[arg-type]
    assert (found.beyond, found.beyond_sampling, round(found.largest_difference, 9)) == (1, 2, 10.0)
    assert found.table3_rows == {"μ": NUMBERS[:1], "A (mm²)": NUMBERS[1:2]}
    assert found.roughness == ["1.68 µm", "0 µm"]
    assert found.hertz == ["approach 2.5 for 2.4 µm (4.2e-02)"]
    assert found.quantities == [("μ, Table 3", 1, "+9.5 %", "", 0), ("A, Table 3", 1, "+0.1 %", "", 1)]
    bars, extremes = found.trust
    for text in ("μ in 90 % (1.2 times the error)", "A in 91 % (2.2 times", "p_max in 92 % (3.2 times"):
        assert text in bars
    assert extremes.startswith("1 of 11 extreme inputs gave a wrong answer, 2 a crash, and 3 a status")
