"""Rigorous enclosures contain the values that two other paths give."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

from appendix_a.wedge import enclosure, reference, stresses

flint = pytest.importorskip("flint", reason="python-flint is an optional extra")


@pytest.mark.parametrize(("r", "share", "gamma"), [(0.5, -0.6, 0.1), (3.0, 0.0, 1.0)])
def test_enclosures(r: float, share: float, gamma: float) -> None:
    theta = share * (np.pi / 2 - gamma)
    balls = enclosure.stresses(r, theta, gamma)
    exact = reference.stresses(r, theta, gamma, digits=25).values
    for ball, value, double in zip(balls, exact, stresses(r, theta, gamma), strict=True):
        assert float(ball.rad()) < 1e-18
        with flint.ctx.workprec(96):
            assert abs(ball - flint.arb(mp.nstr(value, 24))) < 1e-18
        assert abs(ball - float(double)) < 1e-14
