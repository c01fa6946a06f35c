"""Tables of what the paper prints against what is computed: Table 3, Hertz, claims, errata."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from reports.agreement import column_of
from reports.claims import VERDICTS, Judged, judged
from reports.evidence import Evidence
from reports.exhibit import Column
from reports.result_tables import RUN, Row, link, listing, origin, section
from reports.results import Case
from reports.text import interval, quoted, symbols, unit_of


def table_3(reproduction: Mapping[str, Any]) -> str:
    """Show the paper's Table 3, printed and computed."""
    cases = {case["id"]: case["data"] for case in reproduction["cases"]}
    data = [cases[f"reproduction/table3-{name}-full"] for name in ("mu", "area", "peak")]
    first = data[0]
    rows: list[Row] = []
    for k, roughness in enumerate(first["sigma_e (um)"]):
        cells: list[object] = [column_of(roughness), f"{first['mesh'][k]}²", first["realisations"][k]]
        for found, scale in zip(data, (1.0, 1e6, 1e-9), strict=True):
            computed, half_width = scale * found["ours"][k], scale * found["half width 95 %"][k]
            cells += [f"{scale * found['printed'][k]:.4g}", interval(computed, half_width)]
        rows.append([*cells, link("reproduction")])
    head = (
        "half-space", "grid", "surfaces", "μ printed", "μ computed", "A printed (mm²)", "A computed (mm²)",
        "p_max printed (GPa)", "p_max computed (GPa)", "file",
    )  # fmt: skip
    text = (
        "Table 1's ball on a flat under 70 N, as printed in the paper and as computed here: means over "
        "random surfaces. Columns are named by the half-space's rms roughness, as in the paper. The "
        "interval is of the mean."
    )
    return section("Table 3 of the paper", text, head, rows)


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
        "Smooth ball under 70 N without friction. Errors of quantities are relative, errors of orders of "
        "convergence absolute."
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


def _counted(items: Sequence[Judged]) -> str:
    counts = {verdict: sum(item.verdict == verdict for item in items) for verdict in VERDICTS}
    listed = ", ".join(f"{count} {verdict}" for verdict, count in counts.items() if count)
    return (
        f"Of {len(items)} statements of the paper (Karpenko and Akay 2001, text converted by machine): "
        f"{listed}. "
        "Listed are those that do not hold as printed or need conditions; `make report` shows all."
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
    return listing("Errata of the paper", "", evidence.errata, columns)
