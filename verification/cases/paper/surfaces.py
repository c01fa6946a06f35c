"""Figs 4 and 11: the surfaces' statistics, undeformed and in contact."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from verification.cases import Measured, Verdict, judged
from verification.reproduction import fig4, fig11
from verification.reproduction.printed import CORRELATION_LENGTH, FLAT_RMS, LARGEST_SLOPE, QUOTED_SLOPES, SIDE
from verification.reproduction.tiers import in_both_tiers

SIZES = {"quick": (12, 128), "full": (75, 512)}  # realisations, elements per side
SIZES_FIG11 = {"quick": (12, 128), "full": (75, 256)}
DRAWN = 64  # elements per side of the surfaces in the figure


@cache
def _statistics(tier: str) -> fig4.Statistics:
    return fig4.measured(*SIZES[tier])


@cache
def _panels(tier: str) -> list[fig11.Panel]:
    return fig11.panels(*SIZES_FIG11[tier])


@in_both_tiers("reproduction/fig4-correlation", metric="at_most", tolerance=0.12)
def correlation(tier: str) -> Measured:
    """Fig. 4: correlation radius and Gaussian heights of the surfaces.

    Claim: Section 6.1: Gaussian heights, autocorrelation 10 % at 104 um
    Source: paper section 6.1, Fig. 4, Eq. (9)
    Tolerance: bias of the estimate on 15 correlation lengths, whose mean is taken from the sample: the
    correlation loses pi / 2.3 (l / side)^2 = 0.6 % everywhere, 1.3 % of the radius, beside the sampling error
    of 12 realisations, 3 standard errors of 3 % each
    """
    found = _statistics(tier)
    error = abs(found.radius.mean / CORRELATION_LENGTH - 1)
    sentence = (
        f"radius {found.radius.mean * 1e6:.1f} +- {found.radius.half_width * 1e6:.1f} um, skewness "
        f"{found.skewness.mean:+.3f} +- {found.skewness.half_width:.3f}, kurtosis "
        f"{found.kurtosis.mean:.3f} +- {found.kurtosis.half_width:.3f}, {found.radius.n} realisations"
    )
    balls = {"surface map": False, "ball map": True} if tier == "quick" else {}
    data: dict[str, object] = {"side (mm)": 1.61, "radius (um)": found.radius.mean * 1e6}
    data |= {name: fig4.surface(0, DRAWN, ball=ball) for name, ball in balls.items()}
    return judged(Verdict.CONSTRUCTION, sentence, error, data=data)


@in_both_tiers("reproduction/fig4-slopes", metric="relative", tolerance=0.03)
def quoted_slopes(tier: str) -> Measured:
    """Section 6.1: the quoted slopes against surfaces of Eq. (9).

    Claim: Section 6.1: rms slopes of 0.125 and 2.5 degrees for rms heights of 0.084 and 1.68 um
    Source: paper section 6.1, Eq. (9)
    Tolerance: sampling error of 12 realisations: 3 standard errors of 0.9 % each
    """
    found = _statistics(tier)
    component = {rms: fig4.degrees(found.component_slope.mean, rms) for rms in FLAT_RMS}
    gradient = {rms: fig4.degrees(found.mean_gradient.mean, rms) for rms in FLAT_RMS}
    expected = fig4.degrees(_component_slope(SIDE / SIZES[tier][1]), FLAT_RMS[1])
    sentence = "; ".join(
        f"at {rms * 1e6:g} um: rms of a component {component[rms]:.3g} deg, mean magnitude of the "
        f"gradient {gradient[rms]:.3g} deg, printed {QUOTED_SLOPES[rms]:g}"
        for rms in FLAT_RMS
    )
    data = {
        "rms of a component (deg)": list(component.values()),
        "mean magnitude of the gradient (deg)": list(gradient.values()),
    }
    return judged(
        Verdict.REFUTED, sentence, component[FLAT_RMS[1]], reference=expected, unit="deg", data=data
    )


@in_both_tiers("reproduction/largest-slope", metric="at_least", tolerance=1.1)
def largest(tier: str) -> Measured:
    """Appendix A: the largest asperity slope.

    Claim: Appendix A: the largest asperity slope did not exceed 6.5 degrees
    Source: paper Appendix A
    Tolerance: mean of the largest gradients of the undeformed 1.68 um surfaces over 6.5 degrees: the expected
    maximum of a Rayleigh variable of 2 degrees over n = 240 l^2 per surface, sqrt(2 log n), is 7 to 9
    degrees; above 1 the printed number does not hold, and sampling leaves 4 % (12 surfaces)
    """
    found, contact = _statistics(tier), _panels(tier)[3]
    steepest = found.largest_gradient
    mean, least = (fig4.degrees(slope, FLAT_RMS[1]) for slope in (steepest.mean, found.least_steep))
    in_contact = float(np.abs(contact.centres[contact.density > 0]).max())
    sentence = (
        f"largest gradient of a 1.68 um surface: {mean:.2f} deg on average over {steepest.n} surfaces, "
        f"{least:.2f} on the least steep; in true contact, along sliding, at most {in_contact:.2f} deg"
    )
    data = {"largest gradient (deg)": mean, "of the least steep surface (deg)": least}
    data |= {"largest in contact (deg)": in_contact}
    return judged(Verdict.REFUTED, sentence, mean / LARGEST_SLOPE, data=data)


def _component_slope(h: float) -> float:
    """Return rms central differences (1/m) of Eq. (9): ``sqrt((R(0) - R(2 h)) / 2) / h``."""
    return math.sqrt(-math.expm1(-2.3 * (2 * h / CORRELATION_LENGTH) ** 2) / 2) / h


def _fig11_data(tier: str) -> dict[str, object]:
    found: dict[str, object] = {}
    for panel in _panels(tier):
        found |= {f"{panel.name}: value": panel.centres, f"{panel.name}: density": panel.density}
        found |= {
            f"{panel.name}: skewness": [panel.skewness.mean, panel.skewness.half_width],
            f"{panel.name}: kurtosis": [panel.kurtosis.mean, panel.kurtosis.half_width],
            f"{panel.name}: rms": panel.rms,
        }
    return found


@in_both_tiers("reproduction/fig11-heights", metric="at_most", tolerance=0.001)
def heights(tier: str) -> Measured:
    """Fig. 11(a, c): heights before contact and in contact.

    Claim: Fig. 11(c): heights in true contact are not Gaussian, though the surface's are
    Source: paper Fig. 11(a), (c), section 8
    Tolerance: p value of zero mean skewness in contact, Student's t over realisations; each realisation is
    one observation, since a surface's points are correlated
    """
    before, _, contact, _ = _panels(tier)
    sentence = (
        f"skewness {contact.skewness.mean:+.3f} +- {contact.skewness.half_width:.3f} in contact against "
        f"{before.skewness.mean:+.3f} +- {before.skewness.half_width:.3f} before"
    )
    return judged(Verdict.CONFIRMED, sentence, contact.p_skewness, data=_fig11_data(tier))


@in_both_tiers("reproduction/fig11-slopes", metric="at_most", tolerance=0.25)
def slopes(tier: str) -> Measured:
    """Fig. 11(b, d): slopes before contact and in contact.

    Claim: Fig. 11(d): slopes in true contact have an overall negative skewness
    Source: paper Fig. 11(b), (d), section 8
    Tolerance: magnitude of the mean skewness: with elastic, nearly uncoupled surfaces sliding either way is
    alike but for friction's own shift (0.7 % of the Hertz radius), so the mean is zero within sampling, 3
    standard errors of 0.07 for 12 realisations
    """
    *_, contact = _panels(tier)
    e = contact.skewness
    sentence = (
        f"mean skewness {e.mean:+.3f} +- {e.half_width:.3f} over {e.n} realisations, one of which "
        f"scatters by {abs(e.scatter * e.mean):.2f}: a single surface's sign is chance; kurtosis "
        f"{contact.kurtosis.mean:.2f} +- {contact.kurtosis.half_width:.2f} (p {contact.p_kurtosis:.2g})"
    )
    negative = e.mean + e.half_width < 0
    verdict = Verdict.CONDITIONAL if negative else Verdict.REFUTED
    return judged(verdict, sentence, abs(e.mean), data=_fig11_data(tier))
