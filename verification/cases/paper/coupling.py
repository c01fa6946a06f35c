"""Section 9: contacts on slopes couple the sliding direction and the normal one."""

from __future__ import annotations

import numpy as np

import refimpl as rf
from verification.framework.case import Measured
from verification.framework.registry import case
from verification.framework.verdict import Verdict, judged
from verification.reproduction.fig6 import NO_FRICTION
from verification.reproduction.table1 import rough

GRID, SURFACES, FLAT_RMS, BALL_RMS = 128, 6, 1.680e-6, 0.084e-6


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
    for k in range(SURFACES):
        scene = rough(FLAT_RMS, BALL_RMS, k)
        slid = rf.solve(scene, GRID)
        pressed = rf.solve(rough(FLAT_RMS, BALL_RMS, k, friction=NO_FRICTION), GRID, oblique=True)
        tangential.append(pressed.friction_force / pressed.normal_force)
        lifted = float(np.sum(slid.traction * np.sin(slid.theta_x))) * slid.grid.element_area
        normal.append(lifted / slid.normal_force)
    rms, share = (float(np.sqrt(np.mean(np.square(v)))) for v in (tangential, normal))
    sentence = (
        f"rms of F / N without local friction {rms:.2e}; local friction's part of N, {share:.1e} rms, over "
        f"{SURFACES} surfaces at 1.68 um: the coupling exists, and is small on these slopes"
    )
    data = {"F / N without local friction": tangential, "local friction's part of N / N": normal}
    return judged(Verdict.CONFIRMED, sentence, rms, data=data)
