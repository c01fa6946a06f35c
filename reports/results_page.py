"""``python -m reports.results_page``: write `reports/RESULTS.md`, the page of numbers, from the result files.

The page is for readers of the repository. The report (`make report`) holds every case and figure.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from reports.agreement import Number, fine, numbers, printed
from reports.claims import judged
from reports.evidence import Evidence, gathered
from reports.findings import by_claim
from reports.result_tables import RUN
from reports.result_tables.code import (
    MU,
    accuracy_costs,
    checks,
    codes,
    costs,
    coverage,
    coverage_of_others,
    studies,
)
from reports.result_tables.paper import claims, confirmed, hertz, table_3
from reports.results import shown_counts
from reports.text import percent
from verification.output.result_files import read_results

FOLDER = Path(__file__).with_name("results")
PAGE = Path(__file__).with_name("RESULTS.md")

INTRODUCTION = """# Results

- The friction of a rough pair is **not validated**: no experiment was found that states all inputs.
- {agree} of {printed} printed numbers agree with ours within their uncertainty u.
- On the fine mesh of Table 3 {fine} of {of_fine} agree.
- {claims}
- Of {checks} [checks](#checks) of the code: {statuses} (`recorded`: the tolerance was set from the result).
- Error bars of μ cover the reference in {covered} of {scenes} random scenes.

The numbers are those of the committed result files. `make report` makes the full report, with every case and
figure. [results/README.md](results/README.md) names the command behind each file.
`python -m reports.results_page` writes this page; a test compares the two.

Symbols: μ friction coefficient, A real contact area, p_max maximum contact pressure, σ_e equivalent rms
roughness of both bodies. Claims quote the paper, where p_max is f_max. ± is a 95 % interval."""


def page(documents: Mapping[str, Any]) -> str:
    """Return the page as Markdown, of all result files by name without suffix."""
    evidence = gathered(documents[RUN], {name: file for name, file in documents.items() if name != RUN})
    found = numbers(by_claim(evidence.cases))
    sections = (
        _introduction(documents, evidence, found),
        table_3(found),
        hertz(documents[RUN]),
        claims(evidence),
        coverage(documents),
        costs(documents["benchmarks"]),
        accuracy_costs(documents["accuracy_costs"]),
        checks(documents, evidence),
        studies(documents),
        codes(documents["cross_code"]),
        coverage_of_others(documents),
    )
    return "\n\n".join(sections) + "\n"


def _introduction(documents: Mapping[str, Any], evidence: Evidence, found: Sequence[Number]) -> str:
    within, finest = printed(found).values(), fine(found)
    rows = documents["coverage_corrected"]["table"]
    (bars,) = (row for row in rows if row["class"] is None and row["number"] == MU)
    return INTRODUCTION.format(
        agree=sum(within),
        printed=len(within),
        fine=sum(n.within for n in finest),
        of_fine=len(finest),
        claims=confirmed(judged(evidence.cases, evidence.errata)),
        checks=len(evidence.cases),
        statuses=", ".join(f"{n} {status}" for status, n in shown_counts(evidence.cases).items()),
        covered=percent(bars["held"]),
        scenes=bars["scenes"],
    )


def main() -> None:
    """Write the page."""
    PAGE.write_text(page(read_results(FOLDER)), encoding="utf-8")


if __name__ == "__main__":
    main()
