"""``python -m reports.results_page``: write `reports/RESULTS.md`, the page of numbers, from the result files.

The page is for readers of the repository. The report (`make report`) holds every case and figure.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from reports.evidence import gathered
from reports.result_tables import RUN
from reports.result_tables.code import (
    accuracy_costs,
    checks,
    codes,
    costs,
    coverage,
    coverage_of_others,
    studies,
)
from reports.result_tables.paper import claims, hertz, table_3
from verification.output.result_files import read_results

FOLDER = Path(__file__).with_name("results")
PAGE = Path(__file__).with_name("RESULTS.md")

INTRODUCTION = """# Results

The numbers of the committed result files. `python -m reports.results_page` writes this page; a test compares
the two. [results/README.md](results/README.md) names the command behind each file. `make results`
makes those of all cases again. `make report` makes the full report, with every case and figure.

Symbols: μ friction coefficient, A real contact area, p_max maximum contact pressure, σ_e equivalent rms
roughness of both bodies. Claims quote the paper, where p_max is f_max. ± is a 95 % interval."""


def page(documents: Mapping[str, Any]) -> str:
    """Return the page as Markdown, of all result files by name without suffix."""
    evidence = gathered(documents[RUN], {name: file for name, file in documents.items() if name != RUN})
    sections = (
        table_3(documents["reproduction"]),
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
    return "\n\n".join([INTRODUCTION, *sections]) + "\n"


def main() -> None:
    """Write the page."""
    PAGE.write_text(page(read_results(FOLDER)), encoding="utf-8")


if __name__ == "__main__":
    main()
