"""Section 8 beyond yield: Eq. (11) as a bound and as an estimate, and the error of the elastic Table 3."""

from __future__ import annotations

import numpy as np

from verification.cases import Measured, Verdict, judged, percents
from verification.reproduction.beyond_yield import LOWEST, Point, cells, crossing, points
from verification.reproduction.printed import HARDNESS, LOADS
from verification.reproduction.tiers import in_both_tiers

SOURCE = "paper section 8, Eq. (11); pressures that end at the hardness"
LOADS_IN_WORDS = ", ".join(f"{load:g}" for load in LOADS) + " N"


def _by_load(tier: str) -> dict[float, list[Point]]:
    return {load: [p for p in points(tier) if p.load == load] for load in LOADS}


def _above_lowest(point: Point) -> float:
    """Return the mean of mu over Eq. (11), less 1."""
    return point.mean("capped", "friction").mean / LOWEST - 1


@in_both_tiers("reproduction/eq11-capped-bound", metric="at_least", tolerance=-1e-7, source=SOURCE)
def lower_bound(tier: str) -> Measured:
    """Eq. (11) with pressures that end at the hardness: a lower bound where slopes are small.

    Claim: Eq. (11): tau / H + beta is the smallest mu where contact slopes are small
    Tolerance: least mu / (tau / H + beta) - 1 without slope terms: A >= P / H makes it 0 or more, and the
    load is balanced to 1e-8
    """
    found = points(tier)
    least = min(float(p.values("flat", "friction").min()) / LOWEST - 1 for p in found)
    last = [curve[-1] for curve in _by_load(tier).values()]
    nearest = [p.mean("flat", "friction").mean / LOWEST - 1 for p in last]
    pressure = [p.mean("capped", "mean_pressure").mean / HARDNESS for p in last]
    share = [p.mean("capped", "plastic_share").mean for p in last]
    sentence = (
        f"none of {len(found) * len(found[0].found['flat'])} solutions without slope terms has mu below "
        f"{LOWEST:.5f}; at psi = {last[0].psi:.1f} ({LOADS_IN_WORDS}) mu is above it by "
        f"{percents(nearest)}, the mean pressure is {percents(pressure, 0)} of H and {percents(share, 0)} of "
        "the contact is plastic"
    )
    return judged(Verdict.CONFIRMED, sentence, least, data={})


@in_both_tiers("reproduction/eq11-capped-estimate", metric="at_most", tolerance=0.15, source=SOURCE)
def estimate(tier: str) -> Measured:
    """Eq. (11) as an estimate beyond psi = 1.

    Claim: Section 8: beyond psi = 1 Eq. (11) may be used to estimate the friction coefficient
    Tolerance: largest mean of mu over Eq. (11), less 1, where psi > 1: measured 14 % quick and full; three
    realisations scatter by 2 %
    """
    curves = _by_load(tier)
    errors = {load: [_above_lowest(p) for p in curve] for load, curve in curves.items()}
    beyond = [_above_lowest(p) for p in points(tier) if p.psi > 1]
    reached = []
    for level in (0.05, 0.02):
        found = (crossing(curve, errors[load], level) for load, curve in curves.items())
        shown = ("beyond the range" if np.isnan(p) else f"{p:.1f}" for p in found)
        reached.append(f"within {level:.0%} from psi = {', '.join(shown)}")
    at_one = [float(np.interp(1.0, [p.psi for p in curve], errors[load])) for load, curve in curves.items()]
    sentence = (
        f"at psi = 1 mu is above Eq. (11) by {percents(at_one)} ({LOADS_IN_WORDS}); {'; '.join(reached)}. It "
        "is the limit of rough surfaces, not the value at the threshold"
    )
    data: dict[str, object] = {"psi": [p.psi for p in curves[LOADS[0]]]}
    data |= {f"mu / Eq. (11) - 1, {load:g} N": by_psi for load, by_psi in errors.items()}
    return judged(Verdict.CONDITIONAL, sentence, max(beyond), data=data)


@in_both_tiers("reproduction/eq11-capped-slopes", metric="at_most", tolerance=0.06)
def slopes(tier: str) -> Measured:
    """Eq. (11) with slopes: does mu go below it?

    Claim: Eq. (11) holds for small asperity slopes
    Source: {SOURCE}
    Tolerance: largest change of mu by slopes in one realisation: the mean slope under load is of either sign,
    its scatter some 0.1 of the rms slope of 2.5 to 3.7 degrees over the root of the number of contacts
    """
    found = points(tier)
    largest = max(float(np.abs(p.slope_effect).max()) for p in found)
    below = sum(int(np.count_nonzero(p.above_lowest < 0)) for p in found)
    depth = min(float(p.above_lowest.min()) for p in found)
    curves = _by_load(tier)
    means = [float(np.mean([p.slope_effect.mean() for p in curve])) for curve in curves.values()]
    last = [float(curve[-1].slope_effect.std(ddof=1)) for curve in curves.values()]
    sentence = (
        f"slopes change mu by {largest:.1%} at most, on average by {', '.join(f'{m:+.2%}' for m in means)} "
        f"({LOADS_IN_WORDS}), with a scatter of {percents(last)} at psi = {found[-1].psi:.1f}; they take mu "
        f"below Eq. (11) in {below} of {len(found) * len(found[0].found['capped'])} solutions, "
        f"by {max(0.0, -depth):.1%} at most"
    )
    return judged(Verdict.CONDITIONAL, sentence, largest, data={})


@in_both_tiers("reproduction/table3-capped", metric="at_least", tolerance=0.08)
def table3(tier: str) -> Measured:
    """Table 3 with pressures that end at the hardness.

    Claim: Table 3: mu falls to 0.089, A to 0.044 mm^2 and f_max rises to 5.3 GPa
    Source: paper Table 3; pressures that end at copper's 0.8 GPa
    Tolerance: what the elastic mu at 1.68 um is too low by: mu is 0.089 there where Eq. (11) has 0.09875, so
    a tenth; sampling and mesh leave 1 %
    """
    found = cells(tier)
    mu, area = ([p.elastic_error(name) for p in found] for name in ("friction", "area"))
    capped = {name: [p.mean("capped", name) for p in found] for name in ("friction", "plastic_share")}
    rms = ", ".join(f"{p.flat_rms * 1e6:.3f}" for p in found)
    sentence = (
        f"at {rms} um the elastic mu errs by {', '.join(f'{e.mean:+.1%}' for e in mu)} and A by "
        f"{', '.join(f'{e.mean:+.0%}' for e in area)}; capped, mu is "
        f"{', '.join(f'{e.mean:.4f}' for e in capped['friction'])}, and "
        f"{percents([e.mean for e in capped['plastic_share']], 0)} of the contact is plastic"
    )
    data = {"plastic share": [e.mean for e in capped["plastic_share"]]}
    return judged(Verdict.CONDITIONAL, sentence, -mu[-1].mean, data=data)
