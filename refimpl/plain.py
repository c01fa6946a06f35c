"""The whole model in one file: friction between two rough elastic half-spaces, by dense matrices and numpy.

Source: Karpenko and Akay (2001), Eqs (1) to (8). It imports nothing of this project. One value an element;
heights point upwards, displacements into the bodies; s is along the sliding, t 90 degrees anticlockwise:

h = z_upper - z_lower                    gap; zero at first contact
r = q + beta f                           shear by the pressure f; q = tau on the active set, else 0     (1, 8)
u_b = (1 - nu^2)/(pi E) J f +- (1 + nu)(1 - 2 nu)/(2 pi E) J_s r     + lower, - upper body                 (7)
u = u_lower + u_upper                    J = I[1/rho], J_s = I[s/rho^2]: integrals over an element
z = (z_lower - u_lower + z_upper + u_upper - delta -+ w_p)/2         common surface; - if the lower yields
tan theta_x, tan theta_y = dz/ds, dz/dt  K = cos theta_x cos theta_y
v = u/K + h                              v >= delta where f = 0, v = delta where 0 < f < H                 (6)
w_p = (delta - v) K                      plastic indentation where f = H; v <= delta there
N = sum (f cos theta_x - r sin theta_x) cos theta_y dA               = P by the approach delta          (2, 5)
F = sum (f sin theta_x + r cos theta_x) cos theta_y dA               mu = F/P                           (3, 4)
Q = sum (f cos theta_x - r sin theta_x) sin theta_y dA
facets: u by the tractions f - r tan theta_x (down), r + f tan theta_x (along s), f tan theta_y (along t)

The active set of tau. 1. Gradual state: q = tau (1 - (v - delta)/reach), between 0 and tau. The reach is
twice what tau moves around an element, 4 tau sqrt(dA) max(|c|, a/100), with the pair's factors a of J, c of
J_s. This state does not depend on the path to it. 2. The active set is the contact of the gradual state.
Solve with it; elements that are not in contact leave it; solve again, until none leaves. 3. Elements in
contact may be left without tau. If all pressures exceed 1.4 times what closes the gap by tau on those, each
alone (2 a sqrt(dA)), and theirs 1/50 of the reach over that, or if most are left without: solve with tau on
all of the contact. If that is the contact again, this is the state.
"""

from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

OPEN, PARTIAL, CONTACT, PLASTIC = range(4)  # f = 0 = q; f = 0 < q < tau; 0 < f < H; f = H
ROUNDING = 1e-13  # relative, of pressures and displacements against their limits; slopes: 10 times that
Array = NDArray[Any]


def integrals(shape: Any, spacing: Any, direction: float, periodic: bool) -> list[Array]:
    """Return J, J_s, J_t (m): matrices with a row for each field point, a column for each loaded element."""
    if periodic:  # Fourier transforms of 1/rho, x/rho^2, y/rho^2; a mean pressure moves nothing
        waves = [2 * np.pi * np.fft.fftfreq(m, d) for m, d in zip(shape, spacing, strict=True)]
        kx, ky = np.meshgrid(*waves, indexing="ij")
        k = np.where((kx == 0) & (ky == 0), np.inf, np.hypot(kx, ky))
        tables = [np.fft.ifft2(2 * np.pi * s).real for s in (1 / k, -1j * kx / k**2, -1j * ky / k**2)]
    else:  # closed forms at the corners X, Y of the element (Love 1929; Johnson 1985)
        x, y = (np.r_[0:m, 1 - m : 0] * d for m, d in zip(shape, spacing, strict=True))
        tables = [np.zeros((x.size, y.size)) for _ in range(3)]
        for right, up in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
            X, Y = x[:, None] + right * spacing[0] / 2, y[None, :] + up * spacing[1] / 2
            log = np.log((X**2 + Y**2) / (spacing[0] * spacing[1])) / 2
            tables[0] += right * up * (X * np.arcsinh(Y / abs(X)) + Y * np.arcsinh(X / abs(Y)))
            tables[1] += right * up * (Y * log + X * np.arctan(Y / X))
            tables[2] += right * up * (X * log + Y * np.arctan(X / Y))
    i, j = (np.subtract.outer(np.arange(m), np.arange(m)) for m in shape)  # negative: from a table's end
    i, j, n = i[:, None, :, None], j[None, :, None, :], shape[0] * shape[1]
    J, Jx, Jy = (table[i, j].reshape(n, n) for table in tables)
    cos, sin = np.cos(direction), np.sin(direction)
    return [J, cos * Jx + sin * Jy, cos * Jy - sin * Jx]


