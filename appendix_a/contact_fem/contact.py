"""Sliding contact of two bodies known by their surface compliance: active set inside, geometry outside.

With the deformed geometry held, nodal forces are affine in the pressures and the gap is affine in the nodal
displacements: a linear complementarity problem, f >= 0, g >= 0, f g = 0 for the mortar's weighted gap g,
solved by a primal-dual active set.  Friction r = tau + beta f acts on the lower surface along its deformed
tangent and makes the matrix unsymmetric; tau acts between the contact's ends (`ends`), which are found with
sub-element accuracy, so that its support moves smoothly and cannot cycle.  Geometry, the directions of forces
and the ends are then brought up to date until nothing moves.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from appendix_a.contact_fem.bodies import Surface
from appendix_a.contact_fem.ends import contact_ends
from appendix_a.contact_fem.interface import Interface, Sampled, locate
from appendix_a.fem.body import lagrange

Array = NDArray[np.float64]
TOLERANCE = 1e-10  # largest change of a pressure between updates, over the peak: far below any mesh error
UPDATES = 100
# tau's ends stay where their estimate moves by less than HOLD of the shortest edge for every PATIENCE updates
# begun: on coarse meshes an end node that comes and goes would otherwise cycle
HOLD, PATIENCE = 0.5, 10
CHANGES = 200  # limit of changes of the active set; a few tens occur


class NotConverged(RuntimeError):
    """The contact loop ended above its tolerance, or contact left the zone that was meshed for it."""


@dataclass(frozen=True)
class Friction:
    """Local friction r = tau + beta f; `coupling` Dundurs' constant of the pair, for the ends' exponents."""

    tau: float = 0.0
    beta: float = 0.0
    coupling: float = 0.0

    def ends(self, x: Array, pressure: Array) -> tuple[float, float]:
        """Return the ends of the contact of these nodal pressures."""
        return contact_ends(x, pressure, self.coupling * self.beta)


FRICTIONLESS = Friction()


@dataclass(frozen=True, eq=False)
class Contact:
    """A solved contact, per unit thickness.

    `approach` counts from first contact (mean planes' relative displacement); `normal` and `friction` are the
    resultants across and along the mean plane; `ends` are the contact's deformed abscissae, `material_ends`
    those in the undeformed lower and upper surface; `x` and `pressure` the pressure's nodes;
    `penetration` the most negative weighted gap per length, `updates` how often the geometry was updated.
    """

    approach: float
    normal: float
    friction: float
    ends: tuple[float, float]
    material_ends: tuple[tuple[float, float], tuple[float, float]]
    x: Array
    pressure: Array
    penetration: float
    updates: int

    @property
    def length(self) -> float:
        """Contact length, projected onto the mean plane."""
        return self.ends[1] - self.ends[0]

    @property
    def friction_coefficient(self) -> float:
        """F / N."""
        return self.friction / self.normal


@dataclass(frozen=True, eq=False)
class _State:
    pressure: Array
    lower_u: Array
    upper_u: Array
    approach: float
    ends: tuple[float, float] | None


def press(
    lower: Surface, upper: Surface, distance: float, load: float, friction: Friction = FRICTIONLESS
) -> Contact:
    """Solve as the upper body slides along +x under `load` per wavelength and unit thickness.

    lower, upper: surfaces about their mean planes, which are `distance` apart at first contact.
    Raises NotConverged.
    """
    raised = replace(upper, at=upper.at + np.array([[0.0], [distance]]))
    unloaded = np.zeros(lower.edges.shape[1] + 1)
    state = _State(unloaded, np.zeros(lower.at.size), np.zeros(upper.at.size), 0.0, None)
    for update in range(1, UPDATES + 1):
        new = _updated(_posed(lower, raised, state), state, load, friction, HOLD * (1 + update // PATIENCE))
        change = float(np.abs(new.pressure - state.pressure).max() / new.pressure.max())
        state = new
        if change <= TOLERANCE:
            return _gathered(_posed(lower, raised, state), state, friction, update)
    raise NotConverged(f"pressures still change by {change:.1e} of the peak after {UPDATES} updates")


def _posed(lower: Surface, upper: Surface, state: _State) -> Interface:
    down = np.array([[0.0], [state.approach]])
    return Interface(
        lower, upper, lower.at + state.lower_u.reshape(2, -1), upper.at + state.upper_u.reshape(2, -1) - down
    )


def _tau_forces(interface: Interface, state: _State, tau: float) -> tuple[Array, Array]:
    """Return the nodal forces of tau between the contact's ends."""
    if tau == 0.0 or state.ends is None:
        return np.zeros(len(state.lower_u)), np.zeros(len(state.upper_u))
    sampled = interface.at(interface.edges_within(state.ends))
    ones = np.full((len(sampled.dx), 1), tau)
    on_lower, on_upper = sampled.forces(np.zeros_like(ones), ones)
    return on_lower[:, 0], on_upper[:, 0]


def _updated(interface: Interface, state: _State, load: float, friction: Friction, hold: float) -> _State:
    """Return pressures, displacements and approach for `state`'s geometry; `hold` in shortest edges."""
    sampled = interface.at(interface.whole())
    hats = sampled.hats.toarray()
    on_lower, on_upper = sampled.forces(hats, friction.beta * hats)
    tau_lower, tau_upper = _tau_forces(interface, state, friction.tau)
    respond_lower = interface.lower.compliance @ on_lower
    respond_upper = interface.upper.compliance @ on_upper
    rest_lower = interface.lower.compliance @ tau_lower
    rest_upper = interface.upper.compliance @ tau_upper
    by_lower, by_upper = sampled.gap_change()
    gap, width = sampled.weighted_gap()
    matrix = by_lower @ respond_lower + by_upper @ respond_upper
    gap = gap + by_lower @ (rest_lower - state.lower_u) + by_upper @ (rest_upper - state.upper_u)
    half = interface.lower.at.shape[1]
    weights = -on_lower[half:].sum(axis=0)
    needed = load + float(tau_lower[half:].sum())
    start = state.pressure > 0 if np.any(state.pressure > 0) else np.ones(len(gap), dtype=bool)
    pressure, sink = complementary(matrix, gap, width, weights, needed, start)
    x = interface.lower_at[0][interface.vertices]
    return _State(
        pressure,
        respond_lower @ pressure + rest_lower,
        respond_upper @ pressure + rest_upper,
        state.approach + sink,
        _settled(friction.ends(x, pressure), state.ends, hold * float(np.diff(x).min())),
    )


def _settled(
    ends: tuple[float, float], before: tuple[float, float] | None, slack: float
) -> tuple[float, float]:
    """Return the ends between which tau acts: as before if moved by less than `slack`, against cycles."""
    if before is None or max(abs(a - b) for a, b in zip(ends, before, strict=True)) > slack:
        return ends
    return before


def complementary(
    matrix: Array, gap: Array, width: Array, weights: Array, load: float, active: NDArray[np.bool_]
) -> tuple[Array, float]:
    """Solve f >= 0, g = gap + matrix f - sink width >= 0, f g = 0, weights f = load; return (f, sink)."""
    for _ in range(CHANGES):
        at = np.flatnonzero(active)
        system = np.block([[matrix[np.ix_(at, at)], -width[at, None]], [weights[None, at], np.zeros((1, 1))]])
        solution = np.linalg.solve(system, np.append(-gap[at], load))
        pressure = np.zeros(len(gap))
        pressure[at], sink = solution[:-1], float(solution[-1])
        left = gap + matrix @ pressure - sink * width
        new = np.where(active, pressure > 0, left < 0)
        if np.array_equal(new, active):
            return pressure, sink
        active = new
    raise NotConverged(f"the active set still changes after {CHANGES} changes")


def _gathered(interface: Interface, state: _State, friction: Friction, updates: int) -> Contact:
    """Return the resultants and residuals from the converged pressure and geometry."""
    sampled: Sampled = interface.at(interface.whole())
    f = (sampled.hats @ state.pressure)[:, None]
    on_lower, _ = sampled.forces(f, friction.beta * f)
    total = on_lower[:, 0] + _tau_forces(interface, state, friction.tau)[0]
    half = interface.lower.at.shape[1]
    gap, width = sampled.weighted_gap()
    x = interface.lower_at[0][interface.vertices]
    ends = friction.ends(x, state.pressure)
    if state.pressure[:3].any() or state.pressure[-3:].any():
        raise NotConverged("contact reaches the end of the zone that was meshed for it")
    return Contact(
        approach=state.approach,
        normal=-float(total[half:].sum()),
        friction=float(total[:half].sum()),
        ends=ends,
        material_ends=(
            _undeformed(interface.lower, interface.lower_at, ends),
            _undeformed(interface.upper, interface.upper_at, ends),
        ),
        x=x,
        pressure=state.pressure,
        penetration=max(0.0, -float((gap / width).min())),
        updates=updates,
    )


def _undeformed(surface: Surface, deformed: Array, ends: tuple[float, float]) -> tuple[float, float]:
    """Return the undeformed abscissae of the points that deformation has taken to `ends`."""
    edge, t = locate(deformed[0][surface.edges], np.array(ends))
    shape, _ = lagrange(2, t)
    left, right = np.sum(shape * surface.at[0][surface.edges[:, edge]], axis=0)
    return float(left), float(right)
