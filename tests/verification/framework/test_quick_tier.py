"""Quick cases, judged as `make report` does: in `make test` all but `NIGHTLY`, which `make nightly` runs."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

import pytest
from _pytest.mark import ParameterSet

from verification.framework import registry
from verification.framework.case import Case, Status, Tier

QUICK = registry.select(registry.load(), Tier.QUICK)
NIGHTLY = {
    "accuracy/edge-size", "accuracy/hertz-summits", "accuracy/pulled", "accuracy/stress-similarity",
    "accuracy/tau-shares", "appendix-fem/confined", "appendix-fem/correction",
    "appendix-fem/first-order", "appendix-fem/remainder", "appendix-wedge/double-precision",
    "appendix-wedge/enclosures", "appendix-wedge/faces", "appendix-wedge/two-precisions",
    "balance/energy-is-work", "capped/dense-fft", "capped/sphere-areas", "capped/sphere-kogut-etsion",
    "capped/sphere-rings", "cross-check/approach", "cross-check/area", "cross-check/binormal",
    "cross-check/contact-sets", "cross-check/friction", "cross-check/pressure",
    "extremes/beyond-rounding", "extremes/sample", "fem3d/flat", "fem3d/one-point",
    "hertz/radius-corrected", "kernels/normal-enclosed", "kernels/references-agree",
    "kernels/tangential-enclosed", "model-form/one-slope", "paper/convergence", "paper/iterations",
    "paper/own-tolerance", "paper/own-tolerance-friction", "paper/periodicity-beyond",
    "paper/periodicity-extent", "paper/same-state", "paper/tightened", "rectangles/paper-scheme",
    "reference/greenwood-williamson-area", "reference/lay-elastic-friction",
    "reference/rough-plane-slope", "reproduction/eq11-capped-bound",
    "reproduction/eq11-capped-estimate", "reproduction/eq11-capped-slopes",
    "reproduction/fig10-anisotropy", "reproduction/fig10-elastic", "reproduction/fig6a",
    "reproduction/fig6b", "reproduction/fig6c", "reproduction/fig8-exponential",
    "reproduction/fig8-rates", "reproduction/fig8-threshold", "reproduction/fig9",
    "reproduction/interference", "reproduction/interference-broken", "reproduction/largest-slope",
    "reproduction/section8-beta0", "reproduction/section9-cause", "reproduction/section9-coupling",
    "reproduction/steady-sliding", "reproduction/table3-capped",
    "reproduction/tangential-displacements", "surfaces/ensemble", "surfaces/lay-covariance",
}  # fmt: skip
"""Cases of about a second of processor time and more, and those that share their solutions.

Of such cases `make test` keeps: kernels to 50 digits, Hertz, the capped sphere, errata, errors over bars.
"""


def _parts() -> Iterator[ParameterSet]:
    for name, of_module in groupby(QUICK, key=lambda case: case.module.rpartition(".")[2]):
        cases = list(of_module)
        if short := [case for case in cases if case.id not in NIGHTLY]:
            yield pytest.param(short, id=name)
        if long := [case for case in cases if case.id in NIGHTLY]:
            yield pytest.param(long, id=f"{name}, long", marks=pytest.mark.nightly)


def test_what_is_left_to_the_night_is_there() -> None:
    assert NIGHTLY - {case.id for case in QUICK} == set()


@pytest.mark.parametrize("cases", list(_parts()))
def test_the_cases_of_a_module_pass(cases: list[Case]) -> None:
    """In one process and in their order, for they share solutions; all of them, whichever fails."""
    results = [case.run() for case in cases]
    unavailable = {r.id: r.note for r in results if r.status == Status.UNAVAILABLE}
    assert {r.id: r.note for r in results if r.status != Status.PASS and r.id not in unavailable} == {}
    if unavailable:
        pytest.skip(f"{len(results) - len(unavailable)} passed, and not to be had here: {unavailable}")
