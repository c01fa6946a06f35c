"""Tables of what the paper prints against what is computed: Table 3, Hertz, claims, errata."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from reports.agreement import Number, fine, printed
from reports.claims import CONDITIONAL, UNJUDGED, VERDICTS, Judged, judged
from reports.evidence import Evidence
from reports.exhibit import Column
from reports.result_tables import RUN, link, listing, origin
from reports.results import Case
from reports.text import interval, quoted, symbols, unit_of

COMPARED: dict[str, Column] = {
    "printed": lambda n: f"{n.printed:.4g}",
    "computed": lambda n: interval(n.computed, n.half_width),
    "E (%)": lambda n: f"{100 * n.difference / n.printed:+.1f}",
    "u (%)": lambda n: f"{100 * n.uncertainty / n.printed:.1f}",
    "agrees": lambda n: "yes" if n.within else "no",
}
TABLE_3: dict[str, Column] = {
    "half-space": lambda n: n.label.partition(", ")[0],
    "grid": lambda n: n.label.partition(", ")[2],
    "number": lambda n: n.quantity.partition(",")[0] + (f" ({n.unit})" if n.unit else ""),
    **COMPARED,
}
OTHERS: dict[str, Column] = {
    "part of the paper": lambda n: n.part,
    "quantity": lambda n: n.quantity,
    "which": lambda n: n.label,
    "unit": lambda n: n.unit,
    **COMPARED,
}


def table_3(found: Sequence[Number]) -> str:
    """Show the paper's Table 3, printed and computed, with the difference E and its uncertainty u."""
    labels = list(dict.fromkeys(n.label for n in found if n.part == "Table 3"))
    rows = [n for label in labels for n in found if (n.part, n.label) == ("Table 3", label)]
    finest = fine(found)
    text = (
        "Are the numbers of Table 3 reproduced? "
        f"On its fine mesh, 512², {sum(n.within for n in finest)} of {len(finest)} agree. "
        "A load of 70 N presses the ball of Table 1 on a flat, whose rms roughness is in the first column. "
        "Numbers of rough flats are means over 75 random surfaces. μ and A are summed over elements, as in "
        f"the paper. File: {link('reproduction')}.\n\n"
        "- *E*: computed minus printed number, in per cent of the printed one.\n"
        "- *u*: uncertainty of E (95 %), from random surfaces (ours and the paper's) and from the rounding "
        "of printed numbers and inputs.\n"
        "- *Agrees*: abs(E) is at most u."
    )
    return listing("Table 3 of the paper", text, rows, TABLE_3)


def others(found: Sequence[Number]) -> str:
    """Show the printed numbers outside Table 3, in the same columns."""
    rows = [n for n in found if n.part != "Table 3"]
    text = (
        f"Are the other {len(printed(rows))} printed numbers reproduced? Columns are as above. The paper "
        "prints three scatters without their roughness. Each has three rows here, counts once, and agrees if "
        "one of its rows does. "
        f"Files: {link(RUN)}, {link('reproduction')}."
    )
    return listing("Other numbers of the paper", text, rows, OTHERS)


def _scaled(case: Case, key: str) -> str:
    """Return the value or reference in the printed unit; nothing for cases without a reference."""
    return "" if case["reference"] is None else f"{unit_of(case)[1] * case[key]:.7g}"


HERTZ: dict[str, Column] = {
    "quantity": "title",
    "unit": lambda case: unit_of(case)[0],
    "computed": lambda case: _scaled(case, "value"),
    "exact": lambda case: _scaled(case, "reference"),
    "error": "{error:.1e}",
    "tolerance": "{tolerance:.1e}",
    "status": "status",
}


