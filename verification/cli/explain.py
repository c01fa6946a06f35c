"""`rough-friction solve --explain`: what a scene requires, printed without solving it."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING

from refimpl.surfaces.gaussian import DECAY
from verification.cli.output import columns

if TYPE_CHECKING:
    from refimpl.planning.plan import Plan
    from refimpl.planning.resolution import Resolution
    from refimpl.planning.terms import Term


def explained(plan: Plan, scene: str) -> str:
    """The plan as a table of at most 100 columns, and the contact that is expected."""
    asked = f"accuracy asked for: {plan.demand:.2g}; terms left out may add up to {plan.budget:.2g}"
    rows = [["term", "", "change of mu", "of A", "why"], *(_row(term) for term in plan.terms)]
    size = "refined" if plan.decided_on != plan.M else f"{plan.M} x {plan.M} elements"
    return "\n\n".join(
        (
            f"{scene}: {size}, method {plan.method}; nothing is solved\n{asked}",
            columns(rows),
            "changes are relative, and expected not to be exceeded in 19 of 20 scenes",
            columns(_expectations(plan)),
        )
    )


def document(plan: Plan, scene: str) -> dict[str, object]:
    """The same for JSON, SI units."""
    return {
        "scene": scene,
        "method": plan.method,
        "grid": None if plan.decided_on != plan.M else plan.M,
        "decided_on": plan.decided_on,
        "demand": plan.demand,
        "budget": plan.budget,
        "terms": [asdict(term) for term in plan.terms],
        "expected": asdict(plan.outlook),
        "resolution": None if plan.resolution is None else asdict(plan.resolution),
        "memory": plan.memory,
    }


def _row(term: Term) -> list[str]:
    effect = term.effect
    return [
        term.name,
        "in" if term.included else "out",
        _size(effect.friction),
        _size(effect.area),
        term.reason,
    ]


def _resolved(resolution: Resolution, M: int) -> str:
    asked = f"{resolution.asked:.3g} asked for by the accuracy"
    if M == 1:  # the grid is still to be found
        return asked
    found = resolution.elements
    return f"{found:.3g}: rms slopes are seen {DECAY / found**2:.1e} too small"


def _size(change: float) -> str:
    return f"{change:.1e}" if change else "0"


def _expectations(plan: Plan) -> list[list[str]]:
    outlook = plan.outlook
    M, window = plan.decided_on, outlook.window
    rows = [
        ["contact", f"{outlook.elements / M**2:.2%} of the domain, {outlook.elements} of {M} x {M} elements"],
        ["mean pressure", f"{outlook.mean_pressure / 1e6:.4g} MPa"],
        ["approach", f"{outlook.approach * 1e6:.4g} um"],
        ["window of possible contact", f"{window[0]} x {window[1]} elements (gap below twice the approach)"],
        ["mirror symmetry", "yes: no binormal force" if outlook.mirrored else "none"],
        ["half-turn symmetry", "yes: effects of odd order vanish" if outlook.symmetric else "none"],
    ]
    if plan.resolution is not None:
        rows.append(["elements per correlation length", _resolved(plan.resolution, plan.M)])
    return [*rows, ["memory", f"{plan.memory / 1e6:.3g} MB"]] if plan.decided_on == plan.M else rows
