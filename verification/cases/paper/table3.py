"""Table 3 anew, its scatter, and Eqs (10) and (11): 75 realisations; quick: six, on the coarsest mesh."""

from __future__ import annotations

import math

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from refimpl.model.friction import friction_coefficient_at
from verification.cases import Measured, Verdict, case, family, judged, percents
from verification.reproduction import table3
from verification.reproduction.ensemble import QUICK_MESH, Estimate, column, estimate, rows_at
from verification.reproduction.printed import (
    AREA_FLUCTUATION,
    FRICTION_FLUCTUATION,
    HARDNESS,
    LOWEST_FRICTION,
    MESHES,
    TABLE3,
)
from verification.reproduction.table1 import SMOOTH, rough
from verification.reproduction.tiers import TIERS, in_both_tiers

TAU = SMOOTH.friction.tau
ROUGH = tuple(printed.flat_rms for printed in TABLE3[1:])

NAMES = {
    "friction_coefficient": ("mu", "friction coefficient"),
    "contact_area": ("area", "contact area"),
    "max_pressure": ("peak", "maximum contact pressure"),
}
DECIMAL = {"friction_coefficient": 0.01, "contact_area": 0.01e-6, "max_pressure": 0.01e9}  # mm^2, GPa
TOLERANCE = {"quick": 5.0, "full": 1.0}
FINEST = {"quick": QUICK_MESH, "full": 512}  # elements a side


def _estimates(tier: str, quantity: str) -> list[Estimate]:
    """Return the estimates of a quantity in the rough columns of the table, on the finest mesh of a tier."""
    rows, mesh = rows_at(tier, "table3"), FINEST[tier]
    return [estimate(column(rows, quantity, lower_rms=flat, grid=mesh)) for flat in ROUGH]


@family(
    "quantity, name, tier, tolerance",
    {
        f"reproduction/table3-{slug}{'' if tier == 'quick' else '-full'}": (
            quantity, name, tier, TOLERANCE[tier])
        for quantity, (slug, name) in NAMES.items()
        for tier in TIERS
    },
    metric="at_most",
)  # fmt: skip
def reproduced(quantity: str, tier: str) -> Measured:
    """Table 3: {name}.

    Claim: Table 3: {name} of a smooth and three rough pairs
    Source: paper Table 3
    Tolerance: largest deviation of a rough column's mean on the finest mesh from print, in standard
    deviations of a single realisation. Full, 75 realisations: 1 - a mean that is farther off is less alike
    than one pair of surfaces chosen at random. Quick, six realisations on 128 x 128: three standard errors,
    1.2, and what print misses Eq. (10) by on that mesh, 4 % of mu (errata/table3-coarse), 3.5 standard
    deviations
    """
    finest = FINEST[tier]
    table = table3.cells(rows_at(tier, "table3"), quantity, MESHES if tier == "full" else (finest,))
    judgeable = [cell for cell in table if cell.mesh == finest]
    rough = [cell for cell in judgeable if cell.column.flat_rms > 0]
    worst = max(abs(cell.deviation) / cell.ours.scatter for cell in rough)
    printed = [f"{cell.deviation:+.1%} +- {cell.ours.half_width / cell.printed:.1%}" for cell in judgeable]
    largest = max(abs(cell.deviation) for cell in judgeable)
    unlike = [f"{cell.column.flat_rms * 1e6:g}" for cell in judgeable if not cell.within]
    sentence = (
        f"ours less printed at {finest} x {finest}, {rough[0].ours.n} realisations, by roughness: "
        f"{', '.join(printed)}: within {largest:.1%}, and {len(unlike)} of {len(judgeable)} beyond u, of two "
        f"such ensembles and the printed digits (flat's roughness {', '.join(unlike) or 'none'} um)"
    )
    verdict = Verdict.REFUTED if unlike else Verdict.CONFIRMED
    data: dict[str, object] = {**table3.series(table), "largest deviation": largest}
    data |= {"beyond u": len(unlike), "judged": len(judgeable)}
    return judged(verdict, sentence, worst, data=data)


