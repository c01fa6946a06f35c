"""Tables of what the paper prints against what is computed: Table 3, Hertz, claims, errata."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from reports.claims import VERDICTS, Judged, judged
from reports.evidence import Evidence
from reports.result_tables.markdown import RUN, Row, link, origin, section
from reports.text import interval, symbols


def table_3(reproduction: Mapping[str, Any]) -> str:
    """The paper's Table 3, printed and computed."""
    cases = {case["id"]: case["data"] for case in reproduction["cases"]}
    mu, area, peak = (cases[f"reproduction/table3-{name}-full"] for name in ("mu", "area", "peak"))
    rows: list[Row] = []
    for k, roughness in enumerate(mu["sigma_e (um)"]):
        cells: list[object] = [f"{roughness:.3f}", f"{mu['mesh'][k]}²", mu["realisations"][k]]
        for found, scale in ((mu, 1.0), (area, 1e6), (peak, 1e-9)):
            computed, half_width = scale * found["ours"][k], scale * found["half width 95 %"][k]
            cells += [f"{scale * found['printed'][k]:.4g}", interval(computed, half_width)]
        rows.append([*cells, link("reproduction")])
    head = (
        "σ_e (µm)", "grid", "surfaces", "μ printed", "μ computed", "A printed (mm²)", "A computed (mm²)",
        "p_max printed (GPa)", "p_max computed (GPa)", "file",
    )  # fmt: skip
    text = (
        "Table 1's ball on a flat under 70 N, as printed in the paper and as computed here: means over "
        "random surfaces. The interval is of the mean."
    )
    return section("Table 3 of the paper", text, head, rows)


def hertz(run: Mapping[str, Any]) -> str:
    """The smooth ball against Hertz' solution."""
    rows: list[Row] = []
    for case in run["cases"]:
        if case["id"].startswith("hertz/"):
            unit, scale = {"Pa": ("MPa", 1e-6), "m": ("µm", 1e6)}.get(case["unit"], (case["unit"], 1.0))
            value, reference = (None if x is None else scale * x for x in (case["value"], case["reference"]))
            rows.append(
                (
                    case["title"],
                    unit,
                    "" if reference is None else f"{value:.7g}",
                    "" if reference is None else f"{reference:.7g}",
                    f"{case['error']:.1e}",
                    f"{case['tolerance']:.1e}",
                    case["status"],
                    link(RUN),
                )
            )
    head = ("quantity", "unit", "computed", "exact", "error", "tolerance", "status", "file")
    text = (
        "Smooth ball under 70 N without friction. Errors of quantities are relative, errors of orders of "
        "convergence absolute."
    )
    return section("Hertz contact", text, head, rows)


def claims(evidence: Evidence) -> str:
    """List the paper's claims that do not hold or hold with conditions, and errata."""
    found = judged(evidence.cases, evidence.errata)
    rows: list[Row] = [
        (
            item.verdict,
            item.claim.label,
            f"“{symbols(item.claim.quote)}”",
            symbols(item.finding),
            ", ".join(f"`{case['id']}`" for case in item.cases[:2]),
            origin(item.cases[0]),
        )
        for verdict in VERDICTS[:4]
        for item in found
        if item.verdict == verdict and item.cases
    ]
    head = ("verdict", "where", "as printed", "found", "evidence", "file")
    return "\n\n".join([section("Claims of the paper", _counted(found), head, rows), errata(evidence)])


def _counted(items: Sequence[Judged]) -> str:
    counts = {verdict: sum(item.verdict == verdict for item in items) for verdict in VERDICTS}
    listed = ", ".join(f"{count} {verdict}" for verdict, count in counts.items() if count)
    return (
        f"Of {len(items)} statements of the paper (Karpenko and Akay 2001, text converted by machine): "
        f"{listed}. "
        "Confirmed ones, definitions and schematic drawings are in the report (`make report`)."
    )


def errata(evidence: Evidence) -> str:
    """List printed text and its correction."""
    cases = {case["id"]: case for case in evidence.cases}
    rows = [
        (
            erratum["equation"],
            symbols(erratum["printed"]),
            symbols(erratum["corrected"]),
            symbols(erratum["measure"]),
            f"{erratum['printed_error']:.2g}",
            f"{erratum['corrected_error']:.2g}",
            origin(cases[erratum["case"]]),
        )
        for erratum in evidence.errata
    ]
    head = ("equation", "printed", "corrected", "measure", "as printed", "as corrected", "file")
    return section("Errata of the paper", "", head, rows)
