"""Share of finite strain in the half-space's error: an elastic wave under a rigid plane, neo-Hookean.

The same mesh, active set and loads serve linear elasticity and a compressible neo-Hookean body with
``W = mu/2 (tr F'F - 2 - 2 ln J) + lambda/2 (ln J)^2`` (Bonet and Wood 2008, section 6.4.3), so that what both
discretisations share cancels. Plane strain, lengths in wavelengths, E = 1, no friction.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.sparse import csc_matrix, csr_matrix
from scipy.sparse.linalg import spsolve
from skfem import Basis, BilinearForm, ElementTriP1, ElementVector, LinearForm, MeshTri, asm
from skfem.helpers import ddot, grad, trace

from appendix_a.contact_fem.bodies import MeshPlan, wave_height
from appendix_a.contact_fem.scene import WAVENUMBER
from appendix_a.fem.elasticity import lame
from refimpl.grid import Array
from verification.exact.westergaard import Wave

DEPTH = 1.5
PLAN = MeshPlan(64, 0.45, 1, depth=DEPTH)
TOLERANCE = 1e-10  # largest change of a displacement over the amplitude, between Newton steps
STEPS = 60


@dataclass(frozen=True)
class _Material:
    """Stress and its derivative at a displacement gradient (2, 2, ...); ``finite``: neo-Hookean."""

    nu: float
    finite: bool

    def stress(self, gradient: Array) -> Array:
        """Return the first Piola-Kirchhoff stress."""
        lam, mu = lame(self.nu)
        unit = _unit(gradient)
        if not self.finite:
            linear: Array = lam * trace(gradient) * unit + mu * (gradient + _turned(gradient))
            return linear
        inverse, J = _inverse(gradient + unit)
        found: Array = mu * (gradient + unit - _turned(inverse)) + lam * np.log(J) * _turned(inverse)
        return found

    def change(self, gradient: Array, d: Array) -> Array:
        """Return the derivative of the stress along ``d``."""
        lam, mu = lame(self.nu)
        if not self.finite:
            return self.stress(d)
        inverse, J = _inverse(gradient + _unit(gradient))
        turned = _turned(inverse)
        moved = np.einsum("ij...,jk...,kl...->il...", turned, _turned(d), turned)
        spread = np.einsum("ij...,ji...->...", inverse, d)
        found: Array = mu * d + (mu - lam * np.log(J)) * moved + lam * spread * turned
        return found

    def uniform(self, mean_pressure: float) -> float:
        """Return the shortening per depth of a laterally held column."""
        lam, mu = lame(self.nu)
        if not self.finite:
            return mean_pressure / (lam + 2 * mu)

        def missing(stretch: float) -> float:
            return mu * (stretch - 1 / stretch) + lam * math.log(stretch) / stretch + mean_pressure

        return float(1 - brentq(missing, 0.3, 1.0))


def _unit(like: Array) -> Array:
    unit: Array = np.eye(2).reshape((2, 2) + (1,) * (like.ndim - 2)) + np.zeros_like(like)
    return unit


def _turned(a: Array) -> Array:
    return np.swapaxes(a, 0, 1)


def _inverse(F: Array) -> tuple[Array, Array]:
    J = F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0]
    return np.array([[F[1, 1], -F[0, 1]], [-F[1, 0], F[0, 0]]]) / J, J


@dataclass(frozen=True, eq=False)
class _Wave:
    """The meshed wave: basis of the displacements, tie of free to all unknowns, surface nodes."""

    basis: Basis
    tie: csr_matrix
    top: NDArray[np.int64]
    x: Array
    z: Array


@lru_cache(maxsize=4)
def _wave(amplitude: float) -> _Wave:
    reference = PLAN.reference()
    xi, eta = reference.p
    x, depth = xi / 2, eta / 2 + (DEPTH - 0.5) * eta**3
    z = -depth + wave_height(x, amplitude) * (1 - depth / DEPTH) ** 3
    mesh = MeshTri(np.array([x, z]), reference.t)
    if np.linalg.det(np.moveaxis(mesh.p[:, mesh.t[1:]] - mesh.p[:, mesh.t[:1]], 2, 0)).min() < 0:
        mesh = MeshTri(mesh.p, mesh.t[[0, 2, 1]])
    basis = Basis(mesh, ElementVector(ElementTriP1()), intorder=2)
    at, ups = basis.nodal_dofs  # (2, nodes): unknowns of u_x and u_z
    count = mesh.p.shape[1]
    left, right = (np.flatnonzero(np.abs(x - side) < 1e-12) for side in (-0.5, 0.5))
    left, right = left[np.argsort(eta[left])], right[np.argsort(eta[right])]
    master = np.arange(count)
    master[right] = left
    held = np.abs(eta - 1) < 1e-12
    free = np.setdiff1d(master, np.flatnonzero(held))
    number = np.full(count, -1)
    number[free] = np.arange(len(free))
    column = number[master]
    rows = np.flatnonzero(column >= 0)
    tie = csr_matrix(
        (
            np.ones(2 * len(rows)),
            (np.concatenate([at[rows], ups[rows]]), np.concatenate([column[rows], len(free) + column[rows]])),
        ),
        shape=(basis.N, 2 * len(free)),
    )
    top = np.flatnonzero((np.abs(eta) < 1e-12) & (column >= 0))
    top = top[master[top] == top]
    return _Wave(basis, tie, len(free) + column[top], x[top], z[top])


def pressed(amplitude: float, nu: float, approach: float, *, finite: bool) -> tuple[float, float]:
    """Return (load per wavelength, approach of the mean plane) of the wave, its base held, the plane
    ``approach`` below first contact. Raises ArithmeticError where Newton's method does not end."""
    wave, body = _wave(amplitude), _Material(nu, finite)

    @BilinearForm
    def tangent(u, v, w):  # type: ignore[no-untyped-def]  # scikit-fem calls it with its own untyped fields
        return ddot(body.change(w["now"].grad, grad(u)), grad(v))

    @LinearForm
    def force(v, w):  # type: ignore[no-untyped-def]  # as above
        return ddot(body.stress(w["now"].grad), grad(v))

    free = np.zeros(wave.tie.shape[1])
    plane = amplitude - approach
    active = wave.z > plane
    for _ in range(STEPS):
        now = wave.basis.interpolate(wave.tie @ free)
        stiffness = csc_matrix(wave.tie.T @ asm(tangent, wave.basis, now=now) @ wave.tie)
        residual = wave.tie.T @ asm(force, wave.basis, now=now)
        fixed = wave.top[active]
        others = np.setdiff1d(np.arange(len(free)), fixed)
        step = np.zeros_like(free)
        step[fixed] = plane - wave.z[active] - free[fixed]
        step[others] = spsolve(
            stiffness[others][:, others], -residual[others] - stiffness[others][:, fixed] @ step[fixed]
        )
        free += step
        reaction = (residual + stiffness @ step)[wave.top]
        pressed_on = np.where(active, reaction < 0, wave.z + free[wave.top] > plane)
        settled = np.array_equal(pressed_on, active)
        active = pressed_on
        if settled and np.abs(step).max() < TOLERANCE * amplitude:
            load = -float(reaction[active].sum())
            return load, approach - DEPTH * body.uniform(load)
    raise ArithmeticError(f"Newton's method did not end within {STEPS} steps")


