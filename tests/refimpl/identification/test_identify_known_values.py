"""Parts of an identification from responses made up so that each result is a sum of a few numbers."""

from __future__ import annotations

import math
from dataclasses import asdict
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from refimpl.identification.data_table import Row
from refimpl.identification.design import propose
from refimpl.identification.ensemble import mean_response, scatter
from refimpl.identification.fit import linear_fit, shares
from refimpl.identification.forward import COVERAGE, Response
from refimpl.identification.laws import _law
from refimpl.identification.profile import Profile
from refimpl.identification.result import Identification

MADE: dict[str, Any] = {
    "at": (2.0, 1.0), "mu": 0.3, "slopes": (1.0, 0.0), "numerical": 0.04 * COVERAGE, "contact_edge": 0.01,
    "inputs": {}, "area_per_load": 3e-9, "border": 0.0, "plastic": 0.1, "pressures": (1e6, 2e6),
    "weights": (3e-7, 4e-7), "solves": 3, "warnings": ("steep",),
}  # fmt: skip


def response(**changes: Any) -> Response:
    return Response(**{**MADE, **changes})


def test_criteria_of_a_law_count_its_own_and_the_further_parameters() -> None:
    """Six rows, one parameter and one further: 3 + 2 * 2 + 2 * 2 * 3 / (6 - 2 - 1) and 3 + 2 ln 6."""
    rows = [Row(load, 0.2, 0.01) for load in (1.0, 2.0, 3.0, 4.0, 5.0, 6.0)]
    law = _law("Coulomb", {"beta": 0.2}, 3.0, rows, further=1)
    assert (law.aicc, law.bic) == (pytest.approx(11.0), pytest.approx(3 + 2 * math.log(6)))
    assert _law("Coulomb", {"beta": 0.2}, 3.0, rows[:3], further=1).aicc == math.inf


def test_a_proposed_load_is_as_uncertain_as_its_measurement_bar_and_surface() -> None:
    """hypot(0.1 * 0.3, 0.04, 0.12) = 0.13, beside a variance of 4 of tau, which is 2."""
    theta, covariance = np.array([2.0, 1.0]), np.diag([4.0, 0.25])
    found = propose(theta, covariance, [(7.0, response(scatter=0.12))], relative=0.1)
    assert found is not None
    tau = COVERAGE / math.sqrt(1 / 4 + 1 / 0.13**2) / 2
    assert (found.loads, found.widths) == ((7.0,), (pytest.approx(tau), pytest.approx(COVERAGE * 0.5)))
    assert propose(theta, covariance, [], relative=0.1) is None


def test_a_mean_over_realisations_has_the_worst_border_and_all_warnings() -> None:
    """Means, but for the largest shares of a contact, the sum of solves, and half of each weight."""
    other = response(
        mu=0.5, slopes=(3.0, 1.0), numerical=0.08 * COVERAGE, contact_edge=0.03, area_per_load=5e-9,
        border=0.2, plastic=0.0, pressures=(5e6,), weights=(8e-7,), solves=4, warnings=("steep", "plastic"),
    )  # fmt: skip
    found = asdict(mean_response([response(), other]))
    # one pair about a mean of two: 0.2 / sqrt(2) * sqrt(1 + 1/2)
    assert found.pop("scatter") == pytest.approx(math.sqrt(0.03))
    expected = {
        **MADE, "mu": 0.4, "slopes": (2.0, 0.5), "numerical": 0.06 * COVERAGE, "contact_edge": 0.02,
        "area_per_load": 4e-9, "border": 0.2, "plastic": 0.1, "pressures": (1e6, 2e6, 5e6),
        "weights": (1.5e-7, 2e-7, 4e-7), "solves": 7, "warnings": ("steep", "plastic"),
    }  # fmt: skip
    for name, value in expected.items():
        numeric = not isinstance(value, dict) and name != "warnings"
        assert found[name] == (pytest.approx(value) if numeric else value), name


def test_all_rows_share_the_error_of_an_input() -> None:
    """Two rows that have one parameter each: their errors of 0.3 and -0.4 go together."""
    rows = [Row(1.0, 0.5, 0.1), Row(2.0, 0.7, 0.2)]
    made = [response(at=(0.0, 0.0), mu=0.0, slopes=slopes) for slopes in ((1.0, 0.0), (0.0, 1.0))]
    alone = scatter([[one] for one in made])  # one draw has no scatter
    fitted = linear_fit(rows, made, np.zeros((2, 2)), alone, away=0.0, passes=1)
    inputs = [{"load": 0.3 * COVERAGE}, {"load": -0.4 * COVERAGE}]
    found = shares(rows, fitted, inputs)
    assert found["input load"] == pytest.approx(np.array([[0.09, -0.12], [-0.12, 0.16]]), rel=1e-8)
    assert found["measurement"] == pytest.approx(np.diag([0.01, 0.04]), rel=1e-8, abs=1e-10)
    # the bars 0.04 and 0.01 / 1.96: half of their variance is common to all rows
    assert found["numerical"] == pytest.approx(np.array([[16e-4, 8e-4], [8e-4, 16e-4]]), rel=1e-8)
    assert fitted.theta == pytest.approx([0.5, 0.7], rel=1e-8)


@pytest.mark.parametrize(("away", "bounded"), [((1.0, 5.0), True), ((5.0, 1.0), True), ((5.0, 2.0), False)])
def test_an_interval_that_reaches_zero_is_cut(away: tuple[float, float], bounded: bool) -> None:
    """Optima so many standard deviations from zero; 95 % are 1.96 of them."""
    spread = np.array([1e6, 0.01])
    assert Profile(np.array(away) * spread, np.diag(spread**2)).is_bounded is bounded


def test_rows_far_above_and_far_below_are_outliers() -> None:
    made: Any = SimpleNamespace(deleted=(0.5, -4.0, 2.9, 3.1))
    assert Identification.outliers.fget(made) == (1, 3)  # type: ignore[attr-defined]
