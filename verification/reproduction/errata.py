"""Errors in the paper's body: a number against each place, and a number for its correction.

``evidence()`` measures the printed form and ``check()`` the corrected one, by the same ``measure``: zero is
right. Appendix A's errata are `appendix_a.errata`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import refimpl as rf
from refimpl.model.forces import plasticity_index
from refimpl.model.friction import friction_coefficient_at
from verification.reproduction.ensemble import column, estimate, rows_at
from verification.reproduction.printed import (
    CORRELATION_LENGTH,
    CRITICAL_RMS,
    FIG6_RMS,
    FLAT_RMS,
    HARDNESS,
    LENGTH_IN_ELEMENTS,
    LOWEST_FRICTION,
    QUOTED_SLOPES,
    RESOLUTION,
    SPHERE_RMS,
    TABLE2,
    TABLE3,
)
from verification.reproduction.table1 import SMOOTH

LAW = SMOOTH.friction


@dataclass(frozen=True)
class Erratum:
    """One fault; ``measure`` says what ``evidence`` and ``check`` compute, ``tolerance`` bounds ``check``."""

    slug: str
    equation: str
    printed: str
    corrected: str
    measure: str
    evidence: Callable[[], float]
    check: Callable[[], float]
    tolerance: float
    tolerance_reason: str


def _off(value: float, reference: float) -> float:
    return abs(value / reference - 1)


def _slope_misfit(factor: float) -> float:
    """Return the quoted slopes against ``factor`` times the component rms of Eq. (9), l = 33."""
    length = LENGTH_IN_ELEMENTS * RESOLUTION
    slopes = {rms: rf.GaussianRoughness(rms, length, seed=0).rms_slope for rms in FLAT_RMS}
    return max(_off(math.degrees(factor * slope), QUOTED_SLOPES[rms]) for rms, slope in slopes.items())


def _plasticity_misfit(length: float) -> float:
    return abs(plasticity_index(SMOOTH.materials.reduced_modulus, HARDNESS, CRITICAL_RMS, length) - 1)


def _ours(quantity: str, flat_rms: float) -> float:
    """Return the mean of six realisations at 128 x 128."""
    return estimate(column(rows_at("quick", "table3"), quantity, lower_rms=flat_rms)).mean


def _limit_misfit(*, elastic: bool) -> float:
    """Return friction printed at 1.68 um against its lower limit, or Eq. (10) at our pressure."""
    printed = TABLE3[-1].friction_coefficient[-1]
    if not elastic:
        return _off(printed, LOWEST_FRICTION)
    pressure = SMOOTH.load / _ours("contact_area", TABLE3[-1].flat_rms)
    return _off(printed, friction_coefficient_at(LAW, pressure))


def _coarse_misfit(*, printed: bool) -> float:
    """Return the mu of Table 3's two roughest columns against Eq. (10) with the A beside it: the largest
    misfit of the printed 128 x 128 and 256 x 256, or of ours on 128 x 128.
    """
    names, pairs = ("contact_area", "friction_coefficient"), []
    for c in TABLE3[2:]:
        if printed:
            pairs += [tuple(getattr(c, name)[mesh] for name in names) for mesh in (0, 1)]
        else:
            pairs.append(tuple(_ours(name, c.flat_rms) for name in names))
    return max(_off(mu, friction_coefficient_at(LAW, SMOOTH.load / A)) for A, mu in pairs)


def _outside(roughness: Iterable[float]) -> float:
    """Return how far equivalent roughnesses (m) leave section 6.1's range, relative to its ends."""
    lowest, highest = (math.hypot(SPHERE_RMS, flat) for flat in FLAT_RMS)
    values = list(roughness)
    return max(0.0, 1 - min(values) / lowest, max(values) / highest - 1)