@in_both_tiers("reproduction/section8-scatter", metric="at_most", tolerance=0.25)
def scatter(tier: str) -> Measured:
    """Section 8: scatter of friction between surface representations.

    Claim: Section 8: mu fluctuates by 1.0 %, less than A because of the constant term in Eq. (10)
    Source: paper section 8, Eq. (10)
    Tolerance: relative difference of mu's scatter from what Eq. (10) makes of A's, tau A / N / mu times it:
    at 1.68 um that is 1.0 % of mu, and the elastic part's own 0.7 % (measured) adds in squares: 19 %
    """
    areas, frictions = (_estimates(tier, name) for name in ("contact_area", "friction_coefficient"))
    area, mu = ([e.scatter for e in found] for found in (areas, frictions))
    expected = [
        TAU * a.mean / SMOOTH.load / m.mean * a.scatter for a, m in zip(areas, frictions, strict=True)
    ]
    worst = float(np.max(np.abs(np.array(mu) / np.array(expected) - 1)))
    met = [
        [_reaches(e, printed) for e in found]
        for found, printed in ((areas, AREA_FLUCTUATION), (frictions, FRICTION_FLUCTUATION))
    ]
    both = sum(map(all, zip(*met, strict=True)))
    sentence = (
        f"mu scatters by {percents(mu)} (0.504, 1.008, 1.68 um) where A does by {percents(area)}; "
        f"{FRICTION_FLUCTUATION:.1%} and {AREA_FLUCTUATION:.1%} within u at {both} roughnesses together; "
        f"less than A, as Eq. (10) implies, to {worst:.0%} of mu's scatter"
    )
    data = {
        "sigma_e (um)": [c.equivalent_rms * 1e6 for c in TABLE3[1:]],
        "scatter of A": area,
        "scatter of mu": mu,
        "Eq. (10)": expected,
        "printed A": AREA_FLUCTUATION,
        "printed mu": FRICTION_FLUCTUATION,
    }
    return judged(Verdict.CONDITIONAL if any(met[1]) else Verdict.REFUTED, sentence, worst, data=data)


@in_both_tiers(
    "reproduction/section8-area-scatter", metric="at_most", tolerance={"quick": 0.64, "full": 0.17}
)
def area_scatter(tier: str) -> Measured:
    """Section 8: scatter of the contact area between surface representations.

    Claim: Section 8: A fluctuates by 7.5 % about its mean value
    Source: paper section 8
    Tolerance: relative difference of A's scatter from the printed 7.5 % at the roughness where it is least
    (print states no roughness). A standard deviation of n realisations is known, at 95 %, to 2 / sqrt(2 n -
    2) of itself: 0.63 of six, 0.164 of 75
    """
    area = _estimates(tier, "contact_area")
    scatter = [a.scatter for a in area]
    nearest = min(abs(s / AREA_FLUCTUATION - 1) for s in scatter)
    known = 2 / math.sqrt(2 * area[0].n - 2)
    sentence = (
        f"A scatters by {percents(scatter)} (0.504, 1.008, 1.68 um), each known to {known:.0%} of itself"
    )
    data = {"sigma_e (um)": [c.equivalent_rms * 1e6 for c in TABLE3[1:]], "scatter of A": scatter}
    met = sum(_reaches(a, AREA_FLUCTUATION) for a in area)
    return judged(Verdict.CONDITIONAL if met else Verdict.REFUTED, sentence, nearest, data=data)


def _reaches(found: Estimate, printed: float) -> bool:
    """Return True where a scatter is within u, 95 %, of a printed one: two ensembles, three digits."""
    own = found.scatter * 2 / math.sqrt(2 * found.n - 2)
    return abs(found.scatter - printed) <= math.hypot(math.sqrt(2) * own, 0.0005)


@in_both_tiers("reproduction/eq10", metric="at_most", tolerance=0.03)
def equation10(tier: str) -> Measured:
    """Eq. (10) against full solutions.

    Claim: Eq. (10): mu = tau A / N + beta approximates the friction of rough surfaces
    Source: paper Eq. (10)
    Tolerance: largest error of a single solution: the part that Eq. (10) neglects is elastic, first order in
    the mean slope under load, whose scatter is 1 % of mu
    """
    found, mesh = rows_at(tier, "table3"), FINEST[tier]
    errors: dict[float, Array] = {}
    for flat in ROUGH:
        where = {"lower_rms": flat, "grid": mesh}
        pressure = np.array(column(found, "normal_force", **where)) / column(found, "contact_area", **where)
        simple = np.array([friction_coefficient_at(SMOOTH.friction, p) for p in pressure])
        errors[flat] = simple / column(found, "friction_coefficient", **where) - 1
    worst = max(float(np.abs(e).max()) for e in errors.values())
    means = [float(e.mean()) for e in errors.values()]
    sentence = (
        f"largest error {worst:.2%} in one solution, mean errors {', '.join(f'{m:+.3%}' for m in means)}"
    )
    data = {"sigma_e (um)": [c.equivalent_rms * 1e6 for c in TABLE3[1:]], "mean error": means}
    return judged(Verdict.CONFIRMED, sentence, worst, data=data)


