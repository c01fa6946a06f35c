"""The codes that take part: each peer's adapter, and this project's solver without and with coupling.

A plus in a name stands for more than the recommended set-up: coupling for ours, options for a peer. Ours is
timed from a scene to a solution with its error bars, and once more alone, from a gap to a pressure, as peers.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial

import numpy as np

import refimpl as rf
from refimpl.driver.options import Options
from refimpl.grid import Array
from refimpl.model.friction import is_frictionless
from refimpl.model.problem import Terms
from refimpl.operators.fft import Counter
from refimpl.scene.discretise import discretise
from refimpl.solvers.production.nested_solver import solve_fft
from verification.adapters import aspher, contactmechanics, tamaas
from verification.adapters.published_code import PublishedCode
from verification.benchmarks.problems import FRICTION, problem, scene
from verification.output.provenance import DISTRIBUTION, versions

OWN = "refimpl"
ALONE = f"{OWN}-solver"
SHEARED, SLOPED = f"{OWN}+friction", f"{OWN}+friction+slopes"
SETTINGS = {OWN: (rf.Friction(), False), SHEARED: (FRICTION, False), SLOPED: (FRICTION, True)}
PUBLISHED = {
    "tamaas": tamaas.solve,
    "ContactMechanics": contactmechanics.solve,
    "aspher": aspher.solve,
    "aspher+options": aspher.fastest,
}


@dataclass(frozen=True, eq=False)
class Pressed:
    """Result of a code.

    pressure : ``(M, M)`` (Pa)
    converged : whether the code says so; for ours, the contact edge may alternate under tau
    operations : its own counts
    residual : the certificate's worst residual; only with coupling, where the frictionless judge cannot say
    """

    pressure: Array
    converged: bool
    operations: Mapping[str, float] = field(default_factory=dict)
    residual: float | None = None


@dataclass(frozen=True)
class Code:
    """One competitor. `ready` makes what is to be timed from a problem's kind, its M and a tolerance."""

    name: str
    version: str | None
    ready: Callable[[str, int, float], Callable[[], Pressed]]


def _published(code: PublishedCode, kind: str, M: int, tolerance: float) -> Callable[[], Pressed]:
    posed = problem(kind, M, tolerance)

    def press() -> Pressed:
        answer = code(posed)
        return Pressed(np.asarray(answer.pressure), bool(answer.converged), answer.operations)

    return press


def own(friction: rf.Friction, oblique: bool, kind: str, M: int, tolerance: float) -> Callable[[], Pressed]:
    """Return our solve of a kind of contact, from a scene to a solution with its error bars."""
    posed = scene(kind, M, friction)

    def press() -> Pressed:
        found = rf.solve(posed, grid=M, oblique=oblique, tolerance=tolerance)
        work = {f"{name} products": float(n) for name, n in found.cost.applications.items()}
        coupled = None if is_frictionless(friction) and not oblique else found.certificate.largest
        work["n log2 n"] = found.cost.point_logs
        _ = found.uncertainty, found.warnings  # computed when read
        return Pressed(found.pressure, found.converged, work, coupled)

    return press


def alone(friction: rf.Friction, oblique: bool, kind: str, M: int, tolerance: float) -> Callable[[], Pressed]:
    """Return the solver of the same contact, from a gap to a certified pressure."""
    whole = scene(kind, M, friction)
    plan = Options(scene=whole, grid=M, requested=Terms(oblique=oblique)).plan()
    posed = discretise(whole, plan.grid, plan.switches)

    def press() -> Pressed:
        counter = Counter()
        state = solve_fft(posed, tolerance, counter)
        work = {f"{name} products": float(n) for name, n in counter.tally.items()}
        converged = state.status in (rf.Status.CONVERGED, rf.Status.CYCLED)
        return Pressed(state.pressure, converged, work | {"n log2 n": counter.point_logs})

    return press


def codes() -> dict[str, Code]:
    """Return all codes by name; the version is None where a peer is not installed."""
    version = f"{OWN} {versions()[DISTRIBUTION]}"
    found = {name: Code(name, version, partial(own, *setting)) for name, setting in SETTINGS.items()}
    found[ALONE] = Code(ALONE, version, partial(alone, *SETTINGS[OWN]))
    for name, code in PUBLISHED.items():
        found[name] = Code(name, code.version if code.installed else None, partial(_published, code))
    return found
