"""``python -m reports.results_page``: write `reports/RESULTS.md`, the page of numbers, from the result files.

The page is for readers of the repository. The validation report (`make report`) holds every case and figure.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from reports.claims import VERDICTS, Judged, judged
from reports.evidence import Evidence, gathered
from reports.result_files import read_results
from reports.results import FORMAT, STATUSES, Case
from reports.studies.benchmarks import newest_rows
from reports.text import interval, percent, symbols

FOLDER = Path(__file__).with_name("results")
PAGE = Path(__file__).with_name("RESULTS.md")
RUN = "quick"
"""The run that the report is made of; the other files are beside it."""

INTRODUCTION = """# Results

The numbers of the committed result files. `python -m reports.results_page` writes this page; a test compares
the two. [results/README.md](results/README.md) names the command behind each file. `rough-friction verify
--stale` lists the files that are older than the code. `make report` makes the full report, with every case
and figure.

Symbols: μ friction coefficient, A real contact area, p_max maximum contact pressure, σ_e equivalent rms
roughness of both bodies. Claims quote the paper, where p_max is f_max. ± is a 95 % interval."""

Documents = Mapping[str, Any]
Row = Sequence[object]


def page(documents: Documents) -> str:
    """The page as Markdown, of all result files by name without suffix."""
    evidence = gathered(documents[RUN], {name: file for name, file in documents.items() if name != RUN})
    sections = (
        table_3(documents["reproduction"]),
        hertz(documents[RUN]),
        claims(evidence),
        coverage(documents),
        costs(documents["benchmarks"]),
        accuracy_costs(documents["tradeoff"]),
        checks(documents, evidence),
        studies(documents),
        codes(documents["cross_code"]),
    )
    return "\n\n".join([INTRODUCTION, *sections]) + "\n"


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


def coverage(documents: Documents) -> str:
    """Coverage of the reference by error bars."""
    labels = {
        "friction_coefficient": "μ",
        "contact_area": "A",
        "contact_area_corrected": "A, perimeter-corrected",
        "max_pressure": "p_max",
    }
    rows: list[Row] = []
    for name in ("coverage", "coverage_fresh"):
        for entry in documents[name]["accuracies"]:
            for quantity, label in labels.items():
                found = entry["numbers"][quantity]
                rows.append(
                    (
                        label,
                        f"{entry['accuracy']:g}",
                        found["scenes"],
                        percent(found["met"]),
                        percent(found["covered"]),
                        percent(found["covered_at_worst"]),
                        number(found["median_bar_over_error"], ".1f"),
                        number(found["median_cost"], ".1f"),
                        link(name),
                    )
                )
    head = (
        "number", "accuracy", "scenes", "reached", "covered", "covered at worst", "error bar over error",
        "cost", "file",
    )  # fmt: skip
    text = (
        "Error bars of 95 % against far finer grids, on random scenes that the estimator was not fitted to. "
        "*Reached*: on grids up to 512². *At worst*: the reference is off by its own bound, against the "
        "error bar. *Error bar over error* and *cost* are medians. The cost is in transforms, over that of "
        "the cheapest grid that would have been enough."
    )
    return section("Coverage of error bars", text, head, rows)


def costs(benchmarks: Mapping[str, Any]) -> str:
    """Seconds of this code and of published solvers, newest run of each."""
    own = {
        "refimpl-solver": "solver",
        "refimpl": "with error bars",
        "refimpl+friction": "with friction",
        "refimpl+friction+slopes": "with friction and slopes",
    }
    peers = {"aspher": "ASPHER", "tamaas": "Tamaas", "ContactMechanics": "ContactMechanics"}
    rows: list[Row] = []
    for (kind, M), entries in newest_rows(benchmarks["runs"]).items():
        found = {row["code"]: row for row in entries}
        cells = [number(median(found.get(code), "seconds")) for code in own]
        cells += [number(median(found.get(code, {}).get("ratio"), "seconds")) for code in peers]
        rows.append((f"{kind} flat", f"{M}²", *cells, link("benchmarks")))
    head = (
        "surface",
        "grid",
        *(f"{label} (s)" for label in own.values()),
        *(f"ratio: {label}" for label in peers.values()),
        "file",
    )
    text = (
        "Table 1's contact to a relative duality gap of 1e-8, recomputed for every code. Seconds of this "
        "code: the solver alone; from a scene to numbers with error bars; with friction; with friction and "
        "slopes. Of other codes: ratio of their time to this code's with error bars, median of the newest "
        "run on that grid. Runs are of several machines."
    )
    return section("Time", text, head, rows)


def median(row: Mapping[str, Any] | None, clock: str) -> float | None:
    """The median of a benchmark's row; None for a code that was not timed."""
    return None if row is None or clock not in row else row[clock]["median"]


