"""A solution at a prompt: one line, a short table, and HTML with a small map."""

from __future__ import annotations

import math
from html import escape

import numpy as np

from refimpl.accuracy.digits import bar_of, digits_of, verdict
from refimpl.grid import Array
from refimpl.solution.model_warning import Notice
from refimpl.solution.quantities import QUANTITIES
from refimpl.solution.record import Record
from refimpl.solution.units import printed_unit

_CELLS = 32  # cells along the longer side of the map
_INK = "#0072B2"  # Okabe and Ito 2008


def line(solution: Record) -> str:
    """Return one line: status, grid, corrected mu and A with their errors."""
    mu, area = (
        " ".join(shown(solution, name))
        for name in ("friction_coefficient_corrected", "contact_area_corrected")
    )
    return f"<Solution {solution.status.value}, {solution.grid}: mu = {mu}, A = {area}>"


def table(solution: Record) -> str:
    """Return the numbers with their errors, the warnings and the notes."""
    rows = _rows(solution)
    width, number = (max(len(row[k]) for row in rows) for k in (0, 1))
    head = f"status {solution.status.value}, {solution.grid} elements, method {solution.plan.method}"
    body = [f"  {name:{width}}  {value:{number}}  {unit}".rstrip() for name, value, unit in rows]
    return "\n".join([head, *body, *(f"{_kind(text)}: {text}" for text in solution.warnings)])


def _kind(text: str) -> str:
    return "note" if isinstance(text, Notice) else "warning"


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


def shown(solution: Record, name: str) -> list[str]:
    """Return a number, its bar, "(not usable)" and its unit, each where there is one."""
    number, unit = number_and_unit(solution, name)
    return [*number, unit] if unit else number


def number_and_unit(solution: Record, name: str) -> tuple[list[str], str]:
    """Return a number with its bar and "(not usable)", where there are such, and the unit at its scale."""
    value, error = getattr(solution, name), solution.error(name)
    unit = printed_unit(value, QUANTITIES[name].unit)
    error = None if error is None else error / unit.size
    texts = digits_of(value / unit.size, error), bar_of(error), verdict_on(solution, name)
    return [text for text in texts if text], unit.name


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


def rows(solution: Record, table: str) -> list[tuple[str, list[str], str]]:
    """Return name, number and unit of each number of a table; plastic ones where anything is."""
    return [
        (quantity.label, *number_and_unit(solution, name))
        for name, quantity in QUANTITIES.items()
        if table in quantity.tables and (solution.plastic_area or not name.startswith("plastic"))
    ]


def _rows(solution: Record) -> list[tuple[str, str, str]]:
    return [(name, " ".join(number), unit) for name, number, unit in rows(solution, "prompt")]


def _map(solution: Record) -> str:
    """Return the squares shaded by the pressure's maximum in each, x to the right and y up."""
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
    """Return the maximum pressure in each cell of at most `_CELLS` along the longer side."""
    step = max(1, math.ceil(max(pressure.shape) / _CELLS))
    rest = [(0, -count % step) for count in pressure.shape]
    padded = np.pad(pressure, rest)
    i, j = (count // step for count in padded.shape)
    coarse: Array = padded.reshape(i, step, j, step).max(axis=(1, 3))
    return coarse
