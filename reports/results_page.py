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
    studies,
)
from reports.result_tables.paper import claims, confirmed, hertz, others, table_3
from reports.results import shown_counts
from reports.text import percent
from verification.output.result_files import read_results

FOLDER = Path(__file__).with_name("results")
PAGE = Path(__file__).with_name("RESULTS.md")

INTRODUCTION = """# Results

You want a number that was computed here, and the file behind it. Find your question:

- Do error bars contain the right value? Those of μ do in {covered} of {scenes} random scenes
  ([coverage](#coverage-of-error-bars)).
- Which grid do I need, and how long does a grid take? See [cost and accuracy](#cost-and-accuracy) and
  [time](#time).
- Does μ agree with experiments? The friction of a rough pair is **not validated**: no experiment was found
  that states all inputs. [What was compared](../docs/experiments.md).
- Are the numbers of the paper reproduced? It prints {printed}, and {agree} of the {printed}
  agree with ours within the uncertainty of the difference. On the fine mesh of
  [Table 3](#table-3-of-the-paper) {fine} of {of_fine} agree.
- Do the statements of the paper hold? {claims} See [claims](#claims-of-the-paper) and
  [errata](#errata-of-the-paper).
- Does the code pass its own checks? Of {checks} [checks](#checks): {statuses}. The tolerance of a `recorded`
  check was set from its own result.
- Is an exact solution met? See [Hertz contact](#hertz-contact). Were wrong results found? See
  [studies](#studies).
- How do other codes fare? See [solvers in the suite](#solvers-in-the-suite-for-other-solvers).

The paper is that of Karpenko and Akay (2001). Every table names its result file;
[results/README.md](results/README.md) has the command that made the file. `make report` makes the full
report, with every case and figure. `python -m reports.results_page` writes this page from the files.

Symbols: μ friction coefficient, A real contact area, p_max maximum contact pressure, σ_e equivalent rms
roughness of both bodies, ψ plasticity index of Eq. (12), a half-width of a loaded element. In quotes of the
paper, p_max is f_max. ± is a 95 % interval."""


def page(documents: Mapping[str, Any]) -> str:
    """Return the page as Markdown, of all result files by name without suffix."""
    evidence = gathered(documents[RUN], {name: file for name, file in documents.items() if name != RUN})
    found = numbers(by_claim(evidence.cases))
    sections = (
        _introduction(documents, evidence, found),
        coverage(documents),
        accuracy_costs(documents["accuracy_costs"]),
        costs(documents["benchmarks"]),
        table_3(found),
        others(found),
        hertz(documents[RUN]),
        claims(evidence),
        codes(documents["cross_code"]),
        checks(documents, evidence),
        studies(documents),
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
