"""What tractions do to the gap of a window: the part that CG inverts, and the part that is held meanwhile.

CG inverts ``a f``, and where it is weak the coupling ``beta c f`` with it. Cerruti's kernel is odd, so ``c``
is skew: it adds nothing to a curvature ``d.(a d)``, and both kernels are one to the transforms. What is left
of shear then is tau's, which is constant on a given support. Where the coupling is strong, CG's directions
lose each other; then all of shear is held, and brought up to date by mixed updates. So it is with facet
tractions, whose shear is no multiple of the pressure.
"""

from __future__ import annotations

import numpy as np

from refimpl.grid import Array
from refimpl.model.friction import Mask, local_friction
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.operators.fft import FFTInfluence
from refimpl.operators.periodic import PeriodicInfluence

_WEAK = 0.3  # sigma up to which CG takes the coupling in; on random scenes it pays to 0.5, and fails at 0.7


class Flexibility:
    """The displacements of a problem on a window, by its operator.

    ``sigma`` is the spectral radius of ``beta c f`` against ``a f``, at most, and zero where shear does not
    reach the gap; ``coupled`` says whether `apply` holds both.
    """

    def __init__(self, problem: Problem, operator: FFTInfluence | PeriodicInfluence) -> None:
        pair, beta = problem.pair, problem.friction.beta
        self._problem, self._operator = problem, operator
        self._ratio = pair.shear_compliance * beta / pair.normal_compliance
        terms = problem.terms
        self.sigma = abs(self._ratio) if terms.coupled or terms.slope_correction else 0.0
        self.coupled = 0 < self.sigma <= _WEAK and not terms.slope_correction
        self._product = operator.coupled(self._ratio) if self.coupled else operator.normal
        self._led: tuple[Mask, Array] | None = None
        self._pressed: tuple[int, float, Array] | None = None

    def apply(self, pressure: Array) -> Array:
        """``a f``, or ``a f + beta c f`` (m)."""
        displacement = self._product(pressure)
        displacement *= self._problem.pair.normal_compliance
        return displacement

    def displaced(
        self, pressure: Array, step: int, support: Mask, slopes: Slopes, displacement: Array
    ) -> tuple[Array, Slopes]:
        """What shear adds to ``displacement = apply(pressure)`` (m), and the slopes that all leave.

        The pressure is that of CG's ``step``, but for a factor; tau is on ``support``; ``slopes`` are the
        last ones.
        """
        problem, operator = self._problem, self._operator
        if not problem.terms.oblique:
            held = self._pulled_by_tau(support) if self.coupled else self._pulled(pressure, support)
            return problem.coupling(operator, held), slopes
        if self.coupled:
            by_pressure = self._by_pressure(pressure, step)
            normal = displacement / problem.pair.normal_compliance - self._ratio * by_pressure
            by_traction = problem.friction.beta * by_pressure + self._by_tau(support)
            lower, upper = problem.parted(normal, by_traction)
        else:
            corrected = problem.terms.slope_correction
            product = None if corrected else displacement / problem.pair.normal_compliance
            traction = self._pulled(pressure, support)
            lower, upper = problem.displacements(operator, pressure, traction, slopes, product=product)
        return lower + upper - displacement, problem.slopes(lower, upper)

    def _by_pressure(self, pressure: Array, step: int) -> Array:
        """The shear product of a pressure, applied once for a step: from then on only the scale changes."""
        total = float(pressure.sum())
        if self._pressed is None or self._pressed[0] != step:
            self._pressed = step, total, self._operator.shear(pressure)
        _, applied, product = self._pressed
        return product if applied in (0.0, total) else (total / applied) * product

    def _by_tau(self, support: Mask) -> Array | float:
        """The shear product of tau alone, applied once for a support."""
        if self._problem.friction.tau == 0:
            return 0.0
        if self._led is None or not np.array_equal(self._led[0], support):
            self._led = support, self._operator.shear(self._pulled_by_tau(support))
        return self._led[1]

    def _pulled(self, pressure: Array, support: Mask) -> Array:
        return local_friction(self._problem.friction, pressure, support)

    def _pulled_by_tau(self, support: Mask) -> Array:
        return self._problem.friction.tau * support.astype(np.float64)
