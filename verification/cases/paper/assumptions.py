"""The paper's silent assumptions: interference, tangential displacements, slopes, cosines, coupling."""

from __future__ import annotations

from functools import cache
from itertools import product

import numpy as np

import refimpl as rf
from refimpl.grid import Array
from verification.cases import Measured, Verdict, case, certified, judged
from verification.reproduction import assumptions
from verification.reproduction.fig6 import NO_FRICTION
from verification.reproduction.table1 import rough
from verification.reproduction.tiers import in_both_tiers

GRID = {"quick": 128, "full": 512}
REALISATIONS = {"quick": 3, "full": 10}
FLATS = (0.084e-6, 0.504e-6, 1.680e-6)  # m
BALL = 0.084e-6  # m
COUPLED = 6  # realisations


@cache
def _solutions(tier: str) -> dict[float, list[tuple[rf.Scene, rf.Solution]]]:
    scenes = {flat: [rough(flat, BALL, k) for k in range(REALISATIONS[tier])] for flat in FLATS}
    return {flat: [(s, rf.solve(s, GRID[tier])) for s in chosen] for flat, chosen in scenes.items()}


@in_both_tiers("reproduction/interference", metric="at_least", tolerance=0.0)
def within(tier: str) -> Measured:
    """True contact lies within kinematic interference.

    Claim: Section 4: true contact is contained in the kinematic interference area
    Source: paper section 4, Eq. (6)
    Tolerance: least (approach - h) / approach on the contact: below 0 the surfaces touch without interfering
    """
    margin = {
        flat: min(assumptions.kinematic_margin(scene, found) for scene, found in solved)
        for flat, solved in _solutions(tier).items()
    }
    sentence = "least margin " + ", ".join(f"{m:.3f} at {flat * 1e6:g} um" for flat, m in margin.items())
    data = {"margin": list(margin.values())}
    return judged(Verdict.CONFIRMED, sentence, min(margin.values()), data=data)


@in_both_tiers("reproduction/tangential-displacements", metric="at_most", tolerance=0.01)
def tangential(tier: str) -> Measured:
    """Tangential displacements are negligible.

    Claim: Section 4: relative tangential displacements are negligibly small
    Source: paper section 4; Johnson 1985, sections 3.2 and 3.6
    Tolerance: change of mu and A when the displacements are worked into the surfaces: first order in the
    displacement over the correlation length, 0.3 / 104, and two steps of A, one element in 290 at 1.68 um
    """
    grid = min(GRID[tier], 256)
    found = {flat: assumptions.tangential_effect(flat, BALL, 0, grid) for flat in FLATS}
    worst = max(abs(change) for e in found.values() for change in (e.friction, e.area))
    sentence = "; ".join(
        f"at {flat * 1e6:g} um: displacement {e.displacement:.2f} of the approach, gap {e.gap:.2%} of "
        f"it, mu {e.friction:+.3%}, A {e.area:+.2%}, f_max {e.peak:+.2%}"
        for flat, e in found.items()
    )
    *_, mu, area, peak = zip(*found.values(), strict=True)
    data = {"change of mu": mu, "change of A": area, "change of f_max": peak}
    return judged(Verdict.CONFIRMED, sentence, worst, data=data)


@in_both_tiers("reproduction/small-slopes", metric="at_most", tolerance=0.1)
def small(tier: str) -> Measured:
    """Rms slopes below 0.1 rad.

    Claim: Section 2: rms slopes are below 0.1 rad
    Source: paper section 2
    Tolerance: the paper's own bound, on the largest rms slope of a component (rad), before contact and in it
    """
    before, contact = {}, {}
    for flat, solved in _solutions(tier).items():
        before[flat] = max(_rms(*np.gradient(s.heights(f.grid)[0], *f.grid.spacings)) for s, f in solved)
        contact[flat] = max(_rms(f.slopes.tan_x[f.contact], f.slopes.tan_y[f.contact]) for _, f in solved)
    sentence = "; ".join(
        f"at {flat * 1e6:g} um {before[flat]:.4f} before and {contact[flat]:.4f} rad in contact"
        for flat in FLATS
    )
    worst = max(*before.values(), *contact.values())
    return judged(Verdict.CONSTRUCTION, sentence, worst, data={"rms slope": list(before.values())})


