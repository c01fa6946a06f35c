"""Residuals of pressures in the frictionless problem, recomputed by the exact operator on the whole grid."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy.fft as sfft

from refimpl.grid import Array, Grid, Window
from refimpl.operators.fft import FFTInfluence
from verification.solver_suite.protocol import ContactProblem


@dataclass(frozen=True)
class Judgement:
    """Relative residuals and the numbers that all codes must agree on.

    gap : ``sum f (v - min v) dA`` over the elastic energy
    balance : ``|N - P| / P``
    penetration : of the approach
    tension : largest negative pressure over the peak
    area : m^2
    peak : Pa
    """

    gap: float
    balance: float
    penetration: float
    tension: float
    area: float
    peak: float


def judged(problem: ContactProblem, pressure: Array) -> Judgement:
    """The judgement on pressures (Pa) of a problem under a load, in free space.

    Raises ValueError for other problems.
    """
    if problem.load is None or problem.periodic or problem.coupling is not None:
        raise ValueError("only frictionless problems under a load, in free space")
    operator = FFTInfluence(Grid(problem.shape, problem.lengths), direction=0.0)
    u = operator.normal(pressure) / (math.pi * problem.reduced_modulus)
    v, dA = u + problem.gap, problem.element_area
    energy = 0.5 * float(np.vdot(pressure, u)) * dA
    approach = float(np.vdot(pressure, v) / pressure.sum())
    return Judgement(
        gap=float(np.vdot(pressure, v - v.min())) * dA / energy,
        balance=abs(float(pressure.sum()) * dA / problem.load - 1),
        penetration=max(0.0, approach - float(v.min())) / approach,
        tension=max(0.0, -float(pressure.min())) / float(pressure.max()),
        area=float(np.count_nonzero(pressure > 0)) * dA,
        peak=float(pressure.max()),
    )


def padded_box(pressure: Array) -> tuple[int, int]:
    """Shape of the FFT that convolves over the contact's bounding box."""
    rows, columns = (2 * n for n in Window.around(pressure > 0, margin=0).shape)
    return sfft.next_fast_len(rows), sfft.next_fast_len(columns, real=True)