@in_both_tiers("reproduction/eq11", metric="at_least", tolerance=1.5)
def equation11(tier: str) -> Measured:
    """Eq. (11): is tau / H + beta the lowest friction?

    Claim: Eq. (11): mu falls to 0.1, where the mean pressure is the hardness
    Source: paper Eq. (11), Table 3
    Tolerance: mean pressure over hardness at 1.68 um: above 1 the elastic model passes the limit that (11)
    assumes; the mesh and the sample leave 10 %
    """
    area, mu = ([e.mean for e in _estimates(tier, n)] for n in ("contact_area", "friction_coefficient"))
    ratio = [SMOOTH.load / a / HARDNESS for a in area]
    sentence = (
        f"mu goes down to {mu[-1]:.4f} (printed 0.089), below {LOWEST_FRICTION}, at a mean pressure of "
        f"{ratio[-1]:.2f} H; the elastic model itself knows no hardness"
    )
    data = {
        "sigma_e (um)": [c.equivalent_rms * 1e6 for c in TABLE3[1:]],
        "mean pressure / H": ratio,
        "mu": mu,
        "Eq. (11)": friction_coefficient_at(SMOOTH.friction, HARDNESS),
    }
    return judged(Verdict.REFUTED, sentence, ratio[-1], data=data)


@case("reproduction/table3-digits", metric="at_least", tolerance=2.0)
def digits() -> Measured:
    """Table 3: do the numbers converge to two decimal places?

    Claim: Section 8: A, mu and f_max converge up to two decimal places with the fine mesh
    Source: paper section 8, Table 3 itself
    Tolerance: largest change from 256 to 512 elements, in units of the second decimal (mm^2, GPa; print has
    tenths of them, where changes are ten times as many): it would be below 1, and 2 is beyond rounding

    Check of the printed numbers alone.
    """
    shown, largest = [], 0.0
    within: dict[bool, list[str]] = {True: [], False: []}
    for quantity, (_, name) in NAMES.items():
        medium, fine = np.array([getattr(found, quantity)[1:] for found in TABLE3]).T
        decimals = np.abs(fine - medium) / DECIMAL[quantity]
        change = np.abs(fine / medium - 1)
        shown.append(f"{name} {decimals.max():.1f} ({change.max():.1%})")
        within[bool(decimals.max() < 1)].append(name)
        largest = max(largest, float(decimals.max()))
    sentence = (
        "printed numbers move from 256 to 512 elements, in units of the second decimal (and relative), by: "
        f"{', '.join(shown)}. Within it, in mm^2 and GPa: {', '.join(within[True]) or 'none'}; beyond: "
        f"{', '.join(within[False]) or 'none'}"
    )
    verdict = Verdict.REFUTED if within[False] else Verdict.CONFIRMED
    return judged(verdict, sentence, largest, data={})


REALISATIONS, MESH, ROUGHER_BALL = 25, 256, 0.252e-6


@case("reproduction/table3-ball-roughness-full", metric="at_most", tolerance=0.5, tier="full")
def ball_roughness() -> Measured:
    """Table 3: what would explain the trend of the deviations.

    Claim: The deviations of A from Table 3 fall with roughness; a ball of 0.252 um in place of 0.084 um would
    make them alike
    Source: paper Table 3
    Tolerance: share of the trend (deviation of A at 0.504 um less that at 1.68 um) that is left; paired
    realisations leave 15 % of uncertainty in it

    A sensitivity, not a proof: the printed numbers behave as if the ball were three times as rough.
    """
    ratios: dict[float, list[float]] = {}
    peaks: dict[float, list[float]] = {}
    for flat in (0.504e-6, 1.680e-6):
        for k in range(REALISATIONS):
            stated = rf.solve(rough(flat, 0.084e-6, k), MESH)
            rougher = rf.solve(rough(flat, ROUGHER_BALL, k), MESH)
            ratios.setdefault(flat, []).append(rougher.contact_area / stated.contact_area)
            peaks.setdefault(flat, []).append(rougher.max_pressure / stated.max_pressure)
    cells = table3.cells(rows_at("full", "table3"), "contact_area", (MESH,))
    deviations = {cell.column.flat_rms: cell.deviation for cell in cells}
    change = {flat: estimate(values) for flat, values in ratios.items()}
    before = deviations[0.504e-6] - deviations[1.680e-6]
    after = before + change[0.504e-6].mean - change[1.680e-6].mean
    data = {"trend before": before, "trend after": after}
    sentence = (
        f"trend of A's deviation {before:+.1%} over the columns as stated, {after:+.1%} with a ball of "
        f"0.252 um, which changes f_max at 0.504 um by {float(np.mean(peaks[0.504e-6])) - 1:+.1%}"
    )
    return judged(Verdict.CONDITIONAL, sentence, abs(after / before), data=data)
