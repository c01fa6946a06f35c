"""`rough-friction solve --explain`: what a scene requires, printed instead of solving it.

With an accuracy the two grids that open a refinement are solved: by their bars the last grid is forecast.
"""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import TYPE_CHECKING

from refimpl.half_space.model_form import ALLOWED, expected_error
from refimpl.planning.expected_contact import WITHIN
from refimpl.scene.discretise import discretise
from refimpl.solution.domain_error import resolution
from refimpl.solution.rough_contact import estimates_of
from verification.output.text_table import columns

if TYPE_CHECKING:
    from refimpl.driver.options import Options
    from refimpl.driver.refined import Forecast
    from refimpl.planning.plan import Plan
    from refimpl.planning.terms import Term


def explained(options: Options, plan: Plan, scene: str, expected: Forecast | None = None) -> str:
    """Return the plan as a table of at most 100 columns, the contact that is expected, and the forecast."""
    demand = (
        f"requested relative accuracy: {plan.demand:.2g}; neglected terms may add up to {plan.budget:.2g}"
    )
    rows = [["term", "", "change of mu", "of A", "why"], *(_row(term) for term in plan.terms)]
    size = "refined" if options.grid is None else f"{plan.grid} elements"
    solved = "nothing is solved"
    if expected is not None:
        solved = f"solved are only {' and '.join(map(str, expected.solved))} elements, for the forecast"
    return "\n\n".join(
        (
            f"{scene}: {size}, method {plan.method}; {solved}\n{demand}",
            columns(rows),
            "changes are relative, and expected not to be exceeded in 19 of 20 scenes",
            columns([*_expectations(options, plan), *_forecast(options, expected)]),
        )
    )


def _forecast(options: Options, expected: Forecast | None) -> list[list[str]]:
    if expected is None:
        return []
    what = f"{options.target_quantity} to {options.accuracy:g}"
    if expected.refusal:
        return [["forecast", f"{what} is not to be reached: {expected.refusal}"]]
    took = f"about {expected.seconds:.1g} s, {expected.memory / 1e6:.3g} MB"
    return [["forecast", f"{what} takes {expected.grid} elements, {took}"]]


def document(options: Options, plan: Plan, scene: str, expected: Forecast | None = None) -> dict[str, object]:
    """Return the plan for JSON, in SI units; one number of elements is that along the longer side."""
    resolved = resolution(options.scene, plan.grid, plan.demand)
    forecast: dict[str, object] | None = None
    if expected is not None:
        numbers = {name: getattr(expected, name) for name in ("seconds", "memory", "refusal")}
        solved = [list(grid.shape) for grid in expected.solved]
        forecast = {"grid": list(expected.grid.shape), **numbers, "solved": solved}
    return {
        "scene": scene,
        "method": plan.method,
        "grid": options.grid,
        "decided_on": max(plan.grid.shape),
        "demand": plan.demand,
        "budget": plan.budget,
        "terms": [{**asdict(term), "label": term.label} for term in plan.terms],
        "expected": asdict(plan.contact),
        "theories": [asdict(found) for found in estimates_of(options.scene, plan.grid)],
        "resolution": None if resolved is None else asdict(resolved),
        "memory": plan.memory,
        "forecast": forecast,
    }


def _row(term: Term) -> list[str]:
    sizes = (f"{change:.1e}" if change else "0" for change in (term.effect.friction, term.effect.area))
    return [term.label, "in" if term.included else "out", *sizes, term.reason]


def _expectations(options: Options, plan: Plan) -> list[list[str]]:
    contact, grid, window = plan.contact, plan.grid, plan.contact.window
    share = contact.elements / grid.elements
    rows = [
        ["contact", f"about {share:.2%} of the domain, {contact.elements} of {grid} elements"],
        ["", f"(from at most 64 x 64 heights: within a factor of {WITHIN} on 25 rough scenes)"],
        ["mean pressure", f"{contact.mean_pressure / 1e6:.4g} MPa"],
        ["approach, from first contact", f"{contact.approach * 1e6:.4g} um"],
        ["window of possible contact", f"{window[0]} x {window[1]} elements (gap below twice the approach)"],
        ["mirror symmetry", "yes: no binormal force" if contact.mirrored else "none"],
        ["half-turn symmetry", "yes: effects of odd order vanish" if contact.symmetric else "none"],
    ]
    refined = options.grid is None
    if (resolved := resolution(options.scene, grid, plan.demand)) is not None:
        missing = resolved.detail.curvature**2 / 8 / resolved.elements**2
        seen = f"{resolved.elements:.3g}: rms slopes are seen {missing:.1e} too small"
        if refined:  # the grid is not known yet
            seen = f"{resolved.required:.3g} required by the accuracy"
        rows.append([f"elements per {resolved.detail.name}", seen])
    rows += [
        [f"{found.theory} (elastic)", f"A {found.area * 1e6:.3g} mm^2, {found.mean_pressure / 1e6:.4g} MPa"]
        for found in estimates_of(options.scene, grid)
    ]
    slope, error = expected_error(discretise(options.scene, grid))
    if error > ALLOWED:
        told = f"slopes of {math.degrees(slope):.2g} degrees: N at a given approach may be off by {error:.0%}"
        rows.append(["half-space", told])
    return rows if refined else [*rows, ["memory", f"{plan.memory / 1e6:.3g} MB"]]