def accuracy_costs(tradeoff: Mapping[str, Any]) -> str:
    """The cheapest configuration for each accuracy."""
    labels = {"friction_coefficient": "μ", "contact_area": "A", "max_pressure": "p_max"}
    rows: list[Row] = []
    for study in tradeoff["studies"]:
        for entry in study["prices"]:
            reached = entry["M"] is not None
            rows.append(
                (
                    study["scene"],
                    labels[entry["quantity"]],
                    f"{entry['error']:g}",
                    f"{entry['M']}²" if reached else "not reached",
                    f"{entry['seconds']:.2g}" if reached else "",
                    entry["way"] if reached else "",
                    link("tradeoff"),
                )
            )
    head = ("scene", "number", "relative error", "grid", "seconds", "configuration", "file")
    text = (
        "Cheapest configuration that keeps the error, against a grid of 4096². A configuration names the "
        "method and its tolerance; *flat* is without slope terms, *uncoupled* without normal-tangential "
        "coupling."
    )
    return section("Cost and accuracy", text, head, rows)


def checks(documents: Documents, evidence: Evidence) -> str:
    """Counts of statuses, by result file."""
    rows: list[Row] = []
    for name, run in documents.items():
        if run.get("format") == FORMAT:
            made = run["provenance"]
            selected = (
                ", ".join(f"`{pattern}`" for pattern in run["only"]) or f"all of the {run['tier']} tier"
            )
            counts = [run["counts"][status] for status in STATUSES]
            rows.append((link(name), selected, *counts, made["date"][:10], f"`{made['commit'][:12]}`"))
    total = [sum(case["status"] == status for case in evidence.cases) for status in STATUSES]
    listed = ", ".join(f"{count} {status}" for count, status in zip(total, STATUSES, strict=True))
    bad = [f"`{case['id']}` ({case['status']})" for case in evidence.cases if case["status"] != "pass"]
    text = f"{len(evidence.cases)} different checks: {listed}. Not passed: {', '.join(bad) or 'none'}."
    return section("Checks", text, ("file", "checks", *STATUSES, "date", "commit"), rows)


