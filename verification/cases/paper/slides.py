"""Figs 9 and 10 and steady sliding: forces over sliding distance and direction."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from verification.cases import Measured, Verdict, judged
from verification.reproduction import slides
from verification.reproduction.ensemble import rows_at
from verification.reproduction.printed import FLAT_RMS
from verification.reproduction.table1 import SMOOTH
from verification.reproduction.tiers import in_both_tiers
from verification.sweep.run import Row


@in_both_tiers("reproduction/fig9", metric="at_most", tolerance=0.005)
def binormal(tier: str) -> Measured:
    """Fig. 9: the binormal force over sliding distance and direction.

    Claim: Fig. 9: a binormal force Q exists, very small against the load
    Source: paper Fig. 9, section 8
    Tolerance: largest |Q| over P: the rms slope under load, 0.004, averaged over some 20 contacts, with three
    standard deviations
    """
    found = rows_at(tier, "fig9")
    directions = sorted({row["sliding_direction"] for row in found})
    offsets = sorted({row["sliding_offset"] for row in found})
    Q = np.array([row["binormal_force"] for row in found]).reshape(len(directions), len(offsets))
    drawn = rows_at(tier, "table3")  # a surface a row; Fig. 10 turns a few of them
    surfaces, turned = (_largest_transverse(rows) for rows in (drawn, rows_at(tier, "fig10")))
    shown, largest = float(np.abs(Q).max()) / SMOOTH.load, max(surfaces[0], turned[0])
    sentence = (
        f"largest |Q| / P = {largest:.1e} on the roughest flats, of {FLAT_RMS[1] * 1e6:.3g} um "
        f"({surfaces[1]} solutions on different surfaces, {turned[1]} on turned ones); {shown:.1e} on one of "
        f"{found[0]['lower_rms'] * 1e6:.3g} um over {offsets[-1] * 1e6:.0f} um in {len(directions)} "
        "directions, which the figure shows"
    )
    data = {
        "distance (um)": np.array(offsets) * 1e6,
        "direction (deg)": np.degrees(directions),
        "Q (N)": Q,
    }
    return judged(Verdict.CONFIRMED, sentence, max(shown, largest), data=data)


def _largest_transverse(rows: Sequence[Row]) -> tuple[float, int]:
    finest = max(row["grid"] for row in rows)
    roughest = [row for row in rows if row["lower_rms"] == FLAT_RMS[1] and row["grid"] == finest]
    return max(abs(row["binormal_force"]) / SMOOTH.load for row in roughest), len(roughest)


@in_both_tiers("reproduction/fig10-elastic", metric="at_most", tolerance=0.03)
def elastic(tier: str) -> Measured:
    """Fig. 10(a): the elastic part of friction over the direction.

    Claim: Fig. 10(a): forces of elastic deformation contribute negligibly to friction
    Source: paper Fig. 10(a), section 8
    Tolerance: largest share of F: at 1.68 um one realisation scatters by 0.7 % (Table 3's ensemble), and four
    standard deviations cover all directions of six realisations
    """
    curves = _turning(tier)
    largest = max(float(np.abs(c.elastic).max()) for c in curves)
    shown = ", ".join(
        f"{float(np.sqrt(np.mean(c.elastic**2))):.2%} at {c.flat_rms * 1e6:g} um" for c in curves
    )
    sentence = f"largest share {largest:.2%}, rms {shown}"
    return judged(Verdict.CONFIRMED, sentence, largest, data=_fig10_data(curves))


@in_both_tiers("reproduction/fig10-anisotropy", metric="at_most", tolerance=0.03)
def anisotropy(tier: str) -> Measured:
    """Fig. 10(b): friction over the direction of sliding.

    Claim: Fig. 10(b): friction varies with direction, very little, and more on rougher surfaces
    Source: paper Fig. 10(b), section 8
    Tolerance: largest departure from the mean over directions, which is that of the elastic part: see the
    case of Fig. 10(a)
    """
    curves = _turning(tier)
    largest = max(float(np.abs(c.anisotropy).max()) for c in curves)
    rms = [float(np.sqrt(np.mean(c.anisotropy**2))) for c in curves]
    if rms[-1] <= rms[0]:
        raise ArithmeticError(f"the roughest surface is not the most anisotropic: {rms}")
    steadiest = float(np.corrcoef(np.ravel(curves[-1].elastic), np.ravel(curves[-1].anisotropy))[0, 1])
    shown = ", ".join(f"{r:.2%} at {c.flat_rms * 1e6:g} um" for r, c in zip(rms, curves, strict=True))
    sentence = (
        f"largest departure {largest:.2%}, rms {shown}; correlation with the elastic part {steadiest:.2f}"
    )
    return judged(Verdict.CONFIRMED, sentence, largest, data=_fig10_data(curves))


@in_both_tiers("reproduction/section9-cause", metric="at_most", tolerance=0.05)
def cause(tier: str) -> Measured:
    """Section 9: why does friction depend on the direction?

    Claim: Section 9: the reason for directional dependence is the non-Gaussian distribution of roughness
    within the contact
    Source: paper sections 8 and 9, Figs 10 and 11
    Tolerance: share of the elastic part's variance over directions that its first harmonic leaves. On one
    contact there is no other: a sum over slopes is a vector's component. What is measured is how far the
    contact depends on the direction: coupling and tau's edge move it by 0.7 % of the Hertz radius, 3 % of a
    correlation length
    """
    curves = _turning(tier)
    left = [slides.beyond_mean_slope(c.direction, c.elastic) for c in curves]
    alike = [slides.beyond_mean_slope(c.direction, c.anisotropy) for c in curves]
    sentence = (
        "the pressure-weighted mean slope, two numbers, gives all but "
        f"{', '.join(f'{v:.2%}' for v in left)} of the variance of the elastic part over directions "
        f"({', '.join(f'{c.flat_rms * 1e6:g}' for c in curves)} um), and all but "
        f"{', '.join(f'{v:.2%}' for v in alike)} of friction's: a first moment, which finitely many contacts "
        "leave whatever the shape of their distribution. Slopes alone enter these sums, and in contact they "
        "are Gaussian within sampling (fig11-slopes); heights are not (fig11-heights)"
    )
    data = {"left of the elastic part": left, "left of friction": alike}
    return judged(Verdict.REFUTED, sentence, max(left), data=data)


@in_both_tiers("reproduction/steady-sliding", metric="at_most", tolerance=0.005)
def snapshot(tier: str) -> Measured:
    """Does a snapshot stand for steady sliding?

    Claim: Section 8 takes single positions (and their average over surfaces) for steady sliding
    Source: paper sections 5 to 8
    Tolerance: the slide's mean elastic force over friction. Elastic forces take back along a slide what they
    gave, so the mean is but the tilt that shear gives to the common surface: -0.1 % of F, measured by
    averaging forward and backward slides of 40 surfaces; and four standard errors of 0.04 % (full) or 0.06 %
    (quick)
    """
    found = rows_at(tier, "slide")
    mu, area, elastic, Q = (
        slides.trace(found, name)
        for name in ("friction_coefficient", "contact_area", "elastic_friction", "binormal_force")
    )
    friction = mu.mean * SMOOTH.load
    sentence = (
        f"along the slide mu scatters by {mu.scatter / mu.mean:.2%} and A by "
        f"{area.scatter / area.mean:.1%} about their means, correlated over {area.correlated * 1e6:.0f} "
        f"um; the elastic part of F averages to {elastic.mean / friction:+.2%} +- "
        f"{2 * elastic.standard_error / friction:.2%}, a snapshot's scatters by "
        f"{elastic.scatter / friction:.2%}: snapshots are fair for mu and A within that scatter, and not "
        "for the elastic and binormal parts, which are nearly all fluctuation"
    )
    data = {
        "offset (um)": mu.offset * 1e6,
        "mu": mu.values,
        "A (mm^2)": area.values * 1e6,
        "elastic friction (N)": elastic.values,
        "Q (N)": Q.values,
    }
    return judged(Verdict.CONDITIONAL, sentence, abs(elastic.mean) / friction, data=data)


def _turning(tier: str) -> list[slides.Turning]:
    return slides.turning(rows_at(tier, "fig10"))


def _fig10_data(curves: list[slides.Turning]) -> dict[str, object]:
    data: dict[str, object] = {"direction (deg)": np.degrees(curves[0].direction)}
    for c in curves:
        at = f"{c.flat_rms * 1e6:g} um"
        data |= {f"elastic / F, {at}": c.elastic[0], f"F / mean - 1, {at}": c.anisotropy[0]}
    return data
