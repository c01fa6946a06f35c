"""Tables of what the paper prints against what is computed: Table 3, Hertz, claims, errata."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from reports.agreement import Number, fine
from reports.claims import CONDITIONAL, UNJUDGED, VERDICTS, Judged, judged
from reports.evidence import Evidence
from reports.exhibit import Column
from reports.result_tables import RUN, link, listing, origin
from reports.results import Case
from reports.text import interval, quoted, symbols, unit_of

TABLE_3: dict[str, Column] = {
    "half-space": lambda n: n.label.partition(", ")[0],
    "grid": lambda n: n.label.partition(", ")[2],
    "number": lambda n: n.quantity.partition(",")[0] + (f" ({n.unit})" if n.unit else ""),
    "printed": lambda n: f"{n.printed:.4g}",
    "computed": lambda n: interval(n.computed, n.half_width),
    "E (%)": lambda n: f"{100 * n.difference / n.printed:+.1f}",
    "u (%)": lambda n: f"{100 * n.uncertainty / n.printed:.1f}",
    "agrees": lambda n: "yes" if n.within else "no",
    "file": lambda n: link("reproduction"),
}


def table_3(found: Sequence[Number]) -> str:
    """Show the paper's Table 3, printed and computed, with the difference E and its uncertainty u."""
    labels = list(dict.fromkeys(n.label for n in found if n.part == "Table 3"))
    rows = [n for label in labels for n in found if (n.part, n.label) == ("Table 3", label)]
    finest = fine(found)
    text = (
        "Are the numbers of Table 3 reproduced? "
        f"On its fine mesh, 512², {sum(n.within for n in finest)} of {len(finest)} agree. "
        "A load of 70 N presses the ball of Table 1 on a flat. The first column has the rms roughness of the "
        "flat. Numbers of rough flats are means over 75 random surfaces. E is the computed number minus the "
        "printed one. u is the uncertainty of E (95 %): sampling of random surfaces, and rounding of the "
        "printed number and of the printed inputs. A number agrees if abs(E) is at most u."
    )
    return listing("Table 3 of the paper", text, rows, TABLE_3)


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
    "file": lambda case: link(RUN),
}


def hertz(run: Mapping[str, Any]) -> str:
    """Show the smooth ball against Hertz' solution."""
    text = (
        "A smooth ball under 70 N without friction has the exact solution of Hertz. An order of convergence "
        "states how fast errors fall on finer grids. The last row is the excess of the maximum pressure by "
        "slope terms, for a ball that is pressed deep. Its error and those of orders are differences, all "
        "others relative."
    )
    return listing("Hertz contact", text, (c for c in run["cases"] if c["id"].startswith("hertz/")), HERTZ)


CLAIMS: dict[str, Column] = {
    "verdict": lambda item: item.verdict,
    "where": lambda item: item.claim.label,
    "as printed": lambda item: f"“{quoted(item.claim.quote)}”",
    "found": lambda item: symbols(item.finding),
    "evidence": lambda item: ", ".join(f"`{case['id']}`" for case in item.cases[:2]),
    "file": lambda item: origin(item.cases[0]),
}


def claims(evidence: Evidence) -> str:
    """List the paper's claims that do not hold or hold with conditions, and errata."""
    found = judged(evidence.cases, evidence.errata)
    listed = VERDICTS[: VERDICTS.index("confirmed")]
    shown = [item for verdict in listed for item in found if item.verdict == verdict and item.cases]
    return "\n\n".join([listing("Claims of the paper", _counted(found), shown, CLAIMS), errata(evidence)])


def confirmed(items: Sequence[Judged]) -> str:
    """Return how many of the judged statements hold."""
    counts = counted(items)
    holds = counts["confirmed"] + counts[CONDITIONAL]
    judged = sum(count for verdict, count in counts.items() if verdict not in UNJUDGED)
    under = counts[CONDITIONAL]
    return (
        f"Of {judged} judged statements of the paper {holds} are confirmed, {under} of these with conditions."
    )


def counted(items: Sequence[Judged]) -> dict[str, int]:
    """Return the number of statements by verdict."""
    return {verdict: sum(item.verdict == verdict for item in items) for verdict in VERDICTS}


def _counted(items: Sequence[Judged]) -> str:
    counts = counted(items)
    listed = ", ".join(f"{count} {verdict}" for verdict, count in counts.items() if count)
    return (
        f"Which statements of the paper hold? {confirmed(items)} The table has those that do not hold as "
        "printed or need conditions, the worst first; `make report` shows all. We read the paper as a text "
        "converted by machine, so a misprint may be one of the conversion. "
        f"The verdicts on all {len(items)} statements: {listed}."
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
        "*As printed* is this error with the printed text, *as corrected* with the correction."
    )
    return listing("Errata of the paper", text, evidence.errata, columns)
