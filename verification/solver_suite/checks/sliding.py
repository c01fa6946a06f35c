"""Sliding contact of dissimilar bodies: friction moves the surfaces normally, and with them the contact.

Pressures of the arrays of pins span two and a half decades, so that tau moves most of what barely carries
anything. That no other active set of tau gives a solution is tested for every array, over all 4096 supports.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import quad

from refimpl.grid import Array
from verification.exact import fourier
from verification.exact.coupled_indentation import CoupledHertz, ShearedSphere
from verification.exact.sliding_wave import SlidingWave
from verification.framework.case import Measured, Metric
from verification.solver_suite.check import COMPLIANCE, MODULUS, Check, Entrant, Pressed
from verification.solver_suite.check import Fault as F
from verification.solver_suite.checks.exact import BOUND, SOURCE, TWO_SIDED, by_approach, by_load
from verification.solver_suite.checks.invariance import LOAD, TWICE, images, same
from verification.solver_suite.checks.periodic import AMPLITUDE, STAR, ridge
from verification.solver_suite.checks.residuals import AND_MEAN, sliding
from verification.solver_suite.checks.smooth import SPHERE, apart, sphere
from verification.solver_suite.gaps import centres, rough_bump, waves
from verification.solver_suite.pin_arrays import PEAK, PinArray, graded, standing
from verification.solver_suite.protocol import Coupling

D = float(np.pi * COMPLIANCE * MODULUS)
"""Dundurs' constant of the pair, 0.3."""
M = 32
TAU, BETA = 0.05 * PEAK, 0.4
COUPLINGS = (
    Coupling(TAU, BETA, COMPLIANCE, 0.9),
    Coupling(TAU, BETA, -COMPLIANCE / 2, 0.9),
    Coupling(TAU, BETA, -COMPLIANCE / 2, 2.2),
)
"""In turn: another c0, and that alone; then another direction."""
FREE = tuple(PinArray(graded(standing(12), 3), coupling) for coupling in COUPLINGS)
PERIODIC = tuple(PinArray(graded(standing(13), 3), coupling, periodic=True) for coupling in COUPLINGS)
"""An odd number of elements has no Nyquist frequency to disagree about."""
SIGNS = "; c is lower minus upper, and odd in the offset (verification.solver_suite.protocol)"
SYMBOLS = "the exact Fourier symbols (verification.exact.fourier)" + SIGNS
SKEW = BOUND + "it holds with c, which is skew"
FRICTION = (
    *(F.SIGN_OF_C, F.TAU_MISSING, F.TAU_EVERYWHERE, F.TAU_NOT_ON_ALL),
    *(F.TRANSPOSED, F.HALF_ELEMENT, F.MODULUS_OFF),
)
IN_PERIODS = (F.APERIODIC_FOR_PERIODIC, F.TAU_BESIDE, F.TAU_ALONG_X, F.SIGN_OF_C_LOST)


def centroid(pressed: Pressed, x: Array) -> float:
    """Return the pressure-weighted mean of ``x`` (m). Raises ValueError without a load."""
    if not pressed.load > 0:
        raise ValueError(f"the pressures carry {pressed.load:.3g} N: no centroid")
    return float(np.sum(pressed.pressure * x) / pressed.pressure.sum())


def _trailing_shift(entrant: Entrant) -> Measured:
    side = 2.6 * SPHERE.contact_radius
    state = ShearedSphere(SPHERE, COMPLIANCE, tau=0.2 * SPHERE.peak_pressure)
    pressed = entrant.press(sphere(side, M), side, load=1.0, coupling=Coupling(state.tau, 0.0, COMPLIANCE))
    data = {"element": side / M}
    return Measured(centroid(pressed, centres(side, M)[0]), state.shift, 0.0, "m", data)


def coupled_hertz(entrant: Entrant, n: int, tau: float) -> tuple[Array, Array]:
    """Return found and exact pressures of a sliding Hertz state; ``tau`` is a share of the peak."""
    side, direction = 2.6 * SPHERE.contact_radius, 2.5
    state = CoupledHertz(SPHERE, COMPLIANCE, tau=tau * SPHERE.peak_pressure, beta=0.8)
    x, y = centres(side, n)
    cos, sin = np.cos(direction), np.sin(direction)
    coupling = Coupling(state.tau, state.beta, COMPLIANCE, direction)
    gap = state.gap(cos * x + sin * y, cos * y - sin * x)
    pressed = entrant.press(gap, side, load=1.0, coupling=coupling)
    return pressed.pressure, SPHERE.pressure(np.hypot(x, y))


def _sliding_wave(entrant: Entrant) -> Measured:
    n, beta, tau = 64, 0.4, 0.04 * STAR
    wave = SlidingWave(0.3 * STAR, AMPLITUDE, 1.0, MODULUS, D, tau, beta)
    coupling = Coupling(tau, beta, COMPLIANCE)
    pressed = entrant.press(ridge(n), 1.0, load=0.3 * STAR, periodic=True, coupling=coupling)
    exact = quad(lambda x: x * float(wave.pressure(x)), *wave.edges, epsrel=1e-9)[0] / (0.3 * STAR)
    return Measured(centroid(pressed, centres(1.0, n)[0]), exact, 1e-7 * abs(exact), "m")


def _full_contact(entrant: Entrant) -> Measured:
    gap = AMPLITUDE * waves(M, seed=61, longest=2, shortest=8)
    mean, beta, direction = 40 * STAR, 0.8, 0.7
    exact = fourier.FullContact(gap, 1.0, MODULUS, mean, D, beta, direction).pressure
    coupling = Coupling(0.01 * STAR, beta, COMPLIANCE, direction)
    pressed = entrant.press(gap, 1.0, load=mean, periodic=True, coupling=coupling)
    return entrant.against((pressed, exact))


