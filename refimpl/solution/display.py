"""A solution at a prompt: one line, a short table, and HTML with a small map."""

from __future__ import annotations

import math
from html import escape

import numpy as np

from refimpl.accuracy.digits import bar_of, digits_of, verdict
from refimpl.grid import Array
from refimpl.solution.record import Record

# attribute of Solution, name in the table, factor from SI to the unit shown, that unit
SHOWN = (
    ("friction_coefficient_corrected", "friction coefficient mu", 1.0, ""),
    ("friction_coefficient", "  summed over elements", 1.0, ""),
    ("contact_area", "contact area A", 1e6, "mm^2"),
    ("contact_area_share", "A/A0", 1.0, ""),
    ("plastic_area", "plastic area", 1e6, "mm^2"),
    ("max_pressure", "maximum pressure p_max", 1e-6, "MPa"),
    ("mean_pressure", "mean contact pressure", 1e-6, "MPa"),
    ("mean_gap", "mean gap", 1e6, "um"),
    ("approach", "approach", 1e6, "um"),
    ("normal_force", "normal force N", 1.0, "N"),
    ("friction_force_corrected", "friction force F", 1.0, "N"),
    ("binormal_force", "binormal force Q", 1.0, "N"),
)
_CELLS = 32  # cells along the longer side of the map
_INK = "#0072B2"  # Okabe and Ito 2008


def line(solution: Record) -> str:
    """Return one line: status, grid, mu with its error, A."""
    mu = " ".join(shown(solution, "friction_coefficient_corrected"))
    area = " ".join(shown(solution, "contact_area", 1e6))
    return f"<Solution {solution.status.value}, {solution.grid}: mu = {mu}, A = {area} mm^2>"


def table(solution: Record) -> str:
    """Return the numbers with their errors, and the warnings."""
    rows = _rows(solution)
    width, number = (max(len(row[k]) for row in rows) for k in (0, 1))
    head = f"status {solution.status.value}, {solution.grid} elements, method {solution.plan.method}"
    body = [f"  {name:{width}}  {value:{number}}  {unit}".rstrip() for name, value, unit in rows]
    return "\n".join([head, *body, *(f"warning: {text}" for text in solution.warnings)])


def html(solution: Record) -> str:
    """Return the short table with a map of pressure: an image made of squares, without any library."""
    rows = "".join(
        f"<tr><td>{escape(name)}</td><td>{escape(value)}</td><td>{escape(unit)}</td></tr>"
        for name, value, unit in _rows(solution)
    )
    notes = "".join(f"<li>{escape(text)}</li>" for text in solution.warnings)
    head = f"status {escape(solution.status.value)}, {escape(str(solution.grid))} elements"
    return (
        f"<div><p>{head}</p><div style='display:flex;gap:1em'><table>{rows}</table>{_map(solution)}</div>"
        + (f"<ul>{notes}</ul>" if notes else "")
        + "</div>"
    )


def shown(solution: Record, name: str, factor: float = 1.0) -> list[str]:
    """Return a number, its bar and "(not usable)", each where there is one; ``factor``: SI to the unit."""
    error = solution.error(name) * factor
    texts = digits_of(getattr(solution, name) * factor, error), bar_of(error), verdict_on(solution, name)
    return [text for text in texts if text]


def verdict_on(solution: Record, name: str) -> str:
    """Return "(not usable)" for a bar above half of the number's magnitude, nothing otherwise.

    Symmetry may make Q zero: its magnitude is that of the tangential force, F and Q together. Without
    friction that of F and Q is N, and that of mu is 1.
    """
    value = getattr(solution, name)
    if not math.isfinite(value):  # without contact
        return ""
    scale = {"binormal_force": math.hypot(solution.friction_force, solution.binormal_force)}
    if name.startswith(("friction", "binormal")) and not solution.traction.any():  # frictionless
        scale = dict.fromkeys(("friction_force_corrected", "binormal_force"), solution.normal_force)
        scale |= dict.fromkeys(("friction_coefficient_corrected", "friction_coefficient"), 1.0)
    return verdict(solution.error(name), scale.get(name, value))


def _rows(solution: Record) -> list[tuple[str, str, str]]:
    left = set() if solution.plastic_area else {"plastic_area"}
    return [
        (name, " ".join(shown(solution, attribute, factor)), unit)
        for attribute, name, factor, unit in SHOWN
        if attribute not in left
    ]


def _map(solution: Record) -> str:
    """Squares shaded by the pressure's maximum in each, x to the right and y up."""
    coarse = _coarse(solution.pressure)
    top = coarse.max()
    columns, rows = coarse.shape
    squares = "".join(
        f"<rect x='{i}' y='{rows - 1 - j}' width='1' height='1' fill='{_INK}' "
        f"fill-opacity='{0.2 + 0.8 * coarse[i, j] / top:.2f}'/>"
        for i in range(columns)
        for j in range(rows)
        if coarse[i, j] > 0
    )
    wide = 160 * columns / max(coarse.shape)
    return (
        f"<svg width='{wide:.0f}' viewBox='0 0 {columns} {rows}' role='img'><title>pressure</title>"
        f"<rect width='{columns}' height='{rows}' fill='none' stroke='black' stroke-width='0.2'/>"
        f"{squares}</svg>"
    )


def _coarse(pressure: Array) -> Array:
    """Maximum pressure in each cell of at most `_CELLS` along the longer side."""
    step = max(1, math.ceil(max(pressure.shape) / _CELLS))
    rest = [(0, -count % step) for count in pressure.shape]
    padded = np.pad(pressure, rest)
    i, j = (count // step for count in padded.shape)
    coarse: Array = padded.reshape(i, step, j, step).max(axis=(1, 3))
    return coarse