class Model(SimpleNamespace):
    """Matrices of a problem, and its state: f, q, delta, slopes, the part of each element, steps left."""

    def __init__(self, **arguments: Any) -> None:
        super().__init__(ended="converged", **arguments)  # arguments of `solve`
        self.shape = self.z_lower.shape
        self.spacing = self.lengths[0] / self.shape[0], self.lengths[1] / self.shape[1]
        self.dA = self.spacing[0] * self.spacing[1]
        gap = (self.z_upper - self.z_lower).ravel()
        self.h = gap - gap.min()
        self.datum = self.h.mean() if self.periodic else 0.0  # approach 0: mean planes, or first contact
        self.J, self.Js, self.Jt = integrals(self.shape, self.spacing, self.direction, self.periodic)
        self.a_of = [(1 - nu**2) / (np.pi * E) for E, nu in (self.lower, self.upper)]
        self.c_of = [(1 + nu) * (1 - 2 * nu) / (2 * np.pi * E) for E, nu in (self.lower, self.upper)]
        self.a, self.c = sum(self.a_of), self.c_of[0] - self.c_of[1]
        self.reach = 4 * self.tau * self.dA**0.5 * max(abs(self.c), self.a / 100)
        self.delta = np.inf if self.approach is None else self.approach + self.datum
        self.part = np.where(self.h < self.delta, CONTACT, OPEN)
        self.f, self.q, self.left = *np.zeros((2, gap.size)), iter(range(150 + 50000 // gap.size))
        self.set_slopes(np.zeros((2, gap.size)))
        self.set_slopes(self.deformed_slopes() if self.slopes else self.tan)

    def set_slopes(self, tan: Array) -> None:
        x, y = np.arctan(tan)
        self.tan, self.in_u = tan, tan if self.facets else 0 * tan  # the tangents that enter u
        self.cos_x, self.sin_x, self.cos_y, self.sin_y = np.cos(x), np.sin(x), np.cos(y), np.sin(y)
        self.K = self.cos_x * self.cos_y

    def displacements(self) -> Any:
        r = self.q + self.beta * self.f
        pressed = self.J @ (self.f - r * self.in_u[0])
        sheared = self.Js @ (r + self.f * self.in_u[0]) + self.Jt @ (self.f * self.in_u[1])
        (a_lower, a_upper), (c_lower, c_upper) = self.a_of, self.c_of
        return [a_lower * pressed + c_lower * sheared, a_upper * pressed - c_upper * sheared]

    def v(self) -> Any:
        return sum(self.displacements()) / self.K + self.h

    def forces(self) -> Any:
        r = np.where(self.part >= CONTACT, self.q + self.beta * self.f, 0.0)
        down, along = self.f * self.cos_x - r * self.sin_x, self.f * self.sin_x + r * self.cos_x
        return [(x * self.dA).sum() for x in (down * self.cos_y, along * self.cos_y, down * self.sin_y)]

    def deformed_slopes(self) -> Array:
        u_lower, u_upper = self.displacements()
        z = (self.z_lower.ravel() - u_lower + self.z_upper.ravel() + u_upper) / 2
        if self.softer is not None:
            w_p = np.where(self.part == PLASTIC, (self.delta - self.v()) * self.K, 0.0)
            z += w_p / 2 if self.softer == "upper" else -w_p / 2
        odd: Any = {} if self.periodic else {"reflect_type": "odd"}  # one-sided differences at the border
        z = np.pad(z.reshape(self.shape), 1, mode="wrap" if self.periodic else "reflect", **odd)
        x = ((z[2:, 1:-1] - z[:-2, 1:-1]) / (2 * self.spacing[0])).ravel()
        y = ((z[1:-1, 2:] - z[1:-1, :-2]) / (2 * self.spacing[1])).ravel()
        along = (x + 1j * y) * np.exp(-1j * self.direction)  # turned into the frame of the sliding
        return np.array([along.real, along.imag])

    def free_one(self) -> None:
        """Free the element next to change, to balance the load; where H balances it, delta in the middle."""
        v, plastic, excess = self.v(), self.part == PLASTIC, self.forces()[0] - self.load
        if abs(excess) > ROUNDING * self.load:
            self.part[np.where(plastic == (excess > 0), v if excess > 0 else -v, -np.inf).argmax()] = CONTACT
        else:
            self.delta = (v[plastic].max() + (v if plastic.all() else v[~plastic]).min()) / 2

    def solve_parts(self, active: Array | None) -> None:
        """Solve for f in CONTACT, q in PARTIAL, and delta under a load; every element keeps its part."""
        for _ in range(2):  # the second time with the freed element
            contact, partial = self.part == CONTACT, self.part == PARTIAL
            self.f = np.where(self.part == PLASTIC, self.hardness, 0.0)
            self.q = self.tau * (self.part >= CONTACT if active is None else active)
            if self.load is not None and not contact.any():
                self.free_one()
        s, (tan_x, tan_y), unit = np.flatnonzero(contact | partial), self.in_u, self.a * self.dA**0.5
        down = np.where(contact, 1 - self.beta * tan_x, -tan_x)[s]
        along, across = np.where(contact, self.beta + tan_x, 1.0)[s], np.where(contact, tan_y, 0.0)[s]
        right = (self.K * (partial * self.reach - self.h) - sum(self.displacements()))[s]
        J, Js, Jt = (table[np.ix_(s, s)] for table in (self.J, self.Js, self.Jt))
        matrix = self.a * J * down + self.c * (Js * along + Jt * across)
        matrix[np.diag_indices(s.size)] += (partial * self.K * self.reach / (self.tau or 1.0))[s]
        if self.load is None or not contact.any():
            x = np.linalg.solve(matrix / unit, (right + self.K[s] * self.delta) / unit)
        else:  # the last row is Eq. (2), the last unknown delta; ``unit`` scales both to the others
            row = (contact * (self.cos_x - self.beta * self.sin_x) * self.cos_y)[s] / s.size
            missing = (self.load - self.forces()[0]) / (self.dA * s.size)
            bordered = np.block([[matrix / unit, -self.K[s, None]], [row, np.zeros(1)]])
            x, (delta,) = np.split(np.linalg.solve(bordered, np.append(right / unit, missing)), [s.size])
            self.delta = delta * unit
        self.f[contact], self.q[partial] = x[contact[s]], x[partial[s]]

    def exchange(self, active: Array | None) -> str:
        """Exchange parts until all inequalities hold; where all at once cycle, the first (Murty 1974)."""
        fewest, patience = self.h.size + 1, 10
        for _, _ in zip(range(50 + 5 * self.h.size), self.left, strict=False):  # at most 15 such
            self.solve_parts(active)
            part, v = self.part, self.v()
            terms = abs(v - self.h) + abs(self.a * self.J @ self.f)  # pressure and shear may cancel
            clearance, near, small = v - self.delta, *(ROUNDING * abs(x).max() for x in (terms, self.f))
            limit = self.reach + np.where(part == PARTIAL, near, -near) if active is None else -np.inf
            beside = np.where(clearance < limit, PARTIAL, OPEN)
            new = np.where(part < CONTACT, np.where(clearance < -near, CONTACT, beside), part)
            new[(part == PLASTIC) & (clearance > near)] = CONTACT
            new[(part == CONTACT) & (self.f > self.hardness + small)] = PLASTIC
            new = np.where((part == CONTACT) & (self.f < -small), beside, new)
            changed = np.flatnonzero(new != part)
            if changed.size == 0:
                return "converged"
            fewest, patience = (changed.size, 10) if changed.size < fewest else (fewest, patience - 1)
            self.part = new if patience >= 0 else np.where(np.arange(part.size) == changed[0], new, part)
        return "contact did not settle"

    def settle(self, active: Array | None) -> None:
        """Solve for pressures and slopes by turns until noise is left, slopes mixed of 6 (Anderson 1965)."""
        slopes, changes = list[Array](), list[Array]()
        for _ in range(300 if self.slopes else 1):
            self.ended = self.exchange(active)
            new = self.deformed_slopes() if self.slopes else self.tan
            slopes, changes = [*slopes[-5:], new.ravel()], [*changes[-5:], (new - self.tan).ravel()]
            noise = np.finfo(float).eps * self.a * (abs(self.J) @ self.f).max() / min(self.spacing)
            if abs(changes[-1]).max() <= max(10 * ROUNDING * abs(new).max(), noise):
                return
            if len(changes) > 1:
                mix = np.linalg.lstsq(np.diff(changes, axis=0).T, changes[-1], rcond=None)[0]
                new = (slopes[-1] - np.diff(slopes, axis=0).T @ mix).reshape(2, -1)
            self.set_slopes(new)
        self.ended = "slopes did not settle"


def solve(
    z_lower: Array, z_upper: Array, lengths: tuple[float, float], lower: tuple[float, float],
    upper: tuple[float, float], tau: float, beta: float, *, load: float | None = None,
    approach: float | None = None, direction: float = 0.0, hardness: float = np.inf,
    softer: str | None = None, periodic: bool = False, slopes: bool = True, facets: bool = False,
) -> SimpleNamespace:
    """Return the solution for heights (m, Mx by My) on a domain of ``lengths`` (m), bodies (E, nu) (Pa, -).

    Given ``load`` (N) or ``approach`` (m; periodic: from the mean planes). ``softer``: the body that yields.
    Returns pressure, traction (Pa), active (mask of tau), approach (m), normal, friction, transverse (N), mu,
    area, plastic_area (m^2), p_max (Pa), tangents, ended ("converged", or what did not settle). Raises
    ValueError for other shapes, more than 64 x 64 elements, a load above the hardness times the domain.
    """
    arguments, shape = dict(locals()), z_lower.shape
    if z_upper.shape != shape or len(shape) != 2 or z_lower.size > 64**2:  # nine arrays of 134 MB
        raise ValueError(f"heights of {shape} and {z_upper.shape}: expected one shape, 64 x 64 at most")
    if (load is None) == (approach is None) or (load or 0) > hardness * lengths[0] * lengths[1]:
        raise ValueError(f"load = {load}, approach = {approach}: expected one, load <= hardness * domain")
    model, active = Model(**arguments), np.ones(z_lower.size, dtype=bool)
    touch = bool((model.part == CONTACT).any())
    if touch and tau > 0:
        model.exchange(~active)  # a start near the gradual state: without tau, undeformed slopes
        model.settle(None)
        active = model.part >= CONTACT
        model.part[~active] = OPEN
    while touch:
        model.settle(active)
        before, active = active, active & (model.part >= CONTACT)
        if (active == before).all():
            break
    contact, state = model.part >= CONTACT, vars(model) | {"part": model.part.copy()}
    spared = contact & ~active
    lifting = np.maximum(1.4 * model.c * (model.Js @ (tau * spared)), spared * model.reach / 50)
    stays = (2 * model.a * model.dA**0.5 * model.f > lifting)[contact].all()
    if touch and tau > 0 and spared.any() and (stays or 2 * spared.sum() > contact.sum()):
        model.settle(contact)
        if model.ended == "converged" and (contact == (model.part >= CONTACT)).all():
            active = contact
        else:
            vars(model).update(state)
    model.f, model.q = np.where(contact, np.maximum(model.f, 0.0), 0.0), tau * active * contact
    N, F, Q = model.forces()
    arrays = {"pressure": model.f, "traction": model.q + beta * model.f, "active": active & contact}
    return SimpleNamespace(
        **{name: array.reshape(shape) for name, array in arrays.items()},
        approach=model.delta - model.datum, normal=N, friction=F, transverse=Q,
        mu=F / (load or N) if N else np.nan, p_max=model.f.max(), area=contact.sum() * model.dA,
        plastic_area=(model.part == PLASTIC).sum() * model.dA,
        tangents=model.tan.reshape(2, *shape), ended=model.ended,
    )
