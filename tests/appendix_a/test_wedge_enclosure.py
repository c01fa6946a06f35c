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


def test_the_tails_bound_is_checked(monkeypatch: pytest.MonkeyPatch) -> None:
    """From xi = 1 on, ``|z| sin(2 alpha) <= sinh(2 alpha xi) / 2`` fails for alpha = 1/2: 1.26 and 0.59."""
    monkeypatch.setattr(enclosure, "TAIL_EXPONENT", 0.1)
    with pytest.raises(ArithmeticError, match="from xi = 1"):
        enclosure._tail_start(flint.arb, flint.arb(0.5), flint.arb(0.0))
    with pytest.raises(ArithmeticError, match="from xi = 1"):
        enclosure._tail_start(flint.arb, flint.arb(0.895), flint.arb(0.0))  # 1.464 and 1.456
    assert enclosure._tail_start(flint.arb, flint.arb(1.0), flint.arb(0.0)) == 1  # 1.36 and 1.81
