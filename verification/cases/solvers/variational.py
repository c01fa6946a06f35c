"""Table 2: the paper's scheme and the production solver against general minimisers of the energy.

Kalker and van Randen 1972; Tian and Bhushan 1996, the competitor of Table 2. Without friction and at a
prescribed approach the total complementary energy of the discrete half-space is

    V*(f) = (1/2 f . a f - f . (approach - h)) dA,    f >= 0,

and its minimum is the contact. Only elements of kinematic interference, h < approach, can be loaded: a is
positive, so elsewhere dV*/df > 0 whatever the pressure is. They are the unknowns here.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from scipy.linalg import cholesky, solve_triangular
from scipy.optimize import minimize, nnls

import refimpl as rf
from refimpl.grid import Array, Mask
from refimpl.model.problem import Problem, Terms
from refimpl.operators.fft import FFTInfluence
from refimpl.operators.kernel_tables import unit_table
from refimpl.scene.discretise import discretise
from verification.framework.case import Measured
from verification.framework.registry import case
from verification.framework.verdict import Verdict, judged

SOURCE = "paper Table 2; the principle: Kalker and van Randen 1972, Tian and Bhushan 1996"
M_QUICK = 32
GRADIENT_TOLERANCE = 1e-6  # L-BFGS-B, of the projected gradient: penetration over approach
DENSE_GRIDS, FFT_GRIDS = (48, 64, 80), (48, 64, 80, 100, 128, 256, 512)
SCHEME_ERROR = 3.5e-4  # pressure error over the peak that the paper's tolerances allow its scheme
_STEPS = 20_000  # at most, of L-BFGS-B


def table2_scene() -> rf.Scene:
    """Return Table 2's contact as the paper has it: "a half-space and a sphere with a rough surface".

    Sphere, moduli, load and side are those of Table 1, the roughness is the only one that the paper gives
    its sphere, 0.084 um; the half-space is smooth, and there is no friction ("static contact").
    """
    roughness = rf.GaussianRoughness(rms=0.084e-6, correlation_length=104e-6, seed=1)
    return rf.Scene(
        upper=rf.Body(rf.Material(E=200e9, nu=0.30), rf.Sphere(radius=0.14) + roughness),
        lower=rf.Body(rf.Material(E=118e9, nu=0.30), rf.Flat()),
        friction=rf.Friction(),
        load=70.0,
        side=1.61e-3,
    )


@dataclass(frozen=True, eq=False)
class Energy:
    """V* in units of its own: lengths in approaches, pressures in ``approach / (compliance spacing)``.

    ``problem`` has a prescribed ``approach`` (m) and no friction. Unknowns ``x``, shape ``(n,)``, are the
    pressures on ``interference``, row by row; then ``V* = 1/2 x.Ax - x.depth`` with ``A`` of unit elements.
    """

    problem: Problem
    approach: float

    @classmethod
    def on(cls, M: int, approach: float) -> Energy:
        """Return the energy of Table 2's scene on ``M x M`` elements at an approach (m)."""
        scene = table2_scene()
        terms = Terms(coupled=False, oblique=False)
        return cls(discretise(scene, scene.grid(M), terms, approach), approach)

    @cached_property
    def interference(self) -> Mask:
        """The elements that may be loaded, ``(M, M)``: Table 2's initial contact points."""
        return self.problem.gap < self.approach

    @cached_property
    def depth(self) -> Array:
        """``(approach - h) / approach`` on the interference, ``(n,)``."""
        depth: Array = 1 - self.problem.gap[self.interference] / self.approach
        return depth

    @cached_property
    def operator(self) -> FFTInfluence:
        """The product by FFT, which counts its work."""
        return FFTInfluence(self.problem.grid, self.problem.direction)

    def matrix(self) -> Array:
        """Return ``I[1/rho]`` of unit elements between all pairs of unknowns, ``(n, n)``."""
        table = unit_table("normal", self.problem.grid.shape)
        i, j = np.nonzero(self.interference)
        pairs = np.empty((len(i), len(i)))
        for k in range(len(i)):
            pairs[k] = table[np.abs(i - i[k]), np.abs(j - j[k])]
        return pairs

    def apply(self, x: Array) -> Array:
        """Return ``A x`` by FFT, ``(n,)``."""
        displacement: Array = self.operator.normal(self._spread(x))[self.interference]
        return displacement / self.problem.grid.element_size

    def pressure(self, x: Array) -> Array:
        """Return the pressures on the whole grid, ``(M, M)`` (Pa)."""
        unit = self.approach / (self.problem.pair.normal_compliance * self.problem.grid.element_size)
        return unit * self._spread(x)

    def _spread(self, x: Array) -> Array:
        whole = np.zeros(self.problem.gap.shape)
        whole[self.interference] = x
        return whole


