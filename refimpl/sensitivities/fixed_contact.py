"""The contact problem on a contact set that stays as it is: a smooth system, and its answer to a change.

Unknown are the pressures on the set, but for elements at the hardness, and the approach,
``x = (f, delta)``; the equations are Eq. (6) with equality on the set, written ``u + K (h - delta) = 0`` with
``K = cos theta_x cos theta_y``, and ``N = P``. Cosines, shear and load all follow from ``x``, so one residual
holds the whole model; its Jacobian is applied by a difference quotient and inverted by GMRES (Knoll and Keyes
2004), which starts from the inverse of what is left without friction and slopes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy

from refimpl.errors import NotConverged
from refimpl.grid import Array, Mask
from refimpl.model.certificate import approach_from
from refimpl.model.forces import Forces, resultants
from refimpl.model.problem import Problem
from refimpl.model.slopes import Slopes
from refimpl.operators.influence import window_influence
from refimpl.operators.preconditioner import ExtendedPreconditioner, SpectralPreconditioner
from refimpl.scene.discretise import discretise
from refimpl.scene.parameters import with_parameter
from refimpl.scene.scene import Scene
from refimpl.sensitivities.difference_quotients import both_sides

_MARGIN = 2  # elements around the contact: its slopes are central differences
_STEP = 1e-4  # step of the quotient, in peak pressures: the error is slopes^2, that of rounding 1e-12
_TOLERANCE = 1e-6  # relative residual of GMRES: a thousandth of the accuracy of a derivative
_RESTART, _CYCLES = 80, 5
_FACETS = 4  # times: each leaves a hundredth of what slopes still change by (at 5 degrees; see the tests)
_PARAMETER_STEP = 1e-4  # relative, of parameters: smooth at a fixed set, so the quotient errs by 1e-8
_TIED = 1e-6  # share of p_max within which pressures tie: symmetric scenes, apart from slopes
_SOLVED = 1e-3  # relative residual of a linear solve, at most: the digits of a derivative
_WIDTHS = 5, 9  # elements over which the change at an edge is compared with that inside


class LinearResponse(NamedTuple):
    """Answer of pressures (window's shape, Pa) and approach (m) to a unit of change; GMRES's residual."""

    pressure: Array
    approach: float
    residual: float


class FixedContact:
    """A solved state's contact set and its active set of tau, on the window of the grid that holds them."""

    def __init__(self, problem: Problem, pressure: Array, active: Mask, slopes: Slopes) -> None:
        self.window = problem.grid.window_around(pressure > 0, margin=_MARGIN)
        cut = self.window.slices
        self.pressure, self.active = pressure[cut], active[cut]
        self.contact = self.pressure > 0
        self.capped: Mask = self.pressure >= problem.cap
        self.free: Mask = self.contact & ~self.capped
        self.peak = float(self.pressure.max())
        self.operator = window_influence(problem.grid, problem.direction, self.window)
        self.problem = problem.windowed(self.window)
        self._slopes = Slopes(slopes.tan_x[cut], slopes.tan_y[cut])
        traction = problem.friction.traction(self.pressure, self.active)
        u = np.add(*self.problem.displacements(self.operator, self.pressure, traction, self._slopes))
        v = self._slopes.per_cosine_product(u) + self.problem.gap
        self.approach = approach_from(self.pressure, v, problem.cap)
        self._base = self.residual(self.problem, self.pressure, self.approach)

    def forces(self, problem: Problem, pressure: Array, approach: float) -> Forces:
        """Return N, F and Q of a state on the set (N)."""
        return self._state(problem, pressure, approach)[2]

    def residual(self, problem: Problem, pressure: Array, approach: float) -> Array:
        """Return the misfit of Eq. (6) over the base approach, then that of the load over the load."""
        u, K, forces = self._state(problem, pressure, approach)
        misfit = (u + K * (problem.gap - approach))[self.free] / self.approach
        return np.append(misfit, forces.normal / (problem.load or forces.normal) - 1)

    def response(self, change: Array) -> LinearResponse:
        """Solve ``J dx = -change``, the change being a derivative of the residual."""
        if not change.any():  # the modulus of a body that is as good as rigid
            return LinearResponse(*self._unpacked(change), 0.0)
        size = len(change)
        jacobian, plain = (
            scipy.sparse.linalg.LinearOperator((size, size), matvec=product, dtype=np.float64)
            for product in (self.jacobian, self.plain_inverse)
        )
        x, _ = scipy.sparse.linalg.gmres(
            jacobian, -change, rtol=_TOLERANCE, restart=_RESTART, maxiter=_CYCLES, M=plain
        )
        with np.errstate(invalid="ignore"):  # nan where the change is not finite: no derivative is found
            left = float(np.linalg.norm(jacobian @ x + change) / np.linalg.norm(change))
        return LinearResponse(*self._unpacked(x), left)

    def jacobian(self, x: Array) -> Array:
        """Return ``J x`` by a difference quotient; x in base peaks, then base approaches."""
        x = np.ravel(x)
        scale = _STEP / max(float(np.abs(x).max()), np.finfo(float).tiny)
        pressure, approach = self._unpacked(scale * x)
        moved = self.residual(self.problem, self.pressure + pressure, self.approach + approach)
        return np.asarray((moved - self._base) / scale)

    def plain_inverse(self, x: Array) -> Array:
        """Return ``y`` with ``J y`` about ``x``, by the system of flat surfaces without friction.

        It is ``a f - delta = misfit`` under ``sum f dA = load``, with a preconditioner for the inverse of a.
        """
        x = np.ravel(x)
        load = self.problem.load or float(self.pressure.sum()) * self.problem.grid.element_area
        misfit = np.zeros(self.free.shape)
        misfit[self.free] = self.approach * x[:-1]
        pressure, lifted = self._precondition(misfit)[self.free], self._lifted
        approach = (load * x[-1] / self.problem.grid.element_area - pressure.sum()) / lifted.sum()
        return np.append((pressure + approach * lifted) / self.peak, approach / self.approach)

    @cached_property
    def _precondition(self) -> ExtendedPreconditioner:
        spectral = SpectralPreconditioner(self.operator, self.problem.elasticity.symbol(self.operator.symbol))
        return ExtendedPreconditioner(spectral, self.free)

    @cached_property
    def _lifted(self) -> Array:
        """Pressures on the set for an approach of one, about (Pa/m)."""
        return self._precondition(self.free.astype(np.float64))[self.free]

    def _unpacked(self, x: Array) -> tuple[Array, float]:
        """Return the pressures on the window and approach of a vector in peaks and base approaches."""
        pressure = np.zeros(self.free.shape)
        pressure[self.free] = self.peak * x[:-1]
        return pressure, self.approach * float(x[-1])

    def _state(self, problem: Problem, pressure: Array, approach: float) -> tuple[Array, Array, Forces]:
        """Return displacement u (m), product of cosines and forces, slopes repeated for facets and yield."""
        if self.capped.any():
            pressure = np.where(self.capped, problem.cap, pressure)
        traction, slopes = problem.friction.traction(pressure, self.active), self._slopes
        repeated = problem.terms.slope_correction or bool(self.capped.any())
        for _ in range(_FACETS if repeated else 1):
            lower, upper = problem.displacements(self.operator, pressure, traction, slopes)
            yielded = problem.indentation(pressure, lower + upper, slopes.cosine_product, approach)
            slopes = problem.slopes(lower, upper, yielded)
        forces = resultants(pressure, traction, slopes, problem.grid.element_area)
        return lower + upper, slopes.cosine_product, forces


@dataclass(frozen=True, eq=False)
class Answer:
    """Derivatives at the fixed set: pressures (window's shape), their peak, F, Q and the approach.

    Of peaks that tie the middle one counts, as for a central difference; ``torn`` is how far others are off.
    """

    pressure: Array
    peak: float
    torn: float
    friction: float
    binormal: float
    approach: float
    residual: float


def fixed_answer(
    scene: Scene, base: Problem, fixed: FixedContact, name: str, value: float, excess: float
) -> Answer:
    """Return the answer to a parameter; friction without tau on the mean ``excess`` (m^2)."""
    (low, below), (high, above) = both_sides(
        name,
        value,
        _PARAMETER_STEP,
        lambda at: _changed(scene, base, with_parameter(scene, name, at)).windowed(fixed.window),
    )
    span = high - low
    residuals = [fixed.residual(problem, fixed.pressure, fixed.approach) for problem in (below, above)]
    found = fixed.response((residuals[1] - residuals[0]) / span)
    if not found.residual <= _SOLVED:
        raise NotConverged(f"the derivative over {name} is not found: {found.residual:.1e} is left of it")
    before, after = (
        fixed.forces(
            problem,
            fixed.pressure + (at - value) * found.pressure,
            fixed.approach + (at - value) * found.approach,
        )
        for problem, at in ((below, low), (above, high))
    )
    pressure = found.pressure
    if fixed.capped.any():
        pressure = np.where(fixed.capped, (above.cap - below.cap) / span, pressure)
    tied = pressure[fixed.pressure >= (1 - _TIED) * fixed.peak]
    return Answer(
        pressure=pressure,
        peak=0.5 * float(tied.max() + tied.min()),
        torn=0.5 * float(np.ptp(tied)),
        friction=(after.friction - before.friction - (above.friction.jump - below.friction.jump) * excess)
        / span,
        binormal=(after.binormal - before.binormal) / span,
        approach=found.approach,
        residual=found.residual,
    )


def _changed(scene: Scene, base: Problem, changed: Scene) -> Problem:
    """Return the changed scene's problem; surfaces are sampled again only where they changed."""
    if changed.upper.surface is scene.upper.surface and changed.lower.surface is scene.lower.surface:
        elasticity = replace(base.elasticity, pair=changed.materials)
        return replace(base, elasticity=elasticity, friction=changed.friction, load=changed.load)
    return discretise(changed, base.grid, base.terms)


class EdgeMotion:
    """Motion of the contact's edge, calibrated by the load: the area's derivative from a pressure's.

    Pressure falls off as ``k sqrt(d)`` at a distance d from an edge, so an edge that moves by V changes it by
    ``k V / (2 sqrt d)``. The relative change of the outermost elements, ``df / f = V / (2 d)``, beyond that
    of the elements inside, measures V up to one factor, which a change whose area is known gives.
    """

    def __init__(self, fixed: FixedContact, over_load: tuple[float, float], loaded: Array) -> None:
        self.fixed = fixed
        wrapped = np.pad(fixed.contact, 1, mode=fixed.problem.grid.continuation)
        self.elements = (wrapped & ~scipy.ndimage.binary_erosion(wrapped, border_value=1))[1:-1, 1:-1]
        derivative, counted = over_load
        self.everywhere = np.ones(fixed.contact.shape)
        self.factors = [
            derivative / growth if (growth := self._growth(loaded, size)) else 0.0 for size in _WIDTHS
        ]
        self.counted = counted / abs(derivative) if derivative else 0.0

    def derivative(self, pressure: Array) -> tuple[float, float]:
        """Return ``dA/dp`` (m^2 a unit) and its scatter for a derivative of the pressures."""
        near, far = (
            factor * self._growth(pressure, size) for factor, size in zip(self.factors, _WIDTHS, strict=True)
        )
        return near, math.hypot(self.counted * near, near - far)

    def _growth(self, pressure: Array, size: int) -> float:
        """Sum the relative change along the edge, less that of all ``size x size`` elements around."""
        mode = self.fixed.problem.grid.continuation

        def ratio(where: Array, width: int) -> Array:
            change, level = (
                scipy.ndimage.uniform_filter(where * field, width, mode=mode)[self.elements]
                for field in (pressure, self.fixed.pressure)
            )
            return np.asarray(change / level)

        return float(np.sum(ratio(self.elements.astype(np.float64), 3) - ratio(self.everywhere, size)))