# fmt: off
CHECKS = (
    Check("trailing-shift", "A hard sphere with constant shear strength: the contact trails",
          "tau alone moves the pressure of a sphere on a softer flat by -pi c0 tau R along the sliding "
          "direction, towards the trailing edge",
          "Gauss' law for the kernel s/rho^2; verification.exact.coupled_indentation; paper section 7", 0.03,
          "the edge of tau is a staircase that places the centroid to a per cent of the shift at "
          "12 elements across the radius: 1.4e-2 measured. The other sign misses by 2, no tau by 1",
          (F.SIGN_OF_C, F.TAU_MISSING), _trailing_shift, Metric.RELATIVE),
    Check("coupled-indentation", "A gap whose exact sliding state is Hertz'",
          "Sliding at 2.5 rad with tau and beta over a gap that takes their displacement away, the pressure "
          "is centred and round",
          "Gauss' law for the kernel s/rho^2; verification.exact.coupled_indentation", 0.02,
          "relative L2; order 1 as for Hertz alone, with the jump of tau at the edge; 1.6e-2 "
          "measured at 12 elements across the radius",
          (F.SIGN_OF_C, F.TAU_MISSING, F.TRANSPOSED, F.HALF_ELEMENT),
          lambda entrant: apart(*coupled_hertz(entrant, M, 0.3))),
    Check("sliding-wave", "A sliding wave with the binomial law: trailing shift",
          "With shear tau + beta p the centroid of a wave's pressure trails by the exact amount; tau is "
          "worth a fifth of it",
          "singular exponents of Galin 1953 and Johnson 1985, section 8.3, on Westergaard's wave", 2e-3,
          "the edges are placed to 1/64 of a wave, but enter the centroid by their pressure, "
          "which vanishes there: 1e-3 measured",
          (F.SIGN_OF_C, F.TAU_MISSING, F.TAU_EVERYWHERE, F.TRANSPOSED), _sliding_wave, Metric.RELATIVE),
    Check("full-contact-sliding", "A rough plane sliding in full contact",
          "With coupling the pressure's transform gains 1/(1 - i d beta q_s/q), in a direction of 0.7 rad",
          "transform of s/rho^2, -2 pi i q_s/q^2; derived in verification.exact.fourier", 2.0,
          "in claims of the squared energy-norm error, as full-contact",
          (F.SIGN_OF_C, F.TRANSPOSED, F.MODULUS_OFF, F.MODULUS_DOUBLED), _full_contact),
    Check("sliding-reversed", "Sliding the other way in the mirror",
          "The mirrored gap sliding along -x has the mirrored pressure, as has the exchanged pair of bodies "
          "sliding along -x on the same gap the same one",
          "c is odd in the offset, and lower minus upper", 4.1, TWICE, (F.HALF_ELEMENT,),
          images(rough_bump(20, 62), same(np.flipud, coupling=sliding(np.pi)),
                 same(np.asarray, coupling=sliding(np.pi, sign=-1.0)), load=LOAD, coupling=sliding(0.0))),
    Check("identical-materials", "Identical materials do not couple",
          "With c0 = 0, friction changes no pressure",
          "c is lower minus upper (verification.solver_suite.protocol); Johnson 1985, section 5.4",
          4.1, TWICE, (),
          images(rough_bump(20, 63), same(np.asarray, coupling=Coupling(0.1 * LOAD, 0.5, 0.0, 1.0)),
                 load=LOAD)),
    Check("sheared-pins", "A bed of pins that slides",
          "With tau and beta, at two c0 of unlike sign and in two oblique directions, each changed alone, "
          "the pins carry the pressures that were chosen, down to 0.3 % of the largest",
          SOURCE + SIGNS, 1.1, SKEW,
          (*FRICTION, F.C0_KEPT, F.DIRECTION_KEPT, F.CORNER_LEFT_OUT, F.PADDING_SHORT), by_load(*FREE)),
    Check("sheared-pins-approach", "A bed of pins that slides at a prescribed approach",
          "The sliding pins carry the same pressures at the approach that their load takes",
          SOURCE + SIGNS, 2.0, TWO_SIDED,
          (*FRICTION, F.MEAN_DISPLACEMENT_LOST, F.CORNER_LEFT_OUT, F.PADDING_SHORT, F.UNCOUPLED_AT_APPROACH),
          by_approach(FREE[-1])),
    Check("periodic-sheared-pins", "A periodic bed of pins that slides",
          "With tau and beta, at two c0 of unlike sign and in two oblique directions, each changed alone, "
          "the pins carry the pressures that were chosen, across the border as well",
          SYMBOLS, 1.1, SKEW, (*FRICTION, *IN_PERIODS, F.C0_KEPT, F.DIRECTION_KEPT, F.ODD_GRIDS),
          by_load(*PERIODIC)),
    Check("periodic-sheared-pins-approach", "A periodic bed of pins that slides at a prescribed approach",
          "The sliding pins carry the same pressures at the approach of mean planes that their load takes",
          SYMBOLS, 2.0, AND_MEAN + "3.0 here",
          (*FRICTION, *IN_PERIODS, F.MEAN_PLANES_LOST, F.MEAN_PRESSURE_ADDED, F.UNCOUPLED_AT_APPROACH,
           F.ODD_GRIDS),
          by_approach(PERIODIC[-1])),
)
# fmt: on