def least_squares(energy: Energy) -> Array:
    """Minimise V* by active sets (Lawson and Hanson 1974), ``A = L L^T``; RuntimeError if unending."""
    factor = cholesky(energy.matrix(), lower=True, overwrite_a=True, check_finite=False)
    right = solve_triangular(factor, energy.depth, lower=True, check_finite=False)
    x: Array = nnls(factor.T, right, maxiter=10 * len(right))[0]
    return x


def quasi_newton(energy: Energy) -> Array:
    """Minimise V* by L-BFGS-B (Byrd, Lu, Nocedal and Zhu 1995); RuntimeError where the gradient stays."""

    def value_and_gradient(x: Array) -> tuple[float, Array]:
        displacement = energy.apply(x)
        return 0.5 * float(x @ displacement) - float(x @ energy.depth), displacement - energy.depth

    depth = energy.depth
    found = minimize(
        value_and_gradient,
        depth * float(depth @ depth) / float(depth @ energy.apply(depth)),
        jac=True,
        method="L-BFGS-B",
        bounds=[(0.0, None)] * len(depth),
        options={"gtol": GRADIENT_TOLERANCE, "ftol": 0.0, "maxiter": _STEPS, "maxfun": 2 * _STEPS},
    )
    if not found.success:
        raise RuntimeError(f"L-BFGS-B: {found.message}")
    x: Array = found.x
    return x


MINIMISERS: Mapping[str, Callable[[Energy], Array]] = {
    "NNLS": least_squares,
    "L-BFGS-B": quasi_newton,
}


@cache
def reference() -> rf.Solution:
    """Return the dense reference of Table 2's scene: pivoting on Eq. (7), no minimiser."""
    return rf.solve(table2_scene(), grid=M_QUICK, method="dense", oblique=False)


@cache
def minimum(name: str) -> Array:
    """Return the pressure (Pa) of one minimiser at the reference's approach."""
    energy = Energy.on(M_QUICK, reference().approach)
    return energy.pressure(MINIMISERS[name](energy))


def departure(name: str) -> Measured:
    """Return the largest difference of a method's pressure from the reference, over the peak."""
    return Measured(float(np.abs(minimum(name) - reference().pressure).max() / reference().max_pressure))


@case("variational/nnls", metric="at_most", tolerance=2e-12, source=SOURCE)
def nnls_agrees() -> Measured:
    """Least squares over positive pressures give the contact.

    Claim: Non-negative least squares on the Cholesky factor of [a] returns the dense reference's pressure
    Tolerance: rounding of a Cholesky factor: n eps cond(a) = 492 * 1.1e-16 * 37 = 2e-12 of the peak; measured
    6e-15
    """
    return departure("NNLS")


@case("variational/quasi-newton", metric="at_most", tolerance=1.2e-5, source=SOURCE)
def quasi_newton_agrees() -> Measured:
    """A bound-constrained quasi-Newton method gives the contact.

    Claim: L-BFGS-B with products by FFT returns the dense reference's pressure
    Tolerance: it stops at a penetration of 1e-6 of the approach; over [a]'s least eigenvalue, 1.83, and the
    peak, 0.049 (both in units of the problem), that is 1.1e-5 of the peak; measured 2.6e-6
    """
    return departure("L-BFGS-B")


@case("variational/same-contact", metric="equal", tolerance=0.0, source=SOURCE)
def one_contact() -> Measured:
    """All minimisers find one contact.

    Claim: NNLS, L-BFGS-B, the paper's scheme, FFT and dense solvers load the same elements
    Tolerance: the solution is unique (a is positive definite), and no element is in doubt at this grid: a set
    has no tolerance
    """
    loaded = reference().contact
    sets = {name: minimum(name) > 0 for name in MINIMISERS}
    for method in ("fft", "paper"):
        sets[method] = rf.solve(table2_scene(), grid=M_QUICK, method=method, oblique=False).contact
    differing = {name: int(np.count_nonzero(found != loaded)) for name, found in sets.items()}
    return Measured(max(differing.values()), 0.0, unit="elements", data=differing)


@dataclass(frozen=True, eq=False)
class Contact:
    """Table 2's scene on one grid with its certified approach (m) and pressure, for every method."""

    M: int
    approach: float
    pressure: Array

    @classmethod
    def on(cls, M: int) -> Contact:
        """Solve to 1e-12, which also fills the kernels' tables that all methods share."""
        solution = rf.solve(table2_scene(), grid=M, oblique=False, tolerance=1e-12)
        if not solution.certificate.satisfies(1e-10):
            raise RuntimeError(f"no reference at M = {M}: {solution.certificate}")
        return cls(M, solution.approach, solution.pressure)

    def solve(self, method: str) -> tuple[Array, float]:
        """Return the pressure (Pa) of a method at the approach, and its transformed points n log2 n."""
        if method in MINIMISERS:
            energy = Energy.on(self.M, self.approach)
            pressure = energy.pressure(MINIMISERS[method](energy))
            return pressure, energy.operator.counter.point_logs
        solution = rf.solve(
            table2_scene(),
            grid=self.M,
            method="paper" if method == "paper" else "fft",
            oblique=False,
            approach=self.approach,
        )
        return solution.pressure, solution.cost.point_logs