def approaches(slope_deg: float, nu: float, share: float) -> tuple[float, float]:
    """Return the half-space's relative error of approach by first order, and what finite strain adds.

    At a mean pressure of ``share`` p*: the approaches of the linear and of the neo-Hookean wave count over
    Westergaard's at their own loads, which differ by little, so that the mesh's error cancels.
    """
    amplitude = math.tan(math.radians(slope_deg)) / WAVENUMBER
    modulus = 1 / (1 - nu**2)
    load = share * math.pi * amplitude * modulus
    guess = Wave(load, amplitude, 1.0, modulus).approach + DEPTH * _Material(nu, False).uniform(load)
    linear, finite = (_over_westergaard(amplitude, nu, guess, finite=law) for law in (False, True))
    exact = Wave(load, amplitude, 1.0, modulus)
    # the kernel C (eta(x) + eta(s)) adds C N <eta f> to the energy, and its derivative by N to the approach
    step = 1e-3
    more, less = (_moment(amplitude, modulus, load * (1 + sign * step)) for sign in (1, -1))
    sunk = (1 + nu) * (1 - 2 * nu) * (more * (1 + step) - less * (1 - step)) / (2 * step)
    return sunk / exact.approach, finite - linear


def _moment(amplitude: float, modulus: float, load: float) -> float:
    x = (np.arange(20000) + 0.5) / 20000 - 0.5
    return float(np.mean(wave_height(x, amplitude) * Wave(load, amplitude, 1.0, modulus).pressure(x)))


def _over_westergaard(amplitude: float, nu: float, depth: float, *, finite: bool) -> float:
    load, approach = pressed(amplitude, nu, depth, finite=finite)
    return approach / Wave(load, amplitude, 1.0, 1 / (1 - nu**2)).approach - 1
