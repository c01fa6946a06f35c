"""The committed pair `metal-crest-medium`: a solution warns where finite elements find N far off."""

from __future__ import annotations

import pytest

import refimpl as rf
from verification.cases.appendix_a.model_form import METAL
from verification.cases.appendix_a.model_form_study import CREST, LOADS, SLOPES, pair_of, scene_of
from verification.output.result_files import committed

SHARE = LOADS[1]


def committed_errors() -> dict[float, float]:
    """Percent by which N at a given approach is off, by maximum slope (degrees)."""
    document = committed("model_form")
    [found] = [case for case in document["cases"] if case["id"] == "model-form/metal-crest-medium"]
    return dict(zip(SLOPES, map(abs, found["data"]["normal, as printed"]), strict=True))


def solved(slope: float) -> rf.Solution:
    pair = pair_of(*METAL, slope, CREST)
    return rf.solve(scene_of(pair, SHARE * pair.full_contact_pressure, 64), grid=64)


def warns_of_the_half_space(solution: rf.Solution) -> bool:
    return any("half-space misstates N" in str(warning) for warning in solution.warnings)


@pytest.mark.parametrize(("slope", "off"), [(6.5, 3.9)])
def test_a_crest_on_a_crest_is_warned_of(slope: float, off: float) -> None:
    assert committed_errors()[slope] == pytest.approx(off, abs=0.05)
    solution = solved(slope)
    assert warns_of_the_half_space(solution)
    assert solution.details.model_form.normal_force > off / 100


def test_gentle_crests_state_their_error_without_a_warning() -> None:
    solution = solved(2.5)
    assert not warns_of_the_half_space(solution)
    assert solution.details.model_form.normal_force > committed_errors()[2.5] / 100