@case("variational/transform-work", metric="at_most", tolerance=1.0)
def transform_work() -> Measured:
    """With products by FFT, a general minimiser needs no more work than the paper's scheme.

    Claim: Transformed points n log2 n of L-BFGS-B over those of the paper's scheme, for the same contact
    Source: {SOURCE}; the paper credits its scheme with the advantage
    Tolerance: the statement itself: no more work; counts do not depend on the machine. Measured 0.4
    """
    contact = Contact.on(64)
    work = {method: contact.solve(method)[1] for method in ("paper", "L-BFGS-B", "production")}
    share = work["L-BFGS-B"] / work["paper"]
    sentence = (
        f"L-BFGS-B on the energy, with products by FFT, does {share:.2f} of the scheme's transform work. "
        "What costs no less than Table 2's rival did is a solver with the matrix (table2-rerun): the FFT is "
        "the advantage, and a variational method may have it too"
    )
    return judged(Verdict.CONDITIONAL, sentence, share, data={f"n log2 n: {k}": v for k, v in work.items()})


def timed(contact: Contact, method: str) -> tuple[Array, float]:
    """Return a method's pressure (Pa) and processor seconds: the mean of what fills a fifth of a second."""
    start, calls = time.process_time(), 0
    while calls == 0 or time.process_time() - start < 0.2:
        pressure, _ = contact.solve(method)
        calls += 1
    return pressure, (time.process_time() - start) / calls


@cache
def table2() -> dict[str, dict[int, float]]:
    """Return processor seconds by method and grid: the least of two turns, for other work only adds.

    Methods take turns on every grid, so that a slow spell of the machine meets all of them. Methods with the
    matrix end at `DENSE_GRIDS`. A fast wrong answer raises RuntimeError.
    """
    seconds: dict[str, dict[int, float]] = {name: {} for name in ("paper", "production", *MINIMISERS)}
    for M in FFT_GRIDS:
        contact = Contact.on(M)
        methods = seconds if M in DENSE_GRIDS else ("paper", "production", "L-BFGS-B")
        for method in (*methods, *methods):
            if seconds[method].get(M, 0.0) > 2.0:  # one turn of what takes long
                continue
            pressure, took = timed(contact, method)
            seconds[method][M] = min(took, seconds[method].get(M, took))
            error = float(np.abs(pressure - contact.pressure).max() / contact.pressure.max())
            if error > SCHEME_ERROR:
                raise RuntimeError(f"{method} on {M} x {M}: off by {error:.1e} of the peak")
    return seconds


@case("variational/table2-rerun", metric="at_least", tolerance=13.3, tier="full")
def table2_rerun() -> Measured:
    """Table 2's ratio, measured here and now.

    Claim: Processor time of a general solver with matrix (NNLS) over the paper's scheme's; printed: 13 to 14
    Source: paper Table 2
    Tolerance: the lower of the printed ratios, 96 h / 7.21 h. Ours grows with the grid and depends on machine
    and BLAS; on 64 x 64 it is several times that, so that a busy machine does not decide
    """
    found = table2()
    return Measured(found["NNLS"][64] / found["paper"][64])


@case("variational/table2-growth", metric="at_least", tolerance=1.0, tier="full")
def table2_growth() -> Measured:
    """Growth of computing time with the number of elements.

    Claim: The time of a solver with matrix (NNLS) grows faster with the elements than that of the scheme
    Source: paper Table 2; operation counts
    Tolerance: difference of exponents in the number of elements n: a factorisation takes n^3, products by FFT
    n log n times some sqrt(n) iterations, a difference of 1.5; the active set of the least grids takes 0.5 of
    that
    """
    data: dict[str, object] = {}
    for name, by_grid in table2().items():
        data |= {f"{name}: M": list(by_grid), f"{name}: s": list(by_grid.values())}
        data[f"{name}: exponent"] = growth(by_grid)
    return Measured(growth(table2()["NNLS"]) - growth(table2()["paper"]), data=data)


def growth(seconds: Mapping[int, float]) -> float:
    """Return the exponent of a cost in the number of elements ``M^2``, fitted to all grids.

    >>> round(growth({10: 3.0, 20: 48.0, 40: 768.0}), 12)
    2.0
    """
    return float(np.polyfit(2 * np.log(list(seconds)), np.log(list(seconds.values())), 1)[0])