ERRATA = (
    Erratum(
        "slopes",
        "section 6.1",
        "'standard deviations of ... sigma_theta_x=sigma_theta_y=0.125 deg for its slope distributions', and "
        "'between ... 0.125 and 2.50 deg'",
        "conjecture: mean magnitudes of the gradient, sqrt(pi / 2) times the rms of a component",
        "largest relative difference of the quoted slopes from Eq. (9)'s",
        lambda: _slope_misfit(1.0),
        lambda: _slope_misfit(math.sqrt(math.pi / 2)),
        0.0056,
        "half a unit of 0.125's last digit, and as much of 3.15 um's",
    ),
    Erratum(
        "bracket",
        "(9)",
        "'sigma^2 e^{-2.3[k/l_x]^2 + m/l_y]^2}'",
        "sigma^2 exp(-2.3 ([k/l_x]^2 + [m/l_y]^2)); the bracket may be lost in the conversion of the text",
        "|R at the correlation radius along y - 10 %|",
        lambda: abs(math.exp(1.0) - 0.1),
        lambda: abs(math.exp(-2.3) - 0.1),
        0.0003,
        "2.3 is log 10 to two digits: exp(-2.3) = 0.10026",
    ),
    Erratum(
        "plasticity-length",
        "(12)",
        "'psi ~ 2.2 E'/H (sigma_e/epsilon)' with 'epsilon=3.15 um'; 'psi reaches the threshold value of "
        "unity at about sigma_e = 0.5 um'",
        "psi with the correlation length, l = 104 um, for epsilon: 2.2 sigma / l is then the rms slope of "
        "Eq. (9), sqrt(4.6) sigma / l = 2.14 sigma / l, from the second derivative of the ACF at its origin",
        "|psi(0.5 um) - 1|",
        lambda: _plasticity_misfit(RESOLUTION),
        lambda: _plasticity_misfit(CORRELATION_LENGTH),
        0.1,
        "'about 0.5 um' has one digit, 10 %",
    ),
    Erratum(
        "lowest-friction",
        "(11)",
        "'the lowest value mu reaches is estimated as 0.1'",
        "no such limit in an elastic model: Eq. (10) at the pressure solved for",
        "relative difference of Table 3's mu = 0.089 from the limit, or from Eq. (10)",
        lambda: _limit_misfit(elastic=False),
        lambda: _limit_misfit(elastic=True),
        0.01,
        "the printed digit, 0.6 %, and the coarse mesh's area, 10 % of tau A / N: 1 % of mu",
    ),
    Erratum(
        "table3-coarse",
        "Table 3, 128 x 128 and 256 x 256",
        "'1.01 0.97' and '0.94 0.91' (mu / 0.1) beside '0.77 0.71' and '0.50 0.45' (A / 0.1 mm^2), "
        "meshes 128 and 256",
        "conjecture: mu by Eq. (10) from the A beside it, which our solutions on coarse meshes obey",
        "largest relative difference of mu from Eq. (10) with the same mesh's A, 1.008 and 1.68 um",
        lambda: _coarse_misfit(printed=True),
        lambda: _coarse_misfit(printed=False),
        0.005,
        "the elastic part's mean over six realisations, 0.7 % / sqrt(6) and a fixed 0.15 %",
    ),
    Erratum(
        "table2-case4",
        "Table 2, case 4",
        "'23715' initial and '68951' final contact points",
        "conjecture: a digit is lost, as in 237150, four times case 3",
        "relative difference of the initial points from four times those of the grid half as fine",
        lambda: _off(TABLE2[3][1], 4 * TABLE2[2][1]),
        lambda: _off(10 * TABLE2[3][1], 4 * TABLE2[2][1]),
        0.01,
        "case 3 departs from four times case 2 by 0.65 %",
    ),
    Erratum(
        "fig6-range",
        "Fig. 6",
        "'vary between sigma(fs)=0.084 and 1.680 um' (section 6.1) beside 'sigma_e=0.068; 0.511 and 2.69 um' "
        "(Fig. 6)",
        "section 6.1's range, sigma_e of 0.119 to 1.682 um with 0.084 um on the ball, is that of Table 3",
        "how far equivalent roughnesses lie outside the range, relative to its ends: Fig. 6's, Table 3's",
        lambda: _outside(FIG6_RMS),
        lambda: _outside(column.equivalent_rms for column in TABLE3 if column.flat_rms > 0),
        0.0003,
        "half a unit of the last digit of 1.682 um",
    ),
)