def hertz(run: Mapping[str, Any]) -> str:
    """Show the smooth ball against Hertz' solution."""
    text = (
        "Is the exact solution met? A smooth ball under 70 N without friction has that of Hertz. An order of "
        "convergence says how fast errors fall on finer grids; its error is a difference. All other errors "
        f"are relative. *64 shifts*: mean over 64 positions of the ball between elements. File: {link(RUN)}."
    )
    shown = [case for case in run["cases"] if case["id"].startswith("hertz/")]
    small_slope = "hertz/small-slope"  # its reference is no solution of Hertz
    return listing("Hertz contact", text, (case for case in shown if case["id"] != small_slope), HERTZ)


CLAIMS: dict[str, Column] = {
    "verdict": lambda item: item.verdict,
    "where": lambda item: item.claim.label,
    "as printed": lambda item: f"“{quoted(item.claim.quote)}”",
    "found": lambda item: symbols(item.finding),
    "check, file": lambda item: _evidence(item),
}
CONDITIONS: dict[str, Column] = {
    "where": CLAIMS["where"],
    "as printed": CLAIMS["as printed"],
    "holds": lambda item: symbols(item.claim.condition),
    "check, file": CLAIMS["check, file"],
}


def _evidence(item: Judged) -> str:
    return f"`{item.cases[0]['id']}`, {origin(item.cases[0])}" if item.cases else "none"


def claims(evidence: Evidence) -> str:
    """List the paper's claims that do not hold, those that hold with conditions, and errata."""
    found = judged(evidence.cases, evidence.errata)
    doubted = [v for v in VERDICTS[: VERDICTS.index("confirmed")] if v != CONDITIONAL]
    shown = [item for verdict in doubted for item in found if item.verdict == verdict]
    conditional = [item for item in found if item.verdict == CONDITIONAL]
    text = (
        "Which statements hold only under a condition? *Holds* states it. The report has the numbers that "
        "were found (`make report`)."
    )
    return "\n\n".join(
        (
            listing("Claims of the paper", _counted(found), shown, CLAIMS),
            listing("Claims confirmed with conditions", text, conditional, CONDITIONS),
            errata(evidence),
        )
    )


def confirmed(items: Sequence[Judged]) -> str:
    """Return how many of the judged statements hold."""
    counts = counted(items)
    holds = counts["confirmed"] + counts[CONDITIONAL]
    judged = sum(count for verdict, count in counts.items() if verdict not in UNJUDGED)
    under = counts[CONDITIONAL]
    return (
        f"Of {judged} statements that are not true by definition {holds} are confirmed, {under} of these "
        "with conditions."
    )


def counted(items: Sequence[Judged]) -> dict[str, int]:
    """Return the number of statements by verdict."""
    return {verdict: sum(item.verdict == verdict for item in items) for verdict in VERDICTS}


def _counted(items: Sequence[Judged]) -> str:
    counts = counted(items)
    listed = ", ".join(f"{count} {verdict}" for verdict, count in counts.items() if count)
    return (
        f"Which statements of the paper hold? {confirmed(items)} This table has all others that were "
        "judged, the worst first. We read the paper as a text converted by machine, so a misprint may be "
        f"one of the conversion. The verdicts on all {len(items)} statements: {listed}."
    )


def errata(evidence: Evidence) -> str:
    """List printed text and its correction."""
    cases = {case["id"]: case for case in evidence.cases}
    columns: dict[str, Column] = {
        "equation": "equation",
        "printed": lambda erratum: quoted(erratum["printed"]),
        "corrected": lambda erratum: symbols(erratum["corrected"]),
        "measure": lambda erratum: symbols(erratum["measure"]),
        "as printed": "{printed_error:.2g}",
        "as corrected": "{corrected_error:.2g}",
        "file": lambda erratum: origin(cases[erratum["case"]]),
    }
    text = (
        "Which equations and numbers of the paper need a correction? *Measure* names an error that shows it. "
        "*As printed* is this error with the printed text, *as corrected* with the correction. A statement "
        "that needs a correction may have a worse verdict above."
    )
    return listing("Errata of the paper", text, evidence.errata, columns)
