"""The uncertainty budget of a solve as a table and as JSON."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from refimpl.accuracy.digits import bar_of, digits_of
from refimpl.solution.quantities import QUANTITIES
from refimpl.solution.units import printed_unit
from verification.output.text_table import columns, wrapped

if TYPE_CHECKING:
    from refimpl.sensitivities.budget import Budget, Budgets


def document(budgets: Budgets) -> dict[str, object]:
    """Return SI units, half-widths of 95 %; infinite where unbounded, for the caller to make null."""
    return {
        "tolerances": dict(budgets.tolerances),
        "numbers": {number: _parts(part) for number, part in budgets.numbers.items()},
        "derivatives": {name: dict(row) for name, row in budgets.derivatives.derivatives.items()},
        "contact_stiffness": budgets.derivatives.contact_stiffness,
        "derivatives_scatter": {name: dict(row) for name, row in budgets.derivatives.scatter.items()},
    }


def table(budgets: Budgets) -> str:
    """Return each number's parts in per cent of it, all of them, and the changes for one of a parameter."""
    header = ["", *(QUANTITIES[number].symbol for number in budgets.numbers)]
    numbers = list(budgets.numbers.values())
    widths: dict[str, list[float | None]] = {
        "numerical": [part.numerical for part in numbers],
        "input": [part.input for part in numbers],
        **{
            f"  {name}, {tolerance:.2g}": [part.inputs[name] for part in numbers]
            for name, tolerance in budgets.tolerances.items()
        },
        "sampling": [part.sampling for part in numbers],
        "model form": [part.model_form for part in numbers],
        **{f"  {source}": [part.sources[source] for part in numbers] for source in numbers[0].sources},
        "total": [part.total for part in numbers],
    }
    rows = [[name, *map(_share, numbers, of_name)] for name, of_name in widths.items()]
    changes = [
        [name, *(_relative(budgets, number, name) for number in budgets.numbers)]
        for name in budgets.derivatives.parameters
    ]
    return (
        "uncertainty budget of mu and A (both corrected), p_max and Q (95 %, in per cent of each):\n"
        f"{columns([header, *rows])}\n{_in_words(budgets)}\n\n"
        f"change in per cent for one per cent of a parameter:\n{columns([header, *changes])}\n"
        f"contact stiffness dN/d(approach): {budgets.derivatives.contact_stiffness:.4g} N/m"
    )


def _in_words(budgets: Budgets) -> str:
    """Return each number with its total in its unit, what that leaves out, and what it does not know."""
    found = []
    for number, part in budgets.numbers.items():
        quantity = QUANTITIES[number]
        unit = printed_unit(part.value, quantity.unit)
        value, total = part.value / unit.size, part.total / unit.size
        found.append(f"{quantity.symbol} = {digits_of(value, total)} {bar_of(total)} {unit.name}".rstrip())
    lines = [wrapped(", ".join(found), "with all parts: ")]
    if all(part.sampling is None for part in budgets.numbers.values()):
        lines.append("sampling is of means over realisations: other specimens are not in this total (sweep)")
    if names := _undetermined(budgets):
        lines.append(
            wrapped(f"{', '.join(names)}: one realisation does not tell (sweep)", "not determined: ")
        )
    return "\n".join(lines)


def _undetermined(budgets: Budgets) -> list[str]:
    """Return toleranced parameters of derivatives unknown in sign that would count for mu."""
    number = "friction_coefficient_corrected"
    derivative, scatter = budgets.derivatives.derivatives[number], budgets.derivatives.scatter[number]
    least = 0.1 * budgets.numbers[number].input
    return [
        name
        for name, tolerance in budgets.tolerances.items()
        if scatter[name] >= abs(derivative[name])
        and scatter[name] * abs(budgets.derivatives.parameters[name]) * tolerance > least
    ]


def _parts(part: Budget) -> dict[str, object]:
    names = ("value", "numerical", "input", "inputs", "sampling", "model_form", "total")
    return {name: getattr(part, name) for name in names} | {"model_form_sources": part.sources}


def _share(part: Budget, width: float | None) -> str:
    """Return a half-width in per cent of the number; "-" for none stated or a number of zero."""
    if width is None or part.value == 0:
        return "-"
    return f"{100 * width / abs(part.value):.2g}" if math.isfinite(width) else "unbounded"


def _relative(budgets: Budgets, number: str, name: str) -> str:
    found, answers = budgets.derivatives.found[number], budgets.derivatives
    if found == 0:
        return "-"
    change = answers.relative(number, name)
    scatter = abs(answers.scatter[number][name] * answers.parameters[name] / found)
    return f"{change:+.3f}" + (f" +-{scatter:.2g}" if scatter >= max(0.1 * abs(change), 0.001) else "")
