"""The numbers of a solve as a table and as a document, with their error bars and warnings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from verification.output.text_table import columns, wrapped

if TYPE_CHECKING:
    from refimpl import Solution

# Advice after an end that is no success.
NEXT = {
    "STAGNATED": "not converged: a residual below stays above the tolerance; check units first "
    "(load, E, tau, lengths), then try a looser --tolerance or a coarser --grid",
    "ITERATION_LIMIT": "not converged within the limits of iterations: a looser --tolerance or --accuracy",
    "ACCURACY_NOT_REACHED": "the certificate holds, the accuracy was not reached: a larger --accuracy, or "
    "more of --max-grid, --max-seconds, --max-memory",
    "NO_CONTACT": "nothing touches: prescribe a larger --approach, or leave it out to press with the load",
}

_RESIDUALS = {"gap": "complementarity gap", "law_violations": "law violations, elements"}


def show_finished(interrupt: KeyboardInterrupt, scene: str) -> None:
    """Show the table of the last finished grid: the `Solution` that is the interrupt's argument, if any."""
    from refimpl import Solution
    from verification.cli.output import show

    finished = [item for item in interrupt.args if isinstance(item, Solution)]
    if finished:
        show(f"interrupted; the last finished grid:\n\n{table(finished[0], scene)}")


def document(solution: Solution, scene: str) -> dict[str, object]:
    """Return the JSON of a solve: SI units, names of `refimpl.Solution`; arrays are for the VTK file."""
    from verification.output.provenance import provenance

    found = {"scene": scene, **solution.summary()}
    return found | {"not_usable": not_usable(solution), "provenance": provenance()}


def table(solution: Solution, scene: str, waited: float | None = None) -> str:
    """Return the numbers, how well they converged, the terms not modelled, the warnings, and the notes.

    ``waited`` : seconds with reading, bars and warnings; by default those of the solves alone
    """
    from refimpl.solution.display import rows

    seconds = solution.cost.seconds if waited is None else waited
    numbers = [
        [name, value, " ".join(rest), unit] for name, (value, *rest), unit in rows(solution, "command")
    ]
    summary = solution.summary()
    warnings = summary["warnings"]
    certificate = [
        [_RESIDUALS.get(name, name.replace("_", " ")), f"{value:.2g}"]
        for name, value in summary["certificate"].items()
    ]
    not_modelled = [
        [term["term"], term["reason"], _change(term["effect"])]
        for term in summary["plan"]
        if not term["included"]
    ]
    parts = [
        f"{scene}: {solution.grid} elements, method {summary['method']}, {seconds:.2f} s\n"
        + wrapped(NEXT.get(solution.status.name, ""), f"status: {solution.status.name}  "),
        columns(numbers),
        f"certificate, each residual within {summary['tolerance']:g} (0 is exact):\n{columns(certificate)}",
        f"not modelled:\n{columns(not_modelled)}" if not_modelled else "",
        *(wrapped(w["text"], f"warning ({w['name']}): ") for w in warnings if w["limit"] is not None),
        "\n".join(wrapped(w["text"], "note: ") for w in warnings if w["limit"] is None),
    ]
    return "\n\n".join(part for part in parts if part)


def not_usable(solution: Solution) -> list[str]:
    """Return the names of the numbers in the table whose bar exceeds half of their magnitude."""
    from refimpl.solution.display import verdict_on
    from refimpl.solution.quantities import QUANTITIES

    shown = [name for name, quantity in QUANTITIES.items() if "command" in quantity.tables]
    elastic = not solution.plan.includes("plastic")
    return [n for n in shown if not (elastic and n.startswith("plastic")) and verdict_on(solution, n)]


def _change(effect: Mapping[str, float]) -> str:
    """Return the effect of neglecting a term, in words; nothing where it is exactly zero."""
    if not any(effect.values()):
        return ""
    return f"changes mu by about {100 * effect['friction']:.2g} %, A by {100 * effect['area']:.2g} %"