def _rms(along: Array, across: Array) -> float:
    return float(np.sqrt(np.mean(along**2 + across**2) / 2))


@case("reproduction/interference-broken", metric="at_least", tolerance=0.04)
def contact_without_interference() -> Measured:
    """Coupling can take contact out of kinematic interference.

    Claim: Section 4's assumption fails where shear exceeds the pressure some four times
    Source: paper section 4, Eqs (6) and (7)
    Tolerance: largest (h - approach) / approach on the contact at beta = 4, on the grid where it is smaller:
    above 0 there is contact without interference. The two grids differ by 0.013, of which 0.04 is three
    times. Without tau states are unique at fixed slopes
    """
    ratios = (1.0, 2.0, 3.0, 4.0, 5.0)
    margins: dict[int, list[float]] = {64: [], 128: []}
    for beta, M in product(ratios, margins):
        scene = assumptions.sheared_scene(beta)
        found = certified(rf.solve(scene, M), cycled=False)
        margins[M].append(assumptions.kinematic_margin(scene, found))
    sentence = "least margin " + ", ".join(
        f"{m:+.3f} at beta = {beta:g}" for beta, m in zip(ratios, margins[128], strict=True)
    )
    data = {"beta": ratios, **{f"margin at {M} x {M}": found for M, found in margins.items()}}
    worst = max(found[3] for found in margins.values())
    return judged(Verdict.CONDITIONAL, sentence, -worst, data=data)


@case("reproduction/facet-tractions", metric="relative", tolerance=0.2)
def facets() -> Measured:
    """The printed cosines against exact facet tractions.

    Claim: Eqs (2) and (3): the printed cosines give the resultants of tractions on oblique facets
    Source: paper Eqs (2) and (3)
    Tolerance: order of the difference of N in the rms slope, fitted over slopes of 0.003 to 0.15: second,
    since cosines differ from 1 at second order; realisations of four roughnesses leave 0.2
    """
    flats = (0.504e-6, 1.680e-6, 6.720e-6, 26.88e-6)
    effects = [assumptions.facet_effect(flat, 128) for flat in flats]
    slope, normal, _, mu = np.array(effects).T
    order = float(np.polyfit(np.log(slope), np.log(np.abs(normal)), 1)[0])
    sentence = "; ".join(
        f"rms slope {at:.4f}: N {of_N:+.1e}, F {of_F:+.1e}, mu {of_mu:+.1e}"
        for at, of_N, of_F, of_mu in effects
    )
    data = {"rms slope": slope, "change of N": normal, "change of mu": mu}
    return judged(Verdict.CONFIRMED, f"order {order:.2f} in N; {sentence}", order, reference=2.0, data=data)


@case("reproduction/section9-coupling", metric="at_least", tolerance=1e-6)
def coupling() -> Measured:
    """Section 9: slopes couple the normal and the sliding direction.

    Claim: Section 9: contacts at asperity slopes give rise to force components in both the sliding direction
    and normal to it
    Source: paper section 9, Eqs (2) and (3)
    Tolerance: rms of F / N without local friction, which is zero without slopes: a hundred times the
    certificate's 1e-8 is no rounding
    """
    tangential, normal = [], []
    for k in range(COUPLED):
        scene = rough(FLATS[-1], BALL, k)
        slid = rf.solve(scene, GRID["quick"])
        pressed = rf.solve(rough(FLATS[-1], BALL, k, friction=NO_FRICTION), GRID["quick"], oblique=True)
        tangential.append(pressed.friction_force / pressed.normal_force)
        lifted = float(np.sum(slid.traction * np.sin(slid.slopes.theta_x))) * slid.grid.element_area
        normal.append(lifted / slid.normal_force)
    rms, share = (float(np.sqrt(np.mean(np.square(v)))) for v in (tangential, normal))
    sentence = (
        f"rms of F / N without local friction {rms:.2e}; local friction's part of N, {share:.1e} rms, over "
        f"{COUPLED} surfaces at 1.68 um: the coupling exists, and is small on these slopes"
    )
    return judged(Verdict.CONSTRUCTION, sentence, rms, data={})