def studies(documents: Documents) -> str:
    """Quality of the verification itself: single numbers of the studies."""
    extremes, fuzz, faults = documents["extremes"]["counts"], documents["fuzz"], documents["fault_matrix"]
    drawn, chaos = documents["extremes_drawn"]["counts"], documents["chaos"]
    invariants, order, ensembles = documents["hypothesis"], documents["random_order"], documents["multilevel"]
    seen = sum(bool(fault["caught_by"]) for fault in faults["faults"])
    tests = [run["tests"] for run in order["runs"]]
    covered = {name: found["covered"] for name, found in ensembles["quantities"].items()}
    rows: list[Row] = [
        (
            "extreme inputs",
            f"{extremes['right']} right, {extremes['honest failure']} detected failures, "
            f"{extremes['wrong']} wrong, {extremes['crash']} crashes",
            link("extremes"),
        ),
        (
            "extreme inputs, all parameters drawn at random",
            f"{drawn['right']} right, {drawn['honest failure']} detected failures, "
            f"{drawn['wrong']} wrong, {drawn['crash']} crashes",
            link("extremes_drawn"),
        ),
        (
            "sweeps that are killed, copied and cut off",
            f"{chaos['sweeps']} tried, {chaos['different']} other tables, {chaos['tracebacks']} tracebacks",
            link("chaos"),
        ),
        (
            "damaged input files",
            f"{fuzz['inputs']} tried, {fuzz['tracebacks']} tracebacks, {fuzz['hangs']} hangs",
            link("fuzz"),
        ),
        (
            "random examples of invariants",
            f"{invariants['examples']} tried, {invariants['counterexamples']} counter-examples",
            link("hypothesis"),
        ),
        (
            "seeded faults in the code",
            f"{seen} of {len(faults['faults'])} detected, by {len(faults['checks'])} quick checks",
            link("fault_matrix"),
        ),
        *(
            (
                what,
                f"{100 * found['score']:.1f} % of {found['tried'] - found['equivalent']} detected; "
                f"95 % lower bound {100 * found['score_lower_bound']:.1f} %",
                link(name),
            )
            for what, name, found in (
                (
                    "mutants of the code, sample that tests were written for",
                    "mutation",
                    documents["mutation"],
                ),
                ("mutants of the code, fresh sample", "mutation_fresh", documents["mutation_fresh"]),
                ("mutants of the verification code", "mutation_judges", documents["mutation_judges"]),
            )
        ),
        (
            "tests in random order",
            f"{len(tests)} orders of {' to '.join(dict.fromkeys((str(min(tests)), str(max(tests)))))} tests, "
            + (
                "no test changes its outcome" if order["no_test_flips"] else "some tests change their outcome"
            ),
            link("random_order"),
        ),
        (
            "intervals of ensemble means",
            f"cover μ in {covered['friction_coefficient']} and A in {covered['contact_area']} of "
            f"{ensembles['repetitions']} repetitions",
            link("multilevel"),
        ),
    ]
    text = "How far the verification itself can be trusted, and what broad searches found."
    return section("Studies", text, ("study", "result", "file"), rows)


def codes(cross_code: Mapping[str, Any]) -> str:
    """Solvers through the suite of checks for other solvers."""
    roles = {"ours": "this code", "peer": "published solver", "trap": "negative control"}
    rows: list[Row] = [
        (
            entrant["name"],
            roles[entrant["role"]],
            *(entrant["counts"][status] for status in STATUSES),
            link("cross_code"),
        )
        for entrant in cross_code["entrants"]
    ]
    text = "Unavailable: outside a solver's abilities. A negative control is set up wrongly on purpose."
    return section(
        "Solvers in the suite for other solvers", text, ("solver", "role", *STATUSES, "file"), rows
    )


def section(title: str, text: str, head: Sequence[str], rows: Sequence[Row]) -> str:
    """A heading, a paragraph, and a table."""
    return "\n\n".join(filter(None, (f"## {title}", text, "\n".join(_table(head, rows)))))


def _table(head: Sequence[str], rows: Sequence[Row]) -> Iterator[str]:
    yield f"| {' | '.join(head)} |"
    yield "|" + "---|" * len(head)
    for row in rows:
        yield f"| {' | '.join(str(cell).replace('|', chr(92) + '|') for cell in row)} |"


def number(value: float | None, digits: str = ".2g") -> str:
    """A number in a table; a dash where there is none."""
    return "-" if value is None else format(value, digits)


def link(name: str) -> str:
    """A link to a result file."""
    return f"[{name}.json](results/{name}.json)"


def origin(case: Case) -> str:
    """A link to the file that holds the case."""
    return link(RUN if case["origin"] is None else case["origin"]["file"].removesuffix(".json"))


def main() -> None:
    """Write the page."""
    PAGE.write_text(page(read_results(FOLDER)), encoding="utf-8")


if __name__ == "__main__":
    main()
